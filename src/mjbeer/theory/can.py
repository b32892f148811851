"""The parts of a scene: a can, its load (beer fills a segment of the circle), and the damping."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory import slosh
from mjbeer.theory.segment import segment

RADIUS = 0.033
"""Radius of a 12-oz can [m]; paper, after eq. (31)."""
LENGTH = 0.12
"""Length of a 12-oz can [m]; paper, after eq. (31)."""
THICKNESS = 1e-4
"""Thickness of the wall of an aluminium drinks can [m]; a common value, as the paper has none."""
ALUMINIUM = 2700.0
"""Density of aluminium [kg/m^3]; handbook value."""
BEER = 1000.0
"""Density of beer [kg/m^3]: that of water, rounded, from which beer differs by about 1 %."""


@dataclass(frozen=True)
class Can:
    """The properties of a can on which its rolling depends.

    Raises:
      ParameterError: if one of them is outside the domain, or a can without mass has inertia.
    """

    radius: float = RADIUS
    """Outer radius a [m]."""
    length: float = LENGTH
    """Length l along the axis [m]; the can is drawn with it, and masses follow from it."""
    mass: float = 0.0
    """Mass m_can [kg], eq. (30)."""
    inertia: float = 0.0
    """Moment of inertia I_can about the axis [kg m^2], eq. (31)."""

    def __post_init__(self) -> None:
        radius = require.within("can radius", self.radius, *require.SIZE, "m")
        length = require.within("can length", self.length, *require.SIZE, "m")
        mass = require.within("can mass", self.mass, *require.MASS, "kg", zero=True)
        inertia = require.non_negative("can inertia", self.inertia, "kg m^2")
        if mass == 0 and inertia > 0:
            got = require.format_value(self.inertia)
            allowed = "can inertia must be 0 for a can without mass"
            raise ParameterError(f"{allowed} [kg m^2], got {got}")
        largest = require.LARGEST_INERTIA * mass * radius**2
        require.within(f"can inertia with a mass of {mass:g} kg", inertia, 0, largest, "kg m^2")
        require.set_fields(self, radius=radius, length=length, mass=mass, inertia=inertia)

    @property
    def effective_mass(self) -> float:
        """Return the inertia of the rolling can against a force along the incline [kg].

        It is K = m_can + I_can/a^2.
        """
        return self.mass + self.inertia / self.radius**2

    @classmethod
    def massless(cls, radius: float = RADIUS, length: float = LENGTH) -> "Can":
        """Return a can without mass, as in section 2 of the paper.

        Raises:
          ParameterError: as `Can`.
        """
        return cls(radius, length)

    @classmethod
    def sheet_metal(
        cls,
        radius: float = RADIUS,
        length: float = LENGTH,
        thickness: float = THICKNESS,
        density: float = ALUMINIUM,
    ) -> "Can":
        """Return a can of thin metal sheet, a wall and two ends: eqs. (30) and (31).

        `thickness` [m] is that of the sheet, `density` [kg/m^3] that of the metal.

        Raises:
          ParameterError: as `Can`, or if the sheet is as thick as the can.
        """
        radius = require.within("can radius", radius, *require.SIZE, "m")
        length = require.within("can length", length, *require.SIZE, "m")
        thickness = require.positive("sheet thickness", thickness, "m")
        if thickness >= radius:
            allowed = f"sheet thickness must be less than the radius of the can, {radius:g} [m]"
            raise ParameterError(f"{allowed}, got {require.format_value(thickness)}")
        density = require.positive("sheet density", density, "kg/m^3")
        # The wall has the mass 2 pi a l thickness density, and each end pi a^2 thickness density.
        # Their inertias are a^2 and a^2/2 times that.
        unit = math.pi * radius * thickness * density
        return cls(
            radius,
            length,
            mass=2 * unit * (length + radius),
            inertia=unit * radius**2 * (2 * length + radius),
        )

    @classmethod
    def hoop(cls, radius: float = RADIUS, length: float = LENGTH, mass: float = 0.05) -> "Can":
        """Return a hoop, which has all of its `mass` [kg] at the rim (appendices A.4 and B).

        Its inertia is I_can = m_can a^2.

        Raises:
          ParameterError: as `Can`.
        """
        radius = require.within("can radius", radius, *require.SIZE, "m")
        mass = require.within("hoop mass", mass, *require.MASS, "kg")
        return cls(radius, length, mass, inertia=mass * radius**2)


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
    """Depth divided by the diameter, h/2a of eq. (32), if the load is a circular segment.

    Only drawings and cans that are free in space (`mjbeer.attach`) depend on it.
    """
    sloshes_in: Can | None = field(default=None, kw_only=True)
    """The can for which `Load.liquid` made the load; None for a rigid load.

    The inertia is that of slosh in this can while it rolls. Only a scene in which the load slides
    in this very can, under gravity, takes it.
    """

    def __post_init__(self) -> None:
        fill = None if self.fill is None else require.fill(self.fill)
        if self.sloshes_in is not None:
            require.instance("sloshes_in", self.sloshes_in, Can)
        require.set_fields(
            self,
            mass=require.within("load mass", self.mass, *require.MASS, "kg"),
            offset=require.within("load offset", self.offset, 0, require.SIZE[1], "m"),
            inertia=require.non_negative("load inertia", self.inertia, "kg m^2"),
            fill=fill,
        )

    @property
    def moment(self) -> float:
        """Return the first moment of mass about the axis, m b [kg m]."""
        return self.mass * self.offset

    @property
    def axis_inertia(self) -> float:
        """Return the moment of inertia about the axis, I_axis = I_cm + m b^2 [kg m^2]."""
        return self.inertia + self.mass * self.offset**2

    @classmethod
    def segment(
        cls,
        radius: float = RADIUS,
        length: float = LENGTH,
        fill: float = 0.5,
        density: float = BEER,
    ) -> "Load":
        """Return beer of `density` [kg/m^3] in a can of `radius` and `length` [m]: eqs. (32)-(37).

        `fill` is the depth divided by the diameter, h/2a of eq. (32).

        Raises:
          ParameterError: as `Load`.
        """
        radius = require.within("can radius", radius, *require.SIZE, "m")
        length = require.within("can length", length, *require.SIZE, "m")
        fill = require.fill(fill)
        density = require.positive("load density", density, "kg/m^3")
        shape = segment(fill)
        mass = density * length * radius**2 * shape.area
        return cls(
            mass,
            offset=radius * shape.offset,
            inertia=mass * radius**2 * shape.inertia,
            fill=fill,
        )

    @classmethod
    def liquid(cls, can: Can, fill: float = 0.5, density: float = BEER) -> "Load":
        """Return the rigid load that swings in a rolling can as a liquid without viscosity does.

        Mass and centre of mass are those of `Load.segment`. The moment of inertia is such that on
        level ground a small swing has the frequency of the liquid's slowest mode. So it depends on
        the can as well, and a scene takes the load in this `can` alone. It does not depend on
        gravity, without which nothing sloshes.

        The load moves as the slowest mode does, and the liquid has more modes, whose shares of the
        energy are in `theory.slosh.rolling`. In a can without mass that is filled to less than 0.3,
        a flat tilt that is let go has more of a faster mode than of this one. Where the load rests
        at an angle to the normal of the ground, it swings more slowly than the liquid, most so in a
        can without mass: at 30 degrees by 1.3 % if the can is half full, and by 6 % at a fill of
        0.25.

        `fill` is the depth divided by the diameter, `density` [kg/m^3] that of the liquid.

        Raises:
          ParameterError: as `Load`, or if `can` is no `Can` or the fill is not between 0.01 and
            0.99.
        """
        can = require.instance("can", can, Can)
        solid = cls.segment(can.radius, can.length, fill, density)
        mass_ratio = (solid.mass + can.effective_mass) / solid.mass
        modes = slosh.rolling(fill, mass_ratio)
        axis_inertia = modes.axis_inertia * solid.mass * can.radius**2
        inertia = axis_inertia - solid.mass * solid.offset**2
        return replace(solid, inertia=inertia, sloshes_in=can)

    @classmethod
    def point(cls, mass: float, offset: float) -> "Load":
        """Return a point of `mass` [kg] at `offset` [m] from the axis (appendices A.4 and B).

        Raises:
          ParameterError: as `Load`.
        """
        return cls(mass, offset)


@dataclass(frozen=True)
class Damping:
    """A torque c1 w + c2 w |w| + c3 w^3, where w is the slip rate of can and load [rad/s].

    The slip rate is w = roll_dot - phi_dot. The torque acts on the load with the sign of w and on
    the can with the opposite sign. MuJoCo's damping is the same polynomial.

    Raises:
      ParameterError: if a coefficient is negative or not finite.
    """

    linear: float = 0.0
    """c1 [N m s]."""
    quadratic: float = 0.0
    """c2 [N m s^2]."""
    cubic: float = 0.0
    """c3 [N m s^3]."""
    valid_rates: tuple[float, float] | None = field(
        default=None,
        compare=False,
        repr=False,
        kw_only=True,
    )
    """Lowest and highest slip rate [rad/s] at which this is the damping of a real liquid.

    None if it is not that of a liquid.
    """
    coating_rate: float = field(default=math.inf, compare=False, repr=False, kw_only=True)
    """Slip rate [rad/s] from which a film all round the wall can hold a third of that liquid."""
    liquid: str = field(default="", compare=False, repr=False, kw_only=True)
    """The name of that liquid."""

    def __post_init__(self) -> None:
        require.set_fields(
            self,
            linear=require.non_negative("damping", self.linear, "N m s"),
            quadratic=require.non_negative("quadratic damping", self.quadratic, "N m s^2"),
            cubic=require.non_negative("cubic damping", self.cubic, "N m s^3"),
        )

    def __bool__(self) -> bool:
        return any(self.coefficients)

    @property
    def coefficients(self) -> tuple[float, float, float]:
        """Return c1, c2 and c3."""
        return self.linear, self.quadratic, self.cubic

    def torque(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the torque on the load [N m] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return rate * (self.linear + size * (self.quadratic + size * self.cubic))

    def derivative(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the derivative of the torque by the slip rate [N m s] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return self.linear + size * (2 * self.quadratic + size * 3 * self.cubic)

    def rate_at(self, torque: float) -> float:
        """Return the slip rate [rad/s] at which the torque on the load is `torque` [N m].

        It is infinite if there is no damping.
        """
        if torque == 0:
            return 0.0
        # Each term of the polynomial alone would need a higher rate than their sum does. From the
        # lowest of these rates Newton's method falls to the solution, as the sum is convex.
        rate = math.inf
        for power, coefficient in enumerate(self.coefficients, start=1):
            if coefficient > 0:
                rate = min(rate, (abs(torque) / coefficient) ** (1 / power))
        while rate < math.inf:
            excess = float(self.torque(rate)) - abs(torque)
            lower = rate - excess / float(self.derivative(rate))
            if not lower < rate:
                break
            rate = lower
        return math.copysign(rate, torque)
