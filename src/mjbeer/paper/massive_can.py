"""Sec. 3.1 of the paper, eqs. (39)-(49): a can with mass; and appendix B, (56)-(61).

The wheel of appendix B is a hoop of mass M with a pendulum. As the paper says, its equations are
those of the can with m_can = M, I_can/a^2 = M and I_cm = 0. In equations M is `can_mass`, and
K = m_can + I_can/a^2 is `rolling`, which is 2M for the wheel.
"""

import math
from functools import partial

from mjbeer.paper.claim import CONSEQUENCE, Bound, Claim, Limit, Misprint, Observation, Witness
from mjbeer.paper.sliding import KINETIC_11, POTENTIAL_14, POTENTIAL_17
from mjbeer.paper.witness import (
    DRIFT,
    EXACT,
    HELD,
    METAL,
    REDUCED,
    SMALL,
    WHEEL,
    oscillate,
    simulated,
)
from mjbeer.theory.can import Can
from mjbeer.theory.paper_scenes import pendulum, sliding
from mjbeer.theory.scene import Scene

_KINETIC_39 = (
    "rolling/2*s_dot**2 + rolling*b*cos(phi)*s_dot*phi_dot + rolling/2*b**2*cos(phi)**2*phi_dot**2"
)
_PRINTED_39 = (
    "rolling/2*s_dot**2 + rolling*b*cos(phi)*s_dot*phi_dot + rolling/2*b**2*sin(phi)**2*phi_dot**2"
)
"""T_can [J] in s and phi, and as the paper prints it: with sin^2 for the cos^2 of the last term."""
_POTENTIAL_40 = "- can_mass*g*s*sin(alpha) - can_mass*g*b*sin(phi)*sin(alpha)"
"""V_can [J] in s and phi."""
_TWICE_44 = "m/2*u_dot**2 - m*b*cos(phi)*u_dot*phi_dot + m/2*b**2*phi_dot**2"
"""m v_beer^2/2 [J], the energy of the beer's centre of mass, which eq. (56) has too."""
_MOTION_46 = (
    "(m + rolling)*u_ddot - m*b*cos(phi)*phi_ddot + m*b*sin(phi)*phi_dot**2 "
    "- (m + can_mass)*g*sin(alpha)"
)
_AFTER_47 = " - m*b*cos(phi)*u_ddot + m*g*b*sin(theta)"
"""Eqs. (47) and (58), I_axis theta_ddot - m b cos(phi) u_ddot = -m g b sin(theta), without the
first term, which the paper prints wrong. There phi_ddot is theta_ddot."""
_MOTION_48 = (
    "(m + rolling)*s_ddot + rolling*b*cos(phi)*phi_ddot - rolling*b*sin(phi)*phi_dot**2 "
    "- (m + can_mass)*g*sin(alpha)"
)
_COMMON_49 = (
    "(inertia + m*b**2*sin(phi)**2)*phi_ddot + m*b**2*sin(phi)*cos(phi)*phi_dot**2 + "
    "m*g*b*cos(alpha)*sin(phi) + rolling*b*cos(phi)*s_ddot"
)
_MOTION_49 = (
    f"{_COMMON_49} + rolling*b**2*cos(phi)**2*phi_ddot - rolling*b**2*sin(phi)*cos(phi)*phi_dot**2 "
    "- can_mass*g*b*sin(alpha)*cos(phi)"
)
_PRINTED_49 = f"{_COMMON_49} + rolling*b**2*sin(phi)**2*phi_ddot"
"""Eq. (49), corrected and as printed; both have the terms of eq. (16), and one with s_ddot."""
_CAN_LESS_KINETIC = "rolling*u_dot**2/2 - kinetic"
_CAN_LESS_POTENTIAL = "- can_mass*g*u*sin(alpha) - potential"
"""The kinetic and the potential energy [J] of the can, each less that of can and beer."""
_STEADY = "g*sin(alpha)*(m + can_mass)/(m + {})"
"""Acceleration [m/s^2] of a can whose beer does not swing; the gap is for K."""
_BOB_59 = "m*s_dot**2/2 + m*b**2*sin(phi)**2*phi_dot**2/2"
"""T [J] of the pendulum in s and phi."""


