"""The equations of the claims, derived by Lagrange's equations; a misprint does not follow."""

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
"""What holds in the scene of each motion that claims share: no can, a half cylinder, rolling."""


def slope(value: Any) -> Any:
    """Return the derivative with respect to time."""
    rates = {u: u_dot, phi: phi_dot, u_dot: u_ddot, phi_dot: phi_ddot}
    return sum(sp.diff(value, coordinate) * rate for coordinate, rate in rates.items())


class Symbols(Observation):
    """The symbols in equations, with the functions of SymPy for those of NumPy."""

    sin = sp.sin
    cos = sp.cos
    pi = sp.pi


def letters() -> Symbols:
    """Return a symbol or an expression for every name in an equation.

    The load is at (u - b sin(phi), -b cos(phi)), seen from where the axis starts, and the can turns
    at u_dot/a.
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
    """Return u_ddot and phi_ddot by Lagrange's equations, d/dt dL/d(q_dot) = dL/dq."""
    given = GIVEN[witness]
    lagrangian = (Q.kinetic - Q.potential).subs(given)
    moved = {phi: phi_dot} if u in given else {u: u_dot, phi: phi_dot}
    equations = [
        slope(sp.diff(lagrangian, rate)) - sp.diff(lagrangian, coordinate)
        for coordinate, rate in moved.items()
    ]
    unknowns = [phi_ddot] if u in given else [u_ddot, phi_ddot]
    (solution,) = sp.solve(equations, unknowns, dict=True)
    return solution


def vanishes(expression: Any, witness: Witness) -> bool:
    """Whether an expression is zero for every motion of a witness's scene.

    Sines and cosines become letters, so that the numerator is a polynomial in them.
    """
    moving = sp.expand_trig(expression.subs(GIVEN[witness]).subs(accelerations(witness)))
    numerator = sp.expand(sp.numer(sp.together(moving.subs(PLAIN))))
    without_s = sp.rem(numerator, S**2 + C**2 - 1, S)
    return sp.rem(without_s, A**2 + B**2 - 1, A) == 0


# Eq. (1) is about a time since the start, and a linear equation is only near the truth.
DERIVED = [
    claim
    for claim in paper.claims()
    if claim.witness in GIVEN
    and claim.limit is None
    and claim.equation != "(1)"
    and "linear" not in claim.quantity
]


def test_every_equation_of_a_motion_is_derived() -> None:
    named = " ".join(claim.equation for claim in DERIVED)
    numbers = [2, 3, 4, *range(11, 23), 25, *range(39, 50), 51, 52, *range(56, 62)]
    assert not [number for number in numbers if f"({number})" not in named]


@pytest.mark.costly
@pytest.mark.parametrize("claim", DERIVED, ids=lambda claim: f"{claim.equation} {claim.quantity}")
def test_derived(claim: Claim) -> None:
    """No term vanishes by itself, so none can be left out; a misprint does not follow."""
    right = terms(claim.residual, Q)

    assert vanishes(sum(right), claim.witness)
    for term in right:
        assert not vanishes(term, claim.witness)
    if claim.misprint:
        assert not vanishes(value(claim.printed, Q), claim.witness)


def is_value_of(formula: str, expected: Any, given: dict[Any, Any]) -> bool:
    """Whether a formula has an expected value where some symbols are `given`."""
    return sp.simplify((value(formula, Q) - expected).subs(given)) == 0


@pytest.mark.slow
def test_frequencies_of_sliding_beer() -> None:
    """Eqs. (6), (10) and (24) follow from the linear part of (16)."""
    omega_squared = -sp.diff(accelerations(SWING)[phi_ddot], phi).subs({phi: 0, phi_dot: 0})
    half_cylinder = {b: 4 * a / (3 * sp.pi)}
    assert is_value_of(sliding.EQ_6, omega_squared, {inertia: HALF[inertia]})
    assert is_value_of(sliding.EQ_24, omega_squared, {})
    assert is_value_of(sliding.EQ_10, omega_squared, half_cylinder)
    assert not is_value_of(sliding.PRINTED_10, omega_squared, half_cylinder)


@pytest.mark.slow
def test_frequency_of_frozen_beer() -> None:
    """Eq. (55) follows from the linear part of (52)."""
    x = sp.symbols("x", real=True)
    torque = g * (a * sp.sin(alpha) - b * sp.sin(alpha + Q.rest + x))
    effective_inertia = 3 * a**2 / 2 - 2 * a * b * sp.cos(Q.rest)
    omega_squared = -torque.diff(x).subs(x, 0) / effective_inertia
    assert is_value_of(frozen.EQ_55.format(2), omega_squared, {})
    assert not is_value_of(frozen.EQ_55.format(1), omega_squared, {})


def test_linear_torque_about_c() -> None:
    """Eq. (4) has the slope of its exact form, and as printed it has not."""
    (linear,) = (claim for claim in paper.claims() if claim.equation == "(4)" and claim.misprint)
    assert sp.diff(value(linear.residual, Q), phi).subs(phi, 0) == 0
    assert sp.diff(value(linear.printed, Q), phi).subs(phi, 0) != 0


def first_order(expression: Any, small: sp.Symbol) -> Any:
    """Return an expression to first order in a small symbol."""
    return sp.series(expression, small, 0, 2).removeO()


def amplitude(expression: Any, angle: sp.Symbol) -> Any:
    """Return the amplitude of sin(angle) in an expression, by Fourier's integral."""
    product = sp.expand_trig(sp.expand(expression)) * sp.sin(angle)
    return sp.integrate(product, (angle, 0, 2 * sp.pi)) / sp.pi


@pytest.mark.costly
def test_fast_loops() -> None:
    """Eqs. (26)-(29) to first order in delta.

    Without a potential J phi_dot^2/2 = E, with J in proportion to 1 - delta cos(2 phi), and phi is
    psi + (delta/4) sin(2 psi) in a phase psi that grows evenly. A potential -D cos(phi) shifts psi
    by e = D/(2E) times the integral of cos(phi).
    """
    psi, delta, e, w = sp.symbols("psi delta e w", real=True)
    eta = delta / 4

    root_of_j = first_order(sp.sqrt(1 - delta * sp.cos(2 * psi)), delta)
    phase = sp.integrate(root_of_j, (psi, 0, psi))
    assert sp.simplify(phase - (psi - eta * sp.sin(2 * psi))) == 0

    cosine = sp.expand_trig(first_order(sp.cos(psi + eta * sp.sin(2 * psi)), delta))
    shift = sp.integrate(cosine * sp.cos(psi), (psi, 0, 2 * sp.pi)) / sp.pi
    assert sp.simplify(shift - (1 - delta / 8)) == 0

    # The ripple of phi at Omega: 1 - delta/8 from the shift, -delta/4 from that within sin(2 psi).
    shifted = e * shift * sp.sin(w)
    ripple = shifted + first_order(eta * sp.sin(2 * (w + shifted)), e)
    assert sp.simplify(first_order(amplitude(ripple, w) / e, delta) - (1 - 3 * delta / 8)) == 0

    # The ripple of u at Omega, divided by b.
    sway = first_order(sp.sin(w + eta * sp.sin(2 * w)), delta)
    assert sp.simplify(amplitude(sway, w) - (1 + delta / 8)) == 0
