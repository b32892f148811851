"""A standing can with liquid in it: the slosh of its free surface, in the exact linear theory.

The liquid has no viscosity, a radius R and a height h. Each zero xi of J1' has a mode, which varies
as J1(xi r/R) cos(angle). A mode acts on the can like a pendulum. What the pendulums leave of the
liquid acts like a rigid body. Heights z are above the centroid of the liquid at rest.
(H. N. Abramson, ed., "The Dynamic Behavior of Liquids in Moving Containers", NASA SP-106, 1966,
chapters 2 and 6.)
"""

import functools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError, warn_of_liquid
from mjbeer.theory.can import Can
from mjbeer.theory.liquid_properties import LIQUIDS, NAMES
from mjbeer.theory.scene import GRAVITY

QUANTITATIVE = 0.1
"""Elevation of the surface at the wall, divided by R, up to which linear theory gives numbers."""
INDICATIVE = 0.3
"""The elevation up to which it gives a picture."""
MOST_MODES = 5
"""Largest number of modes in a model. At any fill the sixth has at most 0.6 % of the liquid's mass,
2/(xi^2 - 1) in the limit of a shallow liquid."""
SERIES = 4000
"""Terms of the infinite sums, which fall as the fourth power or faster: the rest is below 1e-13."""


class Reaction(NamedTuple):
    """The forces on the liquid per unit of acceleration of the can, about its centroid at rest."""

    force: np.ndarray | float
    """Force per sideways acceleration, F_X [kg]."""
    coupling: np.ndarray | float
    """Force per angular acceleration, and moment per sideways one, F_Theta = M_X [kg m]."""
    moment: np.ndarray | float
    """Moment per angular acceleration about a level axis, M_Theta [kg m^2]."""


class _Pendulums(NamedTuple):
    """The pendulums that stand for the first modes; every array has shape (count,)."""

    mass: np.ndarray
    """m_n [kg]."""
    bob: np.ndarray
    """Height z_n above the centroid of the liquid at rest [m]."""
    length: np.ndarray
    """L_n [m]."""

    @property
    def pivot(self) -> np.ndarray:
        """Return the heights p_n of the pivots above the centroid of the liquid at rest [m]."""
        return self.bob + self.length


