"""The equations of motion with damping or drag, and their derivatives.

**The equations** are (46) and (47) with the torque T(w) of the damping and the drag
d u_dot |u_dot|. The variables are phi, phi_dot and the slip rate w = roll_dot - phi_dot, with
roll = u/a. Where the damping is strong, w is small, and as a difference it would lose its digits.
With M_e = m + m_can + I_can/a^2, (46) is divided by M_e a, and (47), with u_ddot eliminated, by
M_e a^2. With c = beta cos(phi) and s = beta sin(phi) they are

    roll_ddot = drive - s phi_dot^2 + c phi_ddot - braking,
    j phi_ddot = -delta sin(phi - bottom) - s c phi_dot^2 + tau - c braking,
    braking = tau + kappa roll_dot |roll_dot|,

    drive = m_t g sin(alpha)/(M_e a),    beta = m b/(M_e a),    tau = T(w)/(M_e a^2),
    kappa = d a/M_e,    delta = depth/(M_e a^2),    j = J/(M_e a^2).

J, `depth` and `bottom` are those of `Oscillator`.

**The derivatives** are those by phi, phi_dot and w. J is constant but for (m b sin(phi))^2/M_e, so
that j is constant but for s^2. Let `tau_by_w` be the derivative of tau, and `drag_by_roll_dot` that
of kappa roll_dot |roll_dot|, which is 2 kappa |roll_dot|. As roll_dot = phi_dot + w, the parts have
the derivatives

    of           c    s    j        tau         braking
    by phi      -s    c    2 s c    0           0
    by phi_dot   0    0    0        0           drag_by_roll_dot
    by w         0    0    0        tau_by_w    tau_by_w + drag_by_roll_dot

By the product rule the equation of phi gives

    j phi_ddot_by_phi + 2 s c phi_ddot
        = -delta cos(phi - bottom) - (c^2 - s^2) phi_dot^2 + s braking,
    j phi_ddot_by_phi_dot = -2 s c phi_dot - c drag_by_roll_dot,
    j phi_ddot_by_w = tau_by_w - c (tau_by_w + drag_by_roll_dot).

From the equation of roll follow w_dot = roll_ddot - phi_ddot and its derivatives:

    w_dot = drive - s phi_dot^2 - braking - (1 - c) phi_ddot,
    w_dot_by_phi = -c phi_dot^2 - s phi_ddot - (1 - c) phi_ddot_by_phi,
    w_dot_by_phi_dot = -2 s phi_dot - drag_by_roll_dot - (1 - c) phi_ddot_by_phi_dot,
    w_dot_by_w = -tau_by_w - drag_by_roll_dot - (1 - c) phi_ddot_by_w.
"""

import math
from typing import NamedTuple

import numpy as np

from mjbeer.theory.equations import accelerations
from mjbeer.theory.scene import Scene


class Accelerations(NamedTuple):
    """phi_ddot and w_dot in a state, or in several at once."""

    values: np.ndarray
    """phi_ddot and w_dot [rad/s^2], of shape (2, ...)."""
    jacobian: np.ndarray
    """Their derivatives by phi, phi_dot and w, of shape (2, 3, ...)."""


class Equations:
    """The equations of a scene."""

    def __init__(self, scene: Scene) -> None:
        self.swing_rate = math.sqrt(scene.oscillator.depth / scene.oscillator.base)
        """Frequency of the load's swings [rad/s], about."""
        corners = []
        if scene.damping_law.quadratic > 0:
            corners.append([0.0, 1.0])  # w
        if scene.drag > 0:
            corners.append([1.0, 1.0])  # roll_dot
        self.corners = np.reshape(corners, (-1, 2))
        """A row for each rate that makes a corner at 0: the factors of phi_dot and w in it."""
        self._scene = scene
        self._unit = scene.effective_mass * scene.can.radius**2  # M_e a^2
        self._beta = scene.load.moment / scene.effective_mass / scene.can.radius
        self._kappa = scene.drag * scene.can.radius / scene.effective_mass
        self._delta = scene.oscillator.depth / self._unit

    def accelerations(
        self,
        phi: np.ndarray,
        phi_dot: np.ndarray,
        slip_rate: np.ndarray,
    ) -> Accelerations:
        """Return phi_ddot and w_dot [rad/s^2], and their derivatives by phi, phi_dot and w."""
        scene = self._scene
        radius = scene.can.radius
        roll_dot = phi_dot + slip_rate
        u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, radius * roll_dot, slip_rate)
        w_dot = u_ddot / radius - phi_ddot

        j = scene.oscillator.inertia(phi) / self._unit
        c = self._beta * np.cos(phi)
        s = self._beta * np.sin(phi)
        tau = scene.damping_law.torque(slip_rate) / self._unit
        tau_by_w = scene.damping_law.derivative(slip_rate) / self._unit
        drag_by_roll_dot = 2 * self._kappa * np.abs(roll_dot)
        braking = tau + drag_by_roll_dot * roll_dot / 2
        gap = 1 - c
        square = phi_dot * phi_dot

        right_by_phi = -self._delta * np.cos(phi - scene.oscillator.bottom)
        right_by_phi += s * braking - (c * c - s * s) * square
        j_by_phi = 2 * s * c
        phi_ddot_by_phi = (right_by_phi - j_by_phi * phi_ddot) / j
        phi_ddot_by_phi_dot = (-j_by_phi * phi_dot - c * drag_by_roll_dot) / j
        phi_ddot_by_w = (gap * tau_by_w - c * drag_by_roll_dot) / j

        w_dot_by_phi = -c * square - s * phi_ddot - gap * phi_ddot_by_phi
        w_dot_by_phi_dot = -2 * s * phi_dot - drag_by_roll_dot - gap * phi_ddot_by_phi_dot
        w_dot_by_w = -tau_by_w - drag_by_roll_dot - gap * phi_ddot_by_w
        return Accelerations(
            np.array([phi_ddot, w_dot]),
            np.array(
                [
                    [phi_ddot_by_phi, phi_ddot_by_phi_dot, phi_ddot_by_w],
                    [w_dot_by_phi, w_dot_by_phi_dot, w_dot_by_w],
                ]
            ),
        )
