"""The half cylinder, the can's sheet metal and the beer as a circular segment: equations (7)-(9) and (30)-(38).

Lengths are in can radii a, areas in a^2 and inertias in m a^2, unless a docstring gives an SI unit. beta [rad] is half
the angle that the beer subtends at the axis.
"""

from math import asin, cos, pi, sin


def eq_7() -> float:
    """Return b/a = 4/(3 pi) of a half cylinder."""
    return 4 / (3 * pi)


def eq_9() -> float:
    """Return I_cm/(m a^2) = 1/2 - (b/a)^2 of a half cylinder."""
    return 0.5 - eq_7() ** 2


def eq_30(radius: float, length: float, thickness: float, density: float) -> float:
    """Return m_can = 2 pi a t (l + a) rho [kg]."""
    return 2 * pi * radius * thickness * (length + radius) * density


def eq_31(radius: float, length: float, thickness: float, density: float) -> float:
    """Return I_can = pi a^3 t (2l + a) rho [kg m^2]."""
    return pi * radius**3 * thickness * (2 * length + radius) * density


def ratio_31(radius: float, length: float) -> float:
    """Return I_can/(m_can a^2) = (2l + a)/(2(l + a))."""
    return (2 * length + radius) / (2 * (length + radius))


def eq_32(beta: float) -> float:
    """Return h/a = 1 - cos(beta)."""
    return 1 - cos(beta)


def eq_33(beta: float) -> tuple[float, float]:
    """Return the area by the middle and by the last form of eq. (33)."""
    return pi / 2 - cos(beta) * sin(beta) - asin(cos(beta)), (2 * beta - sin(2 * beta)) / 2


def eq_34(beta: float, radius: float, length: float, density: float) -> float:
    """Return m = a^2 l rho (2 beta - sin(2 beta))/2 [kg]."""
    return radius**2 * length * density / 2 * (2 * beta - sin(2 * beta))


def eq_35(beta: float) -> tuple[float, float]:
    """Return b by the form of eq. (35) with the area A, and by the last form."""
    return 2 * sin(beta) ** 3 / (3 * eq_33(beta)[1]), 4 * sin(beta) ** 3 / (3 * (2 * beta - sin(2 * beta)))


def middle_36(beta: float, part: float = 4) -> float:
    """Return I_axis by the first form of the third line of eq. (36), with sin(2 beta) sin^2(beta)/`part`.

    The paper prints 8 for `part`; 4 is right.
    """
    bracket = 3 * beta / 4 - 3 * sin(2 * beta) / 8 + sin(2 * beta) * sin(beta) ** 2 / part
    return 2 / 3 * bracket / eq_33(beta)[1]


def integral_36(beta: float) -> float:
    """Return I_axis by the second line of eq. (36), with its integrals evaluated."""
    c, s = cos(beta), sin(beta)
    first = pi / 4 - c * s / 2 - asin(c) / 2
    second = pi / 8 + c * s**3 / 2 - c * s / 4 - asin(c) / 4
    return 2 / 3 * (first + second) / eq_33(beta)[1]


def eq_36(beta: float) -> float:
    """Return k = I_axis/(m a^2) by the last form of eq. (36)."""
    return 0.5 * (1 + 2 * sin(2 * beta) * sin(beta) ** 2 / (3 * (2 * beta - sin(2 * beta))))


def eq_37(beta: float) -> float:
    """Return k = I_cm/(m a^2) by eq. (37)."""
    twice = 2 * beta - sin(2 * beta)
    return 0.5 * (1 + 2 * sin(2 * beta) * sin(beta) ** 2 / (3 * twice) - 32 * sin(beta) ** 6 / (9 * twice**2))


def eq_38(load_mass: float, can_mass: float, offset: float) -> float:
    """Return the distance of the common centre of mass from the axis, d = m b/(m + m_can) [m]."""
    return load_mass / (load_mass + can_mass) * offset
