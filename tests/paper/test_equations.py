"""The rows, derived with symbols by Lagrange's equations; a misprint does not follow."""

from functools import cache
from typing import Any

import pytest
import sympy as sp

from mjbeer import paper
from mjbeer.paper import frozen, sliding
from mjbeer.paper.claim import Claim, Observation, Witness, terms, value
from mjbeer.paper.witness import FOOTNOTE_8, METAL, NARROW, ROLL_DOWN, SWING, TENTH, WHEEL, WIDE

a, b, m, inertia, can_mass, can_inertia, g = sp.symbols("a b m I_cm m_can I_can g", positive=True)
alpha, u, u_dot, phi, phi_dot, u_ddot, phi_ddot = sp.symbols(
    "alpha u u_dot phi phi_dot u_ddot phi_ddot", real=True
)
S, C, A, B = sp.symbols("S C A B")
PLAIN = {sp.sin(phi): S, sp.cos(phi): C, sp.sin(alpha): A, sp.cos(alpha): B}
HALF = {can_mass: 0, can_inertia: 0, inertia: m * a**2 / 2 - m * b**2}
ROLLS = {u: a * phi, u_dot: a * phi_dot, u_ddot: a * phi_ddot}
GIVEN = {
    **dict.fromkeys((SWING, WIDE, TENTH, NARROW), HALF),
    METAL: {},
    WHEEL: {can_inertia: can_mass * a**2, inertia: 0},
    **dict.fromkeys((ROLL_DOWN, FOOTNOTE_8), HALF | ROLLS),
}
"""What is special about the scenes of the motions that rows share."""


def slope(value: Any) -> Any:
    """The derivative by time."""
    rates = {u: u_dot, phi: phi_dot, u_dot: u_ddot, phi_dot: phi_ddot}
    return sum(sp.diff(value, coordinate) * rate for coordinate, rate in rates.items())


class Symbols(Observation):
    """Equations name sines and the like, which are those of symbols here."""

    sin = sp.sin
    cos = sp.cos
    pi = sp.pi


def letters() -> Symbols:
    """Symbols for everything.

    The load is at (u - b sin(phi), -b cos(phi)) from where the axis starts; the can turns at
    u_dot/a.
    """
    x = u - b * sp.sin(phi)
    y = -b * sp.cos(phi)
    height = -x * sp.sin(alpha) + y * sp.cos(alpha)
    kinetic = m * (slope(x) ** 2 + slope(y) ** 2) / 2 + inertia * phi_dot**2 / 2
    kinetic += can_mass * u_dot**2 / 2 + can_inertia * (u_dot / a) ** 2 / 2
    return Symbols(
        a=a,
        b=b,
        m=m,
        inertia=inertia,
        can_mass=can_mass,
        can_inertia=can_inertia,
        g=g,
        alpha=alpha,
        u=u,
        u_dot=u_dot,
        u_ddot=u_ddot,
        phi=phi,
        phi_dot=phi_dot,
        phi_ddot=phi_ddot,
        theta=alpha + phi,
        s=x,
        s_dot=slope(x),
        s_ddot=slope(slope(x)),
        across=y,
        across_dot=slope(y),
        height=height,
        kinetic=kinetic,
        potential=m * g * height - can_mass * g * u * sp.sin(alpha),
        rest=sp.symbols("phi_0", real=True),
    )


Q = letters()


@cache
def accelerations(witness: Witness) -> dict:
    """u_ddot and phi_ddot by Lagrange's equations, d/dt dL/d(q_dot) = dL/dq."""
    given = GIVEN[witness]
    lagrangian = (Q.kinetic - Q.potential).subs(given)
    moved = {phi: phi_dot} if u in given else {u: u_dot, phi: phi_dot}
    equations = [
        slope(sp.diff(lagrangian, rate)) - sp.diff(lagrangian, coordinate)
        for coordinate, rate in moved.items()
    ]
    return sp.solve(equations, [u_ddot, phi_ddot][-len(moved) :], dict=True)[0]


def vanishes(whole: Any, witness: Witness) -> bool:
    whole = sp.expand_trig(whole.subs(GIVEN[witness]).subs(accelerations(witness)))
    top = sp.expand(sp.numer(sp.together(whole.subs(PLAIN))))
    return sp.rem(sp.rem(top, S**2 + C**2 - 1, S), A**2 + B**2 - 1, A) == 0


