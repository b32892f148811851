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
    # A lager of 5 % alcohol without its gas. Zhang and Xu, Elements 4, 47 (2008): 1.44 times the viscosity of water.
    # Liger-Belair and Cilindre, ACS Omega 6, 9672 (2021): 2.42 mPa s at 6 degrees, 1.65 times, and 1010 kg/m^3.
    "beer": Properties(1010.0, 1.6e-6),
    # CRC Handbook of Chemistry and Physics: 84 mPa s; oils differ by some 10 %.
    "olive oil": Properties(911.0, 9.2e-5),
    # Segur and Oberstar, Ind. Eng. Chem. 43, 2117 (1951): 1.41 Pa s without water. By the fit of Cheng, Ind. Eng.
    # Chem. Res. 47, 3285 (2008), to such tables a hundredth of water takes a fifth of it.
    "glycerol": Properties(1261.0, 1.12e-3),
    # Of 18 % water, some 10 Pa s. By tables after Munro, J. Econ. Entomol. 36, 769 (1943), clover honey of 16 % has 19
    # Pa s, and a hundredth more of water does what 3.5 degrees do: it takes a third.
    "honey": Properties(1420.0, 7e-3),
}
"""Handbook values; where samples differ, by how much is said beside them."""
