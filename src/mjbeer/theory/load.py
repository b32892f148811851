"""The load that the can carries: the beer of the paper, or a point mass."""

from dataclasses import dataclass

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.segment import segment

BEER = 1000.0
"""Density of beer [kg/m^3]: that of water, rounded, from which beer differs by about 1 %."""


@dataclass(frozen=True)
class Load:
    """The properties of a load on which its motion depends.

    Raises:
      ParameterError: on a mass that is not positive, a negative or non-finite offset or
        inertia, or a fill outside (0, 1].
    """

    mass: float
    """Mass m [kg], eq. (34)."""
    offset: float
    """Distance b of the centre of mass from the can's axis [m], eqs. (7) and (35)."""
    inertia: float = 0.0
    """Moment of inertia I_cm about the centre of mass [kg m^2], eqs. (9) and (37)."""
    fill: float | None = None
    """Filling height over diameter, h/2a of eq. (32), if the load is a circular segment. It decides
    only how the load is drawn: without it the load is a ball at its centre of mass."""

    @property
    def moment(self) -> float:
        """Return its first moment about the axis, m b [kg m]."""
        return self.mass * self.offset

    @property
    def axis_inertia(self) -> float:
        """Return its moment of inertia about the axis, I_cm + m b^2 [kg m^2]."""
        return self.inertia + self.mass * self.offset**2

    def __post_init__(self) -> None:
        require.store(
            self,
            mass=require.within("load mass", self.mass, *require.MASS, "kg"),
            offset=require.within("load offset", self.offset, 0, require.SIZE[1], "m"),
            inertia=require.non_negative("load inertia", self.inertia, "kg m^2"),
            fill=None if self.fill is None else _checked_fill(self.fill),
        )

    @classmethod
    def segment(
        cls, radius: float = RADIUS, length: float = LENGTH, fill: float = 0.5, density: float = BEER
    ) -> "Load":
        """Return beer of `density` [kg/m^3] in a can of `radius` and `length` [m]: eqs. (32)-(37).

        `fill` is h/2a of eq. (32), 0 < fill <= 1.

        Raises:
          ParameterError: if `fill` is outside (0, 1], or another number is not positive.
        """
        radius = require.positive("load radius", radius, "m")
        length = require.positive("load length", length, "m")
        density = require.positive("load density", density, "kg/m^3")
        fill = _checked_fill(fill)
        shape = segment(fill)
        mass = density * length * radius**2 * shape.area
        with require.from_given(radius=radius, length=length, fill=fill, density=density):
            return cls(mass, offset=radius * shape.offset, inertia=mass * radius**2 * shape.inertia, fill=fill)

    @classmethod
    def point(cls, mass: float, offset: float) -> "Load":
        """Return a point of `mass` [kg] at `offset` [m] from the axis (appendices A.4 and B)."""
        return cls(mass, offset, 0.0)


def _checked_fill(fill: float) -> float:
    share = require.number("fill", fill)
    if not 0 < share <= 1:
        raise ParameterError(
            f"fill (height of the beer over the can's diameter) must be in (0, 1], got {require.shown(fill)}"
        )
    return share
