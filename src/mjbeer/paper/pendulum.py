"""Appendix B of the paper, equations (56)-(61): a hoop wheel of mass M = `can_mass` with a pendulum.

They are those of the massive can with I_can/a^2 = m_can = M and I_cm = 0, as the paper says: K is 2M.
"""

import math

from mjbeer.paper.claim import CONSEQUENCE, Bound, Claim, Limit, Misprint, Motion, Terms, Witness
from mjbeer.paper.massive_can import (
    BRACKET_49,
    can_39,
    motion_46,
    motion_47,
    motion_48,
    motion_49,
    potential_40,
    printed_49,
    speed_43,
)
from mjbeer.paper.sliding import potential_14
from mjbeer.paper.witness import EXACT, HELD, REDUCED, SMALL, WHEEL, frequency
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import pendulum


def _bob_59(q: Motion) -> Terms:
    return q.m * q.s_dot**2 / 2, q.m * q.b**2 * q.sin_phi**2 * q.phi_dot**2 / 2


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
        lambda q: (q.can_mass * q.u_dot**2, *(q.m / 2 * each for each in speed_43(q)), -q.kinetic),
        Misprint(0.70, lambda q: (
            q.can_mass * q.u_dot**2, q.m / 2 * q.u_dot**2, q.m * q.b * q.cos_phi * q.u_dot * q.phi_dot, -q.kinetic),
            "Pendulum in a wheel: kinetic energy",
            r"M\dot u^2+\frac m2\bigl[\dot u^2<{}+2b\cos(\theta-\alpha)\,\dot u\,\dot\theta|"
            r"{}-2b\cos(\theta-\alpha)\,\dot u\,\dot\theta+b^2\dot\theta^2>\bigr]")),
    Claim("(56)", "V in u and theta", WHEEL, EXACT,
        lambda q: (-(q.can_mass + q.m) * q.g * q.u * q.sin_alpha, -q.m * q.g * q.b * q.cos_theta, -q.potential)),
    Claim("(57)", "equation of motion of u", WHEEL, HELD, lambda q: motion_46(q, 2 * q.can_mass)),
    Claim("(58)", "equation of motion of theta: theta_ddot; printed theta (in SI units)", WHEEL, HELD,
        lambda q: motion_47(q, q.m * q.b**2 * q.phi_ddot),
        Misprint(1.12, lambda q: motion_47(q, q.m * q.b**2 * q.theta), "Pendulum in a wheel: equation of motion of θ",
            r"mb^2<\theta|\ddot\theta>-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta")),
    Claim("(59)", "T in s and phi: cos^2; printed sin^2", WHEEL, HELD,
        lambda q: (*can_39(q, 2 * q.can_mass, q.cos_phi**2), *_bob_59(q), -q.kinetic),
        Misprint(0.28, lambda q: (*can_39(q, 2 * q.can_mass, q.sin_phi**2), *_bob_59(q), -q.kinetic),
            "Pendulum in a wheel: kinetic energy of the wheel",
            r"M(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi+b^2<\sin^2\!\varphi|\cos^2\!\varphi>\,\dot\varphi^2)",
            CONSEQUENCE, "(39)"),
        quote=_AS_IN_3),
    Claim("(59)", "V in s and phi", WHEEL, EXACT, lambda q: (*potential_40(q), *potential_14(q), -q.potential)),
    Claim("(60)", "equation of motion of s", WHEEL, HELD, lambda q: motion_48(q, 2 * q.can_mass)),
    Claim("(61)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", WHEEL, HELD,
        lambda q: motion_49(q, 2 * q.can_mass),
        Misprint(1.09, lambda q: printed_49(q, 2 * q.can_mass), "Pendulum in a wheel: equation of motion of φ",
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
