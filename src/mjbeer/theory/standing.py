"""A standing can with liquid in it: the slosh of its free surface, in the exact linear theory without viscosity.

The modes of a liquid of radius R and height h vary as J1(xi r/R) cos(angle) with J1'(xi) = 0. Each acts on the can like
a pendulum, the rest like a rigid body. Heights z are above the centroid of the liquid at rest. (H. N. Abramson, ed.,
"The Dynamic Behavior of Liquids in Moving Containers", NASA SP-106, 1966, chapters 2 and 6.)
"""

import functools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError, warn_of_liquid
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import LIQUIDS, NAMES
from mjbeer.theory.scene import GRAVITY

QUANTITATIVE, INDICATIVE = 0.1, 0.3
"""Elevations of the surface at the wall, over the radius, up to which linear theory gives numbers, and a picture."""
MOST_MODES = 5
SERIES = 4000  # terms of the infinite sums, which fall as the fourth power or faster: the rest is below 1e-13


class Reaction(NamedTuple):
    """The forces on the liquid per unit of acceleration of the can, about the liquid's centroid at rest."""

    force: np.ndarray | float  # per sideways acceleration, F_X [kg]
    coupling: np.ndarray | float  # force per angular, and moment per sideways acceleration, F_Theta = M_X [kg m]
    moment: np.ndarray | float  # per angular acceleration about a level axis, M_Theta [kg m^2]


@dataclass(frozen=True)
class Standing:
    """A can that stands, with a liquid in it whose surface is free.

    Raises:
      ParameterError: if one of the values is not allowed.
    """

    can: Can
    fill: float
    """Height of the liquid over the can's length."""
    name: str
    density: float
    """Density of the liquid [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity nu [m^2/s]."""
    modes: int = 1
    """Number of modes that move in the model, unless over-damped (see `moving_modes`); with 0 the liquid is solid."""
    damping_ratio: float | None = None
    """Damping of every mode over the critical one, with which none moves; None: what the layers on the walls give."""
    gravity: float = GRAVITY
    """Acceleration of gravity [m/s^2]."""

    def __post_init__(self) -> None:
        require.instance("can", self.can, Can)
        if not self.can.mass * self.can.inertia > 0:
            raise ParameterError(f"a standing can must have mass and inertia, as Can.sheet_metal(), got {self.can!r}")
        fill = require.number("fill", self.fill)
        if not 0 < fill < 1:
            raise ParameterError(
                f"fill must be a fraction between 0 and 1 (50 % is 0.5): a full can has no free surface, got {fill!r}"
            )
        # In thinner films viscosity is everywhere.
        require.within("height of the liquid over the radius", fill * self.can.length / self.can.radius, 0.05, 50.0)
        ratio = self.damping_ratio
        vars(self).update(
            fill=fill,
            density=require.positive("density", self.density, "kg/m^3"),
            viscosity=require.non_negative("viscosity", self.viscosity, "m^2/s"),
            modes=_checked_count("modes", self.modes, MOST_MODES),
            damping_ratio=None if ratio is None else require.within("damping_ratio", ratio, 0, 1),
            gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2"),
        )
        require.within("mass of the liquid", self.mass, *require.MASS, "kg")
        require.within("mass of the can", self.can.mass, self.mass / require.RATIO, self.mass * require.RATIO, "kg")

    @property
    def height(self) -> float:
        """Return the height h of the liquid [m]."""
        return self.fill * self.can.length

    @property
    def mass(self) -> float:
        """Return the mass of the liquid [kg]."""
        return self.density * math.pi * self.can.radius**2 * self.height

    @property
    def held_inertia(self) -> float:
        """Return the moment of inertia about a level axis of the liquid under a lid on its surface, I_F [kg m^2]."""
        radius, xi = self.can.radius, _roots()
        series = float(np.sum(np.tanh(xi * self.height / (2 * radius)) / (xi**3 * (xi**2 - 1))))
        return self.mass * (self.height**2 / 12 - 0.75 * radius**2 + 16 * radius**3 / self.height * series)

    @property
    def moving_modes(self) -> int:
        """Return the number of modes that move in the model: `modes`, or 0 if the first one is over-damped.

        The first mode is the most damped one. Where it does not swing, the layers on the walls fill the liquid, which
        then moves with the can as a solid.
        """
        if self.modes == 0 or self.damping_ratios(1)[0] >= 1:
            return 0
        return self.modes

    def frequencies(self, count: int | None = None) -> np.ndarray:
        """Return the natural frequencies of the first `count` modes in a can that is held [rad/s], shape (count,).

        They are those without damping. By default, here and below, the modes are those that move in the model, which
        are none in a liquid that is over-damped; with a `count` they are those of theory, whether they move or not.
        """
        _, _, length = self._pendulums(count)
        return np.sqrt(self.gravity / length)

    def slosh_masses(self, count: int | None = None) -> np.ndarray:
        """Return the masses of the pendulums [kg], shape (count,)."""
        return self._pendulums(count)[0]

    def pivots(self, count: int | None = None) -> np.ndarray:
        """Return the heights of the pendulums' pivots above the inside of the bottom [m], shape (count,)."""
        _, bob, length = self._pendulums(count)
        return self.height / 2 + bob + length

    def damping_ratios(self, count: int | None = None) -> np.ndarray:
        """Return the damping of the modes over the critical one, shape (count,).

        Thin layers on wall and bottom take rho u^2 sqrt(nu omega/2)/2 where a mode has the velocity u along them.
        """
        radius, xi = self.can.radius, self._xi(count)
        if self.damping_ratio is not None:
            return np.full(len(xi), self.damping_ratio)
        depth = self.height / radius
        inverse_sinh = 2 * np.exp(-2 * xi * depth) / -np.expm1(-4 * xi * depth)
        layers = (xi**2 + 1) / (xi**2 - 1) + 2 * xi * (1 - depth) * inverse_sinh
        return np.sqrt(self.viscosity / (2 * self.frequencies(count))) / (2 * radius) * layers

    def elevations(self, count: int | None = None) -> np.ndarray:
        """Return how high the surface rises at the wall, over R and the sine of each pendulum's angle, (count,)."""
        return 2 / (self._xi(count) ** 2 - 1)

    def reaction(self, omega: float | np.ndarray) -> Reaction:
        """Return force and moment of the liquid alone in a can that is shaken with a frequency `omega` [rad/s].

        There is no damping. X is sideways, Theta about the level axis across it. Weight is included: a tilted liquid's
        metacentric moment is -g sum(m_n L_n) = -rho g pi R^4/4 per angle.

        Raises:
          ParameterError: if a frequency is not between 1e-6 and 1e6.
        """
        for each in np.atleast_1d(np.asarray(omega, object)):
            require.within("omega", each, 1e-6, 1e6, "rad/s")
        omega = np.asarray(omega, float)
        mass, bob, length = self._pendulums(SERIES)
        square = omega[..., None] ** 2
        share = mass * square / (self.gravity / length - square)
        arm = bob + self.gravity / square
        force, coupling, moment = (np.sum(share * arm**power, axis=-1)[()] for power in range(3))
        return Reaction(self.mass + force, coupling, self.held_inertia + moment)

    def fixed_moments(self) -> np.ndarray:
        """Return the moments of mass of the model in all, about the centroid: the zeroth, first and second one.

        The modes left out are fixed at their pivots, where slow motion has them: sum(m_n L_n) to the first moment
        [kg m], sum(m_n (p_n^2 - z_n^2)) to the second [kg m^2]. If no mode moves, the liquid is a solid cylinder.
        """
        if self.moving_modes == 0:
            return np.array([self.mass, 0.0, self.mass * (self.can.radius**2 / 4 + self.height**2 / 12)])
        mass, bob, length = self._pendulums(SERIES)[:, self.moving_modes :]
        second = self.held_inertia + np.sum(mass * ((bob + length) ** 2 - bob**2))
        return np.array([self.mass, np.sum(mass * length), second])

    def _xi(self, count: int | None) -> np.ndarray:
        return _roots()[: self.moving_modes if count is None else _checked_count("count", count, SERIES)]

    def _pendulums(self, count: int | None) -> np.ndarray:
        """Return masses m_n [kg], heights z_n of the bobs above the centroid [m] and lengths L_n [m], (3, count)."""
        radius, height, xi = self.can.radius, self.height, self._xi(count)
        tanh = np.tanh(xi * height / radius)
        mass = self.mass * 2 * radius * tanh / (height * xi * (xi**2 - 1))
        bob = height / 2 - 2 * radius / xi * np.tanh(xi * height / (2 * radius))
        return np.array([mass, bob, radius / (xi * tanh)])


