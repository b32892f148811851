"""The damping of a liquid in a can: three laws of drag, and the polynomial that stands for them.

In a can that rolls steadily the liquid lies still, as a lump. With the slip rate W of can and
liquid, the can drags it along by three laws:

- *Layers of rolling*, with a torque layers W^1.5: in a can that rolls on, a thin liquid has layers
  on the wall and the ends. They begin where the wall enters the liquid and thicken from there
  (Sakiadis, AIChE J. 7, 221, 1961; von Karman, Z. angew. Math. Mech. 1, 233, 1921).
- *Creep*, with a torque creep W: a thick liquid shears everywhere (Stokes).
- *Swinging*, with a torque swing W: in a can that only swings, wall and ends have the oscillating
  layers of Stokes. Under a liquid that sloshes they are weaker than under a lump, because most of
  its wall turns with it: `liquid_swing` has them.

`torque_laws` computes the factors layers, creep and swing. `fit` replaces the laws with a
polynomial in W, as MuJoCo's damping is one:

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
from typing import NamedTuple

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import Damping
from mjbeer.theory.liquid_properties import Properties, stokes_layers, wetted_area
from mjbeer.theory.liquid_swing import Swing
from mjbeer.theory.scene import Scene
from mjbeer.theory.segment import segment

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
COATING_SHARE = 1 / 3
"""Share of the liquid that such a film can hold at the `coating_rate`.

At higher slip rates, what is left below counts as no lump."""
_TURBULENT = 1e6
"""Reynolds number of a layer at its end from which on it may be turbulent on any wall."""


class Laws(NamedTuple):
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


def torque_laws(free: Scene, properties: Properties, swing: Swing) -> Laws:
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
    wetted = wetted_area(free)
    on_wall = WALL * a**3 * math.sqrt(wetted.arc) * length
    return Laws(
        layers=rho * math.sqrt(nu) * (on_wall + ENDS * wetted.end),
        creep=8 / math.pi * rho * nu * a**2 * length * math.log(2 / _EDGE),
        stokes=stokes_layers(free, properties, swing.frequency),
        swing=swing.torque,
        sloshes=not swing.as_ice,
    )


def steady_slip_rate(free: Scene, laws: Laws) -> float:
    """Return the slip rate of steady rolling [rad/s], at which the larger law has the torque.

    The torque is m_t g a sin(alpha), but at most m g b, which is all that the load can exert.
    """
    torque = min(abs(free.downhill_weight) * free.can.radius, free.load.moment * free.gravity)
    by_layers = (torque / laws.layers) ** (2 / 3)
    by_creep = torque / laws.creep
    return min(by_layers, by_creep)


class Fit(NamedTuple):
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


def fit(laws: Laws, steady_rate: float) -> Fit:
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
    return Fit(
        rate,
        linear=(1 - quadratic_share) * secant,
        quadratic=quadratic_share * secant / rate if quadratic_share > 0 else 0.0,
        bend=quadratic_share / _QUADRATIC_SHARE,
        highest=DECADE[1] * rate,
        law=_name_of_law(laws, rolling, secant),
    )


def _fit_of_slosh(laws: Laws, steady_rate: float) -> Fit:
    """Return the polynomial of a liquid that sloshes: of rolling in part, else of its swing."""
    swing_rate = (laws.stokes / laws.layers) ** 2
    rolling = _share_of_rolling(steady_rate, swing_rate)
    secant = max(laws.creep, laws.layers * math.sqrt(steady_rate))
    quadratic_share = min(_QUADRATIC_SHARE, 1 - laws.creep / secant)
    quadratic = 0.0
    if quadratic_share > 0:
        quadratic = rolling * quadratic_share * secant / steady_rate
    return Fit(
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


def _name_of_law(laws: Laws, rolling: float, secant: float) -> str:
    if rolling < 1:
        return "swinging"
    return "thin layers" if secant > laws.creep else "creep"


def fitted_damping(laws: Laws, fitted: Fit, coating_rate: float) -> Damping:
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


def require_laminar(free: Scene, properties: Properties, slip_rate: float) -> None:
    """Check that a layer on the wall is not turbulent at its end, by (W a) (2 beta a)/nu."""
    reynolds = slip_rate * wetted_area(free).arc * free.can.radius**2 / properties.viscosity
    if reynolds > _TURBULENT:
        raise ParameterError(
            "the layer on the wall would be turbulent, with a Reynolds number of "
            f"{reynolds:.2g} where {_TURBULENT:.0e} is the limit: the viscosity is too small, or "
            f"the can too fast, got {properties.viscosity:.4g} m^2/s and {slip_rate:.4g} rad/s"
        )


def coating_rate(free: Scene, properties: Properties) -> float:
    """Return the slip rate W [rad/s] at which a film on the wall can hold `COATING_SHARE`.

    The share that it can hold is FILM_LOAD a sqrt(nu a W/g)/A, with the area A of the liquid's
    cross section.
    """
    a = free.can.radius
    area = a**2 * segment(require.fill(free.load.fill)).area
    film_area = COATING_SHARE * area
    return (film_area / (FILM_LOAD * a)) ** 2 * free.gravity / (properties.viscosity * a)


def share_in_film(coating_rate: float, slip_rate: float) -> float:
    """Return the share of the liquid that a film can hold at a slip rate [rad/s]; from 1 on, all.

    It grows as the square root of the slip rate, and is `COATING_SHARE` at the `coating_rate`.
    """
    return COATING_SHARE * math.sqrt(slip_rate / coating_rate)
