"""The exact motion of a scene that rolls without slipping, from theory alone."""

import math

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory import motion, viscous
from mjbeer.theory.measure import angle_distance
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory


def exact(scene: Scene, time: ArrayLike, phi0: float, phi_dot0: float = 0.0) -> Trajectory:
    """Return the exact motion of a scene that starts with `phi0` [rad] and `phi_dot0` [rad/s] at time 0.

    `time` [s] has the times of the samples, in any order, none before 0. For a sliding load the axis starts at
    u = b sin(phi0) with u_dot = b cos(phi0) phi_dot0, so that the load's centre of mass is at s = 0 and at rest
    along the incline; for a frozen load it starts at u = a phi0 with u_dot = a phi_dot0.

    A start beyond a whole turn gives an `AngleWarning`, as degrees may have been meant.

    Raises:
      ParameterError: if `scene` is no scene, a time is negative or not finite, the start is not between -1e4 and 1e4
        rad or -1e6 and 1e6 rad/s, or the motion is too extreme for double precision.
      NoLibrationError: if the start is so near the separatrix that its rounding decides how the motion goes on.
      ToleranceError: if the times are so late that the rounding of the scene changes phi by more than 1e-4 rad; with
        damping or drag, also if the start is so near an unstable balance, or the motion takes too many steps.
    """
    require.instance("scene", scene, Scene)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    require.radians(phi0)
    return solution(scene, require.times("time", time), phi0, phi_dot0)


def solution(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> Trajectory:
    """Return what `exact` returns, without a warning about the start."""
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            if scene.dissipates:
                phi, phi_dot, u, u_dot = viscous.solve(scene, time, phi0=phi0, phi_dot0=phi_dot0)
            else:
                phi, phi_dot = motion.solve(scene.oscillator, time, phi0=phi0, phi_dot0=phi_dot0)
                u, u_dot = _axis(scene, time, phi=phi, phi_dot=phi_dot, start=scene.start(phi0, phi_dot0))
            roll, roll_dot = u / scene.can.radius, u_dot / scene.can.radius
    except (ArithmeticError, ValueError) as error:
        raise ParameterError(
            f"this motion is beyond double precision ({error}), got phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s "
            f"until {float(time.max())!r} s in {scene!r}"
        ) from error
    zeros = np.zeros_like(time)
    return Trajectory(
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        time=time,
        u=u,
        phi=phi,
        u_dot=u_dot,
        phi_dot=phi_dot,
        roll=roll,
        roll_dot=roll_dot,
        lift=zeros,
        lift_dot=zeros,
    )


def phi_error(trajectory: Trajectory, relative: bool = False) -> float:
    """Return the largest distance of phi [rad] from the exact motion with the same start.

    If `relative`, the distance is divided by the angle that phi has turned, where that exceeds 1 rad: this is the
    error that a tolerance bounds.
    """
    truth = solution(trajectory.scene, trajectory.time, trajectory.phi0, trajectory.phi_dot0)
    return angle_distance(trajectory.phi, truth.phi, trajectory.phi0 if relative else None)


def _axis(
    scene: Scene, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, start: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Return u [m] and u_dot [m/s] of the axis, which is at `start` at time 0.

    A frozen load has u = a phi, eq. (50). With a sliding load M_e u_dot - m b cos(phi) phi_dot -
    (m + m_can) g sin(alpha) t is conserved, the integral of eq. (46); for a massless can this is eq. (12) with eq. (1).
    """
    if scene.attachment == "frozen":
        return scene.can.radius * phi, scene.can.radius * phi_dot
    effective_can_mass = scene.can.mass + scene.can.inertia / scene.can.radius**2
    total = scene.load.mass + effective_can_mass
    moment = scene.load.mass * scene.load.offset
    drive = scene.mass * scene.gravity * math.sin(scene.incline)
    u = (drive * time**2 / 2 + moment * np.sin(phi) + effective_can_mass * (start[0] + start[1] * time)) / total
    u_dot = (drive * time + moment * np.cos(phi) * phi_dot + effective_can_mass * start[1]) / total
    return u, u_dot
