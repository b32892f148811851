"""Section 2 of the paper: beer that slides in a massless can. Equations (1)-(29), printed and right.

The function of an equation returns its terms, all on one side, so that they sum to zero where the equation holds. The
function of a quantity such as an energy returns the terms that add up to it. A name that starts with `printed_` is a
misprint.
"""

import math
from typing import Any

from mjbeer.paper.letters import Letters, Quantities, Terms
from mjbeer.theory.scene import Scene


def eq_1(q: Quantities, time: Any) -> Terms:
    """Return the terms of s = g sin(alpha) t^2 / 2."""
    return q.s, -q.g * q.sin_alpha * time**2 / 2


def eq_2(q: Quantities, torque: Any) -> Terms:
    """Return the terms of tau_C = I_C omega_dot + I_C_dot omega / 2, for a `torque` tau_C [N m] and I_C of eq. (3)."""
    inertia = q.inertia + q.m * q.b**2 * q.sin_phi**2
    change = 2 * q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot
    return inertia * q.phi_ddot, change * q.phi_dot / 2, -torque


def eq_3(q: Quantities) -> Terms:
    """Return the terms of I_C = I_cm + m b^2 sin^2(phi)."""
    return q.inertia, q.m * q.b**2 * q.sin_phi**2


def small_3(q: Quantities) -> Terms:
    """Return the term of I_C = I_cm [kg m^2], for small phi."""
    return (q.inertia + 0 * q.phi,)


def eq_4(q: Quantities) -> Terms:
    """Return the term of tau_C = -m g cos(alpha) b sin(phi)."""
    return (-q.m * q.g * q.cos_alpha * q.b * q.sin_phi,)


def linear_4(q: Quantities) -> Terms:
    """Return the term of tau_C = -m b g cos(alpha) phi, for small phi; corrected."""
    return (-q.m * q.b * q.g * q.cos_alpha * q.phi,)


def printed_4(q: Quantities) -> Terms:
    """Return the term of tau_C = +m b g cos(alpha) phi [N m], as printed."""
    return (q.m * q.b * q.g * q.cos_alpha * q.phi,)


def eq_5(q: Quantities) -> Terms:
    """Return the terms of I_cm phi_ddot = -m b g cos(alpha) phi, for small phi; this is eq. (23) as well."""
    return q.inertia * q.phi_ddot, q.m * q.b * q.g * q.cos_alpha * q.phi


def eq_6(c: Letters) -> Any:
    """Return omega^2 = m b g cos(alpha) / I_cm [1/s^2]."""
    return c.m * c.b * c.g * c.cos_alpha / c.inertia


def eq_10(c: Letters, pi: Any) -> Any:
    """Return omega^2 = 24 pi g cos(alpha) / ((9 pi^2 - 32) a) [1/s^2] of a half can; corrected."""
    return printed_10(c, pi) / c.a


def printed_10(c: Letters, pi: Any) -> Any:
    """Return 24 pi g cos(alpha) / (9 pi^2 - 32) [m/s^2]: the misprint lacks the radius."""
    return 24 * pi * c.g * c.cos_alpha / (9 * pi**2 - 32)


def frequency_10(scene: Scene) -> float:
    """Return omega [rad/s] by eq. (10), corrected."""
    return math.sqrt(eq_10(Letters.of(scene), math.pi))


def eq_24(c: Letters) -> Any:
    """Return omega^2 = 2 b g cos(alpha) / (a^2 - 2 b^2) [1/s^2] of a half can; also the first form of eq. (10)."""
    return 2 * c.b * c.g * c.cos_alpha / (c.a**2 - 2 * c.b**2)


def kinetic_11(q: Quantities) -> Terms:
    """Return the terms of T [J]; they are those of the beer in any can, the second line of eq. (44)."""
    return q.m * q.s_dot**2 / 2, q.m * q.b**2 * q.sin_phi**2 * q.phi_dot**2 / 2, q.inertia * q.phi_dot**2 / 2


def eq_12(q: Quantities) -> Terms:
    """Return the terms of u = s + b sin(phi)."""
    return q.u, -q.s, -q.b * q.sin_phi


