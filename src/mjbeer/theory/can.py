"""The parts of a scene: a can, its load (beer is a segment of a circle in cross section), and the damping."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError

RADIUS = 0.033  # of a 12-oz can [m]; paper, after eq. (31)
LENGTH = 0.12  # of a 12-oz can [m]; paper, after eq. (31)
THICKNESS = 1e-4  # of the wall of an aluminium drinks can [m]; a common value, as the paper gives none
ALUMINIUM = 2700.0  # density [kg/m^3]; handbook value
BEER = 1000.0  # density [kg/m^3]: that of water, rounded, from which beer differs by about 1 %
# Trigonometric polynomials of sixth degree over half a turn: 24 Gauss points would integrate them to rounding.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


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
        vars(self).update(
            radius=require.within("can radius", self.radius, *require.SIZE, "m"),
            length=require.within("can length", self.length, *require.SIZE, "m"),
            mass=require.within("can mass", self.mass, *require.MASS, "kg", zero=True),
            inertia=require.non_negative("can inertia", self.inertia, "kg m^2"),
        )
        if self.mass == 0 and self.inertia > 0:
            got = require.format_value(self.inertia)
            raise ParameterError(f"can inertia must be 0 for a can without mass [kg m^2], got {got}")
        most = require.RATIO * self.mass * self.radius**2
        require.within(f"can inertia with a mass of {self.mass:g} kg", self.inertia, 0, most, "kg m^2")

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
        vars(self).update(
            mass=require.within("load mass", self.mass, *require.MASS, "kg"),
            offset=require.within("load offset", self.offset, 0, require.SIZE[1], "m"),
            inertia=require.non_negative("load inertia", self.inertia, "kg m^2"),
            fill=None if self.fill is None else require.fill(self.fill),
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
          ParameterError: as `Load`.
        """
        can, density = Can(radius, length), require.positive("load density", density, "kg/m^3")
        fill = require.fill(fill)
        shape = segment(fill)
        mass = density * can.length * can.radius**2 * shape.area
        return cls(mass, offset=can.radius * shape.offset, inertia=mass * can.radius**2 * shape.inertia, fill=fill)

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


def segment(fill: float) -> Segment:
    """Return the segment whose height is `fill` times the diameter (fill = h/2a, eq. 32), to full relative precision.

    The closed forms (33), (35) and (37) cancel when the can is almost empty. Here their integrals are evaluated over
    strips along the flat side, which end at the angle t <= beta at the axis: y = cos t and dA = 2 sin^2 t dt for a = 1.
    """
    beta = 2 * math.atan2(math.sqrt(fill), math.sqrt(1 - fill))
    sine = 2 * math.sqrt(fill * (1 - fill))  # 1 - fill is exact wherever it is small
    angle = beta / 2 * (1 + _NODES)
    across = np.sin(angle)
    strip = _WEIGHTS * (across / beta) ** 2  # divided by beta^3, which is tiny if the can is almost empty
    below = 2 * np.sin(angle / 2) ** 2  # 1 - cos(angle): depth under the top of the circle
    total = float(strip.sum())
    offset = 2 * (sine / beta) ** 3 / (3 * total)
    height = float(strip @ below) / total - below  # strip's y minus the centroid's
    width = float(strip @ across**2) / (3 * total)
    inertia = width + float(strip @ height**2) / total
    return Segment(half_angle=beta, area=beta**3 * total, offset=offset, inertia=inertia, width=width)


@dataclass(frozen=True)
class Damping:
    """A torque c1 w + c2 w |w| + c3 w^3 against the slip rate w = roll_dot - phi_dot of can and load [rad/s].

    It acts on the load with the sign of w and on the can with the other one. MuJoCo's damping is the same polynomial.

    Raises:
      ParameterError: if a coefficient is negative or not finite.
    """

    linear: float = 0.0
    """c1 [N m s]."""
    quadratic: float = 0.0
    """c2 [N m s^2]."""
    cubic: float = 0.0
    """c3 [N m s^3]."""
    holds: tuple[float, float] | None = field(default=None, compare=False, repr=False, kw_only=True)
    """Slip rates [rad/s] between which it is the damping of a real liquid; None if it is not one's."""
    coats_at: float = field(default=math.inf, compare=False, repr=False, kw_only=True)
    """Slip rate [rad/s] from which a film all round the wall can hold a third of that liquid."""

    def __post_init__(self) -> None:
        vars(self).update(
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
        """Return the torque [N m] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return rate * (self.linear + size * (self.quadratic + size * self.cubic))

    def derivative(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the derivative of the torque by the slip rate [N m s] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return self.linear + size * (2 * self.quadratic + size * 3 * self.cubic)

    def slip_rate(self, torque: float) -> float:
        """Return the slip rate [rad/s] at which the torque is `torque` [N m]; it is infinite if there is no damping."""
        if torque == 0:
            return 0.0
        # Each term alone would need a larger rate. Newton's method falls from above, as the sum is convex.
        terms = enumerate(self.coefficients, start=1)
        rate = min(((abs(torque) / c) ** (1 / power) for power, c in terms if c > 0), default=math.inf)
        while rate < math.inf:
            lower = rate - float((self.torque(rate) - abs(torque)) / self.derivative(rate))
            if not lower < rate:
                break
            rate = lower
        return math.copysign(rate, torque)