@dataclass(frozen=True)
class Standing:
    """A can that stands, with a liquid in it whose surface is free.

    Raises:
      ParameterError: if one of the values is invalid.
    """

    can: Can
    fill: float
    """Height of the liquid divided by the can's length."""
    name: str
    density: float
    """Density of the liquid [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity nu [m^2/s]."""
    modes: int = 1
    """Number of modes that move in the model, unless they are over-damped (see `moving_modes`).

    With 0 the liquid is solid."""
    damping_ratio: float | None = None
    """Damping of every mode divided by the critical one; with 1 none moves.

    None: what the layers on the walls give."""
    gravity: float = GRAVITY
    """Acceleration of gravity [m/s^2]."""

    def __post_init__(self) -> None:
        can = require.instance("can", self.can, Can)
        if not can.mass * can.inertia > 0:
            needed = "a standing can must have mass and inertia, as Can.sheet_metal()"
            raise ParameterError(f"{needed}, got {can!r}")
        fill = require.number("fill", self.fill)
        if not 0 < fill < 1:
            allowed = "fill must be a fraction between 0 and 1 (50 % is 0.5)"
            raise ParameterError(f"{allowed}: a full can has no free surface, got {fill!r}")
        depth = fill * can.length / can.radius
        # In thinner films viscosity is everywhere.
        require.within("height of the liquid divided by the radius", depth, 0.05, 50.0)
        damping_ratio = self.damping_ratio
        if damping_ratio is not None:
            damping_ratio = require.within("damping_ratio", damping_ratio, 0, 1)
        require.set_fields(
            self,
            fill=fill,
            density=require.positive("density", self.density, "kg/m^3"),
            viscosity=require.non_negative("viscosity", self.viscosity, "m^2/s"),
            modes=_checked_count("modes", self.modes, MOST_MODES),
            damping_ratio=damping_ratio,
            gravity=require.within("gravity", self.gravity, *require.GRAVITY, "m/s^2"),
        )
        require.within("mass of the liquid", self.mass, *require.MASS, "kg")
        lightest, heaviest = (ratio * self.mass for ratio in require.RATIO)
        require.within("mass of the can", can.mass, lightest, heaviest, "kg")

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
        """Return the moment of inertia of the liquid under a lid on its surface, I_F [kg m^2].

        It is that about a level axis through the centroid.
        """
        radius = self.can.radius
        xi = _roots()
        terms = np.tanh(xi * self.height / (2 * radius)) / (xi**3 * (xi**2 - 1))
        walls = 16 * radius**3 / self.height * float(np.sum(terms))
        return self.mass * (self.height**2 / 12 - 0.75 * radius**2 + walls)

    @property
    def moving_modes(self) -> int:
        """Return the number of modes that move in the model.

        It is `modes`, or 0 if the first mode, which is the most damped one, is over-damped. The
        layers on the walls then fill the liquid, and it moves with the can as a solid.
        """
        if self.modes == 0 or self.damping_ratios(1)[0] >= 1:
            return 0
        return self.modes

    def frequencies(self, count: int | None = None) -> np.ndarray:
        """Return the natural frequencies of the first `count` modes [rad/s], shape (count,).

        They are those without damping, in a can that is held. By default, here and below, the
        modes are those that move in the model, of which an over-damped liquid has none; with a
        `count` they are those of theory, whether they move or not.
        """
        return np.sqrt(self.gravity / self._pendulums(count).length)

    def slosh_masses(self, count: int | None = None) -> np.ndarray:
        """Return the masses of the pendulums [kg], shape (count,)."""
        return self._pendulums(count).mass

    def pivots(self, count: int | None = None) -> np.ndarray:
        """Return the heights of the pendulums' pivots above the bottom [m], shape (count,)."""
        return self.height / 2 + self._pendulums(count).pivot

    def damping_ratios(self, count: int | None = None) -> np.ndarray:
        """Return the damping of the modes divided by the critical one, shape (count,).

        Thin layers on wall and bottom take the power rho u^2 sqrt(nu omega/2)/2 per area where a
        mode has the velocity u along them. With H = h/R the ratio is

            sqrt(nu/(2 omega))/(2 R)
            ((xi^2 + 1)/(xi^2 - 1) + 2 xi (1 - H)/sinh(2 xi H)).
        """
        xi = self._xi(count)
        if self.damping_ratio is not None:
            return np.full(len(xi), self.damping_ratio)
        radius = self.can.radius
        depth = self.height / radius
        cosech = 2 * np.exp(-2 * xi * depth) / -np.expm1(-4 * xi * depth)  # of 2 xi depth
        walls = (xi**2 + 1) / (xi**2 - 1) + 2 * xi * (1 - depth) * cosech
        layer = np.sqrt(self.viscosity / (2 * self.frequencies(count)))
        return layer / (2 * radius) * walls

    def elevations(self, count: int | None = None) -> np.ndarray:
        """Return how high the surface rises at the wall in each mode, shape (count,).

        It is divided by R and by the sine of the pendulum's angle.
        """
        return mode_elevations(len(self._xi(count)))

    def reaction(self, omega: float | np.ndarray) -> Reaction:
        """Return force and moment of the liquid alone in a can shaken at `omega` [rad/s].

        There is no damping. X is sideways, Theta about the level axis across it. Weight is
        included: a tilted liquid's metacentric moment is -g sum(m_n L_n) = -rho g pi R^4/4 per
        angle.

        Raises:
          ParameterError: if a frequency is not between 1e-6 and 1e6.
        """
        for frequency in np.atleast_1d(np.asarray(omega, object)):
            require.within("omega", frequency, 1e-6, 1e6, "rad/s")
        square = np.asarray(omega, float)[..., None] ** 2
        pendulums = self._pendulums(SERIES)
        added_mass = pendulums.mass * square / (self.gravity / pendulums.length - square)
        arm = pendulums.bob + self.gravity / square
        force = np.sum(added_mass, axis=-1)[()]
        coupling = np.sum(added_mass * arm, axis=-1)[()]
        moment = np.sum(added_mass * arm**2, axis=-1)[()]
        return Reaction(self.mass + force, coupling, self.held_inertia + moment)

    def total_moments(self) -> np.ndarray:
        """Return the moments of mass of the whole model about the centroid, shape (3,).

        They are the zeroth [kg], the first [kg m] and the second one [kg m^2]. The model leaves out
        the modes after `moving_modes`. Motion is slow for them: their bobs hang straight down, and
        act on the can as masses at their pivots, at heights p_n instead of z_n. This adds
        sum(m_n L_n) to the first moment and sum(m_n (p_n^2 - z_n^2)) to the second. If no mode
        moves, the liquid is a solid cylinder.
        """
        if self.moving_modes == 0:
            second = self.mass * (self.can.radius**2 / 4 + self.height**2 / 12)
            return np.array([self.mass, 0.0, second])
        all_modes = self._pendulums(SERIES)
        fixed = _Pendulums(*(values[self.moving_modes :] for values in all_modes))
        first = np.sum(fixed.mass * fixed.length)
        second = self.held_inertia + np.sum(fixed.mass * (fixed.pivot**2 - fixed.bob**2))
        return np.array([self.mass, first, second])

    def _xi(self, count: int | None) -> np.ndarray:
        """Return the xi of the first modes, shape (count,)."""
        if count is None:
            return _roots()[: self.moving_modes]
        return _roots()[: _checked_count("count", count, SERIES)]

    def _pendulums(self, count: int | None) -> _Pendulums:
        """Return the pendulums of the first modes."""
        radius = self.can.radius
        height = self.height
        xi = self._xi(count)
        tanh = np.tanh(xi * height / radius)
        tanh_of_half = np.tanh(xi * height / (2 * radius))
        return _Pendulums(
            mass=self.mass * 2 * radius * tanh / (height * xi * (xi**2 - 1)),
            bob=height / 2 - 2 * radius / xi * tanh_of_half,
            length=radius / (xi * tanh),
        )


