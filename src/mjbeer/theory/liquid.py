"""A can with a real liquid in it: the scene whose load and damping follow from the liquid.

The liquid is one lump. A thin one swings like the slowest mode of its slosh, with the inertia of
`Load.liquid`; a thick one turns as a solid does, with that of ice. `swing_of` says which, and why.
In a can that rolls steadily the lump lies still. With the slip rate W of can and liquid, the can
drags it along by three laws:

- *Layers of rolling*, with a torque layers W^1.5: in a can that rolls on, a thin liquid has layers
  on the wall and the ends. They begin where the wall enters the liquid and thicken from there
  (Sakiadis, AIChE J. 7, 221, 1961; von Karman, Z. angew. Math. Mech. 1, 233, 1921).
- *Creep*, with a torque creep W: a thick liquid shears everywhere (Stokes).
- *Swinging*, with a torque swing W: in a can that only swings, wall and ends have the oscillating
  layers of Stokes. Under a liquid that sloshes they are weaker than under a lump, because most of
  its wall turns with it. Its damping is that of the mode, by `slosh.RollingModes.damping_ratios`.

`_laws` computes the factors layers, creep and swing. `_fit` replaces the laws with a polynomial in
W, as MuJoCo's damping is one:

1. The polynomial has the right torque at one slip rate, the rate of the fit. The right torque is
   the larger of two: the one of layers of rolling and the one of creep.
2. The rate of the fit is the slip rate of steady rolling; for a liquid that does not slosh it is at
   least the *swing rate*. At that rate layers of rolling and Stokes's layers have the same torque
   on a lump; a swing of about two radians slips as fast.
3. For layers of rolling, the polynomial follows W^1.5 in a decade of slip rates. If steady rolling
   is slower than the whole decade of a fit at the swing rate, the can mainly swings. The slower it
   then rolls, the more the linear law of swinging replaces the polynomial, up to all of it on level
   ground. So the damping changes continuously with the incline.

A swing in a can that rolls on is damped by this polynomial as well, and so more than the mode.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, NoEquilibriumError, ParameterError, warn_of_liquid
from mjbeer.theory import slosh
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.paper_scenes import remembers_call, sliding
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene
from mjbeer.theory.segment import segment

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
THICKEST_LAYER = 0.1
"""Largest sqrt(nu/omega)/a of a liquid that sloshes, omega being the frequency of its slosh.

Half full it is 0.006 for water, 0.05 for olive oil, 0.19 for glycerol and 0.46 for honey, whose
layers fill the can. At the limit a swing in a half-full can loses half of its amplitude in about
one period: there slosh dies."""
LEAST_SHARE = 0.5
"""Least share that the slowest mode of a liquid that sloshes has of the energy of a flat tilt.

