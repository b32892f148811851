"""The paper's equations, derived: from positions to energies to Lagrange's equations, with symbols."""

import dataclasses
from collections.abc import Callable

import pytest
import sympy as sp

from mjbeer.paper.equations import frozen as equations
from mjbeer.paper.equations import massive_can, pendulum, sliding
from mjbeer.paper.letters import Quantities, Terms

t = sp.Symbol("t")
a, b, m, inertia, can_mass, can_inertia, g = sp.symbols("a b m I_cm m_can I_can g", positive=True)
alpha = sp.Symbol("alpha", real=True)
phi, s_of, u_of = (sp.Function(each)(t) for each in ("phi", "s", "u"))


def quantities(coordinate: str) -> Quantities:
    """Symbols for everything, with s or u as the coordinate and the other from u = s + b sin(phi), Fig. 3."""
    s = s_of if coordinate == "s" else u_of - b * sp.sin(phi)
    u = s + b * sp.sin(phi)
    return Quantities(
        a, b, m, inertia, can_mass, can_inertia, g, sp.sin(alpha), sp.cos(alpha),
        s, s.diff(t), s.diff(t, 2), u, u.diff(t), u.diff(t, 2), phi, phi.diff(t), phi.diff(t, 2),
        sp.sin(phi), sp.cos(phi), sp.sin(alpha + phi), sp.cos(alpha + phi),
    )  # fmt: skip


def energies(q: Quantities) -> tuple[sp.Expr, sp.Expr]:
    """T and V of can and load from where they are: the load at (u - b sin(phi), -b cos(phi)) from the incline's axis.

    The can rolls: it turns at u_dot/a.
    """
    x, y = q.u - b * sp.sin(phi), -b * sp.cos(phi)
    kinetic = m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 + inertia * phi.diff(t) ** 2 / 2
    kinetic += can_mass * q.u.diff(t) ** 2 / 2 + can_inertia * (q.u.diff(t) / a) ** 2 / 2
    potential = m * g * (-x * sp.sin(alpha) + y * sp.cos(alpha)) - can_mass * g * q.u * sp.sin(alpha)
    return kinetic, potential


def lagrange(coordinate: sp.Expr, kinetic: sp.Expr, potential: sp.Expr) -> sp.Expr:
    """d/dt dL/d(q_dot) - dL/dq."""
    lagrangian = kinetic - potential
    return lagrangian.diff(coordinate.diff(t)).diff(t) - lagrangian.diff(coordinate)


def same(terms: Terms, expected: sp.Expr, given: dict | None = None) -> bool:
    return sp.simplify(sp.expand_trig((sum(terms) - expected).subs(given or {}).doit())) == 0


MASSLESS = {can_mass: 0, can_inertia: 0}
HALF = {**MASSLESS, inertia: m * a**2 / 2 - m * b**2}
WHEEL = {can_inertia: can_mass * a**2, inertia: 0}


@pytest.mark.parametrize(
    ("form", "wrong", "coordinate", "along", "given", "scale"),
    [
        (sliding.eq_15, None, "s", "s", MASSLESS, m),
        (sliding.eq_16, None, "s", "phi", MASSLESS, 1),
        (sliding.eq_18, None, "u", "u", HALF, m),
        (sliding.eq_19, sliding.printed_19, "u", "phi", HALF, m),
        (massive_can.eq_46, None, "u", "u", {}, 1),
        (massive_can.eq_47, massive_can.printed_47, "u", "phi", {}, 1),
        (massive_can.eq_48, None, "s", "s", {}, 1),
        (massive_can.eq_49, massive_can.printed_49, "s", "phi", {}, 1),
        (pendulum.eq_57, None, "u", "u", WHEEL, 1),
        (pendulum.eq_58, None, "u", "phi", WHEEL, 1),
        (pendulum.eq_60, None, "s", "s", WHEEL, 1),
        (pendulum.eq_61, pendulum.printed_61, "s", "phi", WHEEL, 1),
    ],
)
def test_equations_of_motion(
    form: Callable[[Quantities], Terms],
    wrong: Callable[[Quantities], Terms] | None,
    coordinate: str,
    along: str,
    given: dict,
    scale: sp.Expr,
) -> None:
    q = quantities(coordinate)
    kinetic, potential = energies(q)
    moved = {"s": s_of, "u": u_of, "phi": phi}[along]
    derived = lagrange(moved, kinetic, potential)
    assert same(tuple(scale * each for each in form(q)), derived, given)
    if wrong is not None:
        assert not same(tuple(scale * each for each in wrong(q)), derived, given)


