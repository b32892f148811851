"""Appendix A.4 of the paper: a hoop of mass M with a point mass m on its rim, which falls from the top and may hop.

The paper has no equations for it. The ones here hold while the hoop rolls without slipping on level ground. `ratio` is
M/m, and phi [rad] is 0 where the point mass is at the bottom.
"""

import itertools
import math
from functools import cache

from scipy.optimize import brentq, minimize_scalar


def rate(ratio: float, phi: float) -> float:
    """Return phi_dot^2 a/g of a hoop that fell from rest at the top, phi = pi.

    Energy is conserved: (2 M + 4 m sin^2(phi/2)) a^2 phi_dot^2/2 = m g a (1 + cos(phi)).
    """
    return 2 * math.cos(phi / 2) ** 2 / (ratio + 2 * math.sin(phi / 2) ** 2)


def acceleration(ratio: float, phi: float) -> float:
    """Return phi_ddot a/g, which is half the derivative of `rate` by phi."""
    return -math.sin(phi) * (1 + ratio / 2) / (ratio + 2 * math.sin(phi / 2) ** 2) ** 2


def normal(ratio: float, phi: float) -> float:
    """Return N/(m g) = 1 + M/m + (sin(phi) phi_ddot + cos(phi) phi_dot^2) a/g."""
    return 1 + ratio + math.sin(phi) * acceleration(ratio, phi) + math.cos(phi) * rate(ratio, phi)


def friction(ratio: float, phi: float) -> float:
    """Return F/(m g), positive uphill or, on level ground, against the rolling.

    F/(m g) = -((1 + M/m) phi_ddot - cos(phi) phi_ddot + sin(phi) phi_dot^2) a/g.
    """
    turning = acceleration(ratio, phi)
    return -((1 + ratio) * turning - math.cos(phi) * turning + math.sin(phi) * rate(ratio, phi))


def least_normal(ratio: float) -> float:
    """Return the least N/(m g) during the fall."""
    least = minimize_scalar(lambda phi: normal(ratio, phi), bounds=(0.3, 3.1), options={"xatol": 1e-9})
    return float(least.fun)


def lift_off(ratio: float) -> float:
    """Return the angle from the top [rad] at which N = 0; NaN if N stays positive."""
    least = minimize_scalar(lambda phi: normal(ratio, phi), bounds=(0.3, 3.1), options={"xatol": 1e-9})
    if least.fun >= 0:
        return math.nan
    return math.pi - float(brentq(lambda phi: normal(ratio, phi), least.x, math.pi, xtol=1e-14))


def slip(ratio: float, mu: float) -> float:
    """Return the angle from the top [rad] at which |F| first reaches mu N; NaN if it never does."""

    def margin(phi: float) -> float:
        return mu * normal(ratio, phi) - abs(friction(ratio, phi))

    steps = 2000
    angles = [math.pi * (1 - i / steps) for i in range(1, steps)]
    for before, after in itertools.pairwise(angles):
        if margin(after) < 0:
            return math.pi - float(brentq(margin, after, before, xtol=1e-14))
    return math.nan


@cache
def threshold() -> float:
    """Return the M/m below which the least N is negative."""
    return float(brentq(least_normal, 0.05, 0.1, xtol=1e-14))
