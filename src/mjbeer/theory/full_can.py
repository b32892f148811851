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

from mjbeer import require
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import LIQUIDS
from mjbeer.theory.scene import GRAVITY, INCLINE

_TERMS = 1200
"""Number of terms of the series: as many zeros of Bessel functions as SciPy has."""
_NEGLIGIBLE = 36.0
"""Exponent of the last term from which on the rest of the series is below rounding."""
_HALVINGS = 60


@dataclass(frozen=True)
class FullCan:
    """A can that is full of a liquid and rolls down an incline from rest.

    Raises:
      ParameterError: if a parameter is not allowed.
    """

    can: Can
    density: float = LIQUIDS["water"].density
    """Density [kg/m^3]."""
    viscosity: float = LIQUIDS["water"].viscosity
    """Kinematic viscosity nu [m^2/s]."""
    incline: float = INCLINE
    """Angle of the incline [rad]."""
    gravity: float = GRAVITY
    """Acceleration of gravity [m/s^2]."""

    def __post_init__(self) -> None:
        require.instance("can", self.can, Can)
        require.store(
            self,
            density=require.positive("density", self.density, "kg/m^3"),
            viscosity=require.positive("viscosity", self.viscosity, "m^2/s"),
            incline=require.number("incline", self.incline, "rad"),
            gravity=require.non_negative("gravity", self.gravity, "m/s^2"),
        )

    @property
    def liquid_mass(self) -> float:
        """Return the mass m of the liquid [kg]."""
        return math.pi * self.can.radius**2 * self.can.length * self.density

    @property
    def force(self) -> float:
        """Return the weight along the incline F [N]."""
        return (self.liquid_mass + self.can.mass) * self.gravity * math.sin(self.incline)

    @property
    def first_mass(self) -> float:
        """Return M [kg], which resists the force as long as the liquid does not turn."""
        return self.liquid_mass + self.can.mass + self.can.inertia / self.can.radius**2

    def acceleration(self, time: np.ndarray) -> np.ndarray:
        """Return the acceleration of the axis [m/s^2] at times [s], none of them negative.

        Where the series has too few terms, within 2.8 ms for water in a 12-oz can, it is that of the thin layer in
        which the flow then is, (F/M) exp(q^2 t) erfc(q sqrt(t)) with q = 2 m sqrt(nu)/(a M), within 3 nu t/a^2 of
        itself.
        """
        from scipy.special import erfcx  # only here, as nothing else needs a full can

        time = require.times("time", time)
        rates, shares = self._series()
        layer = 2 * self.liquid_mass * math.sqrt(self.viscosity) / (self.can.radius * self.first_mass)
        decayed = np.exp(-np.multiply.outer(time, rates)) @ shares
        late = self._last() + self.force / self.first_mass * decayed
        early = self.force / self.first_mass * erfcx(layer * np.sqrt(time))
        return np.where(time * rates[-1] > _NEGLIGIBLE, late, early)

    def way(self, time: np.ndarray) -> np.ndarray:
        """Return the way of the axis [m] at times [s], none of them negative."""
        time = require.times("time", time)
        rates, shares = self._series()
        ratio = self.liquid_mass / self.first_mass
        # The sum of shares/rates, of which the series lacks a part: it follows from the transform near s = 0.
        delay = self.can.radius**2 / self.viscosity * ratio / 48 / (1 + ratio / 2) ** 2
        decayed = np.expm1(-np.multiply.outer(time, rates)) @ (shares / rates**2)
        return self._last() * time**2 / 2 + self.force / self.first_mass * (delay * time + decayed)

    def _last(self) -> float:
        return self.force / (self.first_mass + self.liquid_mass / 2)

    def _series(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the rates nu x^2/a^2 [1/s] of the terms and their shares of F/M."""
        roots, shares = _terms(2 * self.liquid_mass / self.first_mass)
        return self.viscosity / self.can.radius**2 * roots**2, shares


@functools.cache
def _terms(ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the roots x of x J_1 + r J_2, r = 2 m/M, and the residues there of 1/(s (1 + r J_2/(x J_1)))."""
    from scipy.special import jn_zeros, jv

    low, high = jn_zeros(1, _TERMS), jn_zeros(2, _TERMS)
    sign = np.sign(jv(2, low))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        before = sign * (middle * jv(1, middle) + ratio * jv(2, middle)) > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    roots = (low + high) / 2
    first, second = jv(1, roots), jv(2, roots)
    slope = ((first - 2 * second / roots) * roots * first - second * roots * jv(0, roots)) / (roots * first) ** 2
    return roots, 2 / (roots * ratio * slope)
