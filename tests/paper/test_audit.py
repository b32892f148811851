"""The audit: every equation has a row, which passes, and fails if the equation is a broken one."""

import dataclasses
import math
import re
from collections import Counter

import numpy as np
import pytest

from mjbeer import paper
from mjbeer.paper.claim import (
    APPROXIMATION,
    CONFIRMED,
    CONSEQUENCE,
    CORRECTED,
    MISPRINT,
    Claim,
    ClaimResult,
    Observation,
    PrintedError,
    relative_residual,
    terms,
    value,
)
from mjbeer.paper.witness import EXACT, HELD, METAL, ROLL_DOWN, SWING, WHEEL

ROWS = paper.claims()
NAMES = [f"{row.equation} {row.quantity}" for row in ROWS]
BROKEN = 0.01
"""Relative error of one term in a broken equation; it is twenty bounds where that is more."""


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_row(row: Claim) -> None:
    result = row.measure()
    assert result.passed, result.summary_line()


def test_every_equation_footnote_with_a_claim_and_figure_with_data_has_a_row() -> None:
    """Footnotes 3 and 5 only name things, and so do the figures that are not listed here."""
    named = " ".join(row.equation for row in ROWS)
    equations = {int(number) for number in re.findall(r"\((\d+)\)", named)}
    footnotes = {int(number) for number in re.findall(r"footnote (\d+)", named)}
    assert equations == set(range(1, 62))
    assert footnotes == {1, 2, 4, 6, 7, 8, 9, 10}
    figures = ("Fig. 1", "Fig. 2", "Fig. 3", "figure of (36)", "figure of (37)", "figure of A.3")
    for figure in figures:
        assert figure in named


def test_what_is_no_numbered_equation_is_quoted() -> None:
    in_words = [row for row in ROWS if not row.equation.startswith("(")]
    assert not [row.equation for row in in_words if not row.quote]


def test_kinds_of_what_is_wrong() -> None:
    """A consequence names its misprint; a wrong form misses by more than five bounds."""
    wrong = [(row.equation, row.misprint) for row in ROWS if row.misprint]
    kinds = Counter(misprint.kind for _, misprint in wrong)
    assert kinds == {MISPRINT: 18, CONSEQUENCE: 4, APPROXIMATION: 3}
    slips = {equation for equation, misprint in wrong if misprint.kind == MISPRINT}
    for _, misprint in wrong:
        assert (misprint.of in slips) == (misprint.kind == CONSEQUENCE)
    for row in ROWS:
        assert not (row.misprint and row.limit)
        must_fail = row.misprint or row.limit
        assert must_fail is None or must_fail.expected_error > 5 * row.bound.error


@pytest.mark.parametrize(
    ("measured", "passed"), [(0.059, True), (0.0563, True), (0.055, False), (math.nan, False)]
)
def test_a_misprint_must_have_its_error_to_two_digits(measured: float, passed: bool) -> None:
    printed = PrintedError(measured, expected=0.059)

    result = ClaimResult("(49)", "n", bound=1e-9, error=1e-10, verdict=CORRECTED, printed=printed)

    assert result.passed is passed


@pytest.mark.slow
@pytest.mark.parametrize(
    "row", [row for row in ROWS if row.verdict != CONFIRMED], ids=lambda row: row.equation
)
def test_a_row_fails_if_the_wrong_form_is_right_or_the_right_form_is_wrong(row: Claim) -> None:
    """For a limit, the case beyond it stands for the wrong form."""
    if row.misprint:
        misprint = dataclasses.replace(row.misprint, wrong=row.residual)
        both_right = dataclasses.replace(row, misprint=misprint)
        both_wrong = dataclasses.replace(row, residual=row.printed)
    else:
        assert row.limit
        limit = row.limit._replace(observe=row.witness.observe)
        witness = row.witness._replace(observe=row.limit.observe)
        both_right = dataclasses.replace(row, limit=limit)
        both_wrong = dataclasses.replace(row, witness=witness)
    assert not both_right.measure().passed
    assert not both_wrong.measure().passed


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_each_term_counts(row: Claim) -> None:
    """An equation fails if one of its terms is wrong by a hundredth.

    A term below a thousandth of the largest need not count.
    """
    observed = row.witness.observe()
    right = terms(row.residual, observed)
    scale = value(row.scale, observed) if row.scale else None
    sizes = [float(np.abs(term).max()) for term in right]
    largest = max(sizes) if scale is None else float(np.abs(scale).max())
    for index, size in enumerate(sizes):
        broken = list(right)
        broken[index] = right[index] * (1 + max(BROKEN, 20 * row.bound.error))
        fails = relative_residual(broken, scale) > row.bound.error
        is_small = size <= 1e-3 * largest
        assert fails or is_small, index


MOTIONS = [
    row
    for row in ROWS
    if row.witness in (SWING, METAL, WHEEL, ROLL_DOWN) and "equation of motion" in row.quantity
]
ACCELERATION = next(row for row in ROWS if row.equation == "(15)")


@pytest.mark.parametrize("row", [*MOTIONS, ACCELERATION], ids=lambda row: row.equation)
def test_an_equation_of_motion_has_no_idle_term_and_no_wrong_constant(row: Claim) -> None:
    """Each term exceeds a thousandth of the largest, so that the motion tests it.

    A row also fails if g or b is wrong by 1e-5.
    """
    observed = row.witness.observe()
    sizes = [float(np.abs(term).max()) for term in terms(row.residual, observed)]
    assert min(sizes) > 1e-3 * max(sizes)
    constants = ["g"] if row is ACCELERATION else ["g", "b"]
    for constant in constants:
        changed = getattr(observed, constant) * (1 + 1e-5)
        wrong = Observation(**vars(observed) | {constant: changed})
        assert row.bound == (EXACT if row.witness is SWING else HELD)
        assert relative_residual(terms(row.residual, wrong)) > row.bound.error


def test_an_error_is_a_share_of_the_largest_term_or_of_a_scale() -> None:
    cancelling = [np.array([1.0, -4.0]), np.array([-1.0, 3.0])]
    assert relative_residual(cancelling) == 0.25
    assert relative_residual(cancelling, scale=np.array([2.0, -1.0])) == 0.5
    assert np.isnan(relative_residual([0.0, 0.0]))
