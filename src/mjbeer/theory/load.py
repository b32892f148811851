"""The load that the can carries: a point mass, or beer, whose cross section at rest is a segment of a circle."""

import functools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.theory.can import LENGTH, RADIUS

BEER = 1000.0
"""Density of beer [kg/m^3]: that of water, rounded, from which beer differs by about 1 %."""
# Trigonometric polynomials of sixth degree over half a turn: 24 Gauss points would integrate them to rounding.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


@dataclass(frozen=True)
class Load:
    """The properties of a load on which its motion depends.

    Raises:
      ParameterError: if one of them is outside the domain.
    """

    mass: float
    """Mass m [kg], eq. (34)."""
    offset: float
    """Distance b of the centre of mass from the can's axis [m], eqs. (7) and (35)."""
    inertia: float = 0.0
    """Moment of inertia I_cm about the centre of mass [kg m^2], eqs. (9) and (37)."""
    fill: float | None = None
    """Filling height over diameter, h/2a of eq. (32), if the load is a circular segment; it decides how it is drawn."""

    def __post_init__(self) -> None:
        require.set_fields(
            self,
            mass=require.within("load mass", self.mass, *require.MASS, "kg"),
            offset=require.within("load offset", self.offset, 0, require.SIZE[1], "m"),
            inertia=require.non_negative("load inertia", self.inertia, "kg m^2"),
            fill=None if self.fill is None else _checked_fill(self.fill),
        )

    @property
    def moment(self) -> float:
        """Return the first moment of mass about the axis, m b [kg m]."""
        return self.mass * self.offset

    @property
    def axis_inertia(self) -> float:
        """Return the moment of inertia about the axis, I_cm + m b^2 [kg m^2]."""
        return self.inertia + self.mass * self.offset**2

    @classmethod
    def segment(
        cls, radius: float = RADIUS, length: float = LENGTH, fill: float = 0.5, density: float = BEER
    ) -> "Load":
        """Return beer of `density` [kg/m^3] in a can of `radius` and `length` [m]: eqs. (32)-(37).

        `fill` is h/2a of eq. (32), 0 < fill <= 1.

        Raises:
          ParameterError: as `Load`, or if `fill` is outside (0, 1].
        """
        radius = require.within("load radius", radius, *require.SIZE, "m")
        length = require.within("load length", length, *require.SIZE, "m")
        density = require.positive("load density", density, "kg/m^3")
        fill = _checked_fill(fill)
        shape = segment(fill)
        mass = density * length * radius**2 * shape.area
        return cls(mass, offset=radius * shape.offset, inertia=mass * radius**2 * shape.inertia, fill=fill)

    @classmethod
    def point(cls, mass: float, offset: float) -> "Load":
        """Return a point of `mass` [kg] at `offset` [m] from the axis (appendices A.4 and B)."""
        return cls(mass, offset, 0.0)


class Segment(NamedTuple):
    """A segment of a circle of radius a, in units of a."""

    half_angle: float  # half of the angle that the segment subtends at the axis, beta [rad]
    area: float  # over a^2, eq. (33)
    offset: float  # distance of the centroid from the axis over a, eq. (35)
    inertia: float  # moment of inertia about the centroid over mass and a^2, eq. (37)
    width: float  # the part of it that lies across, along the flat side: the mean of x^2 over a^2


@functools.lru_cache(maxsize=1024)  # a sweep has the same ones again and again
def segment(fill: float) -> Segment:
    """Return the segment whose height is `fill` times the diameter (fill = h/2a, eq. 32), to full relative precision.

    The closed forms (33), (35) and (37) subtract nearly equal numbers when the can is almost empty. Here the integrals
    behind them are evaluated, over strips along the flat side: the end of a strip is at the angle t at the axis, 0 <= t
    <= beta, where y = cos t and dA = 2 sin^2 t dt for a can of radius 1.
    """
    beta = 2 * math.atan2(math.sqrt(fill), math.sqrt(1 - fill))
    sine = 2 * math.sqrt(fill * (1 - fill))  # 1 - fill is exact wherever it is small
    angle = beta / 2 * (1 + _NODES)
    across = np.sin(angle)
    strip = _WEIGHTS * (across / beta) ** 2  # divided by beta^3, which may underflow
    below = 2 * np.sin(angle / 2) ** 2  # 1 - cos(angle): depth under the top of the circle
    total = float(strip.sum())
    offset = 2 * (sine / beta) ** 3 / (3 * total)
    height = float(strip @ below) / total - below  # strip's y minus the centroid's
    width = float(strip @ across**2) / (3 * total)
    inertia = width + float(strip @ height**2) / total
    return Segment(half_angle=beta, area=beta**3 * total, offset=offset, inertia=inertia, width=width)


def _checked_fill(fill: float) -> float:
    return require.within("fill", require.positive("fill", fill), 0, 1)