def mode_elevations(count: int) -> np.ndarray:
    """Return how high the surface rises at the wall in each of the first modes, shape (count,).

    It is 2/(xi^2 - 1), divided by R and by the sine of the pendulum's angle, at any fill.
    """
    return 2 / (_roots()[:count] ** 2 - 1)


def standing(
    liquid: str = "beer",
    fill: float = 0.5,
    can: Can | None = None,
    modes: int = 1,
    damping_ratio: float | None = None,
    gravity: float = GRAVITY,
) -> Standing:
    """Return a can that stands, by default `Can.sheet_metal()`, with a liquid in it that sloshes.

    `liquid` is a name that `mjbeer.liquid` knows; the others are fields of `Standing`. By default
    the damping follows from the viscosity, for a clean surface: foam or dust doubles it.

    A `LiquidWarning` says that the layers on the walls are not thin, so that the damping is only an
    order of magnitude, and whether it is so large that the liquid does not slosh.

    Raises:
      ParameterError: if a parameter is invalid.
    """
    name = require.choice("liquid", liquid, NAMES)
    can = Can.sheet_metal() if can is None else can
    density, viscosity = LIQUIDS[name]
    standing_can = Standing(can, fill, name, density, viscosity, modes, damping_ratio, gravity)
    if modes > 0 and damping_ratio is None:
        _warn_of_thick_layers(standing_can)
    return standing_can


def _warn_of_thick_layers(standing_can: Standing) -> None:
    """Warn, where `standing` is called, if the damping of thin layers is not the liquid's."""
    layer = math.sqrt(2 * standing_can.viscosity / standing_can.frequencies(1)[0])
    radii = layer / standing_can.can.radius
    if radii <= 0.1:
        return
    message = (
        f"{standing_can.name} is too thick for the damping of thin layers: "
        f"the layer on its wall is {radii:.2g} radii thick, and 0.1 is the limit"
    )
    if standing_can.moving_modes == 0:
        ratio = standing_can.damping_ratios(1)[0]
        message += ", and the liquid does not slosh: "
        message += f"its damping is {ratio:.3g} times the critical one"
    warn_of_liquid.get()(f"{message}; give a damping_ratio", LiquidWarning, stacklevel=3)


def _checked_count(name: str, value: object, most: int) -> int:
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or not 0 <= value <= most:
        got = require.format_value(value)
        raise ParameterError(f"{name} must be one of 0, 1, ... {most}, got {got}")
    return int(value)


@functools.cache
def _roots() -> np.ndarray:
    """Return the first zeros xi > 0 of J1', shape (SERIES,).

    Newton's method finds them from McMahon's expansion.
    """
    from scipy.special import jv  # its own zeros end at 1200

    beta = (np.arange(1, SERIES + 1) - 0.25) * math.pi
    xi = beta - 7 / (8 * beta)
    for _ in range(6):
        slope = jv(0, xi) - jv(1, xi) / xi  # J1'
        curvature = -slope / xi - (1 - 1 / xi**2) * jv(1, xi)  # J1'', by Bessel's equation
        xi = xi - slope / curvature
    return xi
