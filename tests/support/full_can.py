"""The motion of a can full of a viscous liquid, without a lump: the liquid turns in rings that drag each other along.

The flow is that in a long can, v(r, t) about the axis with dv/dt = nu (v'' + v'/r - v/r^2). The ends have no part in
it. With its torque on the wall, the Laplace transform of the can's acceleration is F/(s (M + 2 m I_2(z)/(z I_1(z)))).
Here F = (m + m_can) g sin(alpha), M = m + m_can + I_can/a^2 and z = a sqrt(s/nu). At first only the wall turns, with
F/M. In the end the liquid turns as if it were frozen, with F/(M + m/2). In between are the poles s = -nu x^2/a^2, where
x are the roots of M x J_1(x) + 2 m J_2(x) = 0, one between each root of J_1 and the next one of J_2.
"""

import functools
import math
from dataclasses import dataclass

import numpy as np
from scipy.special import jn_zeros, jv

from mjbeer.theory.can import Can
from mjbeer.theory.liquid import LIQUIDS
from mjbeer.theory.scene import GRAVITY, INCLINE

_TERMS = 1200
"""Number of terms of the series: as many zeros of Bessel functions as SciPy has."""


@dataclass(frozen=True)
class FullCan:
    """A can that is full of a liquid and rolls down an incline from rest."""

    can: Can
    density: float = LIQUIDS["water"].density
    viscosity: float = LIQUIDS["water"].viscosity
    incline: float = INCLINE
    gravity: float = GRAVITY

    @property
    def liquid_mass(self) -> float:
        """m [kg]."""
        return math.pi * self.can.radius**2 * self.can.length * self.density

    @property
    def force(self) -> float:
        """F [N]."""
        return (self.liquid_mass + self.can.mass) * self.gravity * math.sin(self.incline)

    @property
    def first_mass(self) -> float:
        """M [kg], which resists the force as long as the liquid does not turn."""
        return self.liquid_mass + self.can.mass + self.can.inertia / self.can.radius**2

    def way(self, time: np.ndarray) -> np.ndarray:
        """The way of the axis [m] at times [s]."""
        time = np.atleast_1d(time)
        ratio, unit = self.liquid_mass / self.first_mass, self.can.radius**2 / self.viscosity
        roots, shares = terms(2 * ratio)
        rates = roots**2 / unit
        # The sum of shares/rates, of which the series lacks a part: it follows from the transform near s = 0.
        delay = unit * ratio / 48 / (1 + ratio / 2) ** 2
        decayed = np.expm1(-np.multiply.outer(time, rates)) @ (shares / rates**2)
        last = self.force / (self.first_mass + self.liquid_mass / 2)
        return last * time**2 / 2 + self.force / self.first_mass * (delay * time + decayed)


@functools.cache
def terms(ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """The roots x of x J_1 + r J_2, r = 2 m/M, and the residues there of 1/(s (1 + r J_2/(x J_1)))."""
    low, high = jn_zeros(1, _TERMS), jn_zeros(2, _TERMS)
    sign = np.sign(jv(2, low))
    for _ in range(60):
        middle = (low + high) / 2
        before = sign * (middle * jv(1, middle) + ratio * jv(2, middle)) > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    roots = (low + high) / 2
    first, second = jv(1, roots), jv(2, roots)
    slope = ((first - 2 * second / roots) * roots * first - second * roots * jv(0, roots)) / (roots * first) ** 2
    return roots, 2 / (roots * ratio * slope)
