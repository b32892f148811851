"""A can with a real liquid in it: the scene whose damping follows from viscosity and geometry.

The liquid is one lump that lies still in the rolling can. With the slip rate W of can and liquid,
the can drags it along by three laws:

- *Layers of rolling*, with a torque layers W^1.5: in a can that rolls on, a thin liquid has layers
  on the wall and the ends. They begin where the wall enters the liquid and thicken from there
  (Sakiadis, AIChE J. 7, 221, 1961; von Karman, Z. angew. Math. Mech. 1, 233, 1921).
- *Creep*, with a torque creep W: a thick liquid shears everywhere (Stokes).
- *Layers of swinging*, with a torque swing W: in a can that only swings, wall and ends have the
  oscillating layers of Stokes.

`_laws` computes the factors layers, creep and swing. `_fit` replaces the laws with a polynomial in
W, as MuJoCo's damping is one:

1. The polynomial has the right torque at one slip rate, the rate of the fit. The right torque is
   the larger of two: the one of layers of rolling and the one of creep.
2. The rate of the fit is the higher of two: the slip rate of steady rolling and the *swing rate*.
   At the swing rate both kinds of layers have the same torque; a swing of about two radians slips
   as fast.
3. For layers of rolling, the polynomial follows W^1.5 in a decade of slip rates. If steady rolling
   is slower than the whole decade of a fit at the swing rate, the can mainly swings. The slower it
   then rolls, the smaller is the quadratic term, down to the linear law of layers of swinging. So
   the damping changes continuously with incline and viscosity.

A real liquid sloshes as well: in a half-full can that is held, without viscosity, 1.26 times as
fast as the lump swings.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, NoEquilibriumError, ParameterError, warn_of_liquid
from mjbeer.theory.can import Can, Damping
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene, remembers_call, sliding
from mjbeer.theory.segment import Segment, segment

Name = Literal["water", "beer", "olive oil", "glycerol", "honey"]
NAMES: tuple[Name, ...] = get_args(Name)


class Properties(NamedTuple):
    """The properties of a liquid on which its flow depends."""

    density: float
    """rho [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity, nu [m^2/s]."""


LIQUIDS: dict[Name, Properties] = {
    # IAPWS (2008): 1.0016 mPa s.
    "water": Properties(998.2, 1.0034e-6),
    # A lager of 5 % alcohol without its gas. Zhang and Xu, Elements 4, 47 (2008): 1.44 times the
    # viscosity of water. Liger-Belair and Cilindre, ACS Omega 6, 9672 (2021): 2.42 mPa s at 6
    # degrees, 1.65 times that of water, and 1010 kg/m^3.
    "beer": Properties(1010.0, 1.6e-6),
    # CRC Handbook of Chemistry and Physics: 84 mPa s; oils differ by about 10 %.
    "olive oil": Properties(911.0, 9.2e-5),
    # Segur and Oberstar, Ind. Eng. Chem. 43, 2117 (1951): 1.41 Pa s without water; 1 % of water
    # makes it a fifth less (Cheng, Ind. Eng. Chem. Res. 47, 3285, 2008).
    "glycerol": Properties(1261.0, 1.12e-3),
    # With 18 % of water, about 10 Pa s: 19 Pa s with 16 %, and 1 % more makes it a third less
    # (Munro, J. Econ. Entomol. 36, 769, 1943).
    "honey": Properties(1420.0, 7e-3),
}
"""Handbook values at 20 degrees Celsius."""

WALL = 0.8875
"""Drag of Sakiadis's layer on a wall that moves at U, divided by rho U^1.5 sqrt(nu X) L.

X is the length of wall that the layer covers, and L its width.
"""
ENDS = 2 * 0.61592
"""Torque of von Karman's layers on two discs, divided by rho sqrt(nu) W^1.5 and by the second
moment of the discs' area."""
# The polynomial that follows W^1.5 in a decade is a multiple of x + x^2, where x goes from 10^-0.5
# to 10^0.5: it is W divided by the geometric mean of the decade's ends. Divided by x^1.5, x + x^2
# is the ratio sqrt(x) + 1/sqrt(x), which has its minimum, 2, in the middle, and its maximum, 2.34,
# at both ends. No other polynomial with non-negative coefficients has a ratio that varies less. The
# multiple is the one with which the polynomial is exact where the ratio is 2.17, the mean of 2 and
# 2.34. In all of the decade it is then within 7.85 % of W^1.5.
_MEAN_RATIO = (2 + (10**0.25 + 10**-0.25)) / 2
"""Mean of the minimum and the maximum of that ratio."""
_QUADRATIC_SHARE = (1 + math.sqrt(1 - 4 / _MEAN_RATIO**2)) / 2
"""Share q of the quadratic term in the torque of that polynomial, at the higher of the two rates
where it is exact.

There q = x^2/(x + x^2) = x/(1 + x), and q (1 - q) = x/(1 + x)^2 = 1/_MEAN_RATIO^2."""
DECADE = (0.139, 1.39)
"""The ends of the decade, divided by the slip rate where the polynomial is exact, that of the fit.

At that rate x = q/(1 - q) = 2.27, and 10^-0.5 and 10^0.5 are 0.139 and 1.39 times as much."""
_EDGE = 0.03
"""Length beside the edges, divided by a, in which the liquid slips along the wall.

It is a guess; with three times or a third of it the damping of creep changes by a quarter."""
FILM_LOAD = 4.4427
"""Largest volume of a film that a turning wall carries round, divided by a L sqrt(nu a W/g).

More liquid than that stays below as a pool (Moffatt, J. Mecanique 16, 651, 1977)."""
_COATING_SHARE = 1 / 3
"""Share of the liquid that such a film can hold at the `coating_rate`.

At higher slip rates, what is left below counts as no lump."""
_TURBULENT = 1e6
"""Reynolds number of a layer at its end from which on it may be turbulent on any wall."""


@dataclass(frozen=True)
class Liquid:
    """A liquid in a can, and the damping that follows."""

    name: str
    density: float
    """Density rho [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity nu [m^2/s]."""
    law: str
    """"thin layers", "creep" or "swing": the law with the largest part in the damping."""
    slip_rate: float
    """Slip rate of steady rolling by the laws themselves [rad/s]; 0 on level ground."""
    carried: float
    """Share of the liquid that the film on the wall can hold at that rate; 1 or more is all."""
    damping: Damping

    def __str__(self) -> str:
        properties = f"{self.name}: {self.density:g} kg/m^3, {self.viscosity:.3g} m^2/s"
        return f"{properties}, damped by {self.law} at a slip rate of {self.slip_rate:.3g} rad/s"


@remembers_call
def liquid(
    name: str = "water",
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float | None = None,
    viscosity: float | None = None,
    gravity: float = GRAVITY,
    drag: float = 0.0,
) -> Scene:
    """Return the scene of a can with a real liquid in it, whose damping follows from its viscosity.

    `name` is "water", "beer", "olive oil", "glycerol" or "honey", at 20 degrees Celsius; `density`
    [kg/m^3] and kinematic `viscosity` [m^2/s] replace its own. `incline` is in [rad], `fill` is
    h/2a of eq. (32), less than 1; `drag` [kg/m] is that of the air. `liquid_in` has the numbers
    that were used.

    A `LiquidWarning` says that the damping is only an order of magnitude: at the terminal speed a
    film on the wall can hold a third of the liquid, the centrifugal acceleration exceeds
    g cos(alpha), or the damping is for other rates.

    Raises:
      ParameterError: if a parameter is invalid, the can is full, or the layers would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    scene = sliding(incline, fill, can, used.density, gravity, used.damping, drag)
    try:
        speed = scene.terminal_speed()
    except NoEquilibriumError:  # none on so steep an incline
        speed = 0.0
    spread = ""
    if centrifugal_ratio(scene, speed) > 1:
        spread = f"at its terminal speed of {speed:.2g} m/s"
    warning = lump_warning(name, scene, abs(speed) / scene.can.radius, spread)
    if warning:
        warn_of_liquid.get()(warning, LiquidWarning, stacklevel=3)
    return scene


def liquid_in(
    name: str = "water",
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float | None = None,
    viscosity: float | None = None,
    gravity: float = GRAVITY,
) -> Liquid:
    """Return the liquid of the scene that `liquid` makes with the same arguments.

    Raises:
      ParameterError: as `liquid`.
    """
    properties = _properties(name, density, viscosity)
    free = sliding(incline, fill, can, properties.density, gravity)
    if free.load.offset == 0 or free.gravity == 0:
        raise ParameterError(
            "the damping of a liquid is known where it fills the can in part: fill must be less "
            f"than 1 and gravity more than 0, got fill = {fill!r} and "
            f"gravity = {free.gravity!r} m/s^2"
        )
    shape = segment(require.fill(fill))
    laws = _laws(free, shape, properties)
    steady_rate = _steady_slip_rate(free, laws)
    fitted = _fit(laws, steady_rate)
    if fitted.quadratic_share > 0:
        _require_laminar(free, shape, properties, fitted.rate)
    coating_rate = _coating_rate(free, shape, properties)
    return Liquid(
        name,
        properties.density,
        properties.viscosity,
        law=fitted.law,
        slip_rate=steady_rate,
        carried=_share_in_film(coating_rate, steady_rate),
        damping=replace(_damping(laws, fitted, coating_rate), liquid=name),
    )


def _properties(name: str, density: float | None, viscosity: float | None) -> Properties:
    """Return the properties of a liquid, or those that are given instead."""
    handbook = LIQUIDS[require.choice("liquid", name, NAMES)]
    if density is None:
        density = handbook.density
    if viscosity is None:
        viscosity = handbook.viscosity
    return Properties(
        require.positive("density", density, "kg/m^3"),
        # Liquid helium has a viscosity of 2e-8 m^2/s, and pitch of 2e5.
        require.within("viscosity", viscosity, 1e-9, 1e6, "m^2/s"),
    )


class _Laws(NamedTuple):
    """The torques by which a can drags its liquid along at a slip rate W."""

    layers: float
    """That of thin layers in a can that rolls on, divided by W^1.5 [N m s^1.5]."""
    creep: float
    """That of creep, divided by W [N m s]."""
    swing: float
    """That of layers in a can that swings, divided by W [N m s]."""


def _laws(free: Scene, shape: Segment, properties: Properties) -> _Laws:
    """Return the factors of the three laws for the liquid of a scene without damping.

    The liquid wets an arc of the wall, 2 beta, and an area of each end whose second moment about
    the axis is S = (I_axis/m) A. Then

        layers = rho sqrt(nu) (WALL a^3 sqrt(2 beta) L + ENDS S),
        creep  = (8/pi) rho nu a^2 L ln(2/_EDGE),
        swing  = rho sqrt(nu omega/2) (2 beta a^3 L + 2 S).

    The layers on the ends are those of discs that are wet all round, of which the wetted share
    counts. Creep is the wall shear 4 rho nu W/(pi sin(theta)) of Stokes flow in a half disc, summed
    up to the edges; for other fills it is an estimate. In `swing`, omega is the frequency of small
    swings on level ground.
    """
    rho, nu = properties
    a = free.can.radius
    length = free.can.length
    arc = 2 * shape.half_angle
    S = a**4 * shape.area * (shape.inertia + shape.offset**2)
    omega = math.sqrt(free.load.moment * free.gravity / free.oscillator.base)
    return _Laws(
        layers=rho * math.sqrt(nu) * (WALL * a**3 * math.sqrt(arc) * length + ENDS * S),
        creep=8 / math.pi * rho * nu * a**2 * length * math.log(2 / _EDGE),
        swing=rho * math.sqrt(nu * omega / 2) * (arc * a**3 * length + 2 * S),
    )


def _steady_slip_rate(free: Scene, laws: _Laws) -> float:
    """Return the slip rate of steady rolling [rad/s], at which the larger law has the torque.

    The torque is m_t g a sin(alpha), but at most m g b, which is all that the load can exert.
    """
    torque = min(abs(free.downhill_weight) * free.can.radius, free.load.moment * free.gravity)
    by_layers = (torque / laws.layers) ** (2 / 3)
    by_creep = torque / laws.creep
    return min(by_layers, by_creep)


class _Fit(NamedTuple):
    """The polynomial secant W (1 - quadratic_share + quadratic_share W/rate), which is a torque."""

    rate: float
    """Slip rate of the fit [rad/s]."""
    secant: float
    """Torque there divided by that slip rate [N m s]."""
    quadratic_share: float
    """Share of the quadratic term in that torque."""
    law: str
    """The law with the largest part."""


def _fit(laws: _Laws, steady_rate: float) -> _Fit:
    """Return the polynomial that stands for the laws, with the slip rate of steady rolling [rad/s].

    The head of this file has the rules. The swing rate solves layers W^1.5 = swing W. It is 0 here
    if the liquid is so thick that creep is larger than swinging.
    """
    swing_rate = 0.0
    if laws.swing > laws.creep:
        swing_rate = (laws.swing / laws.layers) ** 2
    rate = max(steady_rate, swing_rate)
    secant = max(laws.creep, laws.layers * math.sqrt(rate))
    rolling = 1.0  # falls to 0 where the can only swings
    if swing_rate > 0:
        rolling = min(1.0, steady_rate / (DECADE[0] * swing_rate))
    # The linear term must not be less than creep.
    most = 1 - laws.creep / secant
    quadratic_share = min(_QUADRATIC_SHARE * rolling, most)
    law = "creep"
    if rolling < 1:
        law = "swing"
    elif secant > laws.creep:
        law = "thin layers"
    return _Fit(rate, secant, quadratic_share, law)


def _damping(laws: _Laws, fitted: _Fit, coating_rate: float) -> Damping:
    """Return the damping of a liquid, with the slip rates at which it is valid.

    A polynomial that follows W^1.5 is valid in its decade. The straighter it is, the lower are the
    rates from which on it is valid, down to 0. Creep ends where layers of rolling have the same
    torque.
    """
    lowest = DECADE[0] * fitted.rate * fitted.quadratic_share / _QUADRATIC_SHARE
    highest = max(DECADE[1] * fitted.rate, (laws.creep / laws.layers) ** 2)
    quadratic = 0.0
    if fitted.quadratic_share > 0:
        quadratic = fitted.quadratic_share * fitted.secant / fitted.rate
    return Damping(
        linear=(1 - fitted.quadratic_share) * fitted.secant,
        quadratic=quadratic,
        valid_rates=(lowest, highest),
        coating_rate=coating_rate,
    )


def _require_laminar(free: Scene, shape: Segment, properties: Properties, slip_rate: float) -> None:
    """Check that a layer on the wall is not turbulent at its end, by (W a) (2 beta a)/nu."""
    arc = 2 * shape.half_angle
    reynolds = slip_rate * arc * free.can.radius**2 / properties.viscosity
    if reynolds > _TURBULENT:
        raise ParameterError(
            f"the layer on the wall is turbulent (Reynolds number {reynolds:.2g}): the viscosity "
            f"is too small or the can too fast, got {properties.viscosity:.4g} m^2/s in {free!r}"
        )


def _coating_rate(free: Scene, shape: Segment, properties: Properties) -> float:
    """Return the slip rate W [rad/s] at which a film on the wall can hold `_COATING_SHARE`.

    The share that it can hold is FILM_LOAD a sqrt(nu a W/g)/A, with the area A of the liquid's
    cross section.
    """
    a = free.can.radius
    largest_area = FILM_LOAD * a * math.sqrt(properties.viscosity * a / free.gravity)
    share_by_root = largest_area / (a**2 * shape.area)  # divided by sqrt(W)
    return (_COATING_SHARE / share_by_root) ** 2


def _share_in_film(coating_rate: float, slip_rate: float) -> float:
    """Return the share of the liquid that a film can hold at a slip rate [rad/s]; from 1 on, all.

    It grows as the square root of the slip rate, and is `_COATING_SHARE` at the `coating_rate`.
    """
    return _COATING_SHARE * math.sqrt(slip_rate / coating_rate)


def lump_warning(
    name: str,
    scene: Scene,
    slip_rate: float,
    spread: str,
    turns: float = math.inf,
) -> str | None:
    """Return why a liquid is no lump, in one sentence, or None if it is one.

    It slips by up to `slip_rate` [rad/s]. `spread` says where or when `centrifugal_ratio` is more
    than 1, and is empty if it never is. The can has made so many `turns`. In the first one the film
    is only on the wall that has come out of the liquid so far.
    """
    if scene.damping_law.valid_rates is None:
        return None
    lowest, highest = scene.damping_law.valid_rates
    reasons = []
    if spread:
        exceeds = "the wall's centrifugal acceleration is more than g cos(alpha)"
        reasons.append(f"{spread} {exceeds}, which spreads it round the can")
    in_film = _share_in_film(scene.damping_law.coating_rate, slip_rate) * min(1.0, turns)
    if in_film > _COATING_SHARE:
        share = f"{100 * in_film:.0f} %" if in_film < 1 else "all"
        film = f"at {slip_rate:.3g} rad/s the film on the wall can hold {share} of it"
        reasons.append(f"it coats the can: {film}")
    if not lowest * (1 - 1e-9) <= slip_rate <= highest:
        rates = f"{lowest:.3g} to {highest:.3g} rad/s between can and liquid"
        reasons.append(f"the damping is for {rates}, which slips by {slip_rate:.3g} rad/s")
    if not reasons:
        return None
    return f"{name} as one lump is an order of magnitude only: {'; '.join(reasons)}"


def centrifugal_ratio(scene: Scene, u_dot: np.ndarray | float) -> np.ndarray | float:
    """Return u_dot^2/(a g cos(alpha)) for a speed [m/s].

    It is the centrifugal acceleration at the wall, divided by the part of gravity into the incline.
    """
    return np.square(u_dot) / (scene.can.radius * scene.gravity * math.cos(scene.incline))
