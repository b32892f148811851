"""What a motion of rolling without slipping conserves, and what error its drift implies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mjbeer.theory.trajectory import Trajectory

_SMALL_SWING = 1e-2
"""Share of the well's depth m g b, with which the energy of a motion that hardly swings is compared: a swing of
0.14 rad."""


def implied_error(trajectory: Trajectory) -> float:
    """Error of phi or u/a [rad], relative beyond 1 rad, that the drift of what is conserved implies.

    A share of the swing's energy is about as large a share of its speed, or of its period, and so of the way that phi
    has gone; the drift of the momentum is an error of u. Unlike an error, neither grows where only the phase is off.
    """
    time, phi = trajectory.time - trajectory.time[0], trajectory.phi
    way = float(np.trapezoid(np.abs(trajectory.phi_dot), time))
    implied = swing_drift(trajectory) * max(way, float(np.abs(np.diff(phi)).sum()))
    turned, rolled = np.abs(phi - phi[0]), np.abs(trajectory.u - trajectory.u[0]) / trajectory.scene.can.radius
    axis = np.abs(axis_drift(trajectory)) / trajectory.scene.can.radius
    return max(implied / max(1, float(turned.max())), float(axis.max()) / max(1, float(rolled.max())))


def swing_drift(trajectory: Trajectory) -> float:
    """Largest change of the swing's energy J phi_dot^2 / 2 + V, relative to its largest kinetic energy."""
    form, phi = trajectory.scene.oscillator, trajectory.phi
    kinetic = form.inertia(phi) * trajectory.phi_dot**2 / 2
    change = kinetic - kinetic[0] - form.drop(phi, float(phi[0]))
    scale = max(float(kinetic.max()), _SMALL_SWING * form.depth)
    return float(np.abs(change).max()) / scale if scale > 0 else 0.0


def axis_drift(trajectory: Trajectory) -> np.ndarray:
    """u less what the momentum at the start gives [m], at each sample; eq. (46), integrated twice, for any can.

    M_e u - m b sin(phi) - (m + m_can) g sin(alpha) t^2 / 2 grows steadily where a load slides. A frozen load has no
    such momentum: there u = a phi, and it is the slip that tells.
    """
    scene, time = trajectory.scene, trajectory.time - trajectory.time[0]
    if scene.attachment == "frozen":
        return np.zeros_like(time)
    total = scene.mass + scene.can.inertia / scene.can.radius**2
    arm = scene.load.mass * scene.load.offset / total
    drive = scene.mass * scene.gravity * math.sin(scene.incline) / total
    phi, speed = trajectory.phi, trajectory.u_dot[0] - arm * math.cos(trajectory.phi[0]) * trajectory.phi_dot[0]
    expected = trajectory.u[0] + arm * (np.sin(phi) - math.sin(phi[0])) + speed * time + drive * time**2 / 2
    return trajectory.u - expected
