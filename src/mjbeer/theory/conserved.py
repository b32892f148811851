"""What a motion of rolling without slipping conserves, and what error its drift implies."""

import math

import numpy as np

from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.scene import Scene

_SMALL_SWING = 1e-2
"""Smallest energy with which a drift is compared, relative to the depth m g b of the potential well: that of a swing
of 0.14 rad. A motion that hardly swings would otherwise divide rounding by nearly nothing."""
_ROUNDING = 1e-11
"""Smallest energy with which a drift is compared, relative to the kinetic energy. A thousandth of it, the drift that
is trusted, is still many times the rounding of the kinetic energy."""


def energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return the kinetic and potential energy [J] of can and load at each sample, whether they roll or not."""
    return kinetic_energy(scene, motion) - scene.gravity * (
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


def energy_drift(scene: Scene, motion: Coordinates) -> float:
    """Return the largest change of the total energy over the largest kinetic energy of the swing, J phi_dot^2 / 2.

    The total energy includes slip and lift, and is what users see. Warnings rest on `swing_drift` instead, where the
    energy of a can that runs away down the incline cannot hide a drift. The denominator is at least `_SMALL_SWING` of
    the well's depth, and at least `_ROUNDING` of the kinetic energy, which matters for a balanced load.
    """
    oscillator, total = scene.oscillator, energy(scene, motion)
    swing = float(np.max(oscillator.inertia(motion.phi) * motion.phi_dot**2)) / 2
    scale = max(swing, _SMALL_SWING * oscillator.depth, _ROUNDING * float(kinetic_energy(scene, motion).max()))
    change = float(np.abs(total - total[0]).max())
    return change / scale if scale > 0 else 0.0


def implied_error(scene: Scene, motion: Coordinates) -> float:
    """Return the error of phi or u/a [rad], relative beyond 1 rad, that the drift of energy and momentum implies.

    A relative error of the swing's energy is about as large a relative error of its speed or its period, and so of
    the path that phi has covered. A drift of the momentum is an error of u. Unlike the error itself, neither drift
    grows where only the phase is off.
    """
    time, phi = motion.time - motion.time[0], motion.phi
    path = float(np.trapezoid(np.abs(motion.phi_dot), time))
    implied = swing_drift(scene, motion) * max(path, float(np.abs(np.diff(phi)).sum()))
    turned, rolled = np.abs(phi - phi[0]), np.abs(motion.u - motion.u[0]) / scene.can.radius
    axis = np.abs(axis_drift(scene, motion)) / scene.can.radius
    return max(implied / max(1, float(turned.max())), float(axis.max()) / max(1, float(rolled.max())))


def swing_drift(scene: Scene, motion: Coordinates) -> float:
    """Return the largest change of the swing's energy J phi_dot^2 / 2 + V over its largest kinetic energy."""
    oscillator, phi = scene.oscillator, motion.phi
    kinetic = oscillator.inertia(phi) * motion.phi_dot**2 / 2
    change = kinetic - kinetic[0] - oscillator.drop(phi, float(phi[0]))
    scale = max(float(kinetic.max()), _SMALL_SWING * oscillator.depth)
    return float(np.abs(change).max()) / scale if scale > 0 else 0.0


def axis_drift(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return u less the value that the momentum at the start implies [m], at each sample: eq. (46), integrated twice.

    With a sliding load M_e u - m b sin(phi) - (m + m_can) g sin(alpha) t^2 / 2 grows linearly in time, whatever the
    can. A frozen load conserves no such momentum: there u = a phi, the drift is 0, and slip shows an error instead.
    """
    time = motion.time - motion.time[0]
    if scene.attachment == "frozen":
        return np.zeros_like(time)
    effective_mass = scene.mass + scene.can.inertia / scene.can.radius**2
    arm = scene.load.mass * scene.load.offset / effective_mass
    acceleration = scene.mass * scene.gravity * math.sin(scene.incline) / effective_mass
    phi, speed = motion.phi, motion.u_dot[0] - arm * math.cos(motion.phi[0]) * motion.phi_dot[0]
    implied = motion.u[0] + arm * (np.sin(phi) - math.sin(phi[0])) + speed * time + acceleration * time**2 / 2
    return motion.u - implied