def height_13(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of the height z [m] in u and theta, and those in s and phi."""
    return (-q.u * q.sin_alpha, -q.b * q.cos_theta), (-q.s * q.sin_alpha, -q.b * q.cos_alpha * q.cos_phi)


def potential_14(q: Quantities) -> Terms:
    """Return the terms of V = m g z = -m g (s sin(alpha) + b cos(alpha) cos(phi)) [J]; this is eq. (45) as well."""
    return tuple(q.m * q.g * term for term in height_13(q)[1])


def printed_14(q: Quantities) -> Terms:
    """Return the terms of V = -m g z [J], as printed."""
    return tuple(-term for term in potential_14(q))


def eq_15(q: Quantities) -> Terms:
    """Return the terms of s_ddot = g sin(alpha)."""
    return q.s_ddot, -q.g * q.sin_alpha


def eq_16(q: Quantities) -> Terms:
    """Return the terms of eq. (16).

    (m b^2 sin^2 phi + I_cm) phi_ddot + m b^2 sin phi cos phi phi_dot^2 = -m b g cos(alpha) sin phi.
    """
    return (
        q.m * q.b**2 * q.sin_phi**2 * q.phi_ddot,
        q.inertia * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.m * q.b * q.g * q.cos_alpha * q.sin_phi,
    )


def kinetic_17(q: Quantities) -> Terms:
    """Return the terms of T in eqs. (17) and (20) [J] for a half can, whose I_axis is m a^2/2."""
    half = q.m / 2
    return half * q.u_dot**2, -q.m * q.b * q.cos_phi * q.u_dot * q.phi_dot, half * q.a**2 / 2 * q.phi_dot**2


def potential_17(q: Quantities) -> Terms:
    """Return the terms of V in eqs. (17) and (20) [J]; this is the first form of eq. (45) as well."""
    return -q.m * q.g * q.u * q.sin_alpha, -q.m * q.g * q.b * q.cos_theta


def eq_18(q: Quantities) -> Terms:
    """Return the terms of u_ddot - b cos phi phi_ddot + b sin phi phi_dot^2 = g sin(alpha).

    With phi = theta - alpha this is eq. (21) as well.
    """
    return (
        q.u_ddot,
        -q.b * q.cos_phi * q.phi_ddot,
        q.b * q.sin_phi * q.phi_dot**2,
        -q.g * q.sin_alpha,
    )


def eq_19(q: Quantities) -> Terms:
    """Return the terms of a^2/2 phi_ddot - b cos phi u_ddot = -g b sin(alpha + phi), corrected; also eq. (22)."""
    return q.a**2 / 2 * q.phi_ddot, -q.b * q.cos_phi * q.u_ddot, q.g * q.b * q.sin_theta


def printed_19(q: Quantities) -> Terms:
    """Return the same without g on the right side, as printed."""
    return q.a**2 / 2 * q.phi_ddot, -q.b * q.cos_phi * q.u_ddot, q.b * q.sin_theta


def ripple_25(q: Quantities) -> Terms:
    """Return the terms of u - s = b sin(phi), eq. (12), which corrects eq. (25)."""
    return q.u - q.s, -q.b * q.sin_phi


def printed_25(q: Quantities) -> Terms:
    """Return the terms of u - s = b cos(phi), as printed."""
    return q.u - q.s, -q.b * q.cos_phi


def squares_25(sine: Any, cosine_twice: Any) -> Terms:
    """Return the terms of sin^2(wt)/2 = 1/4 - cos(2wt)/4, the last step of eq. (25) divided by phi_0^2; corrected."""
    return sine**2 / 2, -0.25 + 0 * sine, cosine_twice / 4


def printed_squares_25(sine: Any, cosine_twice: Any) -> Terms:
    """Return the same with cos(2wt)/2, as printed."""
    return sine**2 / 2, -0.25 + 0 * sine, cosine_twice / 2


def epsilon_28(c: Letters, rate: Any) -> Any:
    """Return the amplitude [rad] of the ripple at Omega by eqs. (27) and (28); `rate` is the mean Omega [rad/s]."""
    return c.m * c.b * c.g * c.cos_alpha / (rate**2 * (c.m * c.b**2 / 2 + c.inertia))


def corrected_28(c: Letters, rate: Any) -> Any:
    """Return the same amplitude [rad] times 1 - 3 delta/8, to first order in delta; the ripple at 2 Omega lowers it."""
    return epsilon_28(c, rate) * (1 - 3 * c.spread / 8)


def ripple_26(c: Letters) -> Any:
    """Return the amplitude delta/4 [rad] of the ripple at 2 Omega that eq. (26) leaves out, to first order in delta."""
    return c.spread / 4


def sway_29(c: Letters) -> Any:
    """Return the amplitude b (1 + delta/8) [m] of the ripple of u at Omega, to first order in delta; eq. (29) has b."""
    return c.b * (1 + c.spread / 8)
