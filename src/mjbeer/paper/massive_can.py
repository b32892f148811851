"""Section 3.1 of the paper, equations (39)-(49): a can with mass, partially filled.

The functions take the can's effective mass K = m_can + I_can/a^2 [kg] as `k`, so that the wheel of appendix B, whose K
is 2M, has the same.
"""

from typing import Any

from mjbeer.paper.claim import Bound, Claim, Limit, Misprint, Motion, SceneConstants, Terms, Witness
from mjbeer.paper.sliding import kinetic_11, potential_14, potential_17
from mjbeer.paper.witness import DRIFT, EQUALITY, EXACT, HELD, METAL, resting
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import sliding


def can_39(q: Motion, k: Any, squared: Any) -> Terms:
    """Return the terms of T_can [J] in s and phi, of which `squared` is the last: cos^2(phi), printed sin^2(phi)."""
    return (
        k / 2 * q.s_dot**2,
        k * q.b * q.cos_phi * q.s_dot * q.phi_dot,
        k / 2 * q.b**2 * squared * q.phi_dot**2,
    )


def potential_40(q: Motion) -> Terms:
    """Return the terms of V_can [J] in s and phi."""
    return -q.can_mass * q.g * q.s * q.sin_alpha, -q.can_mass * q.g * q.b * q.sin_phi * q.sin_alpha


def speed_43(q: Motion) -> Terms:
    """Return the terms of v_beer^2 [m^2/s^2] in u and theta."""
    return q.u_dot**2, -2 * q.b * q.cos_phi * q.u_dot * q.phi_dot, q.b**2 * q.phi_dot**2


