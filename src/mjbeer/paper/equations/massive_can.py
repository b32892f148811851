"""Section 3 of the paper: a massive can, partially filled. Equations (39)-(49), printed and right.

The functions return terms as those of `sliding` do. In some formulas K = m_can + I_can/a^2.
"""

from typing import Any

from mjbeer.paper.letters import Letters, Quantities, Terms


def kinetic_39(q: Quantities) -> Terms:
    """Return the term of T_can [J] in u_dot, the first form."""
    return (q.rolling * q.u_dot**2 / 2,)


def expanded_39(q: Quantities) -> Terms:
    """Return the terms of T_can [J] in s and phi; corrected."""
    return tuple(q.rolling / 2 * term for term in (*_cross(q), q.b**2 * q.cos_phi**2 * q.phi_dot**2))


def printed_39(q: Quantities) -> Terms:
    """Return the same with sin^2(phi) in the last term, as printed."""
    return tuple(q.rolling / 2 * term for term in (*_cross(q), q.b**2 * q.sin_phi**2 * q.phi_dot**2))


def _cross(q: Quantities) -> Terms:
    return q.s_dot**2, 2 * q.b * q.cos_phi * q.s_dot * q.phi_dot


def potential_40(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of V_can [J] in u, and those in s and phi."""
    weight = -q.can_mass * q.g * q.sin_alpha
    return (weight * q.u,), (weight * q.s, weight * q.b * q.sin_phi)


def position_41(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of x, and those of y [m], of the beer's centre of mass."""
    return (q.u, -q.b * q.sin_phi), (-q.b * q.cos_phi,)


def velocity_42(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of x_dot = u_dot - b cos(phi) theta_dot and y_dot = b sin(phi) theta_dot [m/s]."""
    return (q.u_dot, -q.b * q.cos_phi * q.phi_dot), (q.b * q.sin_phi * q.phi_dot,)


def printed_42(q: Quantities) -> Terms:
    """Return the term of x_dot = s_dot^2, as printed."""
    return (q.s_dot**2,)


def speed_43(q: Quantities) -> tuple[Terms, ...]:
    """Return the terms of v_beer^2 [m^2/s^2] in u and theta, and those in s and phi."""
    first = q.u_dot**2, -2 * q.b * q.cos_phi * q.u_dot * q.phi_dot, q.b**2 * q.phi_dot**2
    return first, (q.s_dot**2, q.b**2 * q.sin_phi**2 * q.phi_dot**2)


def kinetic_44(q: Quantities) -> Terms:
    """Return the terms of T_beer [J] in u and theta; those of the second line are `sliding.kinetic_11`."""
    return (*(q.m / 2 * term for term in speed_43(q)[0]), q.inertia * q.phi_dot**2 / 2)


def eq_46(q: Quantities) -> Terms:
    """Return the terms of eq. (46).

    (m + m_can + I_can/a^2) u_ddot - m b (cos phi theta_ddot - sin phi theta_dot^2) = (m + m_can) g sin(alpha).
    """
    return (
        (q.m + q.rolling) * q.u_ddot,
        -q.m * q.b * q.cos_phi * q.phi_ddot,
        q.m * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def eq_47(q: Quantities) -> Terms:
    """Return the terms of I_axis theta_ddot - m b cos phi u_ddot = -m g b sin theta; corrected."""
    return q.axial * q.phi_ddot, -q.m * q.b * q.cos_phi * q.u_ddot, q.m * q.g * q.b * q.sin_theta


def printed_47(q: Quantities) -> Terms:
    """Return the same with m a^2 for I_axis, as printed."""
    return q.m * q.a**2 * q.phi_ddot, -q.m * q.b * q.cos_phi * q.u_ddot, q.m * q.g * q.b * q.sin_theta


def eq_48(q: Quantities) -> Terms:
    """Return the terms of eq. (48).

    (m + K) s_ddot + b K (cos phi phi_ddot - sin phi phi_dot^2) = (m + m_can) g sin(alpha), K = m_can + I_can/a^2.
    """
    return (
        (q.m + q.rolling) * q.s_ddot,
        q.rolling * q.b * q.cos_phi * q.phi_ddot,
        -q.rolling * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def eq_49(q: Quantities) -> Terms:
    """Return the terms of eq. (49), corrected: eq. (16) with two additions.

    K (b^2 cos^2 phi phi_ddot - b^2 sin phi cos phi phi_dot^2 + b cos phi s_ddot) is added on the left, and
    m_can g b sin(alpha) cos phi on the right.
    """
    return (
        *_swing(q),
        q.rolling * q.b**2 * q.cos_phi**2 * q.phi_ddot,
        -q.rolling * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.rolling * q.b * q.cos_phi * q.s_ddot,
        -q.can_mass * q.g * q.b * q.sin_alpha * q.cos_phi,
    )


def printed_49(q: Quantities) -> Terms:
    """Return the terms of eq. (49) as printed.

    That is eq. (16) with K (b^2 sin^2 phi phi_ddot + b cos phi s_ddot) added on the left.
    """
    return (
        *_swing(q),
        q.rolling * q.b**2 * q.sin_phi**2 * q.phi_ddot,
        q.rolling * q.b * q.cos_phi * q.s_ddot,
    )


def _swing(q: Quantities) -> Terms:
    return (
        (q.inertia + q.m * q.b**2 * q.sin_phi**2) * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.m * q.g * q.b * q.cos_alpha * q.sin_phi,
    )


def footnote_4(c: Letters) -> Any:
    """Return the acceleration [m/s^2] of a can whose beer does not swing."""
    return c.g * c.sin_alpha * (c.m + c.can_mass) / (c.m + c.rolling)


def hoop_footnote_4(c: Letters) -> Any:
    """Return the same acceleration [m/s^2] for I_can = m_can a^2, the footnote's last step."""
    return c.g * c.sin_alpha * (c.m + c.can_mass) / (c.m + 2 * c.can_mass)


def tilt(c: Letters) -> Any:
    """Return tan(phi*) of beer that does not swing: (A - g sin(alpha)) / (g cos(alpha)), with the A of footnote 4."""
    return (footnote_4(c) - c.g * c.sin_alpha) / (c.g * c.cos_alpha)
