"""The damping of a can by a real liquid, from its viscosity and the geometry, and the scene that it makes.

The liquid is one lump, as in the rest of the theory, that lies still in the rolling can. What drags it along is

- a thin liquid's layer on the wall, which enters it at one edge and thickens to the other (Sakiadis, AIChE J. 7, 221,
  1961), and the layers on both ends (von Karman, Z. angew. Math. Mech. 1, 233, 1921): with the slip rate W,
  T = rho a^3 sqrt(nu) (0.8875 sqrt(2 beta) L + 1.2318 a I/(m a^2) A/a^2) W^1.5. The ends are as if each ring were wet
  all round, and count by their wetted share, I A/m being the second moment of the wetted area A;
- a thick liquid's creep: the wall shear 4 mu W/(pi sin(theta)) of Stokes flow in a half disc, which the edges, of a
  length of `_EDGE`, cut off: c = (8/pi) mu a^2 L ln(2/_EDGE). For other fills than a half it is an estimate;
- on level ground, where the can only swings, the oscillating layer of Stokes on wall and ends:
  c = rho sqrt(nu omega/2) (2 beta a^3 L + 2 I A/m).

The larger of the first two torques counts. A real liquid sloshes as well, 1.5 times faster than the lump swings.
"""

import math
import warnings
from dataclasses import dataclass

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError
from mjbeer.theory.can import Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.liquids import LIQUIDS, NAMES
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene
from mjbeer.theory.scenes import sliding
from mjbeer.theory.segment import segment

WALL = 0.8875
"""Sakiadis's drag on a wall that enters still liquid, over rho U^1.5 sqrt(nu X) L."""
ENDS = 2 * 0.61592
"""Von Karman's torque on two discs, over rho sqrt(nu) W^1.5 and the second moment of the area."""
FIT_ERROR = 0.0785
"""Largest relative error of the fitted polynomial from W^1.5 between 0.139 and 1.39 times the slip rate of steady
rolling, where it has none. No polynomial with non-negative coefficients is better over a decade."""
_EDGE = 0.03
"""Length at the edges of the surface where the liquid slips or is carried along, over a: 1 mm in a 12-oz can. A third
or three times of it changes c by a quarter."""
_TURBULENT = 1e6
"""Reynolds number U X/nu of the layer at its end, beyond which it is turbulent whatever the wall."""
FILM_LOAD = 4.4427
"""Largest volume of a film that a turning wall carries round steadily, over a L sqrt(nu a W/g) (Moffatt, J. Mecanique
16, 651, 1977). More liquid than that stays below as a pool."""
_CARRIED = 1 / 3
"""Share of the liquid that such a film can hold, from which on the rest of it is no lump."""


@dataclass(frozen=True)
class Liquid:
    """A liquid in a can, and the damping that follows."""

    name: str
    density: float
    """Density [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity nu [m^2/s]."""
    law: str
    """"thin layers", "creep" or "swing": which of the laws gave the damping."""
    slip: float
    """Slip rate of the steady rolling for which it is right [rad/s]; 0 on level ground."""
    film: float
    """Thickness of the film that the wall carries round there, sqrt(nu a slip/g) [m]."""
    carried: float
    """Share of the liquid that this film can hold; if it is more than 1, all of the liquid can go round."""
    damping: Damping

    def __str__(self) -> str:
        """Return what was used, in one line."""
        return (
            f"{self.name}: {self.density:g} kg/m^3, {self.viscosity:.3g} m^2/s, damped by {self.law} at a slip rate of "
            f"{self.slip:.3g} rad/s, with a film of {1e3 * self.film:.2g} mm on the wall"
        )


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
    `drag` [kg/m] is that of the air. `liquid_in` tells what was used, and the module's docstring the laws.

    A thin liquid's torque goes with the slip rate to 1.5, which a polynomial fits to `FIT_ERROR`. A `LiquidWarning`
    says where the film on the wall can hold a third of the liquid: there the damping is an order of magnitude only.

    Raises:
      ParameterError: if a parameter is not allowed, the can is full, or the layers would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    scene = sliding(incline, fill, can, used.density, gravity, used.damping, drag)
    if used.carried > _CARRIED:
        share = f"{100 * used.carried:.0f} %" if used.carried < 1 else "all"
        warnings.warn(
            f"{used.name} coats the can: the wall carries round a film of {1e3 * used.film:.2g} mm, which can hold "
            f"{share} of the liquid. The damping of one lump is an order of magnitude only",
            LiquidWarning,
            stacklevel=2,
        )
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
    """Return what `liquid` uses for the same arguments: density, viscosity, law and damping.

    Raises:
      ParameterError: as `liquid`.
    """
    name = require.choice("liquid", name, NAMES)
    own = LIQUIDS[name]
    density = own.density if density is None else require.positive("density", density, "kg/m^3")
    nu = own.viscosity if viscosity is None else require.positive("viscosity", viscosity, "m^2/s")
    free = sliding(incline, fill, can, density, gravity)
    if free.load.offset == 0 or free.gravity == 0:
        raise ParameterError(
            "a liquid's damping is that of a can which it fills in part, under gravity: fill must be less than 1 and "
            f"gravity more than 0, got fill = {fill!r} and gravity = {gravity!r} m/s^2"
        )
    a, length, shape = free.can.radius, free.can.length, segment(fill)
    moment = shape.area * (shape.inertia + shape.offset**2)  # second moment of the wetted area of an end, over a^4
    arc = 2 * shape.half_angle
    if free.incline == 0:
        layer = density * math.sqrt(nu * free.frequency() / 2)
        swing = Damping(layer * a**3 * (arc * length + 2 * moment * a))
        return Liquid(name, density, nu, "swing", 0.0, 0.0, 0.0, swing)
    torque = free.mass * free.gravity * a * abs(math.sin(free.incline))
    torque = min(torque, free.load.mass * free.gravity * free.load.offset)  # all that the load can hold
    thin = density * a**3 * math.sqrt(nu) * (WALL * math.sqrt(arc) * length + ENDS * moment * a)
    thick = 8 / math.pi * density * nu * a**2 * length * math.log(2 / _EDGE)
    slip = (torque / thin) ** (2 / 3)
    creeps = thick * slip > torque
    if creeps:
        law, damping, slip = "creep", Damping(thick), torque / thick
    else:
        law, damping = "thin layers", _fitted(thin, slip)
        if (reynolds := slip * a * arc * a / nu) > _TURBULENT:
            raise ParameterError(
                f"the layer on the wall is turbulent (Reynolds number {reynolds:.2g}), which no law "
                f"here knows: the viscosity is too small or the can too fast, got {nu:.4g} m^2/s, "
                f"incline = {incline!r} rad, fill = {fill!r}, gravity = {gravity!r} m/s^2, "
                f"density = {density!r} kg/m^3 in {free.can!r}"
            )
    film = math.sqrt(nu * a * slip / free.gravity)
    return Liquid(name, density, nu, law, slip, film, FILM_LOAD * film / (shape.area * a), damping)


def _fitted(factor: float, slip: float) -> Damping:
    """Return the polynomial nearest to `factor` W^1.5 in a decade, exact at the `slip` rate [rad/s] of steady rolling.

    With x = W/W0 it is x + x^2 times a factor: over x^1.5 that is sqrt(x) + 1/sqrt(x), 2 at x = 1 and most at the ends.
    """
    most = 10**0.25 + 10**-0.25
    share = 2 / (2 + most)
    root = (1 / share + math.sqrt(1 / share**2 - 4)) / 2
    middle = slip / root**2
    return Damping(share * factor * math.sqrt(middle), share * factor / math.sqrt(middle))
