"""The can: a thin cylinder that rolls without slipping (paper, section 3)."""

import math
from dataclasses import dataclass

from mjbeer import require
from mjbeer.exceptions import ParameterError

RADIUS = 0.033
"""Radius of a 12-oz can [m]; paper, after eq. (31)."""
LENGTH = 0.12
"""Length of a 12-oz can [m]; paper, after eq. (31)."""
THICKNESS = 1e-4
"""Wall of an aluminium drinks can [m]; a common value (0.1 mm), the paper gives none."""
ALUMINIUM = 2700.0
"""Density of aluminium [kg/m^3]; handbook value."""


@dataclass(frozen=True)
class Can:
    """A can, seen as what its rolling depends on.

    Raises:
      ParameterError: on a size that is not positive, a negative or non-finite mass or
        inertia, or an inertia without mass.
    """

    radius: float = RADIUS
    """Outer radius a [m]."""
    length: float = LENGTH
    """Length l along the axis [m]; it enters the drawing, and the mass of what is made of it."""
    mass: float = 0.0
    """Mass m_can [kg], eq. (30)."""
    inertia: float = 0.0
    """Moment of inertia I_can about the axis [kg m^2], eq. (31)."""

    def __post_init__(self) -> None:
        require.positive("can radius", self.radius, "m")
        require.positive("can length", self.length, "m")
        require.non_negative("can mass", self.mass, "kg")
        require.non_negative("can inertia", self.inertia, "kg m^2")
        require.store_floats(self, "radius", "length", "mass", "inertia")
        if self.mass == 0 and self.inertia > 0:
            raise ParameterError(
                f"a can without mass has no inertia, got mass 0 kg and inertia {self.inertia!r} kg m^2"
            )

    @classmethod
    def massless(cls, radius: float = RADIUS, length: float = LENGTH) -> "Can":
        """A can of no mass, as in section 2 of the paper."""
        return cls(radius, length)

    @classmethod
    def sheet_metal(
        cls, radius: float = RADIUS, length: float = LENGTH, thickness: float = THICKNESS, density: float = ALUMINIUM
    ) -> "Can":
        """A can of thin sheet, wall and two ends: eqs. (30) and (31).

        `thickness` of the sheet [m], `density` of the metal [kg/m^3].
        """
        require.positive("can radius", radius, "m")
        require.positive("can length", length, "m")
        require.positive("sheet thickness", thickness, "m")
        require.positive("sheet density", density, "kg/m^3")
        sheet = math.pi * radius * thickness * density
        return cls(
            radius, length, mass=2 * sheet * (length + radius), inertia=sheet * radius**2 * (2 * length + radius)
        )

    @classmethod
    def hoop(cls, radius: float = RADIUS, length: float = LENGTH, mass: float = 0.05) -> "Can":
        """A hoop: all of the `mass` [kg] at the rim, I_can = m_can a^2 (appendices A.4 and B)."""
        require.positive("hoop radius", radius, "m")
        require.positive("hoop mass", mass, "kg")
        return cls(radius, length, mass, mass * radius**2)
