"""The audit: every equation has its row, every row passes, and each would fail on a misprint or a broken form."""

import dataclasses
import re
from collections import Counter

import numpy as np
import pytest

from mjbeer import paper
from mjbeer.paper.claim import (
    APPROXIMATION,
    CONFIRMED,
    CONSEQUENCE,
    MISPRINT,
    Claim,
    Seen,
    relative_residual,
    terms,
)
from mjbeer.paper.witness import EXACT, HELD, METAL, ROLL_DOWN, SWING, WHEEL

ROWS = paper.claims()
NAMES = [f"{row.equation} {row.quantity}" for row in ROWS]
BROKEN = 0.01
"""What a term of a broken form is off by, or twenty bounds where these are wide."""


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_row(row: Claim) -> None:
    result = row.measure()
    assert result.passed, result.summary_line()


def test_every_equation_footnote_with_a_claim_and_figure_with_data_has_a_row() -> None:
    """Footnotes 3 and 5 only name things; of the figures, 1 and 2 state something that can be false."""
    named = " ".join(row.equation for row in ROWS)
    assert {int(each) for each in re.findall(r"\((\d+)\)", named)} == set(range(1, 62))
    assert {int(each) for each in re.findall(r"footnote (\d+)", named)} == {1, 2, 4, 6, 7, 8, 9, 10}
    for each in ("Fig. 1", "Fig. 2", "Fig. 3", "figure of (36)", "figure of (37)", "figure of A.3"):
        assert each in named


def test_what_is_no_numbered_equation_is_quoted() -> None:
    assert not [row.equation for row in ROWS if not row.equation.startswith("(") and not row.quote]


def test_kinds_of_what_is_wrong() -> None:
    """A consequence is one of a misprint; what misses does so by more than the bound."""
    wrong = [(row.equation, row.misprint) for row in ROWS if row.misprint]
    assert Counter(each.kind for _, each in wrong) == {MISPRINT: 18, CONSEQUENCE: 4, APPROXIMATION: 3}
    slips = {name for name, each in wrong if each.kind == MISPRINT}
    assert not [name for name, each in wrong if (each.of in slips) != (each.kind == CONSEQUENCE)]
    for row in ROWS:
        assert not (row.misprint and row.limit)
        other = row.misprint or row.limit
        assert other is None or other.expected_error > 5 * row.bound.error


@pytest.mark.slow
@pytest.mark.parametrize("row", [row for row in ROWS if row.verdict != CONFIRMED], ids=lambda row: row.equation)
def test_a_misprint_that_is_none_is_found_out(row: Claim) -> None:
    """The row would fail if the printed form were right, and if the right form were the printed one."""
    if row.misprint:
        none = dataclasses.replace(row, misprint=dataclasses.replace(row.misprint, wrong=row.right))
        wrong = dataclasses.replace(row, right=row.printed)
    else:
        assert row.limit
        none = dataclasses.replace(row, limit=row.limit._replace(see=row.witness.see))
        wrong = dataclasses.replace(row, witness=row.witness._replace(see=row.limit.see))
    assert not none.measure().passed
    assert not wrong.measure().passed


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_each_term_counts(row: Claim) -> None:
    """A form with any one of its terms off by a hundredth fails, but for terms that are themselves next to nothing."""
    found, factor = terms(row.right, row.witness.see()), 1 + max(BROKEN, 20 * row.bound.error)
    sizes = [float(np.abs(each).max()) for each in found]
    for index, size in enumerate(sizes):
        broken = [each * factor if i == index else each for i, each in enumerate(found)]
        assert size <= 1e-3 * max(sizes) or relative_residual(tuple(broken)) > row.bound.error, index


MOTIONS = [
    row for row in ROWS if row.witness in (SWING, METAL, WHEEL, ROLL_DOWN) and "equation of motion" in row.quantity
]
ACCELERATION = next(row for row in ROWS if row.equation == "(15)")


@pytest.mark.parametrize("row", [*MOTIONS, ACCELERATION], ids=lambda row: row.equation)
def test_an_equation_of_motion_has_no_idle_term_and_no_wrong_constant(row: Claim) -> None:
    """Each term has more than a thousandth of the largest, so that the motion tries it; g or b is wrong by 1e-5."""
    q = row.witness.see()
    sizes = [float(np.abs(each).max()) for each in terms(row.right, q)]
    assert min(sizes) > 1e-3 * max(sizes)
    for constant in ("g",) if row is ACCELERATION else ("g", "b"):
        wrong = Seen(**vars(q) | {constant: getattr(q, constant) * (1 + 1e-5)})
        assert row.bound == (EXACT if row.witness is SWING else HELD)
        assert relative_residual(terms(row.right, wrong)) > row.bound.error


def test_an_error_is_the_sum_over_the_largest_term() -> None:
    assert relative_residual((np.array([1.0, -4.0]), np.array([-1.0, 3.0]))) == 0.25
    assert np.isnan(relative_residual((0.0, 0.0)))