Below, other modes are most of the motion. In a shallow puddle in a light can they swing about as
fast as ice, and the slowest mode at half of that."""
ONE_MODE = 0.8
"""Share of the slowest mode below which it is not the motion."""


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
    swing: "Swing"
    """How it swings."""
    damping: Damping

    def __str__(self) -> str:
        properties = f"{self.name}: {self.density:g} kg/m^3, {self.viscosity:.3g} m^2/s"
        moves = "swings as ice" if self.swing.as_ice else "sloshes"
        damped = f"damped by {self.law} at a slip rate of {self.slip_rate:.3g} rad/s"
        return f"{properties}, {moves}, {damped}"


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

    A thin liquid sloshes, as water, beer and olive oil do: its load is that of `Load.liquid`. It is
    that of `Load.segment`, with the inertia of ice, if the liquid is thick, as glycerol and honey
    are; if the fill is not between 0.01 and 0.99; if the incline is too steep to hold the liquid,
    which then is carried round; or if the slosh is mainly in other modes than the slowest.

    `name` is "water", "beer", "olive oil", "glycerol" or "honey", at 20 degrees Celsius; `density`
    [kg/m^3] and kinematic `viscosity` [m^2/s] replace its own. `incline` is in [rad], `fill` is
    h/2a of eq. (32), less than 1; `drag` [kg/m] is that of the air. `liquid_in` has the numbers
    that were used.

    A `LiquidWarning` says that the damping is only an order of magnitude: at the terminal speed a
    film on the wall can hold a third of the liquid, the centrifugal acceleration exceeds
    g cos(alpha), or the damping is for other rates. Another one says that the slowest mode of the
    slosh has less than 0.8 of the energy of a flat tilt, and so is not the motion.

    Raises:
      ParameterError: if a parameter is invalid, the can is full, or the layers would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    can = Can.massless() if can is None else can
    scene = Scene(can, used.swing.load, incline, "sliding", gravity, used.damping, drag)
    try:
        speed = scene.terminal_speed()
    except NoEquilibriumError:  # none on so steep an incline
        speed = 0.0
    spread = ""
    if centrifugal_ratio(scene, speed) > 1:
        spread = f"at its terminal speed of {speed:.2g} m/s"
    no_lump = lump_warning(name, scene, abs(speed) / scene.can.radius, spread)
    for warning in (no_lump, _modes_warning(name, used.swing)):
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
    swing = swing_of(free, properties)
    laws = _laws(free, properties, swing)
    steady_rate = _steady_slip_rate(free, laws)
    fitted = _fit(laws, steady_rate)
    if fitted.quadratic > 0:
        _require_laminar(free, properties, fitted.rate)
    coating_rate = _coating_rate(free, properties)
    return Liquid(
        name,
        properties.density,
        properties.viscosity,
        law=fitted.law,
        slip_rate=steady_rate,
        carried=_share_in_film(coating_rate, steady_rate),
        swing=swing,
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


class Swing(NamedTuple):
    """How a liquid swings in a can that rolls on level ground."""

    load: Load
    """The load that swings as it does."""
    frequency: float
    """Frequency of small swings without viscosity [rad/s]."""
    torque: float
    """Torque of a swing on the load, divided by its slip rate [N m s]."""
    as_ice: str
    """Why the load has the inertia of ice; empty if the liquid sloshes."""
    share: float | None
    """Share that the slowest mode has of the energy of a flat tilt that is let go.

    None if the load has the inertia of ice for another reason than this share."""


def swing_of(ice: Scene, properties: Properties) -> Swing:
    """Return how the liquid swings whose scene without damping, with a load of ice, is `ice`."""
    fill = require.fill(ice.load.fill)
    lowest, highest = slosh.FILLS
    if not lowest <= fill <= highest:
        return _swing_of_ice(ice, properties, f"its fill is not within {lowest:g} to {highest:g}")
    if abs(ice.downhill_weight) * ice.can.radius > ice.load.moment * ice.gravity:
        reason = "the incline is too steep to hold it, and it is carried round as a solid is"
        return _swing_of_ice(ice, properties, reason)
    modes = slosh.rolling(fill, ice.effective_mass / ice.load.mass)
    omega = float(modes.frequencies(ice.can.radius, ice.gravity)[0])
    layer = math.sqrt(properties.viscosity / omega) / ice.can.radius
    if layer > THICKEST_LAYER:
        reason = f"its layers are {layer:.2g} radii thick, and slosh has {THICKEST_LAYER:g} at most"
        return _swing_of_ice(ice, properties, reason)
    share = float(modes.energy_shares[0])
    if share < LEAST_SHARE:
        reason = f"the slowest mode of its slosh has only {100 * share:.0f} % of the energy"
        return _swing_of_ice(ice, properties, reason)._replace(share=share)
    return _swing_of_slosh(ice, properties, modes)


def _swing_of_ice(ice: Scene, properties: Properties, reason: str) -> Swing:
    """Return the swing of a liquid that turns as a solid does, damped by Stokes's layers."""
    omega = math.sqrt(ice.load.moment * ice.gravity / ice.oscillator.base)
    torque = _stokes_layers(ice, properties, omega)
    return Swing(ice.load, omega, torque, as_ice=reason, share=None)


def _swing_of_slosh(ice: Scene, properties: Properties, modes: slosh.RollingModes) -> Swing:
    """Return the swing of a liquid that sloshes, damped like the slowest of its modes.

    On level ground a swing of the load moves the axis by k = m b/M_e per radian, and so slips by
    1 - k/a per radian. The torque c W takes the energy J phi_dot^2/2 of the swing at the rate
    c (1 - k/a)^2 phi_dot^2. That is the damping ratio c (1 - k/a)^2/(2 J omega).
    """
    can = ice.can
    load = Load.liquid(can, require.fill(ice.load.fill), properties.density)
    omega = float(modes.frequencies(can.radius, ice.gravity)[0])
    ratios = modes.damping_ratios(can.radius, can.length, ice.gravity, properties.viscosity)
    J = load.axis_inertia - load.moment**2 / ice.effective_mass
    slip = 1 - modes.arm
    return Swing(
        load,
        omega,
        torque=2 * (ratios.layers + ratios.bulk) * omega * J / slip**2,
        as_ice="",
        share=float(modes.energy_shares[0]),
    )


