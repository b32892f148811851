"""Rows of the audit: section 2, equations (1)-(24), the accelerations and the instantaneous centre."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import (
    DRIFT,
    EQUALITY,
    EXACT,
    LARGE,
    MODERATE,
    REDUCED,
    ROUNDING,
    SMALL,
    metal,
    still,
    swing,
)
from mjbeer.paper.audit.witness import Witness, watch
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Terms
from mjbeer.paper.scenarios import balanced
from mjbeer.theory.can import Can
from mjbeer.theory.scene import sliding


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _accelerations()
    yield from _centre()
    yield from _lagrange()


def _accelerations() -> Iterator[Claim]:
    yield confirmed(
        "(1)", "s(t) from rest", REDUCED, lambda: equations.eq_1(swing().quantities, swing().time), EXACT,
        "rounding of DOP853",
    )  # fmt: skip
    yield limit(
        "footnote 1", "no friction between can and incline: beyond, the metal can; within, one of a millionth of it",
        EQUALITY, lambda: _unrubbed(metal()), lambda: _unrubbed(_light()), 0.25, 1e-6, "the can's share of the mass",
    )  # fmt: skip
    for k in (1.0, 0.5):
        yield confirmed(
            "footnote 2", f"a cylinder of inertia {k:g} m a^2 has g sin(alpha)/(1 + k)", EQUALITY,
            lambda k=k: _cylinder(k), 1e-7, DRIFT,
        )  # fmt: skip
    yield confirmed(
        "Fig. 1", "at phi = 0 the surface stays parallel to the incline, and u = g sin(alpha) t^2/2", REDUCED,
        lambda: _trivial(_resting()), EXACT, ROUNDING,
    )  # fmt: skip
    yield limit(
        "footnote 6", "sliding beer can be at rest: beyond, at 10 degrees; within, on level ground", REDUCED,
        lambda: _weightless_along(swing()), lambda: _weightless_along(swing(LARGE, 0.0)), 0.174, EXACT, ROUNDING,
    )  # fmt: skip


def _centre() -> Iterator[Claim]:
    yield confirmed(
        "(2)", "torque about the instantaneous centre", REDUCED,
        lambda: equations.eq_2(swing().quantities, _torque(swing())), EXACT, ROUNDING,
    )  # fmt: skip
    yield corrected(
        "Fig. 2", "C moves with the centre of mass along the incline; the caption puts it on a line along the surface",
        REDUCED, lambda: _caption(swing(MODERATE)), lambda: _text(swing(MODERATE)), 0.93, EXACT, ROUNDING,
    )  # fmt: skip
    yield confirmed(
        "(3)", "I_C, exact form", REDUCED, lambda: _spin(swing(), equations.eq_3(swing().quantities)), EXACT, ROUNDING
    )
    yield limit(
        "(3)", "I_C = I_cm: beyond, a swing of 1 rad; within, of 1e-3 rad", REDUCED,
        lambda: _spin(swing(MODERATE), equations.small_3(swing(MODERATE).quantities)),
        lambda: _spin(swing(SMALL), equations.small_3(swing(SMALL).quantities)), 0.095, 1e-6,
        "the amplitude: (m b^2/I_cm) phi^2 = 6e-7",
    )  # fmt: skip
    yield confirmed(
        "(4)", "torque about C, exact form", REDUCED,
        lambda: (*equations.eq_4(swing().quantities), -_torque(swing())), EXACT, ROUNDING,
    )  # fmt: skip
    small = swing(SMALL)
    yield corrected(
        "(4)", "torque about C, linear form: its sign", REDUCED,
        lambda: (*equations.printed_4(small.quantities), -_torque(small)),
        lambda: (*equations.linear_4(small.quantities), -_torque(small)), 2.0, 3e-7, "the amplitude: phi^2/6 = 1.7e-7",
    )  # fmt: skip
    yield limit(
        "(5), (23)", "linear equation of motion: beyond, a swing of 1 rad; within, of 1e-3 rad", REDUCED,
        lambda: equations.eq_5(swing(MODERATE).quantities), lambda: equations.eq_5(small.quantities), 0.40, 1e-6,
        "the amplitude: (1/6 + m b^2/I_cm) phi^2 = 7e-7",
    )  # fmt: skip


def _lagrange() -> Iterator[Claim]:
    q = swing().quantities
    yield confirmed("(11)", "T", REDUCED, lambda: (*equations.kinetic_11(q), -swing().kinetic), EXACT, ROUNDING)
    yield confirmed("(12)", "u = s + b sin(phi)", REDUCED, lambda: equations.eq_12(q), EXACT, ROUNDING)
    yield confirmed(
        "(12), Fig. 3", "theta = alpha + phi", REDUCED,
        lambda: (swing().theta, -q.phi, -np.full_like(q.phi, swing().scene.incline)), EXACT, ROUNDING,
    )  # fmt: skip
    for form, name in enumerate(("u and theta", "s and phi")):
        yield confirmed(
            "(13)", f"z in {name}", REDUCED, lambda form=form: (*equations.height_13(q)[form], -swing().height), EXACT,
            ROUNDING,
        )  # fmt: skip
    yield corrected(
        "(14)", "V, its first form: -mgz for +mgz", REDUCED, lambda: (*equations.printed_14(q), -swing().potential),
        lambda: (*equations.potential_14(q), -swing().potential), 1.92, EXACT, ROUNDING,
    )  # fmt: skip
    yield confirmed("(15)", "s_ddot", REDUCED, lambda: equations.eq_15(q), EXACT, ROUNDING)
    yield confirmed("(16)", "equation of motion of phi", REDUCED, lambda: equations.eq_16(q), EXACT, ROUNDING)
    yield confirmed("(17), (20)", "T", REDUCED, lambda: (*equations.kinetic_17(q), -swing().kinetic), EXACT, ROUNDING)
    yield confirmed(
        "(17), (20)", "V", REDUCED, lambda: (*equations.potential_17(q), -swing().potential), EXACT, ROUNDING
    )
    yield confirmed("(18), (21)", "equation of motion of u", REDUCED, lambda: equations.eq_18(q), EXACT, ROUNDING)
    yield corrected(
        "(19), (22)", "equation of motion of phi or theta: its right side lacks g (in SI units)", REDUCED,
        lambda: equations.printed_19(q), lambda: equations.eq_19(q), 0.61, EXACT, ROUNDING,
    )  # fmt: skip


@cache
def _light() -> Witness:
    can = Can.sheet_metal(thickness=1e-10)
    return watch(sliding(can=can), "equality", 1.0, LARGE)


@cache
def _resting() -> Witness:
    return still(sliding(), "reduced")


def _unrubbed(seen: Witness) -> Terms:
    """The beer and its can are pulled by m g sin(alpha) alone, less F."""
    pull = np.full_like(seen.time, seen.quantities.m * seen.quantities.g * seen.quantities.sin_alpha)
    return pull, -seen.friction, -pull


def _cylinder(k: float) -> Terms:
    q = still(balanced(k), "equality").quantities
    return q.u_ddot, np.full_like(q.u_ddot, -q.g * q.sin_alpha / (1 + k))


def _trivial(seen: Witness) -> Terms:
    """u - g sin(alpha) t^2/2 and, in radians and so far larger, phi."""
    q = seen.quantities
    return q.u, -q.g * q.sin_alpha * seen.time**2 / 2, q.phi


def _weightless_along(seen: Witness) -> Terms:
    g = np.full_like(seen.time, seen.quantities.g)
    return g, seen.quantities.s_ddot, -g


def _torque(seen: Witness) -> np.ndarray:
    """Of the effective gravity about C, below the axis, on its arm as MuJoCo's positions have it [N m]."""
    q = seen.quantities
    return -q.m * q.g * q.cos_alpha * (q.u - q.s)


def _text(seen: Witness) -> Terms:
    """C's velocity across the incline, seen from the centre of mass; along it C has none by itself."""
    q = seen.quantities
    return seen.across[1], -q.phi_dot * (q.u - q.s)


def _caption(seen: Witness) -> Terms:
    """The same, and the velocity along the incline of a C that is b tan(phi) sin(phi) lower, which should be 0."""
    q = seen.quantities
    return *_text(seen), -q.phi_dot * q.b * q.sin_phi**2 / q.cos_phi


def _spin(seen: Witness, inertia: Terms) -> Terms:
    """I_C phi_dot^2/2 with what MuJoCo's kinetic energy has besides m s_dot^2/2."""
    q = seen.quantities
    return *(each * q.phi_dot**2 / 2 for each in inertia), q.m * q.s_dot**2 / 2 - seen.kinetic
