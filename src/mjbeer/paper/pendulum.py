"""Appendix B of the paper, equations (56)-(61): a hoop wheel of mass M = `can_mass` with a pendulum.

They are those of the massive can with I_can/a^2 = m_can = M and I_cm = 0, as the paper says: K is 2M.
"""

import math
from collections.abc import Callable
from typing import Any

from mjbeer.paper.claim import CONSEQUENCE, Bound, Claim, Limit, Misprint, Terms, Witness, equation
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
from mjbeer.paper.witness import EXACT, HELD, REDUCED, SMALL, WHEEL, frequency
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import pendulum

_BOB_59 = "m*s_dot**2/2 + m*b**2*sin_phi**2*phi_dot**2/2"


def _of_the_wheel(text: str) -> Callable[[Any], Terms]:
    """Return the equation of a can with K = 2M."""
    return equation(text.replace("rolling", "2*can_mass"))


def _bob(ratio: float, heavy: bool = False) -> tuple[Scene, float]:
    """Return the scene of a bob of `ratio` wheel masses, and the omega [rad/s] of some twenty small swings.

    A swing of a heavy bob is small only if phi^2 is well below 2M/m.
    """
    scene = pendulum(load_mass=0.2 * ratio)
    amplitude = SMALL / math.sqrt(ratio / 2) if heavy else SMALL
    return scene, frequency(scene, scene.equilibrium() + amplitude, 120 / scene.frequency())


def light_bob(scene: Scene) -> float:
    """Return omega [rad/s] of a pendulum whose pivot accelerates at (g/2) sin(alpha), as an empty wheel does."""
    across, along = math.cos(scene.incline), math.sin(scene.incline) / 2
    return math.sqrt(scene.gravity * math.hypot(across, along) / scene.load.offset)


def heavy_bob(scene: Scene) -> float:
    """Return omega [rad/s] of a light wheel under a bob that hardly moves."""
    ratio = scene.load.mass / (2 * scene.can.mass)
    return math.sqrt(scene.gravity * math.cos(scene.incline) * ratio / scene.load.offset)


_AS_IN_3 = "the considerations in sec. 3 above with m_can → M, I_can/a² → M and I_cm → 0"
_LIMITS = "can be analyzed simply only in the limits that m ≪ M or m ≫ M"

# fmt: off
CLAIMS = (
    Claim("(56)", "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2", WHEEL, HELD,
        equation(f"can_mass*u_dot**2 + {TWICE_44} - kinetic"),
        Misprint(0.70, equation("can_mass*u_dot**2 + m/2*u_dot**2 + m*b*cos_phi*u_dot*phi_dot - kinetic"),
            "Pendulum in a wheel: kinetic energy",
            r"M\dot u^2+\frac m2\bigl[\dot u^2<{}+2b\cos(\theta-\alpha)\,\dot u\,\dot\theta|"
            r"{}-2b\cos(\theta-\alpha)\,\dot u\,\dot\theta+b^2\dot\theta^2>\bigr]")),
    Claim("(56)", "V in u and theta", WHEEL, EXACT,
        equation("-(can_mass + m)*g*u*sin_alpha - m*g*b*cos_theta - potential")),
    Claim("(57)", "equation of motion of u", WHEEL, HELD, _of_the_wheel(MOTION_46)),
    Claim("(58)", "equation of motion of theta: theta_ddot; printed theta (in SI units)", WHEEL, HELD,
        equation(MOTION_47.format("m*b**2", "phi_ddot")),
        Misprint(1.12, equation(MOTION_47.format("m*b**2", "theta")), "Pendulum in a wheel: equation of motion of θ",
            r"mb^2<\theta|\ddot\theta>-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta")),
    Claim("(59)", "T in s and phi: cos^2; printed sin^2", WHEEL, HELD,
        _of_the_wheel(f"{CAN_39.format('cos')} + {_BOB_59} - kinetic"),
        Misprint(0.28, _of_the_wheel(f"{CAN_39.format('sin')} + {_BOB_59} - kinetic"),
            "Pendulum in a wheel: kinetic energy of the wheel",
            r"M(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2)",
            CONSEQUENCE, "(39)"),
        quote=_AS_IN_3),
    Claim("(59)", "V in s and phi", WHEEL, EXACT, equation(POTENTIAL_40 + POTENTIAL_14 + "- potential")),
    Claim("(60)", "equation of motion of s", WHEEL, HELD, _of_the_wheel(MOTION_48)),
    Claim("(61)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", WHEEL, HELD,
        _of_the_wheel(MOTION_49),
        Misprint(1.09, _of_the_wheel(PRINTED_49), "Pendulum in a wheel: equation of motion of φ",
            r"mb^2(\sin^2\!\varphi\,\ddot\varphi+\sin\varphi\,\cos\varphi\,\dot\varphi^2)\\ {}+2M(" + BRACKET_49
            + r"<|{}+Mgb\sin\alpha\,\cos\varphi>", CONSEQUENCE, "(49)"),
        quote=_AS_IN_3),
    Claim("appendix B", "m << M: a pendulum in a frame at (g/2) sin(alpha): beyond, m = M; within, m = 1e-6 M",
        Witness(REDUCED, lambda: _bob(1e-6)), Bound(2e-6, "m/M = 1e-6"),
        lambda found: (light_bob(found[0]), -found[1]),
        limit=Limit(0.182, lambda: _bob(1.0)), quote=_LIMITS),
    Claim("appendix B", "m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M; within, 1e4 M",
        Witness(REDUCED, lambda: _bob(1e4, True)), Bound(2e-4, "M/m = 1e-4"),
        lambda found: (heavy_bob(found[0]), -found[1]),
        limit=Limit(0.42, lambda: _bob(1.0, True)), quote=_LIMITS),
)
# fmt: on