def _stokes_layers(free: Scene, properties: Properties, omega: float) -> float:
    """Return the torque of oscillating layers on a lump, divided by its slip rate [N m s].

    It is rho sqrt(nu omega/2) (2 beta a^3 L + 2 S), as in `_laws`.
    """
    rho, nu = properties
    wetted = _wetted(free)
    return rho * math.sqrt(nu * omega / 2) * (wetted.wall + 2 * wetted.end)


def _modes_warning(name: str, swing: Swing) -> str | None:
    """Return why no load moves as a liquid does that sloshes, or None if one does."""
    if swing.share is None or swing.share >= ONE_MODE:
        return None
    inertia = "of ice" if swing.as_ice else "of that mode"
    return (
        f"{name} sloshes in several modes at once, and one load is not its motion: the slowest "
        f"mode has {100 * swing.share:.0f} % of the energy of a flat tilt that is let go, and the "
        f"load has the inertia {inertia}"
    )


class _Wetted(NamedTuple):
    """What a liquid wets of its can."""

    arc: float
    """Angle of the wall, 2 beta [rad]."""
    wall: float
    """Second moment of the wall's area about the axis, 2 beta a^3 L [m^4]."""
    end: float
    """Second moment of the area of an end about the axis, S [m^4]."""


def _wetted(free: Scene) -> _Wetted:
    """Return what the liquid wets of the can of a scene."""
    shape = segment(require.fill(free.load.fill))
    a = free.can.radius
    arc = 2 * shape.half_angle
    return _Wetted(
        arc,
        wall=arc * a**3 * free.can.length,
        end=a**4 * shape.area * (shape.inertia + shape.offset**2),
    )


class _Laws(NamedTuple):
    """The torques by which a can drags its liquid along at a slip rate W."""

    layers: float
    """That of thin layers in a can that rolls on, divided by W^1.5 [N m s^1.5]."""
    creep: float
    """That of creep, divided by W [N m s]."""
    stokes: float
    """That of Stokes's layers on a lump that swings, divided by W [N m s]."""
    swing: float
    """That of the liquid's own swing, divided by W [N m s]."""
    sloshes: bool
    """Whether the liquid sloshes."""