def _rests(scene: Scene) -> Witness:
    """Return the witness of a motion without a swing."""
    return simulated(scene, scene.equilibrium())


def _of_the_wheel(equation: str) -> str:
    """Return an equation of the can with the K = 2M of the wheel."""
    return equation.replace("rolling", "2*can_mass")


def _bob(ratio: float, amplitude: float = SMALL) -> Observation:
    """Return the frequency of a bob of `ratio` wheel masses in about twenty small swings."""
    scene = pendulum(load_mass=0.2 * ratio)
    return oscillate(scene, scene.equilibrium() + amplitude, 120 / scene.frequency())


def _heavy_bob(ratio: float) -> Observation:
    """Return the frequency of a heavy bob, whose swing is small if phi^2 is well below 2M/m."""
    return _bob(ratio, SMALL / math.sqrt(ratio / 2))


_HALF_FULL = _rests(sliding(can=Can.sheet_metal()))
_NEARLY_EMPTY = _rests(sliding(fill=0.01, can=Can.sheet_metal(thickness=1e-3)))
_HOOP = _rests(sliding(fill=0.01, can=Can.hoop(mass=0.6)))
# The formulas of eq. (49) in LaTeX: its left side, K, and what K multiplies.
_LEFT_49 = (
    r"(I_{\text{cm}}+mb^2\sin^2\!\varphi)\,\ddot\varphi"
    r"+mb^2\sin\varphi\,\cos\varphi\,\dot\varphi^2\\ {}+"
)
_CAN = r"\Bigl(m_{\text{can}}+\frac{I_{\text{can}}}{a^2}\Bigr)"
_BRACKET_49 = (
    r"b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\ddot\varphi"
    r"\\ {}<|{}-b^2\sin\varphi\,\cos\varphi\,\dot\varphi^2>+b\cos\varphi\,\ddot s)\\ "
    r"{}=-mgb\cos\alpha\,\sin\varphi"
)
_AS_IN_3 = "the considerations in sec. 3 above with m_can → M, I_can/a² → M and I_cm → 0"
_LIMITS = "can be analyzed simply only in the limits that m ≪ M or m ≫ M"

