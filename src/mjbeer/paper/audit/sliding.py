"""Claims of section 2, equations (1)-(22): accelerations, the instantaneous centre, and Lagrange's equations."""

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
    equilibrium_motion,
    metal,
    swing,
)
from mjbeer.paper.audit.witness import Witness, watch
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Terms
from mjbeer.paper.scenarios import balanced
from mjbeer.theory.can import Can
from mjbeer.theory.named import sliding


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield from _accelerations()
    yield from _centre()
    yield from _lagrange()


def _accelerations() -> Iterator[Claim]:
    yield confirmed(
        "(1)",
        "s(t) from rest",
        witness=REDUCED,
        terms=lambda: equations.eq_1(swing().quantities, swing().time),
        bound=EXACT,
        reason="rounding of DOP853",
    )
    yield limit(
        "footnote 1",
        "no friction between can and incline: beyond, the metal can; within, one of a ten-thousandth of it",
        witness=EQUALITY,
        beyond=lambda: _frictionless(metal()),
        within=lambda: _frictionless(_light()),
        misses_by=0.25,
        bound=1e-4,
        reason="the can's share of the mass",
    )
    for k in (1.0, 0.5):
        yield confirmed(
            "footnote 2",
            f"a cylinder of inertia {k:g} m a^2 has g sin(alpha)/(1 + k)",
            witness=EQUALITY,
            terms=lambda k=k: _cylinder(k),
            bound=1e-7,
            reason=DRIFT,
        )
    yield confirmed(
        "Fig. 1",
        "at phi = 0 the surface stays parallel to the incline, and u = g sin(alpha) t^2/2",
        witness=REDUCED,
        terms=lambda: _parallel_surface(_resting()),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield limit(
        "footnote 6",
        "sliding beer can be at rest: beyond, at 10 degrees; within, on level ground",
        witness=REDUCED,
        beyond=lambda: _at_rest(swing()),
        within=lambda: _at_rest(swing(LARGE, 0.0)),
        misses_by=0.174,
        bound=EXACT,
        reason=ROUNDING,
    )


def _centre() -> Iterator[Claim]:
    yield confirmed(
        "(2)",
        "torque about the instantaneous centre",
        witness=REDUCED,
        terms=lambda: equations.eq_2(swing().quantities, _torque(swing())),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield corrected(
        "Fig. 2",
        "C moves with the centre of mass along the incline; the caption puts it on a line along the surface",
        witness=REDUCED,
        printed=lambda: _centre_as_in_caption(swing(MODERATE)),
        right=lambda: _centre_as_in_text(swing(MODERATE)),
        misses_by=0.93,
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(3)",
        "I_C, exact form",
        witness=REDUCED,
        terms=lambda: _spin_energy(swing(), equations.eq_3(swing().quantities)),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield limit(
        "(3)",
        "I_C = I_cm: beyond, a swing of 1 rad; within, of 1e-3 rad",
        witness=REDUCED,
        beyond=lambda: _spin_energy(swing(MODERATE), equations.small_3(swing(MODERATE).quantities)),
        within=lambda: _spin_energy(swing(SMALL), equations.small_3(swing(SMALL).quantities)),
        misses_by=0.095,
        bound=1e-6,
        reason="the amplitude: (m b^2/I_cm) phi^2 = 6e-7",
    )
    yield confirmed(
        "(4)",
        "torque about C, exact form",
        witness=REDUCED,
        terms=lambda: (*equations.eq_4(swing().quantities), -_torque(swing())),
        bound=EXACT,
        reason=ROUNDING,
    )
    small = swing(SMALL)
    yield corrected(
        "(4)",
        "torque about C, linear form: its sign",
        witness=REDUCED,
        printed=lambda: (*equations.printed_4(small.quantities), -_torque(small)),
        right=lambda: (*equations.linear_4(small.quantities), -_torque(small)),
        misses_by=2.0,
        bound=3e-7,
        reason="the amplitude: phi^2/6 = 1.7e-7",
    )
    yield limit(
        "(5), (23)",
        "linear equation of motion: beyond, a swing of 1 rad; within, of 1e-3 rad",
        witness=REDUCED,
        beyond=lambda: equations.eq_5(swing(MODERATE).quantities),
        within=lambda: equations.eq_5(small.quantities),
        misses_by=0.40,
        bound=1e-6,
        reason="the amplitude: (1/6 + m b^2/I_cm) phi^2 = 7e-7",
    )


def _lagrange() -> Iterator[Claim]:
    q = swing().quantities
    yield confirmed(
        "(11)",
        "T",
        witness=REDUCED,
        terms=lambda: (*equations.kinetic_11(q), -swing().kinetic),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(12)", "u = s + b sin(phi)", witness=REDUCED, terms=lambda: equations.eq_12(q), bound=EXACT, reason=ROUNDING
    )
    yield confirmed(
        "(12), Fig. 3",
        "theta = alpha + phi",
        witness=REDUCED,
        terms=lambda: (swing().theta, -q.phi, -np.full_like(q.phi, swing().scene.incline)),
        bound=EXACT,
        reason=ROUNDING,
    )
    for form, name in enumerate(("u and theta", "s and phi")):
        yield confirmed(
            "(13)",
            f"z in {name}",
            witness=REDUCED,
            terms=lambda form=form: (*equations.height_13(q)[form], -swing().height),
            bound=EXACT,
            reason=ROUNDING,
        )
    yield corrected(
        "(14)",
        "V, its first form: -mgz for +mgz",
        witness=REDUCED,
        printed=lambda: (*equations.printed_14(q), -swing().potential),
        right=lambda: (*equations.potential_14(q), -swing().potential),
        misses_by=1.92,
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed("(15)", "s_ddot", witness=REDUCED, terms=lambda: equations.eq_15(q), bound=EXACT, reason=ROUNDING)
    yield confirmed(
        "(16)",
        "equation of motion of phi",
        witness=REDUCED,
        terms=lambda: equations.eq_16(q),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(17), (20)",
        "T",
        witness=REDUCED,
        terms=lambda: (*equations.kinetic_17(q), -swing().kinetic),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(17), (20)",
        "V",
        witness=REDUCED,
        terms=lambda: (*equations.potential_17(q), -swing().potential),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(18), (21)",
        "equation of motion of u",
        witness=REDUCED,
        terms=lambda: equations.eq_18(q),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield corrected(
        "(19), (22)",
        "equation of motion of phi or theta: its right side lacks g (in SI units)",
        witness=REDUCED,
        printed=lambda: equations.printed_19(q),
        right=lambda: equations.eq_19(q),
        misses_by=0.61,
        bound=EXACT,
        reason=ROUNDING,
    )


@cache
def _light() -> Witness:
    """Return a swing in a can of a ten-thousandth of the metal can's mass."""
    can = Can.sheet_metal(thickness=1e-8)
    return watch(sliding(can=can), "equality", 1.0, LARGE)


@cache
def _resting() -> Witness:
    """Return a second of beer that starts at its equilibrium, phi = 0."""
    return equilibrium_motion(sliding(), "reduced")


def _frictionless(motion: Witness) -> Terms:
    """Return the terms [N] of F = 0; m g sin(alpha), added and subtracted, sets the scale of the error."""
    pull = np.full_like(motion.time, motion.quantities.m * motion.quantities.g * motion.quantities.sin_alpha)
    return pull, -motion.friction, -pull


def _cylinder(k: float) -> Terms:
    """Return the terms of u_ddot = g sin(alpha)/(1 + k) [m/s^2], for a cylinder of inertia k m a^2."""
    q = equilibrium_motion(balanced(k), "equality").quantities
    return q.u_ddot, np.full_like(q.u_ddot, -q.g * q.sin_alpha / (1 + k))


def _parallel_surface(motion: Witness) -> Terms:
    """Return the terms of u = g sin(alpha) t^2/2 [m], and phi [rad], which must stay zero as well."""
    q = motion.quantities
    return q.u, -q.g * q.sin_alpha * motion.time**2 / 2, q.phi


def _at_rest(motion: Witness) -> Terms:
    """Return the terms of s_ddot = 0 [m/s^2]; g, added and subtracted, sets the scale of the error."""
    g = np.full_like(motion.time, motion.quantities.g)
    return g, motion.quantities.s_ddot, -g


def _torque(motion: Witness) -> np.ndarray:
    """Return the torque of gravity about C, with the lever arm u - s of MuJoCo's positions [N m]."""
    q = motion.quantities
    return -q.m * q.g * q.cos_alpha * (q.u - q.s)


def _centre_as_in_text(motion: Witness) -> Terms:
    """Return the terms [m/s] of: the centre of mass moves across the incline at phi_dot (u - s): it turns about C."""
    q = motion.quantities
    return motion.across[1], -q.phi_dot * (q.u - q.s)


def _centre_as_in_caption(motion: Witness) -> Terms:
    """Return the same terms, and the velocity along the incline that turning about the caption's C would add.

    The caption puts C lower by b tan(phi) sin(phi).
    """
    q = motion.quantities
    return *_centre_as_in_text(motion), -q.phi_dot * q.b * q.sin_phi**2 / q.cos_phi


def _spin_energy(motion: Witness, inertia: Terms) -> Terms:
    """Return the terms [J] of: I_C phi_dot^2/2 is MuJoCo's kinetic energy less m s_dot^2/2."""
    q = motion.quantities
    return *(term * q.phi_dot**2 / 2 for term in inertia), q.m * q.s_dot**2 / 2 - motion.kinetic
