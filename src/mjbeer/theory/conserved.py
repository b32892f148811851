"""What a motion of rolling without slipping conserves, and what error its drift implies."""

import math

import numpy as np

from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.scene import Scene

_SMALL_SWING = 1e-2
"""Share of the well's depth m g b, with which the energy of a motion that hardly swings is compared: a swing of
0.14 rad."""
_ROUNDING = 1e-11
"""Share of the kinetic energy of which a thousandth, the drift that is trusted, is still many roundings."""


def energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Kinetic and potential energy [J] of can and load at each sample, whether they roll or not."""
    return kinetic_energy(scene, motion) - scene.gravity * (
        scene.mass * (motion.u * math.sin(scene.incline) - motion.lift * math.cos(scene.incline))
        + scene.load.mass * scene.load.offset * np.cos(scene.incline + motion.phi)
    )


def kinetic_energy(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Kinetic energy [J] of can and load at each sample, eqs. (39) and (44) with slip and lift allowed."""
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
    """Largest change of the whole energy, relative to the largest kinetic energy of the swing, J phi_dot^2 / 2.

    It is shown to users, and sees slip and lift too; a run is judged by `swing_drift`, which the energy of a can that
    runs away down the incline cannot hide. A motion that hardly swings is compared with a hundredth of the load's
    weight on its arm, a swing of 0.14 rad, and a balanced load with what the can's energy is rounded by.
    """
    form, total = scene.oscillator, energy(scene, motion)
    swing = float(np.max(form.inertia(motion.phi) * motion.phi_dot**2)) / 2
    scale = max(swing, _SMALL_SWING * form.depth, _ROUNDING * float(kinetic_energy(scene, motion).max()))
    change = float(np.abs(total - total[0]).max())
    return change / scale if scale > 0 else 0.0


def implied_error(scene: Scene, motion: Coordinates) -> float:
    """Error of phi or u/a [rad], relative beyond 1 rad, that the drift of what is conserved implies.

    A share of the swing's energy is about as large a share of its speed, or of its period, and so of the way that phi
    has gone; the drift of the momentum is an error of u. Unlike an error, neither grows where only the phase is off.
    """
    time, phi = motion.time - motion.time[0], motion.phi
    way = float(np.trapezoid(np.abs(motion.phi_dot), time))
    implied = swing_drift(scene, motion) * max(way, float(np.abs(np.diff(phi)).sum()))
    turned, rolled = np.abs(phi - phi[0]), np.abs(motion.u - motion.u[0]) / scene.can.radius
    axis = np.abs(axis_drift(scene, motion)) / scene.can.radius
    return max(implied / max(1, float(turned.max())), float(axis.max()) / max(1, float(rolled.max())))


def swing_drift(scene: Scene, motion: Coordinates) -> float:
    """Largest change of the swing's energy J phi_dot^2 / 2 + V, relative to its largest kinetic energy."""
    form, phi = scene.oscillator, motion.phi
    kinetic = form.inertia(phi) * motion.phi_dot**2 / 2
    change = kinetic - kinetic[0] - form.drop(phi, float(phi[0]))
    scale = max(float(kinetic.max()), _SMALL_SWING * form.depth)
    return float(np.abs(change).max()) / scale if scale > 0 else 0.0


def axis_drift(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Difference of u from what the momentum at the start gives [m], at each sample; eq. (46), integrated twice.

    M_e u - m b sin(phi) - (m + m_can) g sin(alpha) t^2 / 2 grows steadily where a load slides, whatever the can. A
    frozen load has no such momentum: there u = a phi, the difference is 0, and slip shows an error instead.
    """
    time = motion.time - motion.time[0]
    if scene.attachment == "frozen":
        return np.zeros_like(time)
    total = scene.mass + scene.can.inertia / scene.can.radius**2
    arm = scene.load.mass * scene.load.offset / total
    drive = scene.mass * scene.gravity * math.sin(scene.incline) / total
    phi, speed = motion.phi, motion.u_dot[0] - arm * math.cos(motion.phi[0]) * motion.phi_dot[0]
    expected = motion.u[0] + arm * (np.sin(phi) - math.sin(phi[0])) + speed * time + drive * time**2 / 2
    return motion.u - expected
