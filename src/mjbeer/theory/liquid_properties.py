"""The properties of the liquids that are known by name, and the part of a can that they wet."""

import math
from typing import Literal, NamedTuple, get_args

from mjbeer import require
from mjbeer.theory.scene import Scene
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


def properties_of(name: str, density: float | None, viscosity: float | None) -> Properties:
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


class Wetted(NamedTuple):
    """What a liquid wets of its can."""

    arc: float
    """Angle of the wall, 2 beta [rad]."""
    wall: float
    """Second moment of the wall's area about the axis, 2 beta a^3 L [m^4]."""
    end: float
    """Second moment of the area of an end about the axis, S [m^4]."""


def wetted_area(free: Scene) -> Wetted:
    """Return what the liquid wets of the can of a scene."""
    shape = segment(require.fill(free.load.fill))
    a = free.can.radius
    arc = 2 * shape.half_angle
    return Wetted(
        arc,
        wall=arc * a**3 * free.can.length,
        end=a**4 * shape.area * (shape.inertia + shape.offset**2),
    )


def stokes_layers(free: Scene, properties: Properties, omega: float) -> float:
    """Return the torque of oscillating layers on a lump, divided by its slip rate [N m s].

    It is rho sqrt(nu omega/2) (2 beta a^3 L + 2 S), as in `torque_laws`.
    """
    rho, nu = properties
    wetted = wetted_area(free)
    return rho * math.sqrt(nu * omega / 2) * (wetted.wall + 2 * wetted.end)
