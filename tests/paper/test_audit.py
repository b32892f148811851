"""The audit: every equation has its row, every row passes, and each would fail on a misprint or a broken form."""

import dataclasses
import re
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer.paper.audit import chapters
from mjbeer.paper.audit.claim import CONFIRMED, CORRECTED, LIMIT, Claim, Finding, miss
from mjbeer.paper.audit.motions import EXACT, HELD, footnote, metal, rolling_down, swing, wheel
from mjbeer.paper.audit.witness import Witness, examine
from mjbeer.paper.equations import frozen, massive_can, pendulum
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Quantities, Terms
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.named import sliding

CLAIMS = chapters.claims()
NAMES = [f"{claim.equation} {claim.quantity}" for claim in CLAIMS]
BROKEN = 0.01
"""What a term of a broken form is off by, or twenty bounds where these are wide."""


@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_row(claim: Claim) -> None:
    finding = claim.measure()
    assert finding.passed, f"{finding.printed}, {finding.right} for {finding.misses_by} and {finding.bound}"


def test_every_equation_has_a_row() -> None:
    numbers = {int(each) for claim in CLAIMS for each in re.findall(r"\((\d+)\)", claim.equation)}
    assert numbers == set(range(1, 62))


def test_every_footnote_with_a_claim_and_every_figure_with_data_has_a_row() -> None:
    """Footnotes 3 and 5 only name things; of the figures, 1 and 2 state something that can be false."""
    named = " ".join(claim.equation for claim in CLAIMS)
    assert {int(each) for each in re.findall(r"footnote (\d+)", named)} == {1, 2, 4, 6, 7, 8, 9, 10}
    for each in ("Fig. 1", "Fig. 2", "Fig. 3", "figure of (36)", "figure of (37)", "figure of A.3"):
        assert each in named


def test_every_misprint_says_what_it_misses_by() -> None:
    for claim in CLAIMS:
        assert claim.verdict in {CONFIRMED, CORRECTED, LIMIT}
        assert (claim.verdict == CONFIRMED) == (claim.right is None) == (claim.misses_by is None)
        assert claim.misses_by is None or claim.misses_by > 5 * claim.bound


@pytest.mark.parametrize("claim", [each for each in CLAIMS if each.right is not None])
def test_a_misprint_that_is_none_is_found_out(claim: Claim) -> None:
    """The row would fail if the printed form were right, and if the right form were the printed one."""
    assert not dataclasses.replace(claim, printed=claim.right).measure().passed
    assert not dataclasses.replace(claim, right=claim.printed).measure().passed


def broken(claim: Claim, index: int, factor: float) -> Terms:
    return tuple(each * factor if i == index else each for i, each in enumerate(claim.terms))


@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_each_term_counts(claim: Claim) -> None:
    """A form with any one of its terms off by a hundredth fails, but for terms that are themselves next to nothing."""
    factor = 1 + max(BROKEN, 20 * claim.bound)
    sizes = [float(np.abs(each).max()) for each in claim.terms]
    counting = [i for i, size in enumerate(sizes) if size > 1e-3 * max(sizes)]
    assert counting
    for index in counting:
        assert miss(broken(claim, index, factor)) > claim.bound, index


Equation = Callable[[Quantities], Terms]
MOTIONS: dict[Equation, Callable[[], Witness]] = {
    **dict.fromkeys((equations.eq_15, equations.eq_16, equations.eq_18, equations.eq_19), swing),
    **dict.fromkeys((massive_can.eq_46, massive_can.eq_47, massive_can.eq_48, massive_can.eq_49), metal),
    **dict.fromkeys((pendulum.eq_57, pendulum.eq_58, pendulum.eq_60, pendulum.eq_61), wheel),
    frozen.eq_52: rolling_down,
}


@pytest.mark.parametrize("equation", MOTIONS, ids=lambda each: f"{each.__module__}.{each.__name__}")
def test_no_term_of_an_equation_of_motion_is_idle(equation: Equation) -> None:
    """Each has more than a thousandth of the largest, so that the motion tries it."""
    sizes = [float(np.abs(each).max()) for each in equation(MOTIONS[equation]().quantities)]
    assert min(sizes) > 1e-3 * max(sizes)


@pytest.mark.parametrize("equation", MOTIONS, ids=lambda each: f"{each.__module__}.{each.__name__}")
@pytest.mark.parametrize("constant", ["g", "b"])
def test_a_wrong_constant_is_found_out(equation: Equation, constant: str) -> None:
    """One that is 1e-5 off, in every equation of motion that has it."""
    q = MOTIONS[equation]().quantities
    wrong = dataclasses.replace(q, **{constant: getattr(q, constant) * (1 + 1e-5)})
    bound = EXACT if MOTIONS[equation] is swing else HELD
    assert miss(equation(q)) <= bound
    if equation is not equations.eq_15 or constant != "b":
        assert miss(equation(wrong)) > bound


def test_a_wrong_motion_is_found_out() -> None:
    """Of a can under a gravity that is 1e-9 too strong."""
    run = simulate(sliding(gravity=9.81 * (1 + 1e-9)), 0.5, 2.0)
    seen = dataclasses.replace(examine(run).quantities, g=9.81)
    assert miss(equations.eq_16(seen)) > EXACT
    assert miss(equations.eq_15(seen)) > EXACT


def test_footnote_8_is_right_for_its_own_numbers_only_with_a_b_in_full() -> None:
    q = footnote().quantities
    assert (q.a, q.b, q.g) == (0.03, 0.01, 9.8)
    assert pytest.approx(100**2 * q.a * q.b / 2) == 3 * 0.5


@pytest.mark.parametrize(
    ("printed", "right", "misses_by", "passed"),
    [
        (1e-4, None, None, True),
        (2e-3, None, None, False),
        (float("nan"), None, None, False),
        (0.5, 1e-4, 0.5, True),
        (0.5, 2e-3, 0.5, False),
        (0.4, 1e-4, 0.5, False),
        (1e-4, 1e-4, 0.5, False),
        (0.5, float("nan"), 0.5, False),
    ],
)
def test_what_passes(printed: float, right: float | None, misses_by: float | None, passed: bool) -> None:
    assert Finding("(0)", "", "", "", printed, right, 1e-3, misses_by, "").passed == passed


def test_an_error_is_the_sum_over_the_largest_term() -> None:
    assert miss((np.array([1.0, -4.0]), np.array([-1.0, 3.0]))) == 0.25
    assert np.isnan(miss((0.0, 0.0)))