CLAIMS = (
    Claim(
        "sec. 3.1",
        "phi = theta - alpha; printed theta + alpha",
        METAL,
        EXACT,
        residual="phi - theta + alpha",
        misprint=Misprint(
            0.16,
            wrong="phi - theta - alpha",
            about="The two angles of the beer",
            latex=r"\varphi=\theta\,<+|->\,\alpha",
        ),
        quote="θ or φ = θ + α as the independent coordinates",
    ),
    Claim(
        "(39)",
        "T_can in u",
        METAL,
        HELD,
        residual=f"rolling*u_dot**2/2 - (kinetic - ({KINETIC_11}))",
    ),
    Claim(
        "(39)",
        "T_can in s and phi: its last term has cos^2; printed sin^2",
        METAL,
        HELD,
        residual=f"{_KINETIC_39} - (kinetic - ({KINETIC_11}))",
        misprint=Misprint(
            0.060,
            wrong=f"{_PRINTED_39} - (kinetic - ({KINETIC_11}))",
            about="Kinetic energy of the can",
            latex=r"\frac12" + _CAN + r"\bigl(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi\\ "
            r"{}+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2\bigr)",
        ),
    ),
    Claim("(40)", "V_can in u", METAL, EXACT, residual=POTENTIAL_14 + _CAN_LESS_POTENTIAL),
    Claim(
        "(40)",
        "V_can in s and phi",
        METAL,
        EXACT,
        residual=_POTENTIAL_40 + POTENTIAL_14 + "- potential",
    ),
    Claim("(41)", "x of the beer's centre of mass", METAL, EXACT, residual="u - b*sin(phi) - s"),
    Claim("(41)", "y of the beer's centre of mass", METAL, EXACT, residual="-b*cos(phi) - across"),
    Claim(
        "(42)",
        "x_dot = s_dot; printed s_dot^2 (in SI units)",
        METAL,
        EXACT,
        residual="s_dot - u_dot + b*cos(phi)*phi_dot",
        misprint=Misprint(
            0.39,
            wrong="s_dot**2 - u_dot + b*cos(phi)*phi_dot",
            about="Velocity of the centre of mass along the incline",
            latex=r"\dot x=<\dot s^2|\dot s>",
        ),
    ),
    Claim("(42)", "y_dot", METAL, EXACT, residual="b*sin(phi)*phi_dot - across_dot"),
    Claim(
        "(43)",
        "v_beer^2 in u and theta",
        METAL,
        EXACT,
        residual="u_dot**2 - 2*b*cos(phi)*u_dot*phi_dot + b**2*phi_dot**2 - (s_dot**2 + "
        "across_dot**2)",
    ),
    Claim(
        "(43)",
        "v_beer^2 in s and phi",
        METAL,
        EXACT,
        residual="s_dot**2 + b**2*sin(phi)**2*phi_dot**2 - (s_dot**2 + across_dot**2)",
    ),
    Claim(
        "(44)",
        "T_beer in u and theta",
        METAL,
        HELD,
        residual=f"{_TWICE_44} + inertia*phi_dot**2/2 + {_CAN_LESS_KINETIC}",
    ),
    Claim(
        "(44)", "T_beer in s and phi", METAL, HELD, residual=f"{KINETIC_11} + {_CAN_LESS_KINETIC}"
    ),
    Claim(
        "(45)", "V_beer in u and theta", METAL, EXACT, residual=POTENTIAL_17 + _CAN_LESS_POTENTIAL
    ),
    Claim("(45)", "V_beer in s and phi", METAL, EXACT, residual=POTENTIAL_14 + _CAN_LESS_POTENTIAL),
    Claim("(46)", "equation of motion of u", METAL, HELD, residual=_MOTION_46),
    Claim(
        "(47)",
        "equation of motion of theta: I_axis; printed m a^2 (for m a^2/2 of a half can)",
        METAL,
        HELD,
        residual="axial*phi_ddot" + _AFTER_47,
        misprint=Misprint(
            0.50,
            wrong="m*a**2*phi_ddot" + _AFTER_47,
            about="Massive can: equation of motion of θ",
            latex=r"<ma^2|I_{\text{axis}}>\,\ddot\theta-mb\cos(\theta-\alpha)\,\ddot "
            r"u=-mgb\sin\theta",
        ),
        quote="recalling that mb² + I_cm = ma²",
    ),
    Claim("(48)", "equation of motion of s", METAL, HELD, residual=_MOTION_48),
    Claim(
        "(49)",
        "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed",
        METAL,
        HELD,
        residual=_MOTION_49,
        misprint=Misprint(
            0.059,
            wrong=_PRINTED_49,
            about="Massive can: equation of motion of φ",
            latex=_LEFT_49
            + _CAN
            + "("
            + _BRACKET_49
            + r"<|{}+m_{\text{can}}gb\sin\alpha\,\cos\varphi>",
        ),
    ),
    Claim(
        "footnote 4",
        "acceleration of a can whose beer does not swing",
        _HALF_FULL,
        HELD,
        residual=f"u_ddot - {_STEADY.format('rolling')}",
        quote="the acceleration of the center of the can would be constant, with value "
        "g sin α(m + m_can)/(m + m_can + I_can/a²)",
    ),
    Claim(
        "footnote 4",
        "the same with I_can = m_can a^2: beyond, the metal can; within, a hoop",
        _HOOP,
        Bound(1e-7, DRIFT),
        residual=f"u_ddot - {_STEADY.format('2*can_mass')}",
        limit=Limit(4.2e-3, _HALF_FULL.observe),
        quote="≈ g sin α(m + m_can)/(m + 2m_can)",
    ),
    Claim(
        "sec. 3.1",
        "(g/2) sin(alpha) of a nearly empty can: beyond, of sheet metal; within, a hoop",
        _HOOP,
        Bound(1e-3, "what beer is left (0.7 g in a hoop of 600 g)"),
        residual="u_ddot - g*sin(alpha)/2",
        limit=Limit(0.058, _NEARLY_EMPTY.observe),
        quote="nearly the same as that of an empty can, with acceleration (g/2) sin α down the "
        "incline",
    ),
    Claim(
        "sec. 3.1",
        "tilt of the beer that does not swing, which the paper leaves open",
        _HALF_FULL,
        HELD,
        residual=f"tan(phi) - ({_STEADY.format('rolling')} - g*sin(alpha))/(g*cos(alpha))",
        quote="small oscillations of the “beer” about an equilibrium",
    ),
)
OF_THE_WHEEL = (
    Claim(
        "(56)",
        "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2",
        WHEEL,
        HELD,
        residual=f"can_mass*u_dot**2 + {_TWICE_44} - kinetic",
        misprint=Misprint(
            0.70,
            wrong="can_mass*u_dot**2 + m/2*u_dot**2 + m*b*cos(phi)*u_dot*phi_dot - kinetic",
            about="Pendulum in a wheel: kinetic energy",
            latex=r"M\dot u^2+\frac m2\bigl[\dot u^2<{}+2b\cos(\theta-\alpha)\,\dot u\,\dot\theta|"
            r"{}-2b\cos(\theta-\alpha)\,\dot u\,\dot\theta+b^2\dot\theta^2>\bigr]",
        ),
    ),
    Claim(
        "(56)",
        "V in u and theta",
        WHEEL,
        EXACT,
        residual="-(can_mass + m)*g*u*sin(alpha) - m*g*b*cos(theta) - potential",
    ),
    Claim("(57)", "equation of motion of u", WHEEL, HELD, residual=_of_the_wheel(_MOTION_46)),
    Claim(
        "(58)",
        "equation of motion of theta: theta_ddot; printed theta (in SI units)",
        WHEEL,
        HELD,
        residual="m*b**2*phi_ddot" + _AFTER_47,
        misprint=Misprint(
            1.12,
            wrong="m*b**2*theta" + _AFTER_47,
            about="Pendulum in a wheel: equation of motion of θ",
            latex=r"mb^2<\theta|\ddot\theta>-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta",
        ),
    ),
    Claim(
        "(59)",
        "T in s and phi: cos^2; printed sin^2",
        WHEEL,
        HELD,
        residual=_of_the_wheel(f"{_KINETIC_39} + {_BOB_59} - kinetic"),
        misprint=Misprint(
            0.28,
            wrong=_of_the_wheel(f"{_PRINTED_39} + {_BOB_59} - kinetic"),
            about="Pendulum in a wheel: kinetic energy of the wheel",
            latex=r"M(\dot s^2+2b\cos\varphi\,\dot "
            r"s\,\dot\varphi+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2)",
            kind=CONSEQUENCE,
            of="(39)",
        ),
        quote=_AS_IN_3,
    ),
    Claim(
        "(59)",
        "V in s and phi",
        WHEEL,
        EXACT,
        residual=_POTENTIAL_40 + POTENTIAL_14 + "- potential",
    ),
    Claim("(60)", "equation of motion of s", WHEEL, HELD, residual=_of_the_wheel(_MOTION_48)),
    Claim(
        "(61)",
        "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed",
        WHEEL,
        HELD,
        residual=_of_the_wheel(_MOTION_49),
        misprint=Misprint(
            1.09,
            wrong=_of_the_wheel(_PRINTED_49),
            about="Pendulum in a wheel: equation of motion of φ",
            latex=r"mb^2(\sin^2\!\varphi\,\ddot\varphi+\sin\varphi\,\cos\varphi\,\dot\varphi^2)\\ "
            r"{}+2M(" + _BRACKET_49 + r"<|{}+Mgb\sin\alpha\,\cos\varphi>",
            kind=CONSEQUENCE,
            of="(49)",
        ),
        quote=_AS_IN_3,
    ),
    Claim(
        "appendix B",
        "m << M: a pendulum in a frame at (g/2) sin(alpha): beyond, m = M; within, m = 1e-3 M",
        Witness(REDUCED, partial(_bob, 1e-3)),
        Bound(2e-3, "m/M = 1e-3"),
        residual="sqrt(g*hypot(cos(alpha), sin(alpha)/2)/b) - omega",
        limit=Limit(0.182, partial(_bob, 1.0)),
        quote=_LIMITS,
    ),
    Claim(
        "appendix B",
        "m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M; within, 1e3 M",
        Witness(REDUCED, partial(_heavy_bob, 1e3)),
        Bound(2e-3, "M/m = 1e-3"),
        residual="sqrt(g*cos(alpha)*m/(2*can_mass*b)) - omega",
        limit=Limit(0.42, partial(_heavy_bob, 1.0)),
        quote=_LIMITS,
    ),
)
