"""Appendix A.4 of the paper: the hoop that hops. Mass M, with a point of mass m on its rim, falling from the top.

The paper has no equations for it; these are those of a hoop that rolls without slipping on level ground.
"""

import itertools
import math
from functools import cache

from scipy.optimize import brentq, minimize_scalar


def rate(ratio: float, phi: float) -> float:
    """phi_dot^2 a/g of a hoop with M/m = `ratio` that fell from rest at the top, phi = pi.

    By energy, (2 M + 4 m sin^2(phi/2)) a^2 phi_dot^2/2 = m g a (1 + cos(phi)).
    """
    return 2 * math.cos(phi / 2) ** 2 / (ratio + 2 * math.sin(phi / 2) ** 2)


def acceleration(ratio: float, phi: float) -> float:
    """phi_ddot a/g: half the derivative of `rate` by phi."""
    return -math.sin(phi) * (1 + ratio / 2) / (ratio + 2 * math.sin(phi / 2) ** 2) ** 2


def normal(ratio: float, phi: float) -> float:
    """N/(m g) = 1 + M/m + (sin(phi) phi_ddot + cos(phi) phi_dot^2) a/g."""
    return 1 + ratio + math.sin(phi) * acceleration(ratio, phi) + math.cos(phi) * rate(ratio, phi)


def friction(ratio: float, phi: float) -> float:
    """F/(m g), uphill or against phi: -((1 + M/m) phi_ddot - cos(phi) phi_ddot + sin(phi) phi_dot^2) a/g."""
    turning = acceleration(ratio, phi)
    return -((1 + ratio) * turning - math.cos(phi) * turning + math.sin(phi) * rate(ratio, phi))


def least_normal(ratio: float) -> float:
    """The least N/(m g) of the fall."""
    found = minimize_scalar(lambda phi: normal(ratio, phi), bounds=(0.3, 3.1), options={"xatol": 1e-9})
    return float(found.fun)


def lift_off(ratio: float) -> float:
    """Angle from the top [rad] at which N = 0; not a number if it stays positive."""
    found = minimize_scalar(lambda phi: normal(ratio, phi), bounds=(0.3, 3.1), options={"xatol": 1e-9})
    if found.fun >= 0:
        return math.nan
    return math.pi - float(brentq(lambda phi: normal(ratio, phi), found.x, math.pi, xtol=1e-14))


def slip(ratio: float, mu: float) -> float:
    """Angle from the top [rad] at which |F| = mu N first."""

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
    """The M/m below which the least N is negative."""
    return float(brentq(least_normal, 0.05, 0.1, xtol=1e-14))