def test_the_printed_58_is_no_equation_of_motion() -> None:
    q = quantities("u")
    derived = lagrange(phi, *energies(q))
    assert not same(pendulum.printed_58(q, alpha + phi), derived, WHEEL)


@pytest.mark.parametrize(
    ("form", "wrong", "coordinate", "given", "which"),
    [
        (sliding.kinetic_11, None, "s", MASSLESS, 0),
        (sliding.kinetic_17, None, "u", HALF, 0),
        (sliding.potential_14, sliding.printed_14, "s", MASSLESS, 1),
        (sliding.potential_17, None, "u", MASSLESS, 1),
        (massive_can.kinetic_44, None, "u", MASSLESS, 0),
        (pendulum.kinetic_56, pendulum.printed_56, "u", WHEEL, 0),
        (pendulum.potential_56, None, "u", WHEEL, 1),
        (pendulum.kinetic_59, pendulum.printed_59, "s", WHEEL, 0),
        (pendulum.potential_59, None, "s", WHEEL, 1),
    ],
)
def test_energies(
    form: Callable[[Quantities], Terms],
    wrong: Callable[[Quantities], Terms] | None,
    coordinate: str,
    given: dict,
    which: int,
) -> None:
    q = quantities(coordinate)
    derived = energies(q)[which]
    assert same(form(q), derived, given)
    if wrong is not None:
        assert not same(wrong(q), derived, given)


def test_the_can_alone() -> None:
    """Eqs. (39) and (40): of u_dot^2, with u = s + b sin(phi)."""
    q = quantities("s")
    load = {m: 0, inertia: 0}
    kinetic, potential = (each.subs(load) for each in energies(q))
    assert same(massive_can.kinetic_39(q), kinetic)
    assert same(massive_can.expanded_39(q), kinetic)
    assert not same(massive_can.printed_39(q), kinetic)
    assert all(same(each, potential) for each in massive_can.potential_40(q))


def test_positions_and_rates_of_the_load() -> None:
    """Eqs. (12), (13) and (41)-(43), from Fig. 3."""
    q = quantities("u")
    x, y = u_of - b * sp.sin(phi), -b * sp.cos(phi)
    assert same(sliding.eq_12(q), sp.Integer(0))
    assert all(same(each, -x * sp.sin(alpha) + y * sp.cos(alpha)) for each in sliding.height_13(q))
    for form, coordinate in zip(massive_can.position_41(q), (x, y), strict=True):
        assert same(form, coordinate)
    for form, coordinate in zip(massive_can.velocity_42(q), (x, y), strict=True):
        assert same(form, coordinate.diff(t))
    assert not same(massive_can.printed_42(q), x.diff(t))
    assert all(same(each, x.diff(t) ** 2 + y.diff(t) ** 2) for each in massive_can.speed_43(q))


def test_the_frozen_can() -> None:
    """Eqs. (51) and (52): one coordinate, by u = a phi; and footnote 8, which is not (52)."""
    q = quantities("u")
    rolls = {u_of: a * phi}
    kinetic, potential = (each.subs(HALF).subs(rolls).doit() for each in energies(q))
    derived = lagrange(phi, kinetic, potential)
    assert same(equations.kinetic_51(q), kinetic, rolls)
    assert same(equations.potential_51(q), potential, rolls)
    assert same(tuple(m * each for each in equations.eq_52(q)), derived, rolls)
    assert not same(tuple(m * each / 100**2 for each in equations.footnote_8(q)), derived, rolls)


