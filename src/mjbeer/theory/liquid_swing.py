"""How a liquid swings in a lying can: as the slowest mode of its slosh, or as ice.

A thin liquid has the inertia of `Load.liquid` and is damped as its mode is, by
`slosh.RollingModes.damping_ratios`; a thick one turns as a solid does, with the inertia of ice,
and is damped by the oscillating layers of Stokes. `swing_of` says which, and why.
"""

import math
from typing import NamedTuple

from mjbeer import require
from mjbeer.theory import slosh
from mjbeer.theory.can import Load
from mjbeer.theory.liquid_properties import Properties, stokes_layers
from mjbeer.theory.scene import Scene

THICKEST_LAYER = 0.1
"""Largest sqrt(nu/omega)/a of a liquid that sloshes, omega being the frequency of its slosh.

Half full it is 0.006 for water, 0.05 for olive oil, 0.19 for glycerol and 0.46 for honey, whose
layers fill the can. At the limit a swing in a half-full can loses half of its amplitude in about
one period: there slosh dies."""
ONE_MODE = 0.8
"""Share of the energy of a flat tilt below which the slowest mode is not the motion."""


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
    """Return how the liquid swings whose scene without damping, with a load of ice, is `ice`.

    A shallow puddle in a light can swings mainly in faster modes than the slowest one, about as
    fast as ice. The load is that of ice where ice swings faster than the slowest mode. Over the
    first swings it is then the better one of the two, and in fuller cans the other is. At the fill
    in between both have the same inertia.
    """
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
    load = Load.liquid(ice.can, fill, properties.density)
    if load.inertia > ice.load.inertia:
        share = float(modes.energy_shares[0])
        reason = (
            "ice swings faster than the slowest mode of its slosh, which has only "
            f"{100 * share:.0f} % of the energy"
        )
        return _swing_of_ice(ice, properties, reason)._replace(share=share)
    return _swing_of_slosh(ice, properties, modes, load)


def _swing_of_ice(ice: Scene, properties: Properties, reason: str) -> Swing:
    """Return the swing of a liquid that turns as a solid does, damped by Stokes's layers."""
    omega = math.sqrt(ice.load.moment * ice.gravity / ice.oscillator.base)
    torque = stokes_layers(ice, properties, omega)
    return Swing(ice.load, omega, torque, as_ice=reason, share=None)


def _swing_of_slosh(
    ice: Scene,
    properties: Properties,
    modes: slosh.RollingModes,
    load: Load,
) -> Swing:
    """Return the swing of a liquid that sloshes, damped like the slowest of its modes.

    On level ground a swing of the load moves the axis by k = m b/M_e per radian, and so slips by
    1 - k/a per radian. The torque c W takes the energy J phi_dot^2/2 of the swing at the rate
    c (1 - k/a)^2 phi_dot^2. That is the damping ratio c (1 - k/a)^2/(2 J omega).
    """
    can = ice.can
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


def modes_warning(name: str, swing: Swing) -> str | None:
    """Return why no load moves as a liquid does that sloshes, or None if one does."""
    if swing.share is None or swing.share >= ONE_MODE:
        return None
    inertia = "of ice" if swing.as_ice else "of that mode"
    return (
        f"{name} sloshes in several modes at once, and one load is not its motion: the slowest "
        f"mode has {100 * swing.share:.0f} % of the energy of a flat tilt that is let go, and the "
        f"load has the inertia {inertia}"
    )