def standing(
    liquid: str = "beer",
    fill: float = 0.5,
    can: Can | None = None,
    modes: int = 1,
    damping_ratio: float | None = None,
    gravity: float = GRAVITY,
) -> Standing:
    """Return a can that stands, by default `Can.sheet_metal()`, with a liquid in it that sloshes.

    `liquid` is a name that `mjbeer.liquid` knows; the others are fields of `Standing`. By default the damping follows
    from the viscosity, for a clean surface: foam or dust doubles it.

    A `LiquidWarning` says where the layers on the walls are not thin, so that the damping is an order of magnitude, and
    where it is so large that the liquid does not slosh.

    Raises:
      ParameterError: if a parameter is not allowed.
    """
    name = require.choice("liquid", liquid, NAMES)
    can = Can.sheet_metal() if can is None else can
    standing_can = Standing(can, fill, name, *LIQUIDS[name], modes, damping_ratio, gravity)
    if modes > 0 and damping_ratio is None:
        layer = math.sqrt(2 * standing_can.viscosity / standing_can.frequencies(1)[0]) / can.radius
        if layer > 0.1:
            thick = f"{name} is too thick for the damping of thin layers: that on the wall has {layer:.3g} radii"
            thick += ", not 0.1 or less"
            if standing_can.moving_modes == 0:
                ratio = standing_can.damping_ratios(1)[0]
                thick += f", and the liquid does not slosh: its damping is {ratio:.3g} times the critical one"
            warn_of_liquid.get()(f"{thick}; give a damping_ratio", LiquidWarning, stacklevel=2)
    return standing_can


def _checked_count(name: str, value: object, most: int) -> int:
    if not isinstance(value, (int, np.integer)) or isinstance(value, bool) or not 0 <= value <= most:
        raise ParameterError(f"{name} must be one of 0, 1, ... {most}, got {require.format_value(value)}")
    return int(value)


@functools.cache
def _roots() -> np.ndarray:
    """Return the first zeros xi > 0 of J1', shape (SERIES,), by Newton's method from McMahon's expansion."""
    from scipy.special import jv  # its own zeros end at 1200

    beta = (np.arange(1, SERIES + 1) - 0.25) * math.pi
    xi = beta - 7 / (8 * beta)
    for _ in range(6):
        derivative = jv(0, xi) - jv(1, xi) / xi  # J1'; Bessel's equation gives its own derivative
        xi = xi - derivative / (-derivative / xi - (1 - 1 / xi**2) * jv(1, xi))
    return xi