def motion_46(q: Motion, k: Any) -> Terms:
    """Return the terms of (m + K) u_ddot - m b (cos phi phi_ddot - sin phi phi_dot^2) = (m + m_can) g sin(alpha)."""
    return (
        (q.m + k) * q.u_ddot,
        -q.m * q.b * q.cos_phi * q.phi_ddot,
        q.m * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def motion_47(q: Motion, turning: Any) -> Terms:
    """Return the terms of I_axis theta_ddot - m b cos phi u_ddot = -m g b sin theta, with the first as `turning`."""
    return turning, -q.m * q.b * q.cos_phi * q.u_ddot, q.m * q.g * q.b * q.sin_theta


def motion_48(q: Motion, k: Any) -> Terms:
    """Return the terms of (m + K) s_ddot + b K (cos phi phi_ddot - sin phi phi_dot^2) = (m + m_can) g sin(alpha)."""
    return (
        (q.m + k) * q.s_ddot,
        k * q.b * q.cos_phi * q.phi_ddot,
        -k * q.b * q.sin_phi * q.phi_dot**2,
        -(q.m + q.can_mass) * q.g * q.sin_alpha,
    )


def motion_49(q: Motion, k: Any) -> Terms:
    """Return the terms of eq. (49), corrected: eq. (16) with two additions.

    K (b^2 cos^2 phi phi_ddot - b^2 sin phi cos phi phi_dot^2 + b cos phi s_ddot) is added on the left, and
    m_can g b sin(alpha) cos phi on the right.
    """
    return (
        *_swing(q),
        k * q.b**2 * q.cos_phi**2 * q.phi_ddot,
        -k * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        k * q.b * q.cos_phi * q.s_ddot,
        -q.can_mass * q.g * q.b * q.sin_alpha * q.cos_phi,
    )


def printed_49(q: Motion, k: Any) -> Terms:
    """Return the same as printed, with K (b^2 sin^2 phi phi_ddot + b cos phi s_ddot) added to eq. (16) on the left."""
    return *_swing(q), k * q.b**2 * q.sin_phi**2 * q.phi_ddot, k * q.b * q.cos_phi * q.s_ddot


def _swing(q: Motion) -> Terms:
    return (
        (q.inertia + q.m * q.b**2 * q.sin_phi**2) * q.phi_ddot,
        q.m * q.b**2 * q.sin_phi * q.cos_phi * q.phi_dot**2,
        q.m * q.g * q.b * q.cos_alpha * q.sin_phi,
    )


def steady(c: SceneConstants, k: Any) -> Any:
    """Return the acceleration [m/s^2] of footnote 4 for a can whose beer does not swing."""
    return c.g * c.sin_alpha * (c.m + c.can_mass) / (c.m + k)


def _of_the_can(q: Motion) -> Any:
    """Return the can's kinetic energy [J]: MuJoCo's of the whole less the beer's."""
    return q.kinetic - sum(kinetic_11(q))


def _rests(scene: Scene) -> Witness:
    return Witness(EQUALITY, lambda: resting(scene))


_FULL, _NEARLY_EMPTY = sliding(can=Can.sheet_metal()), sliding(fill=1e-4, can=Can.sheet_metal())
_HOOP = sliding(fill=1e-4, can=Can.hoop(mass=0.05))
_LEFT_49 = r"(I_{\text{cm}}+mb^2\sin^2\!\varphi)\,\ddot\varphi+mb^2\sin\varphi\,\cos\varphi\,\dot\varphi^2\\ {}+"
_CAN = r"\Bigl(m_{\text{can}}+\frac{I_{\text{can}}}{a^2}\Bigr)"
BRACKET_49 = (
    r"b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\ddot\varphi"
    r"\\ {}<|{}-b^2\sin\varphi\,\cos\varphi\,\dot\varphi^2>+b\cos\varphi\,\ddot s)\\ {}=-mgb\cos\alpha\,\sin\varphi"
)

# fmt: off
CLAIMS = (
    Claim("sec. 3.1", "phi = theta - alpha; printed theta + alpha", METAL, EXACT, lambda q: (q.phi, -q.theta, q.alpha),
        Misprint(0.16, lambda q: (q.phi, -q.theta, -q.alpha), "The two angles of the beer",
            r"\varphi=\theta\,<+|->\,\alpha"),
        quote="θ or φ = θ + α as the independent coordinates"),
    Claim("(39)", "T_can in u", METAL, HELD, lambda q: (q.rolling * q.u_dot**2 / 2, -_of_the_can(q))),
    Claim("(39)", "T_can in s and phi: its last term has cos^2; printed sin^2", METAL, HELD,
        lambda q: (*can_39(q, q.rolling, q.cos_phi**2), -_of_the_can(q)),
        Misprint(0.060, lambda q: (*can_39(q, q.rolling, q.sin_phi**2), -_of_the_can(q)), "Kinetic energy of the can",
            r"\frac12" + _CAN + r"\bigl(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi\\ "
            r"{}+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2\bigr)")),
    Claim("(40)", "V_can in u", METAL, EXACT,
        lambda q: (-q.can_mass * q.g * q.u * q.sin_alpha, *potential_14(q), -q.potential)),
    Claim("(40)", "V_can in s and phi", METAL, EXACT, lambda q: (*potential_40(q), *potential_14(q), -q.potential)),
    Claim("(41)", "x of the beer's centre of mass", METAL, EXACT, lambda q: (q.u, -q.b * q.sin_phi, -q.s)),
    Claim("(41)", "y of the beer's centre of mass", METAL, EXACT, lambda q: (-q.b * q.cos_phi, -q.across)),
    Claim("(42)", "x_dot = s_dot; printed s_dot^2 (in SI units)", METAL, EXACT,
        lambda q: (q.s_dot, -q.u_dot, q.b * q.cos_phi * q.phi_dot),
        Misprint(0.39, lambda q: (q.s_dot**2, -q.u_dot, q.b * q.cos_phi * q.phi_dot),
            "Velocity of the centre of mass along the incline", r"\dot x=<\dot s^2|\dot s>")),
    Claim("(42)", "y_dot", METAL, EXACT, lambda q: (q.b * q.sin_phi * q.phi_dot, -q.across_dot)),
    Claim("(43)", "v_beer^2 in u and theta", METAL, EXACT, lambda q: (*speed_43(q), -(q.s_dot**2 + q.across_dot**2))),
    Claim("(43)", "v_beer^2 in s and phi", METAL, EXACT,
        lambda q: (q.s_dot**2, q.b**2 * q.sin_phi**2 * q.phi_dot**2, -(q.s_dot**2 + q.across_dot**2))),
    Claim("(44)", "T_beer in u and theta", METAL, HELD, lambda q: (
        *(q.m / 2 * each for each in speed_43(q)), q.inertia * q.phi_dot**2 / 2,
        q.rolling * q.u_dot**2 / 2, -q.kinetic)),
    Claim("(44)", "T_beer in s and phi", METAL, HELD,
        lambda q: (*kinetic_11(q), q.rolling * q.u_dot**2 / 2, -q.kinetic)),
    Claim("(45)", "V_beer in u and theta", METAL, EXACT,
        lambda q: (*potential_17(q), -q.can_mass * q.g * q.u * q.sin_alpha, -q.potential)),
    Claim("(45)", "V_beer in s and phi", METAL, EXACT,
        lambda q: (*potential_14(q), -q.can_mass * q.g * q.u * q.sin_alpha, -q.potential)),
    Claim("(46)", "equation of motion of u", METAL, HELD, lambda q: motion_46(q, q.rolling)),
    Claim("(47)", "equation of motion of theta: I_axis; printed m a^2 (for m a^2/2 of a half can)", METAL, HELD,
        lambda q: motion_47(q, q.axial * q.phi_ddot),
        Misprint(0.50, lambda q: motion_47(q, q.m * q.a**2 * q.phi_ddot), "Massive can: equation of motion of θ",
            r"<ma^2|I_{\text{axis}}>\,\ddot\theta-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta"),
        quote="recalling that mb² + I_cm = ma²"),
    Claim("(48)", "equation of motion of s", METAL, HELD, lambda q: motion_48(q, q.rolling)),
    Claim("(49)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", METAL, HELD,
        lambda q: motion_49(q, q.rolling),
        Misprint(0.059, lambda q: printed_49(q, q.rolling), "Massive can: equation of motion of φ",
            _LEFT_49 + _CAN + "(" + BRACKET_49 + r"<|{}+m_{\text{can}}gb\sin\alpha\,\cos\varphi>")),
    Claim("footnote 4", "acceleration of a can whose beer does not swing", _rests(_FULL), HELD,
        lambda q: (q.u_ddot, -steady(q, q.rolling)),
        quote="the acceleration of the center of the can would be constant, with value "
        "g sin α(m + m_can)/(m + m_can + I_can/a²)"),
    Claim("footnote 4", "the same with I_can = m_can a^2: beyond, the metal can; within, a hoop",
        _rests(_HOOP), Bound(1e-7, DRIFT), lambda q: (q.u_ddot, -steady(q, 2 * q.can_mass)),
        limit=Limit(4.2e-3, _rests(_FULL).see), quote="≈ g sin α(m + m_can)/(m + 2m_can)"),
    Claim("sec. 3.1", "(g/2) sin(alpha) of a nearly empty can: beyond, of sheet metal; within, a hoop",
        _rests(_HOOP), Bound(1e-4, "what beer is left (fill 1e-4)"), lambda q: (q.u_ddot, -q.g * q.sin_alpha / 2),
        limit=Limit(0.054, _rests(_NEARLY_EMPTY).see),
        quote="nearly the same as that of an empty can, with acceleration (g/2) sin α down the incline"),
    Claim("sec. 3.1", "tilt of the beer that does not swing, which the paper leaves open", _rests(_FULL), HELD,
        lambda q: (q.sin_phi / q.cos_phi, -(steady(q, q.rolling) - q.g * q.sin_alpha) / (q.g * q.cos_alpha)),
        quote="small oscillations of the “beer” about an equilibrium"),
)
# fmt: on