# Eq. (1) holds over time.
DERIVED = [
    row
    for row in paper.claims()
    if row.witness in GIVEN
    and row.limit is None
    and row.equation != "(1)"
    and "linear" not in row.quantity
]


def test_every_equation_of_a_motion_is_derived() -> None:
    named = " ".join(row.equation for row in DERIVED)
    numbers = [2, 3, 4, *range(11, 23), 25, *range(39, 50), 51, 52, *range(56, 62)]
    assert not [number for number in numbers if f"({number})" not in named]


@pytest.mark.costly
@pytest.mark.parametrize("row", DERIVED, ids=lambda row: f"{row.equation} {row.quantity}")
def test_derived(row: Claim) -> None:
    """No term vanishes by itself, so that none can be left out; a misprint does not follow."""
    right = terms(row.residual, Q)
    assert vanishes(sum(right), row.witness)
    for term in right:
        assert not vanishes(term, row.witness)
    if row.misprint:
        assert not vanishes(value(row.printed, Q), row.witness)


@pytest.mark.slow
def test_small_oscillations() -> None:
    """Eqs. (4)-(6), (10), (24): the linear part of (16); eq. (55): that of (52)."""
    x = sp.symbols("x", real=True)
    half = {inertia: HALF[inertia]}
    whole = {b: 4 * a / (3 * sp.pi)}
    squared = -sp.diff(accelerations(SWING)[phi_ddot], phi).subs({phi: 0, phi_dot: 0})
    torque = g * (a * sp.sin(alpha) - b * sp.sin(alpha + Q.rest + x))
    frozen_squared = -torque.diff(x).subs(x, 0) / (3 * a**2 / 2 - 2 * a * b * sp.cos(Q.rest))
    for formula, expected, given, right in (
        (sliding.EQ_6, squared, half, True),
        (sliding.EQ_24, squared, {}, True),
        (sliding.EQ_10, squared, whole, True),
        (sliding.PRINTED_10, squared, whole, False),
        (frozen.EQ_55.format(2), frozen_squared, {}, True),
        (frozen.EQ_55.format(1), frozen_squared, {}, False),
    ):
        assert (sp.simplify((value(formula, Q) - expected).subs(given)) == 0) is right
    (linear,) = (row for row in paper.claims() if row.equation == "(4)" and row.misprint)
    for formula, right in ((linear.residual, True), (linear.printed, False)):
        assert (sp.diff(value(formula, Q), phi).subs(phi, 0) == 0) is right


@pytest.mark.costly
def test_fast_loops() -> None:
    """Eqs. (26)-(29) to first order in delta: J phi_dot^2/2 = E, then with a little potential.

    In the phase psi that sqrt(J) grows with, phi = psi + (delta/4) sin(2 psi), and V = -D cos(phi)
    shifts psi by (D/2E) times the integral of cos(phi). What is left at Omega has 1 - delta/8 from
    the integral and -delta/4 from the shift within sin(2 psi).
    """
    psi, delta, e, w = sp.symbols("psi delta e w", real=True)
    eta = delta / 4
    root = sp.series(sp.sqrt(1 - delta * sp.cos(2 * psi)), delta, 0, 2).removeO()
    assert sp.simplify(sp.integrate(root, (psi, 0, psi)) - (psi - eta * sp.sin(2 * psi))) == 0
    first = sp.series(sp.cos(psi + eta * sp.sin(2 * psi)), delta, 0, 2).removeO()
    shift = sp.integrate(sp.expand_trig(first) * sp.cos(psi), (psi, 0, 2 * sp.pi)) / sp.pi
    assert sp.simplify(shift - (1 - delta / 8)) == 0
    moved = e * shift * sp.sin(w)
    angle = moved + (eta * sp.sin(2 * (w + moved))).series(e, 0, 2).removeO()
    at_omega = sp.integrate(sp.expand_trig(sp.expand(angle)) * sp.sin(w), (w, 0, 2 * sp.pi)) / sp.pi
    assert sp.simplify(sp.series(at_omega / e, delta, 0, 2).removeO() - (1 - 3 * delta / 8)) == 0
    sway = sp.series(sp.sin(w + eta * sp.sin(2 * w)), delta, 0, 2).removeO()
    assert (
        sp.simplify(sp.integrate(sway * sp.sin(w), (w, 0, 2 * sp.pi)) / sp.pi - (1 + delta / 8))
        == 0
    )
