"""A can with a real liquid in it: the scene that has its damping.

The liquid is one lump that lies still in the rolling can. Three things drag it along, at a slip rate W:

- on the wall and the ends of a can that rolls on, a thin liquid's layers, which enter the liquid at one edge and
  thicken to the other (Sakiadis, AIChE J. 7, 221, 1961; von Karman, Z. angew. Math. Mech. 1, 233, 1921):
  T = rho a^3 sqrt(nu) (0.8875 sqrt(2 beta) L + 1.2318 a I/(m a^2) A/a^2) W^1.5. The ends are as if each ring were wet
  all round, and count by their wetted share, I A/m being the second moment of the wetted area A;
- a thick liquid's creep: the wall shear 4 mu W/(pi sin(theta)) of Stokes flow in a half disc, which the edges, of a
  length of `_EDGE`, cut off: c = (8/pi) mu a^2 L ln(2/_EDGE). For other fills than a half it is an estimate;
- in a can that only swings, the oscillating layers of Stokes on wall and ends:
  c = rho sqrt(nu omega/2) (2 beta a^3 L + 2 I A/m), omega being the frequency of small swings on level ground.

One law follows, continuous in the incline and the viscosity, and a polynomial in W, as MuJoCo's damping is. It has the
larger of the first two torques at the slip rate of steady rolling, or, where a swing of some two radians slips faster,
the swing's torque at the rate at which both kinds of layers drag alike. Where steady rolling is slower than `DECADE` of
that, the swing's layers take over. A real liquid sloshes as well, 1.5 times faster than the lump swings.
"""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, NoEquilibriumError, ParameterError, warn_of_liquid
from mjbeer.theory.can import Can, Damping, segment
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene, remembers_call, sliding

Name = Literal["water", "beer", "olive oil", "glycerol", "honey"]
NAMES: tuple[Name, ...] = get_args(Name)


class Properties(NamedTuple):
    """The properties of a liquid on which its flow depends."""

    density: float  # [kg/m^3]
    viscosity: float  # kinematic [m^2/s]


LIQUIDS: dict[Name, Properties] = {
    # IAPWS (2008): 1.0016 mPa s.
    "water": Properties(998.2, 1.0034e-6),
    # A lager of 5 % alcohol without its gas. Zhang and Xu, Elements 4, 47 (2008): 1.44 times the viscosity of water.
    # Liger-Belair and Cilindre, ACS Omega 6, 9672 (2021): 2.42 mPa s at 6 degrees, 1.65 times, and 1010 kg/m^3.
    "beer": Properties(1010.0, 1.6e-6),
    # CRC Handbook of Chemistry and Physics: 84 mPa s; oils differ by some 10 %.
    "olive oil": Properties(911.0, 9.2e-5),
    # Segur and Oberstar, Ind. Eng. Chem. 43, 2117 (1951): 1.41 Pa s without water, of which a hundredth takes a fifth
    # (Cheng, Ind. Eng. Chem. Res. 47, 3285, 2008).
    "glycerol": Properties(1261.0, 1.12e-3),
    # Of 18 % water, some 10 Pa s: 19 with 16 %, a hundredth takes a third (Munro, J. Econ. Entomol. 36, 769, 1943).
    "honey": Properties(1420.0, 7e-3),
}
"""Handbook values at 20 degrees Celsius."""

WALL = 0.8875  # Sakiadis's drag on a wall that enters still liquid, over rho U^1.5 sqrt(nu X) L
ENDS = 2 * 0.61592  # von Karman's torque on two discs, over rho sqrt(nu) W^1.5 and the second moment of the area
DECADE = 0.139, 1.39
"""Slip rates, over that of the fit, between which the polynomial is within 7.85 % of W^1.5; at the slip rate of the fit
it is exact. No polynomial with non-negative coefficients is better over a decade."""
_CURVED = (1 + math.sqrt(1 - 16 / (2 + 10**0.25 + 10**-0.25) ** 2)) / 2
"""Share of the quadratic term in the torque at the slip rate of that fit. With x the slip rate over the decade's
geometric mean it is x + x^2 times a factor: over x^1.5 that is sqrt(x) + 1/sqrt(x), 2 at x = 1 and most at the ends."""
_EDGE = 0.03  # of a, where the liquid slips beside the edges: a third or three times of it changes c by a quarter
FILM_LOAD = 4.4427
"""Largest volume of a film that a turning wall carries round steadily, over a L sqrt(nu a W/g) (Moffatt, J. Mecanique
16, 651, 1977). More liquid than that stays below as a pool."""
_CARRIED = 1 / 3  # share of the liquid that such a film can hold, from which on the rest of it is no lump


