"""The equations of a damped sliding scene, with rolling built in, in rates: phi_dot and the slip rate w.

The slip rate, and not u_dot, is a variable, as it keeps its digits where the damping is strong and w small. Everything
is divided by M a^2, with M = m + m_can + I_can/a^2, so that only rates remain:

    roll_ddot = drive - beta (sin(phi) phi_dot^2 - cos(phi) phi_ddot) - torque(w) - drag roll_dot |roll_dot|,
    inertia(phi) phi_ddot = -depth sin(phi - bottom) - beta^2 sin(phi) cos(phi) phi_dot^2
                            + (1 - beta cos(phi)) torque(w) - beta cos(phi) drag roll_dot |roll_dot|.

|w| and |roll_dot| are taken as sides * w and side * roll_dot, with signs that the caller gives: so the equations are
smooth also where w or roll_dot vanishes, and right as long as the signs are.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.scene import Scene

Values = np.ndarray | float


@dataclass(frozen=True)
class ViscousEquations:
    """The coefficients of the equations above, over M a^2."""

    drive: float
    beta: float
    base: float
    depth: float
    bottom: float
    torques: tuple[float, float, float]
    drag: float

    @classmethod
    def of(cls, scene: Scene) -> "ViscousEquations":
        """Return the equations of a scene with a sliding load."""
        radius, oscillator = scene.can.radius, scene.oscillator
        mass = scene.mass + scene.can.inertia / radius**2
        unit = mass * radius**2
        linear, quadratic, cubic = (float(np.float64(each) / unit) for each in scene.damping_law.coefficients)
        return cls(
            drive=scene.mass / mass * scene.gravity * math.sin(scene.incline) / radius,
            beta=scene.load.mass / mass * scene.load.offset / radius,
            base=float(np.float64(oscillator.base) / unit),
            depth=float(np.float64(oscillator.depth) / unit),
            bottom=oscillator.bottom,
            torques=(linear, quadratic, cubic),
            drag=float(np.float64(scene.drag) * radius / mass),
        )

    @property
    def smooth(self) -> tuple[bool, bool]:
        """Return whether the equations are smooth where w vanishes, and where roll_dot does."""
        return self.torques[1] == 0, self.drag == 0

    @property
    def natural(self) -> float:
        """Return the rate of the load's swing in a can that stays where it is, about [1/s]."""
        return math.sqrt(self.depth / self.base)

    def forcing(self, rate: float) -> float:
        """Return the size of what the damping has to balance [1/s^2] at a `rate` phi_dot [rad/s]."""
        return abs(self.drive) + self.depth + self.beta * rate**2

    def rates(
        self, phi: Values, phi_dot: Values, slip: Values, sides: tuple[float, float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return phi_ddot and w_dot [rad/s^2], of shape (2, n), and their derivatives, of shape (2, 3, n).

        The derivatives are by phi, phi_dot and w, which is `slip`; `sides` are the signs of w and of roll_dot.
        """
        beta, (linear, quadratic, cubic) = self.beta, self.torques
        sin, cos, square, roll_dot = np.sin(phi), np.cos(phi), phi_dot * phi_dot, phi_dot + slip
        quadratic, drag = sides[0] * quadratic, sides[1] * self.drag
        torque = slip * (linear + slip * (quadratic + slip * cubic))
        steep = linear + slip * (2 * quadratic + slip * 3 * cubic)
        air, air_slope = drag * roll_dot * roll_dot, 2 * drag * roll_dot
        arm, lean = beta * cos, beta * sin
        inertia, open_arm = self.base + lean * lean, 1 - arm
        turned = phi - self.bottom
        phi_ddot = (-self.depth * np.sin(turned) - lean * arm * square + open_arm * torque - arm * air) / inertia
        slip_dot = self.drive - lean * square - torque - air - open_arm * phi_ddot
        slopes = np.empty((2, 3, *np.shape(phi)))
        by_phi = -self.depth * np.cos(turned) - (arm * arm - lean * lean) * square + lean * (torque + air)
        slopes[0, 0] = (by_phi - 2 * lean * arm * phi_ddot) / inertia
        slopes[0, 1] = (-2 * lean * arm * phi_dot - arm * air_slope) / inertia
        slopes[0, 2] = (open_arm * steep - arm * air_slope) / inertia
        slopes[1, 0] = -arm * square - lean * phi_ddot - open_arm * slopes[0, 0]
        slopes[1, 1] = -2 * lean * phi_dot - air_slope - open_arm * slopes[0, 1]
        slopes[1, 2] = -steep - air_slope - open_arm * slopes[0, 2]
        return np.array([phi_ddot, slip_dot]), slopes
