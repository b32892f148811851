"""Densities and viscosities of liquids at 20 degrees Celsius."""

from typing import Literal, NamedTuple, get_args

Name = Literal["water", "beer", "olive oil", "glycerol", "honey"]
NAMES: tuple[Name, ...] = get_args(Name)


class Properties(NamedTuple):
    """What a liquid's flow depends on."""

    density: float
    """Density [kg/m^3]."""
    viscosity: float
    """Kinematic viscosity [m^2/s]."""


LIQUIDS: dict[Name, Properties] = {
    # IAPWS (2008): 1.0016 mPa s.
    "water": Properties(998.2, 1.0034e-6),
    # A lager of 5 % alcohol without its gas; beers differ by some 20 %.
    "beer": Properties(1010.0, 1.6e-6),
    # CRC Handbook of Chemistry and Physics: 84 mPa s; oils differ by some 10 %.
    "olive oil": Properties(911.0, 9.2e-5),
    # Segur and Oberstar, Ind. Eng. Chem. 43, 2117 (1951): 1.41 Pa s without water, of which 1 % takes a quarter.
    "glycerol": Properties(1261.0, 1.12e-3),
    # Of 17 % water, some 10 Pa s; honeys differ by a factor of two.
    "honey": Properties(1420.0, 7e-3),
}
"""Handbook values; where samples differ, by how much is said beside them."""
