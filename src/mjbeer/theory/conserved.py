"""The energy and the momentum of a motion, which rolling without slipping conserves."""

import math

import numpy as np

from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.scene import Scene


def energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the kinetic and potential energy [J] of can and load at each sample, whether they roll or not."""
    return kinetic_energy(scene, motion) + potential_energy(scene, motion)


def potential_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the potential energy [J] of can and load at each sample, 0 with all mass at u = 0 on the axis."""
    return -scene.gravity * (
        scene.mass * (motion.u * math.sin(scene.incline) - motion.lift * math.cos(scene.incline))
        + scene.load.mass * scene.load.offset * np.cos(scene.incline + motion.phi)
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


def axis_without_swing(scene: Scene, motion: Coordinates) -> tuple[np.ndarray, np.ndarray]:
    """Return u - (m b / M_e) sin(phi) [m] and its rate [m/s], which the swing of a sliding load leaves alone."""
    arm = scene.load.mass * scene.load.offset / (scene.mass + scene.can.inertia / scene.can.radius**2)
    return motion.u - arm * np.sin(motion.phi), motion.u_dot - arm * np.cos(motion.phi) * motion.phi_dot


def steady_acceleration(scene: Scene) -> float:
    """Return the derivative of that rate [m/s^2]: eq. (46)."""
    effective_mass = scene.mass + scene.can.inertia / scene.can.radius**2
    return scene.mass * scene.gravity * math.sin(scene.incline) / effective_mass
