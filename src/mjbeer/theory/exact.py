"""The exact motion of a scene that rolls without slipping, from theory alone."""

import math

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory import motion
from mjbeer.theory.measure import angle_distance
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory


def exact(scene: Scene, time: ArrayLike, phi0: float, phi_dot0: float = 0.0) -> Trajectory:
    """Exact motion at the given times.

    `time` [s] is any array of times at or after the start at 0; `phi0` [rad] and `phi_dot0` [rad/s] are
    the start. The axis starts at u = b sin(phi0), u_dot = b cos(phi0) phi_dot0 for a sliding load (its
    centre of mass at s = 0 and at rest along the incline) and at u = a phi0 for a frozen one.

    Raises:
      ParameterError: on times or starts that are not finite, or times before 0.
      NoLibrationError: if the start lies exactly on the separatrix.
    """
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    time = np.atleast_1d(np.asarray(time, dtype=float))
    if time.ndim != 1 or not np.isfinite(time).all() or (time < 0).any():
        raise ParameterError("time must be a one-dimensional array of finite times at or after 0 [s]")
    phi, phi_dot = motion.solve(scene.oscillator, time, phi0, phi_dot0)
    u, u_dot = _axis(scene, time, phi, phi_dot, scene.start(phi0, phi_dot0))
    radius, still = scene.can.radius, np.zeros_like(time)
    return Trajectory(
        scene=scene,
        time=time,
        u=u,
        phi=phi,
        u_dot=u_dot,
        phi_dot=phi_dot,
        roll=u / radius,
        roll_dot=u_dot / radius,
        lift=still,
        lift_dot=still,
    )


def phi_error(trajectory: Trajectory, relative: bool = False) -> float:
    """Largest distance of phi from the exact motion with the same start [rad].

    If `relative`, it is that over the angle that phi has turned, where that exceeds 1 rad: what a tolerance bounds.
    """
    truth = exact(trajectory.scene, trajectory.time, trajectory.phi[0], trajectory.phi_dot[0])
    return angle_distance(trajectory.phi, truth.phi, relative)


def _axis(
    scene: Scene, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, start: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """u [m] and u_dot [m/s] of the axis: eq. (50) for a frozen load.

    For a sliding load M_e u_dot - m b cos(phi) phi_dot - (m + m_can) g sin(alpha) t is conserved, the
    integral of eq. (46); eq. (12) with eq. (1) if the can is massless.
    """
    if scene.attachment == "frozen":
        return scene.can.radius * phi, scene.can.radius * phi_dot
    rolling = scene.can.mass + scene.can.inertia / scene.can.radius**2
    total = scene.load.mass + rolling
    moment = scene.load.mass * scene.load.offset
    drive = scene.mass * scene.gravity * math.sin(scene.incline)
    u = (drive * time**2 / 2 + moment * np.sin(phi) + rolling * (start[0] + start[1] * time)) / total
    u_dot = (drive * time + moment * np.cos(phi) * phi_dot + rolling * start[1]) / total
    return u, u_dot
