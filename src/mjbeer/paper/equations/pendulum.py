"""Appendix B of the paper: a hoop wheel of mass M with a pendulum. Equations (56)-(61), printed and right.

The functions return terms as those of `sliding` do; M is `can_mass`. The equations are those of `massive_can` with
I_can/a^2 = m_can = M and I_cm = 0.
"""

from mjbeer.paper.letters import Quantities, Terms


def kinetic_56(q: Quantities) -> Terms:
    """Return the terms of T in eq. (56) [J]; corrected."""
    half = q.m / 2
    return (
        q.can_mass * q.u_dot**2,
        half * q.u_dot**2,
        -q.m * q.b * q.cos_phi * q.u_dot * q.phi_dot,
        half * q.b**2 * q.phi_dot**2,
    )


def printed_56(q: Quantities) -> Terms:
    """Return the same with + before the product of the rates and without b^2 theta_dot^2, as printed."""
    return q.can_mass * q.u_dot**2, q.m / 2 * q.u_dot**2, q.m * q.b * q.cos_phi * q.u_dot * q.phi_dot


def potential_56(q: Quantities) -> Terms:
    """Return the terms of V in eq. (56) [J]."""
    return -(q.can_mass + q.m) * q.g * q.u * q.sin_alpha, -q.m * q.g * q.b * q.cos_theta


def eq_57(q: Quantities) -> Terms:
    """Return the terms of (m + 2M) u_ddot - m b (cos phi theta_ddot - sin phi theta_dot^2) = (m + M) g sin(alpha)."""
    return (
        (q.m + 2 * q.can_mass) * q.u_ddot,
        -q.m * q.b * q.cos_phi * q.phi_ddot,
        q.m * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def eq_58(q: Quantities) -> Terms:
    """Return the terms of m b^2 theta_ddot - m b cos phi u_ddot = -m g b sin theta; corrected."""
    return q.m * q.b**2 * q.phi_ddot, -q.m * q.b * q.cos_phi * q.u_ddot, q.m * q.g * q.b * q.sin_theta


def printed_58(q: Quantities, theta: object) -> Terms:
    """Return the same with m b^2 theta, as printed; `theta` is in rad."""
    return q.m * q.b**2 * theta, -q.m * q.b * q.cos_phi * q.u_ddot, q.m * q.g * q.b * q.sin_theta


def kinetic_59(q: Quantities) -> Terms:
    """Return the terms of T in eq. (59) [J]; corrected."""
    return (*_shared_59(q), q.can_mass * q.b**2 * q.cos_phi**2 * q.phi_dot**2)


def printed_59(q: Quantities) -> Terms:
    """Return the same with sin^2(phi) in the wheel's last term, as printed."""
    return (*_shared_59(q), q.can_mass * q.b**2 * q.sin_phi**2 * q.phi_dot**2)


def _shared_59(q: Quantities) -> Terms:
    return (
        q.can_mass * q.s_dot**2,
        2 * q.can_mass * q.b * q.cos_phi * q.s_dot * q.phi_dot,
        q.m * q.s_dot**2 / 2,
        q.m * q.b**2 * q.sin_phi**2 * q.phi_dot**2 / 2,
    )


def potential_59(q: Quantities) -> Terms:
    """Return the terms of V in eq. (59) [J]."""
    wheel = -q.can_mass * q.g * q.sin_alpha
    bob = -q.m * q.g
    return wheel * q.s, wheel * q.b * q.sin_phi, bob * q.s * q.sin_alpha, bob * q.b * q.cos_alpha * q.cos_phi


def eq_60(q: Quantities) -> Terms:
    """Return the terms of (m + 2M) s_ddot + 2 M b (cos phi phi_ddot - sin phi phi_dot^2) = (m + M) g sin(alpha)."""
    return (
        (q.m + 2 * q.can_mass) * q.s_ddot,
        2 * q.can_mass * q.b * q.cos_phi * q.phi_ddot,
        -2 * q.can_mass * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def eq_61(q: Quantities) -> Terms:
    """Return the terms of eq. (61), corrected.

    m b^2 (sin^2 phi phi_ddot + sin phi cos phi phi_dot^2)
    + 2M (b^2 cos^2 phi phi_ddot - b^2 sin phi cos phi phi_dot^2 + b cos phi s_ddot)
    = -m g b cos(alpha) sin phi + M g b sin(alpha) cos phi.
    """
    return (
        *_swing(q),
        2 * q.can_mass * q.b**2 * q.cos_phi**2 * q.phi_ddot,
        -2 * q.can_mass * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        2 * q.can_mass * q.b * q.cos_phi * q.s_ddot,
        -q.can_mass * q.g * q.b * q.sin_alpha * q.cos_phi,
    )


def printed_61(q: Quantities) -> Terms:
    """Return the terms of eq. (61) as printed.

    It has 2M (b^2 sin^2 phi phi_ddot + b cos phi s_ddot), and lacks the wheel's weight.
    """
    return (
        *_swing(q),
        2 * q.can_mass * q.b**2 * q.sin_phi**2 * q.phi_ddot,
        2 * q.can_mass * q.b * q.cos_phi * q.s_ddot,
    )


def _swing(q: Quantities) -> Terms:
    return (
        q.m * q.b**2 * q.sin_phi**2 * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.m * q.g * q.b * q.cos_alpha * q.sin_phi,
    )
