"""Claims of appendix B about the wheel with a pendulum, equations (56)-(61)."""

import math
from collections.abc import Iterator

from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import DRIFT, EQUALITY, EXACT, HELD, REDUCED, ROUNDING, SMALL, long_swing, wheel
from mjbeer.paper.equations import pendulum as equations
from mjbeer.paper.letters import Terms
from mjbeer.theory.named import pendulum
from mjbeer.theory.scene import Scene


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield from _motion()
    yield from _limits()


def _motion() -> Iterator[Claim]:
    motion = wheel()
    q = motion.quantities
    yield corrected(
        "(56)",
        "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2",
        witness=EQUALITY,
        printed=lambda: (*equations.printed_56(q), -motion.kinetic),
        right=lambda: (*equations.kinetic_56(q), -motion.kinetic),
        misses_by=0.70,
        bound=HELD,
        reason=DRIFT,
    )
    yield confirmed(
        "(56)",
        "V in u and theta",
        witness=EQUALITY,
        terms=lambda: (*equations.potential_56(q), -motion.potential),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(57)", "equation of motion of u", witness=EQUALITY, terms=lambda: equations.eq_57(q), bound=HELD, reason=DRIFT
    )
    yield corrected(
        "(58)",
        "equation of motion of theta: theta_ddot; printed theta (in SI units)",
        witness=EQUALITY,
        printed=lambda: equations.printed_58(q, motion.theta),
        right=lambda: equations.eq_58(q),
        misses_by=1.12,
        bound=HELD,
        reason=DRIFT,
    )
    yield corrected(
        "(59)",
        "T in s and phi: cos^2; printed sin^2",
        witness=EQUALITY,
        printed=lambda: (*equations.printed_59(q), -motion.kinetic),
        right=lambda: (*equations.kinetic_59(q), -motion.kinetic),
        misses_by=0.28,
        bound=HELD,
        reason=DRIFT,
    )
    yield confirmed(
        "(59)",
        "V in s and phi",
        witness=EQUALITY,
        terms=lambda: (*equations.potential_59(q), -motion.potential),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(60)", "equation of motion of s", witness=EQUALITY, terms=lambda: equations.eq_60(q), bound=HELD, reason=DRIFT
    )
    yield corrected(
        "(61)",
        "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed",
        witness=EQUALITY,
        printed=lambda: equations.printed_61(q),
        right=lambda: equations.eq_61(q),
        misses_by=1.09,
        bound=HELD,
        reason=DRIFT,
    )


def _limits() -> Iterator[Claim]:
    light, even, heavy = (pendulum(load_mass=0.2 * ratio) for ratio in (1e-6, 1.0, 1e4))
    yield limit(
        "appendix B",
        "m << M: a pendulum in a frame at (g/2) sin(alpha): beyond, m = M; within, m = 1e-6 M",
        witness=REDUCED,
        beyond=lambda: _frequency_of_light_bob(even),
        within=lambda: _frequency_of_light_bob(light),
        misses_by=0.182,
        bound=2e-6,
        reason="m/M = 1e-6",
    )
    yield limit(
        "appendix B",
        "m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M; within, 1e4 M",
        witness=REDUCED,
        beyond=lambda: _frequency_of_heavy_bob(even),
        within=lambda: _frequency_of_heavy_bob(heavy),
        misses_by=0.42,
        bound=2e-4,
        reason="M/m = 1e-4",
    )


def _frequency(scene: Scene, amplitude: float) -> float:
    """Return omega [rad/s], measured over some twenty swings of an amplitude [rad]."""
    return long_swing(scene, scene.equilibrium() + amplitude, 120 / scene.frequency()).frequency()


def _frequency_of_light_bob(scene: Scene) -> Terms:
    """Return the terms of: omega [rad/s] is that of a pendulum whose pivot accelerates like an empty wheel.

    An empty wheel accelerates at (g/2) sin(alpha).
    """
    across, along = math.cos(scene.incline), math.sin(scene.incline) / 2
    return math.sqrt(scene.gravity * math.hypot(across, along) / scene.load.offset), -_frequency(scene, SMALL)


def _frequency_of_heavy_bob(scene: Scene) -> Terms:
    """Return the terms of: omega [rad/s] is that of a light wheel under a bob that hardly moves.

    Such a swing is small only if phi^2 is well below 2M/m.
    """
    ratio = scene.load.mass / (2 * scene.can.mass)
    omega = math.sqrt(scene.gravity * math.cos(scene.incline) * ratio / scene.load.offset)
    return omega, -_frequency(scene, SMALL / math.sqrt(ratio))
