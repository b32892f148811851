"""The equations of motion of a can that rolls without slipping: accelerations, forces and energy.

The accelerations are those of eqs. (46) and (47), with damping and drag added. The normal force N and the friction
force F of the incline follow from them. N < 0 means that it would have to pull, |F| > mu N that the can would slip.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False, kw_only=True)
class Coordinates:
    """A motion in the coordinates of the paper's Fig. 3; every array has shape (samples,)."""

    time: np.ndarray
    """Time [s]."""
    u: np.ndarray
    """Place of the axis along the incline [m], positive downhill; at time 0 as `Scene.start` says."""
    phi: np.ndarray
    """Angle of the load [rad]: 0 where its centre of mass is nearest to the incline; it grows as a can rolls down."""
    u_dot: np.ndarray
    """Velocity of the axis down the incline [m/s]."""
    phi_dot: np.ndarray
    """Rate of phi [rad/s]."""
    roll: np.ndarray
    """Angle by which the can has rolled [rad]; u/a where it does not slip."""
    roll_dot: np.ndarray
    """Rate of roll [rad/s]."""
    lift: np.ndarray
    """Height of the can above the incline [m]; slightly negative in a soft contact."""
    lift_dot: np.ndarray
    """Velocity of the can away from the incline [m/s]."""


def select_samples(motion: Coordinates, samples: np.ndarray | list[int] | slice) -> Coordinates:
    """Return some of the samples of a motion."""
    return Coordinates(**{name: getattr(motion, name)[samples] for name in Coordinates.__dataclass_fields__})


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces of the incline on the can along a motion; both arrays have shape (samples,)."""

    normal: np.ndarray
    """N [N], positive away from the incline."""
    friction: np.ndarray
    """F [N], positive up the incline."""

    @property
    def needed_friction(self) -> np.ndarray:
        """Return the friction coefficient |F|/N that rolling needs; infinite where the incline would have to pull."""
        ratio = np.full_like(self.normal, np.inf)
        return np.divide(np.abs(self.friction), self.normal, out=ratio, where=self.normal > 0)


def accelerations(
    scene: Scene,
    phi: np.ndarray | float,
    phi_dot: np.ndarray | float,
    u_dot: np.ndarray | float,
    slip: np.ndarray | float | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return u_ddot [m/s^2] and phi_ddot [rad/s^2] of rolling without slipping.

    The state is `phi` [rad], `phi_dot` [rad/s] and `u_dot` [m/s], of which the last matters to damping and drag alone.
    Give the `slip` rate u_dot/a - phi_dot [rad/s] where it has more digits than the difference.
    """
    if scene.attachment == "frozen":
        phi_ddot = scene.oscillator.acceleration(phi, phi_dot)
        return scene.can.radius * phi_ddot, phi_ddot
    mass, lever, along, torque = scene.effective_mass, scene.load.moment * np.cos(phi), scene.downhill_weight, 0.0
    if scene.dissipates:
        # Torque T and drag D act beside the forces of eqs. (46) and (47). Without u_ddot, which eq. (46) gives, they
        # turn phi by T - (m b cos(phi) / M) (T / a + D), against the inertia J(phi).
        torque = scene.damping_law.torque(slip_rate(scene, phi_dot, u_dot) if slip is None else slip)
        braking = torque / scene.can.radius + scene.drag * u_dot * np.abs(u_dot)
        along, torque = along - braking, torque - lever / mass * braking
    phi_ddot = scene.oscillator.acceleration(phi, phi_dot, torque)
    return (along + lever * phi_ddot - scene.load.moment * np.sin(phi) * phi_dot**2) / mass, phi_ddot  # eq. (46)


def axis_motion(
    scene: Scene, time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, start: tuple[float, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Return u [m] and u_dot [m/s] of rolling without damping and drag, from phi at times [s] since the `start`.

    The start is phi, phi_dot, u and u_dot. A frozen load has u = a phi, eq. (50). With a sliding load
    M_e u_dot - m b cos(phi) phi_dot - (m + m_can) g sin(alpha) t is conserved, the integral of eq. (46).
    """
    if scene.attachment == "frozen":
        return scene.can.radius * phi, scene.can.radius * phi_dot
    phi0, phi_dot0, u0, u_dot0 = start
    arm, steady = scene.load.moment / scene.effective_mass, scene.downhill_weight / scene.effective_mass
    mean_u, mean_u_dot = u0 - arm * math.sin(phi0), u_dot0 - arm * math.cos(phi0) * phi_dot0
    u = arm * np.sin(phi) + (mean_u + mean_u_dot * time + steady * time**2 / 2)
    return u, arm * np.cos(phi) * phi_dot + (mean_u_dot + steady * time)


def slip_rate(scene: Scene, phi_dot: np.ndarray | float, u_dot: np.ndarray | float) -> np.ndarray | float:
    """Return by how much the rolling can turns faster than its load, w = u_dot/a - phi_dot [rad/s]."""
    return u_dot / scene.can.radius - phi_dot


def rolling_forces(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> Forces:
    """Return N and F [N] that rolling without slipping needs in a state, as `accelerations` takes it."""
    sin, cos, square, moment = np.sin(phi), np.cos(phi), phi_dot**2, scene.load.moment
    u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, u_dot)
    normal = scene.mass * scene.gravity * math.cos(scene.incline) + moment * (sin * phi_ddot + cos * square)
    if scene.attachment == "frozen":
        return Forces(normal, scene.downhill_weight - (scene.mass * u_ddot - moment * (cos * phi_ddot - sin * square)))
    damping = scene.damping_law.torque(slip_rate(scene, phi_dot, u_dot)) / scene.can.radius
    return Forces(normal, scene.can.inertia / scene.can.radius**2 * u_ddot + damping)  # both turn the can


def potential_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the potential energy [J] of can and load at each sample, 0 with all mass at u = 0 on the axis."""
    return -scene.gravity * (
        scene.mass * (motion.u * math.sin(scene.incline) - motion.lift * math.cos(scene.incline))
        + scene.load.moment * np.cos(scene.incline + motion.phi)
    )


def kinetic_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the kinetic energy [J] of can and load at each sample: eqs. (39) and (44), with slip and lift added."""
    can, load = scene.can, scene.load
    along = motion.u_dot - load.offset * np.cos(motion.phi) * motion.phi_dot
    across = motion.lift_dot + load.offset * np.sin(motion.phi) * motion.phi_dot
    return (
        can.mass * (motion.u_dot**2 + motion.lift_dot**2)
        + can.inertia * motion.roll_dot**2
        + load.mass * (along**2 + across**2)
        + load.inertia * motion.phi_dot**2
    ) / 2
