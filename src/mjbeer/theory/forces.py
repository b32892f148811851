"""The normal force N and the friction force F with which the incline keeps a can rolling.

Both follow from Newton's second law for the centre of mass of can and load, with the
accelerations that rolling without slipping implies. N < 0 means that the incline would
have to pull; |F| > mu N means that the can would slip.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces of the incline on the can along a motion; both arrays have shape (samples,)."""

    normal: np.ndarray
    """N [N], positive away from the incline."""
    friction: np.ndarray
    """F [N], positive up the incline."""

    @property
    def needed(self) -> np.ndarray:
        """Return the friction coefficient |F|/N that rolling needs; infinite where the incline would have to pull."""
        ratio = np.full_like(self.normal, np.inf)
        return np.divide(np.abs(self.friction), self.normal, out=ratio, where=self.normal > 0)


def accelerations(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray]:
    """Return u_ddot [m/s^2] and phi_ddot [rad/s^2] of rolling without slipping.

    The state is `phi` [rad], `phi_dot` [rad/s] and `u_dot` [m/s], of which the last matters to damping and drag alone.
    """
    u_ddot, phi_ddot, _, _ = _accelerations(scene, phi, phi_dot, u_dot)
    return u_ddot, phi_ddot


def _accelerations(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return u_ddot [m/s^2], phi_ddot [rad/s^2], and how the load's centre of mass accelerates relative to the axis.

    The latter are over b [1/s^2]: away from the incline, and uphill.
    """
    sin, cos, square = np.sin(phi), np.cos(phi), phi_dot**2
    phi_ddot = scene.oscillator.acceleration(phi, phi_dot)
    along, effective_mass = 0.0, scene.mass + scene.can.inertia / scene.can.radius**2
    if scene.dissipates:
        # Torque T and drag D act beside the forces of eqs. (46) and (47). Without u_ddot, which eq. (46) gives, they
        # turn phi by T - (m b cos(phi) / M) (T / a + D), against the inertia J(phi).
        torque, along = dissipation(scene, phi_dot, u_dot)
        arm = scene.load.mass * scene.load.offset * cos / effective_mass
        phi_ddot = phi_ddot + (torque + arm * along) / scene.oscillator.inertia(phi)
    across, uphill = sin * phi_ddot + cos * square, cos * phi_ddot - sin * square
    if scene.attachment == "frozen":
        return scene.can.radius * phi_ddot, phi_ddot, across, uphill
    force = scene.mass * scene.gravity * math.sin(scene.incline) + scene.load.mass * scene.load.offset * uphill
    return (force + along) / effective_mass, phi_ddot, across, uphill  # eq. (46)


def dissipation(
    scene: Scene, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> tuple[np.ndarray | float, np.ndarray | float]:
    """Return the torque on the load [N m], and the force down the incline on the axis [N], of damping and drag."""
    torque = scene.damping_law.torque(slip_rate(scene, phi_dot, u_dot))
    return torque, -torque / scene.can.radius - scene.drag * u_dot * np.abs(u_dot)


def slip_rate(scene: Scene, phi_dot: np.ndarray | float, u_dot: np.ndarray | float) -> np.ndarray | float:
    """Return by how much the rolling can turns faster than its load, w = u_dot/a - phi_dot [rad/s]."""
    return u_dot / scene.can.radius - phi_dot


def rolling_forces(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> Forces:
    """Return N and F [N] that rolling without slipping needs in a state, as `accelerations` takes it."""
    u_ddot, _, across, uphill = _accelerations(scene, phi, phi_dot, u_dot)
    moment, weight = scene.load.mass * scene.load.offset, scene.mass * scene.gravity
    normal = weight * math.cos(scene.incline) + moment * across
    if scene.attachment == "sliding":  # friction and the damping turn the can: F a - T = I_can u_ddot / a
        friction = scene.can.inertia / scene.can.radius**2 * u_ddot
        if scene.damping_law:
            friction = friction + scene.damping_law.torque(slip_rate(scene, phi_dot, u_dot)) / scene.can.radius
        return Forces(normal, friction)
    along = scene.mass * u_ddot - moment * uphill
    return Forces(normal, weight * math.sin(scene.incline) - along)


def stiffness(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float, u_dot: np.ndarray | float
) -> np.ndarray:
    """Return the rate at which damping brings can and load together [1/s]: the torque's slope times J_f/(a^2 M J).

    J_f is the inertia against which can and load turn as one.
    """
    radius, moment = scene.can.radius, scene.load.mass * scene.load.offset
    mass = scene.mass + scene.can.inertia / radius**2
    frozen = mass * radius**2 + scene.load.inertia + moment * (scene.load.offset - 2 * radius * np.cos(phi))
    slope = scene.damping_law.slope(slip_rate(scene, phi_dot, u_dot))
    return slope * frozen / (radius**2 * mass * scene.oscillator.inertia(phi)) + 2 * scene.drag * np.abs(u_dot) / mass
