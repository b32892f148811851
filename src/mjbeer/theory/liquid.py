"""A can with a real liquid in it: the scene whose load and damping follow from the liquid.

The liquid is one lump. `liquid_swing` has how it swings, as slosh or as ice, and `liquid_damping`
how the can drags it along.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import LiquidWarning, NoEquilibriumError, ParameterError, warn_of_liquid
from mjbeer.theory.can import Can, Damping
from mjbeer.theory.liquid_damping import (
    COATING_SHARE,
    coating_rate,
    fit,
    fitted_damping,
    require_laminar,
    share_in_film,
    steady_slip_rate,
    torque_laws,
)
from mjbeer.theory.liquid_properties import properties_of
from mjbeer.theory.liquid_swing import Swing, modes_warning, swing_of
from mjbeer.theory.paper_scenes import remembers_call, sliding
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene


@dataclass(frozen=True)
class Liquid:
    """A liquid in a can, and the damping that follows."""

    name: str
    density: float
    """Density rho [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity nu [m^2/s]."""
    law: str
    """"thin layers", "creep" or "swinging": the law with the largest part in the damping."""
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
        steady = f" at a slip rate of {self.slip_rate:.3g} rad/s" if self.slip_rate > 0 else ""
        return f"{properties}, {moves}, damped by {self.law}{steady}"


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
    which then is carried round; or if ice swings faster than the slowest mode, which in a puddle in
    a light can has next to none of the energy.

    `name` is "water", "beer", "olive oil", "glycerol" or "honey", at 20 degrees Celsius; `density`
    [kg/m^3] and kinematic `viscosity` [m^2/s] replace its own. `incline` is in [rad], `fill` is
    h/2a of eq. (32), less than 1; `drag` [kg/m] is that of the air. `liquid_in` has the numbers
    that were used.

    A `LiquidWarning` says that the damping is only an order of magnitude: at the terminal speed a
    film on the wall can hold a third of the liquid, the centrifugal acceleration exceeds
    g cos(alpha), or the damping is for other rates; or the incline is so steep that there is no
    terminal speed. Another one says that the slowest mode of the slosh has less than 0.8 of the
    energy of a flat tilt, and so is not the motion.

    Raises:
      ParameterError: if a parameter is invalid, the can is full, there is no gravity, or the layers
        would be turbulent.
    """
    used = liquid_in(name, incline, fill, can, density, viscosity, gravity)
    can = Can.massless() if can is None else can
    scene = Scene(can, used.swing.load, incline, "sliding", gravity, used.damping, drag)
    for warning in (_terminal_warning(name, scene), modes_warning(name, used.swing)):
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
    properties = properties_of(name, density, viscosity)
    free = sliding(incline, fill, can, properties.density, gravity)
    if free.load.offset == 0:
        allowed = "a full can has no free surface: fill must be less than 1"
        raise ParameterError(f"{allowed}, got {fill!r}")
    if free.gravity == 0:
        needed = "without gravity a liquid does not slosh, and nothing holds it at the bottom"
        raise ParameterError(f"{needed}: gravity must be more than 0 [m/s^2], got {gravity!r}")
    swing = swing_of(free, properties)
    laws = torque_laws(free, properties, swing)
    steady_rate = steady_slip_rate(free, laws)
    fitted = fit(laws, steady_rate)
    if fitted.quadratic > 0:
        require_laminar(free, properties, fitted.rate)
    coated_from = coating_rate(free, properties)
    return Liquid(
        name,
        properties.density,
        properties.viscosity,
        law=fitted.law,
        slip_rate=steady_rate,
        carried=share_in_film(coated_from, steady_rate),
        swing=swing,
        damping=replace(fitted_damping(laws, fitted, coated_from), liquid=name),
    )


def _terminal_warning(name: str, scene: Scene) -> str | None:
    """Return why a liquid is no lump at its terminal speed, or None if it is one."""
    try:
        speed = scene.terminal_speed()
    except NoEquilibriumError:
        return _no_lump(name, ["the incline is too steep to hold it, and the can carries it round"])
    spread = ""
    if centrifugal_ratio(scene, speed) > 1:
        spread = f"at its terminal speed of {speed:.2g} m/s"
    return lump_warning(name, scene, abs(speed) / scene.can.radius, spread)


def lump_warning(
    name: str,
    scene: Scene,
    slip_rate: float,
    spread: str,
    turns: float = math.inf,
) -> str | None:
    """Return why a liquid is no lump, in one sentence, or None if it is one.

    It slips by up to `slip_rate` [rad/s]. `spread` says where or when `centrifugal_ratio` is more
    than 1, and is empty if it never is. The can has made so many `turns`.
    """
    if scene.damping_law.valid_rates is None:
        return None
    lowest, highest = scene.damping_law.valid_rates
    reasons = []
    if spread:
        exceeds = "the wall's centrifugal acceleration is more than g cos(alpha)"
        reasons.append(f"{spread} {exceeds}, which spreads it round the can")
    in_film = film_share(scene, slip_rate, turns)
    if in_film > COATING_SHARE:
        share = f"{100 * in_film:.0f} %" if in_film < 1 else "all"
        film = f"at {slip_rate:.3g} rad/s the film on the wall can hold {share} of it"
        reasons.append(f"it coats the can: {film}")
    if not lowest * (1 - 1e-9) <= slip_rate <= highest:
        rates = f"{lowest:.3g} to {highest:.3g} rad/s between can and liquid"
        reasons.append(f"the damping is for {rates}, which slips by {slip_rate:.3g} rad/s")
    return _no_lump(name, reasons) if reasons else None


def _no_lump(name: str, reasons: list[str]) -> str:
    return f"{name} as one lump is an order of magnitude only: {'; '.join(reasons)}"


def film_share(scene: Scene, slip_rate: float, turns: float) -> float:
    """Return the share of a liquid that the film on the wall can hold; from 1 on, all.

    Can and liquid slip by up to `slip_rate` [rad/s], and the can has made so many `turns`. In the
    first one the film is only on the wall that has come out of the liquid so far.
    """
    return share_in_film(scene.damping_law.coating_rate, slip_rate) * min(1.0, turns)


def centrifugal_ratio(scene: Scene, u_dot: np.ndarray | float) -> np.ndarray | float:
    """Return u_dot^2/(a g cos(alpha)) for a speed [m/s].

    It is the centrifugal acceleration at the wall, divided by the part of gravity into the incline.
    """
    return np.square(u_dot) / (scene.can.radius * scene.gravity * math.cos(scene.incline))
