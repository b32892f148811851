"""Geometry of a circular segment, the cross section of the beer at rest (paper, section 3).

The closed forms (33), (35) and (37) subtract nearly equal numbers when the can is
almost empty and lose every digit there. Here the integrals behind them are evaluated
instead, with integrands in which nothing cancels. The segment is cut into strips along
its flat side; the end of a strip is at the angle t at the axis, 0 <= t <= beta, where
y = cos t and dA = 2 sin^2 t dt for a can of radius 1.
"""

import math
from dataclasses import dataclass

import numpy as np

# Integrands are entire and at most sixth-degree trigonometric polynomials over half a
# turn: 40 Gauss points integrate them to rounding error (24 already do).
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


@dataclass(frozen=True)
class Segment:
    """A segment of a circle of radius a, in units of a."""

    half_angle: float
    """Half of the angle that the segment subtends at the axis, beta [rad]."""
    area: float
    """Area over a^2, eq. (33)."""
    offset: float
    """Distance of the centroid from the axis over a, eq. (35)."""
    inertia: float
    """Moment of inertia about the centroid over mass and a^2, eq. (37)."""


def segment(fill: float) -> Segment:
    """Return the segment whose height is `fill` times the diameter (fill = h/2a, eq. 32).

    It has full relative precision for every fill in (0, 1], however near 0 or 1: `1 - fill` is exact in floating
    point wherever it is small, so that sin(beta) keeps its digits.
    """
    beta = 2 * math.atan2(math.sqrt(fill), math.sqrt(1 - fill))
    sine = 2 * math.sqrt(fill * (1 - fill))
    angle = beta / 2 * (1 + _NODES)
    strip = _WEIGHTS * (np.sin(angle) / beta) ** 2  # divided by beta^3, which may underflow
    below = 2 * np.sin(angle / 2) ** 2  # 1 - cos(angle): depth under the top of the circle
    total = float(np.sum(strip))
    offset = 2 * (sine / beta) ** 3 / (3 * total)
    height = float(np.sum(strip * below)) / total - below  # strip's y minus the centroid's
    inertia = float(np.sum(strip * (np.sin(angle) ** 2 / 3 + height**2))) / total
    return Segment(half_angle=beta, area=beta**3 * total, offset=offset, inertia=inertia)
