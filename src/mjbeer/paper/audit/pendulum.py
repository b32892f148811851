"""Rows of the audit: appendix B, equations (56)-(61), the wheel with a pendulum."""

import math
from collections.abc import Iterator

from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import DRIFT, EQUALITY, EXACT, HELD, REDUCED, ROUNDING, SMALL, swung, wheel
from mjbeer.paper.equations import pendulum as equations
from mjbeer.paper.letters import Terms
from mjbeer.theory.scene import Scene, pendulum


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _motion()
    yield from _limits()


def _motion() -> Iterator[Claim]:
    seen = wheel()
    q = seen.quantities
    yield corrected(
        "(56)",
        "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2",
        EQUALITY,
        lambda: (*equations.printed_56(q), -seen.kinetic),
        lambda: (*equations.kinetic_56(q), -seen.kinetic),
        0.70,
        HELD,
        DRIFT,
    )
    yield confirmed(
        "(56)", "V in u and theta", EQUALITY, lambda: (*equations.potential_56(q), -seen.potential), EXACT, ROUNDING
    )
    yield confirmed("(57)", "equation of motion of u", EQUALITY, lambda: equations.eq_57(q), HELD, DRIFT)
    yield corrected(
        "(58)", "equation of motion of theta: theta_ddot; printed theta (in SI units)", EQUALITY,
        lambda: equations.printed_58(q, seen.theta), lambda: equations.eq_58(q), 1.12, HELD, DRIFT,
    )  # fmt: skip
    yield corrected(
        "(59)", "T in s and phi: cos^2; printed sin^2", EQUALITY, lambda: (*equations.printed_59(q), -seen.kinetic),
        lambda: (*equations.kinetic_59(q), -seen.kinetic), 0.28, HELD, DRIFT,
    )  # fmt: skip
    yield confirmed(
        "(59)", "V in s and phi", EQUALITY, lambda: (*equations.potential_59(q), -seen.potential), EXACT, ROUNDING
    )
    yield confirmed("(60)", "equation of motion of s", EQUALITY, lambda: equations.eq_60(q), HELD, DRIFT)
    yield corrected(
        "(61)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", EQUALITY,
        lambda: equations.printed_61(q), lambda: equations.eq_61(q), 1.09, HELD, DRIFT,
    )  # fmt: skip


def _limits() -> Iterator[Claim]:
    light, even, heavy = (pendulum(load_mass=0.2 * ratio) for ratio in (1e-6, 1.0, 1e4))
    yield limit(
        "appendix B", "m << M: a pendulum in a frame at (g/2) sin(alpha): beyond, m = M; within, m = 1e-6 M", REDUCED,
        lambda: _as_light(even), lambda: _as_light(light), 0.182, 2e-6, "m/M = 1e-6",
    )  # fmt: skip
    yield limit(
        "appendix B", "m >> M: omega^2 = g cos(alpha) m/(2 M b), without bound: beyond, m = M; within, 1e4 M", REDUCED,
        lambda: _as_heavy(even), lambda: _as_heavy(heavy), 0.42, 2e-4, "M/m = 1e-4",
    )  # fmt: skip


def _measured(scene: Scene, amplitude: float) -> float:
    """omega [rad/s] of a swing, over some twenty of them."""
    return swung(scene, scene.equilibrium() + amplitude, 120 / scene.frequency()).frequency()


def _as_light(scene: Scene) -> Terms:
    """omega [rad/s] of a pendulum on a wheel that accelerates at (g/2) sin(alpha), as if it were empty."""
    across, along = math.cos(scene.incline), math.sin(scene.incline) / 2
    return math.sqrt(scene.gravity * math.hypot(across, along) / scene.load.offset), -_measured(scene, SMALL)


def _as_heavy(scene: Scene) -> Terms:
    """omega [rad/s] of a light wheel under a bob that hardly moves; a swing is small if phi^2 is less than 2M/m."""
    ratio = scene.load.mass / (2 * scene.can.mass)
    omega = math.sqrt(scene.gravity * math.cos(scene.incline) * ratio / scene.load.offset)
    return omega, -_measured(scene, SMALL / math.sqrt(ratio))