def _laws(free: Scene, properties: Properties, swing: Swing) -> _Laws:
    """Return the factors of the laws for the liquid of a scene without damping.

    The liquid wets an arc of the wall, 2 beta, and an area A of each end, whose second moment about
    the axis is S = (I_axis/m) A with the I_axis of ice. Then

        layers = rho sqrt(nu) (WALL a^3 sqrt(2 beta) L + ENDS S),
        creep  = (8/pi) rho nu a^2 L ln(2/_EDGE),
        stokes = rho sqrt(nu omega/2) (2 beta a^3 L + 2 S).

    The layers on the ends are those of discs that are wet all round, of which the wetted share
    counts. Creep is the wall shear 4 rho nu W/(pi sin(theta)) of Stokes flow in a half disc, summed
    up to the edges; for other fills it is an estimate. The swing has the frequency omega.
    """
    rho, nu = properties
    a = free.can.radius
    length = free.can.length
    wetted = _wetted(free)
    on_wall = WALL * a**3 * math.sqrt(wetted.arc) * length
    return _Laws(
        layers=rho * math.sqrt(nu) * (on_wall + ENDS * wetted.end),
        creep=8 / math.pi * rho * nu * a**2 * length * math.log(2 / _EDGE),
        stokes=_stokes_layers(free, properties, swing.frequency),
        swing=swing.torque,
        sloshes=not swing.as_ice,
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
    """The polynomial linear W + quadratic W^2, which is a torque."""

    rate: float
    """Slip rate of the fit [rad/s]."""
    linear: float
    """[N m s]"""
    quadratic: float
    """[N m s^2]"""
    bend: float
    """Share of the quadratic term in the torque of rolling, divided by `_QUADRATIC_SHARE`."""
    highest: float
    """Highest slip rate at which it is valid [rad/s]."""
    law: str
    """The law with the largest part."""


def _fit(laws: _Laws, steady_rate: float) -> _Fit:
    """Return the polynomial that stands for the laws, with the slip rate of steady rolling [rad/s].

    The head of this file has the rules. The swing rate solves layers W^1.5 = stokes W. It is 0 here
    if the liquid is so thick that creep is larger than swinging.
    """
    if laws.sloshes:
        return _fit_of_slosh(laws, steady_rate)
    swing_rate = 0.0
    if laws.stokes > laws.creep:
        swing_rate = (laws.stokes / laws.layers) ** 2
    rate = max(steady_rate, swing_rate)
    secant = max(laws.creep, laws.layers * math.sqrt(rate))
    rolling = _share_of_rolling(steady_rate, swing_rate)
    # The linear term must not be less than creep.
    quadratic_share = min(_QUADRATIC_SHARE * rolling, 1 - laws.creep / secant)
    return _Fit(
        rate,
        linear=(1 - quadratic_share) * secant,
        quadratic=quadratic_share * secant / rate if quadratic_share > 0 else 0.0,
        bend=quadratic_share / _QUADRATIC_SHARE,
        highest=DECADE[1] * rate,
        law=_name_of_law(laws, rolling, secant),
    )


def _fit_of_slosh(laws: _Laws, steady_rate: float) -> _Fit:
    """Return the polynomial of a liquid that sloshes: of rolling in part, else of its swing."""
    swing_rate = (laws.stokes / laws.layers) ** 2
    rolling = _share_of_rolling(steady_rate, swing_rate)
    secant = max(laws.creep, laws.layers * math.sqrt(steady_rate))
    quadratic_share = min(_QUADRATIC_SHARE, 1 - laws.creep / secant)
    quadratic = 0.0
    if quadratic_share > 0:
        quadratic = rolling * quadratic_share * secant / steady_rate
    return _Fit(
        rate=steady_rate,
        linear=rolling * (1 - quadratic_share) * secant + (1 - rolling) * laws.swing,
        quadratic=quadratic,
        bend=rolling * quadratic_share / _QUADRATIC_SHARE,
        highest=DECADE[1] * max(steady_rate, (1 - rolling) * swing_rate),
        law=_name_of_law(laws, rolling, secant),
    )


def _share_of_rolling(steady_rate: float, swing_rate: float) -> float:
    """Return how much a can rolls on: 1, and less where it mainly swings, down to 0."""
    if swing_rate == 0:
        return 1.0
    return min(1.0, steady_rate / (DECADE[0] * swing_rate))


def _name_of_law(laws: _Laws, rolling: float, secant: float) -> str:
    if rolling < 1:
        return "swing"
    return "thin layers" if secant > laws.creep else "creep"


def _damping(laws: _Laws, fitted: _Fit, coating_rate: float) -> Damping:
    """Return the damping of a liquid, with the slip rates at which it is valid.

    A polynomial that follows W^1.5 is valid in its decade. The straighter it is, the lower are the
    rates from which on it is valid, down to 0. Creep ends where layers of rolling have the same
    torque.
    """
    lowest = DECADE[0] * fitted.rate * fitted.bend
    highest = max(fitted.highest, (laws.creep / laws.layers) ** 2)
    return Damping(
        linear=fitted.linear,
        quadratic=fitted.quadratic,
        valid_rates=(lowest, highest),
        coating_rate=coating_rate,
    )


def _require_laminar(free: Scene, properties: Properties, slip_rate: float) -> None:
    """Check that a layer on the wall is not turbulent at its end, by (W a) (2 beta a)/nu."""
    reynolds = slip_rate * _wetted(free).arc * free.can.radius**2 / properties.viscosity
    if reynolds > _TURBULENT:
        raise ParameterError(
            f"the layer on the wall is turbulent (Reynolds number {reynolds:.2g}): the viscosity "
            f"is too small or the can too fast, got {properties.viscosity:.4g} m^2/s in {free!r}"
        )


def _coating_rate(free: Scene, properties: Properties) -> float:
    """Return the slip rate W [rad/s] at which a film on the wall can hold `_COATING_SHARE`.

    The share that it can hold is FILM_LOAD a sqrt(nu a W/g)/A, with the area A of the liquid's
    cross section.
    """
    a = free.can.radius
    largest_area = FILM_LOAD * a * math.sqrt(properties.viscosity * a / free.gravity)
    share_by_root = largest_area / (
        a**2 * segment(require.fill(free.load.fill)).area
    )  # divided by sqrt(W)
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