def test_the_massive_can_becomes_the_massless_one() -> None:
    """Below eq. (49); but (47) as printed does not become (22)."""
    q = quantities("u")
    light = dataclasses.replace(q, can_mass=0, can_inertia=0, inertia=m * a**2 / 2 - m * b**2)
    assert same(massive_can.eq_47(light), m * sum(sliding.eq_19(q)))
    assert not same(massive_can.printed_47(light), m * sum(sliding.eq_19(q)))


def test_torque_about_the_instantaneous_centre() -> None:
    """Eqs. (2)-(4) give (16)."""
    q = quantities("s")
    (torque,) = sliding.eq_4(q)
    assert same(sliding.eq_2(q, torque), sum(sliding.eq_16(q)))
    held = sum(sliding.eq_3(q))
    assert same((held * phi.diff(t, 2), held.diff(t) * phi.diff(t) / 2, -torque), sum(sliding.eq_16(q)))


def test_small_oscillations() -> None:
    """Eqs. (5), (6), (10), (24): the linear part of (16); eq. (55): that of (52)."""
    x, rest = sp.symbols("x phi_0", real=True)
    c = quantities("s")
    half = {inertia: m * a**2 / 2 - m * b**2}
    whole = 4 * a / (3 * sp.pi)
    assert sp.simplify((sliding.eq_6(c) - sliding.eq_24(c)).subs(half)) == 0
    assert sp.simplify(sliding.eq_24(c).subs(b, whole) - sliding.eq_10(c, sp.pi)) == 0
    assert sp.simplify(sliding.eq_24(c).subs(b, whole) - sliding.printed_10(c, sp.pi)) != 0
    torque = g * (a * sp.sin(alpha) - b * sp.sin(alpha + rest + x))
    resists = 3 * a**2 / 2 - 2 * a * b * sp.cos(rest)
    squared = -torque.diff(x).subs(x, 0) / resists
    assert sp.simplify(sp.nsimplify(equations.eq_55(c, sp.cos(rest), sp.cos(alpha + rest))) - squared) == 0
    assert sp.simplify(sp.nsimplify(equations.printed_55(c, sp.cos(rest), sp.cos(alpha + rest))) - squared) != 0


def test_taylor_54() -> None:
    x, rest = sp.symbols("x phi_0", real=True)
    first = sp.sin(alpha + rest + x).diff(x).subs(x, 0) * x
    assert sp.simplify(equations.sine_54(sp.cos(alpha + rest), x) - first) == 0
    assert sp.simplify(equations.printed_54(sp.cos(alpha + rest), x) - first) != 0
    assert sp.simplify(equations.cosine_54(sp.sin(rest), x) - sp.cos(rest + x).diff(x).subs(x, 0) * x) == 0


def test_squares_25() -> None:
    """sin^2 = (1 - cos 2)/2, so that the ripple at 2 omega has the coefficient phi_0^2/4, not phi_0^2/2."""
    x = sp.Symbol("x", real=True)
    exactly = sp.nsimplify(sum(sliding.squares_25(sp.sin(x), sp.cos(2 * x))))
    printed = sp.nsimplify(sum(sliding.printed_squares_25(sp.sin(x), sp.cos(2 * x))))
    assert sp.simplify(exactly) == 0
    assert sp.simplify(printed) != 0


@pytest.mark.slow
def test_fast_loops() -> None:
    """Eqs. (26)-(29) to first order in delta: J phi_dot^2/2 = E, then with a little potential.

    In the phase psi that sqrt(J) grows with, phi = psi + (delta/4) sin(2 psi), and V = -D cos(phi) shifts psi by
    (D/2E) times the integral of cos(phi). What is left at Omega has 1 - delta/8 from the integral and -delta/4 from
    the shift within sin(2 psi).
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
    assert sp.simplify(sp.integrate(sway * sp.sin(w), (w, 0, 2 * sp.pi)) / sp.pi - (1 + delta / 8)) == 0
