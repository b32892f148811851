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
"""Wall thickness of an aluminium drinks can [m]; a common value, as the paper gives none."""
ALUMINIUM = 2700.0
"""Density of aluminium [kg/m^3]; handbook value."""


@dataclass(frozen=True)
class Can:
    """The properties of a can on which its rolling depends.

    Raises:
      ParameterError: if one of them is outside the domain, or a can without mass has inertia.
    """

    radius: float = RADIUS
    """Outer radius a [m]."""
    length: float = LENGTH
    """Length l along the axis [m]; it decides how the can is drawn, and enters masses computed from densities."""
    mass: float = 0.0
    """Mass m_can [kg], eq. (30)."""
    inertia: float = 0.0
    """Moment of inertia I_can about the axis [kg m^2], eq. (31)."""

    def __post_init__(self) -> None:
        require.set_fields(
            self,
            radius=require.within("can radius", self.radius, *require.SIZE, "m"),
            length=require.within("can length", self.length, *require.SIZE, "m"),
            mass=require.within("can mass", self.mass, *require.MASS, "kg", zero=True),
            inertia=require.non_negative("can inertia", self.inertia, "kg m^2"),
        )
        if self.mass == 0 and self.inertia > 0:
            raise ParameterError(
                f"a can without mass has no inertia, got mass 0 kg and inertia {self.inertia!r} kg m^2"
            )
        require.within("can inertia", self.inertia, 0, require.RATIO * self.mass * self.radius**2, "kg m^2")

    @property
    def effective_mass(self) -> float:
        """Return the mass that the rolling can puts against a force along the incline, K = m_can + I_can/a^2 [kg]."""
        return self.mass + self.inertia / self.radius**2

    @classmethod
    def massless(cls, radius: float = RADIUS, length: float = LENGTH) -> "Can":
        """Return a can without mass, as in section 2 of the paper."""
        return cls(radius, length)

    @classmethod
    def sheet_metal(
        cls, radius: float = RADIUS, length: float = LENGTH, thickness: float = THICKNESS, density: float = ALUMINIUM
    ) -> "Can":
        """Return a can of thin metal sheet, a wall and two ends: eqs. (30) and (31).

        `thickness` is the sheet's [m], `density` the metal's [kg/m^3].

        Raises:
          ParameterError: as `Can`.
        """
        empty = cls(radius, length)
        radius, length = empty.radius, empty.length
        thickness = require.positive("sheet thickness", thickness, "m")
        density = require.positive("sheet density", density, "kg/m^3")
        sheet = math.pi * radius * thickness * density
        mass, inertia = 2 * sheet * (length + radius), sheet * radius**2 * (2 * length + radius)
        return cls(radius, length, mass, inertia)

    @classmethod
    def hoop(cls, radius: float = RADIUS, length: float = LENGTH, mass: float = 0.05) -> "Can":
        """Return a hoop, which has all of its `mass` [kg] at the rim: I_can = m_can a^2 (appendices A.4 and B).

        Raises:
          ParameterError: as `Can`.
        """
        mass = require.within("hoop mass", mass, *require.MASS, "kg")
        return cls(radius, length, mass, inertia=mass * cls(radius).radius ** 2)
