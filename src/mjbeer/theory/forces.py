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


def accelerations(scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Return u_ddot [m/s^2] and phi_ddot [rad/s^2] of rolling without slipping at `phi` [rad] and `phi_dot` [rad/s]."""
    u_ddot, phi_ddot, _, _ = _accelerations(scene, phi, phi_dot)
    return u_ddot, phi_ddot


def _accelerations(
    scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return u_ddot [m/s^2], phi_ddot [rad/s^2], and how the load's centre of mass accelerates relative to the axis.

    The latter are over b [1/s^2]: away from the incline, and uphill.
    """
    phi_ddot, sin, cos, square = scene.oscillator.acceleration(phi, phi_dot), np.sin(phi), np.cos(phi), phi_dot**2
    across, uphill = sin * phi_ddot + cos * square, cos * phi_ddot - sin * square
    if scene.attachment == "frozen":
        return scene.can.radius * phi_ddot, phi_ddot, across, uphill
    effective_mass = scene.mass + scene.can.inertia / scene.can.radius**2
    force = scene.mass * scene.gravity * math.sin(scene.incline) + scene.load.mass * scene.load.offset * uphill
    return force / effective_mass, phi_ddot, across, uphill  # eq. (46)


def rolling_forces(scene: Scene, phi: np.ndarray | float, phi_dot: np.ndarray | float) -> Forces:
    """Return N and F [N] that rolling without slipping needs at `phi` [rad] and `phi_dot` [rad/s]."""
    u_ddot, _, across, uphill = _accelerations(scene, phi, phi_dot)
    moment, weight = scene.load.mass * scene.load.offset, scene.mass * scene.gravity
    normal = weight * math.cos(scene.incline) + moment * across
    if scene.attachment == "sliding":  # friction alone turns the can: F a = I_can u_ddot / a
        return Forces(normal, scene.can.inertia / scene.can.radius**2 * u_ddot)
    along = scene.mass * u_ddot - moment * uphill
    return Forces(normal, weight * math.sin(scene.incline) - along)