@dataclass(frozen=True)
class Liquid:
    """A liquid in a can, and the damping that follows."""

    name: str
    density: float  # [kg/m^3]
    viscosity: float  # kinematic, nu [m^2/s]
    law: str  # "thin layers", "creep" or "swing": the law with the largest part in the damping
    slip: float  # slip rate of steady rolling by the laws themselves [rad/s]; 0 on level ground
    carried: float  # share of the liquid that the film on the wall can hold there; beyond 1 all of it can go round
    damping: Damping

    def __str__(self) -> str:
        properties = f"{self.name}: {self.density:g} kg/m^3, {self.viscosity:.3g} m^2/s"
        return f"{properties}, damped by {self.law} at a slip rate of {self.slip:.3g} rad/s"


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
    """Return the scene of a can with a real liquid in it, whose damping follows from viscosity and geometry.

    `name` is "water", "beer", "olive oil", "glycerol" or "honey", at 20 degrees Celsius; `density` [kg/m^3] and
    kinematic `viscosity` [m^2/s] replace its own. `incline` is in [rad], `fill` is h/2a of eq. (32), less than 1;
    `drag` [kg/m] is that of the air. `liquid_in` has the numbers that were used.

    A `LiquidWarning` says that the damping is an order of magnitude: at the terminal speed a film on the wall can
    hold a third of the liquid, the centrifugal acceleration exceeds g cos(alpha), or the damping is for other rates.

    Raises:
      ParameterError: if a parameter is not allowed, the can is full, or the layers would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    scene = sliding(incline, fill, can, used.density, gravity, used.damping, drag)
    try:
        speed = scene.terminal_speed()
    except NoEquilibriumError:  # none on so steep an incline
        speed = 0.0
    spread = f"at its terminal speed of {speed:.2g} m/s" if centrifugal_ratio(scene, speed) > 1 else ""
    if reason := lump_warning(name, scene, abs(speed) / scene.can.radius, spread):
        warn_of_liquid.get()(reason, LiquidWarning, stacklevel=3)
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
    """Return the liquid of the scene that `liquid` makes with the same arguments, with the same errors."""
    # Liquid helium has a viscosity of 2e-8, and pitch of 2e5.
    own = LIQUIDS[require.choice("liquid", name, NAMES)]
    density = own.density if density is None else require.positive("density", density, "kg/m^3")
    nu = own.viscosity if viscosity is None else require.within("viscosity", viscosity, 1e-9, 1e6, "m^2/s")
    free = sliding(incline, fill, can, density, gravity)
    load, a, length = free.load, free.can.radius, free.can.length
    if load.offset == 0 or free.gravity == 0:
        raise ParameterError(
            "the damping of a liquid is known where it fills the can in part: fill must be less than 1 and gravity "
            f"more than 0, got fill = {fill!r} and gravity = {free.gravity!r} m/s^2"
        )
    shape = segment(require.number("fill", fill))
    moment = shape.area * (shape.inertia + shape.offset**2)  # second moment of the wetted area of an end, over a^4
    arc = 2 * shape.half_angle
    layers = density * a**3 * math.sqrt(nu) * (WALL * math.sqrt(arc) * length + ENDS * moment * a)
    creep = 8 / math.pi * density * nu * a**2 * length * math.log(2 / _EDGE)
    omega = math.sqrt(load.moment * free.gravity / free.oscillator.base)
    swinging = density * math.sqrt(nu * omega / 2) * a**3 * (arc * length + 2 * moment * a)

    torque = min(abs(free.downhill_weight) * a, load.moment * free.gravity)  # the latter is all that the load can hold
    steady = min((torque / layers) ** (2 / 3), torque / creep)
    wide = (swinging / layers) ** 2 if swinging > creep else 0.0
    slip = max(steady, wide)
    drag = max(creep, layers * math.sqrt(slip))  # torque over slip rate there
    rolled = min(1.0, steady / (DECADE[0] * wide)) if wide > 0 else 1.0
    curved = min(_CURVED * rolled, 1 - creep / drag)  # the torque is nowhere less than that of creep
    if curved > 0 and (reynolds := slip * a * arc * a / nu) > 1e6:  # of the layer at its end, whatever the wall
        raise ParameterError(
            f"the layer on the wall is turbulent (Reynolds number {reynolds:.2g}): the viscosity is too small or the "
            f"can too fast, got {nu:.4g} m^2/s in {free!r}"
        )
    holds = DECADE[0] * slip * curved / _CURVED, max(DECADE[1] * slip, (creep / layers) ** 2)
    coats_at = (_CARRIED * shape.area * a / FILM_LOAD) ** 2 * free.gravity / (nu * a)
    damping = Damping((1 - curved) * drag, curved * drag / slip if curved > 0 else 0.0, holds=holds, coats_at=coats_at)
    law = "swing" if rolled < 1 else "thin layers" if drag > creep else "creep"
    carried = FILM_LOAD * math.sqrt(nu * a * steady / free.gravity) / (shape.area * a)
    return Liquid(name, density, nu, law, steady, carried, damping)


def lump_warning(name: str, scene: Scene, slip: float, spread: str, turns: float = math.inf) -> str | None:
    """Return why a liquid that slips by up to `slip` [rad/s] is no lump, in one sentence; None if it is one.

    The text `spread` says where or when `centrifugal_ratio` is more than 1, if anywhere. The can has turned by so many
    `turns`: a film grows with the wall that has come up.
    """
    if scene.damping_law.holds is None:
        return None
    reasons, (lowest, highest) = [], scene.damping_law.holds
    if spread:
        exceeds = "the wall's centrifugal acceleration is more than g cos(alpha)"
        reasons.append(f"{spread} {exceeds}, which spreads it round the can")
    carried = _CARRIED * math.sqrt(slip / scene.damping_law.coats_at) * min(1.0, turns)
    if carried > _CARRIED:
        share = f"{100 * carried:.0f} %" if carried < 1 else "all"
        reasons.append(f"it coats the can: at {slip:.3g} rad/s the film on the wall can hold {share} of it")
    if not lowest * (1 - 1e-9) <= slip <= highest:
        meant = f"{lowest:.3g} to {highest:.3g} rad/s between can and liquid"
        reasons.append(f"the damping is for {meant}, which slips by {slip:.3g} rad/s")
    return f"{name} as one lump is an order of magnitude only: {'; '.join(reasons)}" if reasons else None


def centrifugal_ratio(scene: Scene, u_dot: np.ndarray | float) -> np.ndarray | float:
    """Return the centrifugal acceleration at the wall of a can with a speed [m/s], u_dot^2/a, over g cos(alpha)."""
    return np.square(u_dot) / (scene.can.radius * scene.gravity * math.cos(scene.incline))
