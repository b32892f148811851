"""Rows of the audit: section 3, equations (39)-(49), the massive can."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import DRIFT, EQUALITY, EXACT, HELD, ROUNDING, metal, still
from mjbeer.paper.audit.witness import Witness
from mjbeer.paper.equations import massive_can
from mjbeer.paper.equations.sliding import kinetic_11, potential_14, potential_17
from mjbeer.paper.letters import Letters, Terms
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene, sliding


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _energies()
    yield from _motion()
    yield from _steady()


def _energies() -> Iterator[Claim]:
    seen = metal()
    q = seen.quantities
    yield corrected(
        "sec. 3.1", "phi = theta - alpha; printed theta + alpha", EQUALITY,
        lambda: (q.phi, -seen.theta, -np.full_like(q.phi, seen.scene.incline)),
        lambda: (q.phi, -seen.theta, np.full_like(q.phi, seen.scene.incline)), 0.16, EXACT, ROUNDING,
    )  # fmt: skip
    beer = tuple(-each for each in kinetic_11(q))
    yield confirmed(
        "(39)", "T_can in u", EQUALITY, lambda: (*massive_can.kinetic_39(q), _can_energy(seen)), HELD, DRIFT
    )
    yield corrected(
        "(39)",
        "T_can in s and phi: its last term has cos^2; printed sin^2",
        EQUALITY,
        lambda: (*massive_can.printed_39(q), _can_energy(seen)),
        lambda: (*massive_can.expanded_39(q), _can_energy(seen)),
        0.060,
        HELD,
        DRIFT,
    )
    for form, name in enumerate(("u", "s and phi")):
        yield confirmed(
            "(40)",
            f"V_can in {name}",
            EQUALITY,
            lambda form=form: (*massive_can.potential_40(q)[form], *(potential_14(q)), -seen.potential),
            EXACT,
            ROUNDING,
        )
    x, y = massive_can.position_41(q)
    yield confirmed("(41)", "x of the beer's centre of mass", EQUALITY, lambda: (*x, -q.s), EXACT, ROUNDING)
    yield confirmed("(41)", "y of the beer's centre of mass", EQUALITY, lambda: (*y, -seen.across[0]), EXACT, ROUNDING)
    along, across = massive_can.velocity_42(q)
    yield corrected(
        "(42)",
        "x_dot = s_dot; printed s_dot^2 (in SI units)",
        EQUALITY,
        lambda: (*massive_can.printed_42(q), *_less(along)),
        lambda: (q.s_dot, *_less(along)),
        0.39,
        EXACT,
        ROUNDING,
    )
    yield confirmed("(42)", "y_dot", EQUALITY, lambda: (*across, -seen.across[1]), EXACT, ROUNDING)
    speed = q.s_dot**2 + seen.across[1] ** 2
    for form, name in enumerate(("u and theta", "s and phi")):
        yield confirmed(
            "(43)", f"v_beer^2 in {name}", EQUALITY, lambda form=form: (*massive_can.speed_43(q)[form], -speed), EXACT,
            ROUNDING,
        )  # fmt: skip
    whole = -seen.kinetic, *massive_can.kinetic_39(q)
    yield confirmed(
        "(44)", "T_beer in u and theta", EQUALITY, lambda: (*massive_can.kinetic_44(q), *whole), HELD, DRIFT
    )
    yield confirmed("(44)", "T_beer in s and phi", EQUALITY, lambda: (*_less(beer), *whole), HELD, DRIFT)
    for name, form in (("u and theta", potential_17), ("s and phi", potential_14)):
        yield confirmed(
            "(45)", f"V_beer in {name}", EQUALITY,
            lambda form=form: (*form(q), *massive_can.potential_40(q)[0], -seen.potential), EXACT, ROUNDING,
        )  # fmt: skip


def _motion() -> Iterator[Claim]:
    q = metal().quantities
    yield confirmed("(46)", "equation of motion of u", EQUALITY, lambda: massive_can.eq_46(q), HELD, DRIFT)
    yield corrected(
        "(47)", "equation of motion of theta: I_axis; printed m a^2 (for m a^2/2 of a half can)", EQUALITY,
        lambda: massive_can.printed_47(q), lambda: massive_can.eq_47(q), 0.50, HELD, DRIFT,
    )  # fmt: skip
    yield confirmed("(48)", "equation of motion of s", EQUALITY, lambda: massive_can.eq_48(q), HELD, DRIFT)
    yield corrected(
        "(49)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed", EQUALITY,
        lambda: massive_can.printed_49(q), lambda: massive_can.eq_49(q), 0.059, HELD, DRIFT,
    )  # fmt: skip


def _steady() -> Iterator[Claim]:
    full, light = sliding(can=Can.sheet_metal()), sliding(fill=1e-4, can=Can.hoop(mass=0.05))
    yield confirmed(
        "footnote 4", "acceleration of a can whose beer does not swing", EQUALITY,
        lambda: _accelerates(full, massive_can.footnote_4(Letters.of(full))), HELD, DRIFT,
    )  # fmt: skip
    yield limit(
        "footnote 4", "the same with I_can = m_can a^2: beyond, the metal can; within, a hoop", EQUALITY,
        lambda: _accelerates(full, massive_can.hoop_footnote_4(Letters.of(full))),
        lambda: _accelerates(light, massive_can.hoop_footnote_4(Letters.of(light))), 4.2e-3, 1e-7, DRIFT,
    )  # fmt: skip
    nearly = sliding(fill=1e-4, can=Can.sheet_metal())
    yield limit(
        "sec. 3.1", "(g/2) sin(alpha) of a nearly empty can: beyond, of sheet metal; within, a hoop", EQUALITY,
        lambda: _accelerates(nearly, nearly.gravity * Letters.of(nearly).sin_alpha / 2),
        lambda: _accelerates(light, light.gravity * Letters.of(light).sin_alpha / 2), 0.054, 1e-4,
        "what beer is left (fill 1e-4)",
    )  # fmt: skip
    yield confirmed(
        "sec. 3.1", "tilt of the beer that does not swing, which the paper leaves open", EQUALITY,
        lambda: _tilted(full), HELD, DRIFT,
    )  # fmt: skip


@cache
def _still(scene: Scene) -> Witness:
    return still(scene, EQUALITY.split()[-1])


def _can_energy(seen: Witness) -> np.ndarray:
    """Less the kinetic energy [J] that MuJoCo has besides the beer's."""
    return sum(kinetic_11(seen.quantities)) - seen.kinetic


def _less(terms: Terms) -> Terms:
    return tuple(-each for each in terms)


def _accelerates(scene: Scene, expected: float) -> Terms:
    u_ddot = _still(scene).quantities.u_ddot
    return u_ddot, np.full_like(u_ddot, -expected)


def _tilted(scene: Scene) -> Terms:
    """tan(phi), which stays what it is, is that of the closed form."""
    q = _still(scene).quantities
    return q.sin_phi / q.cos_phi, np.full_like(q.phi, -massive_can.tilt(Letters.of(scene)))
