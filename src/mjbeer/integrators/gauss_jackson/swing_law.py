"""What Gauss-Jackson is told about a motion, as plain numbers.

They decide how long its steps may be, and not where the motion goes.
"""

import math
from typing import NamedTuple


class SwingLaw(NamedTuple):
    """The law that phi nearly obeys: an oscillator with an inertia J(phi) and a potential V(phi).

        J phi_dot^2 / 2 + V = E,
        J = base + chord sin^2(phi/2) + coupling sin^2(phi),
        V = -ramp phi - depth cos(phi - bottom).

    One of `chord` and `coupling` is 0. If the model has a slide, the *steady slide*, which is the
    slide less arm sin(phi), is evenly accelerated.

    J and V are those of `theory.formulas`, written again here because the integrators import no
    theory.
    """

    base: float  # [kg m^2]
    chord: float  # [kg m^2]
    coupling: float  # [kg m^2]
    ramp: float  # [N m]
    depth: float  # [J]
    bottom: float  # [rad]
    arm: float = 0.0  # [m]

    def inertia(self, phi: float) -> float:
        """Return J [kg m^2]."""
        return self.base + self.chord * math.sin(phi / 2) ** 2 + self.coupling * math.sin(phi) ** 2

    def largest_inertia(self) -> float:
        """Return the largest J of all angles [kg m^2]."""
        return self.base + self.chord + self.coupling

    def mean_inertia(self) -> float:
        """Return the mean J of a turn [kg m^2]."""
        return self.base + (self.chord + self.coupling) / 2

    def potential(self, phi: float) -> float:
        """Return V [J]."""
        return -self.ramp * phi - self.depth * math.cos(phi - self.bottom)
