"""Appendix B of the paper, equations (56)-(61): a hoop wheel of mass M = `can_mass` with a pendulum.

They are those of the massive can with I_can/a^2 = m_can = M and I_cm = 0, as the paper says: K is 2M.
"""

import math
from functools import partial

from mjbeer.paper.claim import CONSEQUENCE, Bound, Claim, Limit, Misprint, Seen, Witness
from mjbeer.paper.massive_can import (
    BRACKET_49,
    CAN_39,
    MOTION_46,
    MOTION_47,
    MOTION_48,
    MOTION_49,
    POTENTIAL_40,
    PRINTED_49,
    TWICE_44,
)
from mjbeer.paper.sliding import POTENTIAL_14
from mjbeer.paper.witness import EXACT, HELD, REDUCED, SMALL, WHEEL, oscillate
from mjbeer.theory.scenes import pendulum

_BOB_59 = "m*s_dot**2/2 + m*b**2*sin(phi)**2*phi_dot**2/2"


def _of_the_wheel(equation: str) -> str:
    """Return the equation of a can with K = 2M."""
    return equation.replace("rolling", "2*can_mass")


def _bob(ratio: float, heavy: bool = False) -> Seen:
    """Return the frequency of a bob of `ratio` wheel masses, over some twenty small swings.

    A swing of a heavy bob is small only if phi^2 is well below 2M/m.
    """
    scene = pendulum(load_mass=0.2 * ratio)
    amplitude = SMALL / math.sqrt(ratio / 2) if heavy else SMALL
    return oscillate(scene, scene.equilibrium() + amplitude, 120 / scene.frequency())


_AS_IN_3 = "the considerations in sec. 3 above with m_can → M, I_can/a² → M and I_cm → 0"
_LIMITS = "can be analyzed simply only in the limits that m ≪ M or m ≫ M"

# fmt: off
CLAIMS = (
    Claim("(56)", "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2", WHEEL, HELD,
        f"can_mass*u_dot**2 + {TWICE_44} - kinetic",
        Misprint(0.70, "can_mass*u_dot**2 + m/2*u_dot**2 + m*b*cos(phi)*u_dot*phi_dot - kinetic",
            "Pendulum in a wheel: kinetic energy",
            r"M\dot u^2+\frac m2\bigl[\dot u^2<{}+2b\cos(\theta-\alpha)\,\dot u\,\dot\theta|"
            r"{}-2b\cos(\theta-\alpha)\,\dot u\,\dot\theta+b^2\dot\theta^2>\bigr]")),
    Claim("(56)", "V in u and theta", WHEEL, EXACT,
        "-(can_mass + m)*g*u*sin(alpha) - m*g*b*cos(theta) - potential"),
    Claim("(57)", "equation of motion of u", WHEEL, HELD, _of_the_wheel(MOTION_46)),
    Claim("(58)", "equation of motion of theta: theta_ddot; printed theta (in SI units)", WHEEL, HELD,
        MOTION_47.format("m*b**2", "phi_ddot"),
        Misprint(1.12, MOTION_47.format("m*b**2", "theta"), "Pendulum in a wheel: equation of motion of θ",
            r"mb^2<\theta|\ddot\theta>-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta")),
    Claim("(59)", "T in s and phi: cos^2; printed sin^2", WHEEL, HELD,
        _of_the_wheel(f"{CAN_39.format('cos')} + {_BOB_59} - kinetic"),
        Misprint(0.28, _of_the_wheel(f"{CAN_39.format('sin')} + {_BOB_59} - kinetic"),
            "Pendulum in a wheel: kinetic energy of the wheel",
            r"M(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2)",
            CONSEQUENCE, "(39)"),
        quote=_AS_IN_3),
    Claim("(59)", "V in s and phi", WHEEL, EXACT, POTENTIAL_40 + POTENTIAL_14 + "- potential"),
    Claim("(60)", "equation of motion of s", WHEEL, HELD, _of_the_wheel(MOTION_48)),
    Claim("(61)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", WHEEL, HELD,
        _of_the_wheel(MOTION_49),
        Misprint(1.09, _of_the_wheel(PRINTED_49), "Pendulum in a wheel: equation of motion of φ",
            r"mb^2(\sin^2\!\varphi\,\ddot\varphi+\sin\varphi\,\cos\varphi\,\dot\varphi^2)\\ {}+2M(" + BRACKET_49
            + r"<|{}+Mgb\sin\alpha\,\cos\varphi>", CONSEQUENCE, "(49)"),
        quote=_AS_IN_3),
    Claim("appendix B", "m << M: a pendulum in a frame at (g/2) sin(alpha): beyond, m = M; within, m = 1e-6 M",
        Witness(REDUCED, partial(_bob, 1e-6)), Bound(2e-6, "m/M = 1e-6"),
        "sqrt(g*hypot(cos(alpha), sin(alpha)/2)/b) - omega",
        limit=Limit(0.182, partial(_bob, 1.0)), quote=_LIMITS),
    Claim("appendix B", "m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M; within, 1e4 M",
        Witness(REDUCED, partial(_bob, 1e4, True)), Bound(2e-4, "M/m = 1e-4"),
        "sqrt(g*cos(alpha)*m/(2*can_mass*b)) - omega",
        limit=Limit(0.42, partial(_bob, 1.0, True)), quote=_LIMITS),
)
# fmt: on
