"""The audit: every equation has a claim, which passes, and fails if the equation is broken."""

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

CLAIMS = paper.claims()
NAMES = [f"{claim.equation} {claim.quantity}" for claim in CLAIMS]
BROKEN = 0.01
"""Relative error of one term in a broken equation; it is twenty bounds where that is more."""


@pytest.mark.slow
@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_claim(claim: Claim) -> None:
    result = claim.measure()
    assert result.passed, result.summary_line()


def numbers_named(pattern: str) -> set[int]:
    """Return the numbers that a pattern finds in what the claims are about."""
    named = " ".join(claim.equation for claim in CLAIMS)
    return {int(number) for number in re.findall(pattern, named)}


def test_every_equation_has_a_claim() -> None:
    assert numbers_named(r"\((\d+)\)") == set(range(1, 62))


def test_every_footnote_that_claims_something_has_a_claim() -> None:
    """Footnotes 3 and 5 only name things."""
    assert numbers_named(r"footnote (\d+)") == {1, 2, 4, 6, 7, 8, 9, 10}


@pytest.mark.parametrize(
    "figure", ["Fig. 1", "Fig. 2", "Fig. 3", "figure of (36)", "figure of (37)", "figure of A.3"]
)
def test_every_figure_with_data_has_a_claim(figure: str) -> None:
    """The figures that are not listed here only name things."""
    assert [claim for claim in CLAIMS if figure in claim.equation]


def test_what_is_no_numbered_equation_is_quoted() -> None:
    in_words = [claim for claim in CLAIMS if not claim.equation.startswith("(")]

    assert in_words
    assert not [claim.equation for claim in in_words if not claim.quote]


WRONG = [(claim.equation, claim.misprint) for claim in CLAIMS if claim.misprint]
"""The equations that are wrong as printed, each with what is wrong."""


def test_count_of_each_kind_of_what_is_wrong() -> None:
    kinds = Counter(misprint.kind for _, misprint in WRONG)

    assert kinds == {MISPRINT: 18, CONSEQUENCE: 4, APPROXIMATION: 3}


def test_a_consequence_names_its_misprint_and_nothing_else_does() -> None:
    misprinted = {equation for equation, misprint in WRONG if misprint.kind == MISPRINT}

    for _, misprint in WRONG:
        assert (misprint.of in misprinted) == (misprint.kind == CONSEQUENCE)


@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_no_claim_has_both_a_misprint_and_a_limit(claim: Claim) -> None:
    assert not (claim.misprint and claim.limit)


@pytest.mark.parametrize(
    "claim",
    [claim for claim in CLAIMS if claim.misprint or claim.limit],
    ids=lambda claim: claim.equation,
)
def test_what_must_fail_misses_by_more_than_five_bounds(claim: Claim) -> None:
    """A form that is wrong must fail, and so must the case beyond a limit."""
    must_fail = claim.misprint or claim.limit

    assert must_fail
    assert must_fail.expected_error > 5 * claim.bound.error


NOT_CONFIRMED = [claim for claim in CLAIMS if claim.verdict != CONFIRMED]
MISPRINTED = [claim for claim in NOT_CONFIRMED if claim.misprint]
LIMITED = [claim for claim in NOT_CONFIRMED if not claim.misprint]
"""The claims that hold within a limit only."""


@pytest.mark.parametrize(
    ("measured", "passed"), [(0.059, True), (0.0563, True), (0.055, False), (math.nan, False)]
)
def test_a_misprint_must_have_its_error_to_two_digits(measured: float, passed: bool) -> None:
    printed = PrintedError(measured, expected=0.059)

    result = ClaimResult("(49)", "n", bound=1e-9, error=1e-10, verdict=CORRECTED, printed=printed)

    assert result.passed is passed


@pytest.mark.slow
@pytest.mark.parametrize("claim", MISPRINTED, ids=lambda claim: claim.equation)
def test_a_claim_fails_if_the_wrong_form_is_right_or_the_right_form_is_wrong(claim: Claim) -> None:
    assert claim.misprint
    misprint = dataclasses.replace(claim.misprint, wrong=claim.residual)
    both_right = dataclasses.replace(claim, misprint=misprint)
    both_wrong = dataclasses.replace(claim, residual=claim.printed)

    assert not both_right.measure().passed
    assert not both_wrong.measure().passed


@pytest.mark.slow
@pytest.mark.parametrize("claim", LIMITED, ids=lambda claim: claim.equation)
def test_a_claim_fails_if_both_cases_are_within_its_limit_or_both_beyond(claim: Claim) -> None:
    assert claim.limit
    limit = claim.limit._replace(observe=claim.witness.observe)
    witness = claim.witness._replace(observe=claim.limit.observe)
    both_within = dataclasses.replace(claim, limit=limit)
    both_beyond = dataclasses.replace(claim, witness=witness)

    assert not both_within.measure().passed
    assert not both_beyond.measure().passed


@pytest.mark.slow
@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_each_term_counts(claim: Claim) -> None:
    """An equation fails if one of its terms is wrong by a hundredth.

    A term below a thousandth of the largest need not count.
    """
    observed = claim.witness.observe()
    right = terms(claim.residual, observed)
    scale = value(claim.scale, observed) if claim.scale else None
    sizes = [float(np.abs(term).max()) for term in right]
    largest = max(sizes) if scale is None else float(np.abs(scale).max())

    for index, size in enumerate(sizes):
        broken = list(right)
        broken[index] = right[index] * (1 + max(BROKEN, 20 * claim.bound.error))

        fails = relative_residual(broken, scale) > claim.bound.error

        is_small = size <= 1e-3 * largest
        assert fails or is_small, index


MOTIONS = [
    claim
    for claim in CLAIMS
    if claim.witness in (SWING, METAL, WHEEL, ROLL_DOWN) and "equation of motion" in claim.quantity
]
ACCELERATION = next(claim for claim in CLAIMS if claim.equation == "(15)")


an_equation_of_motion = pytest.mark.parametrize(
    "claim", [*MOTIONS, ACCELERATION], ids=lambda claim: claim.equation
)


@an_equation_of_motion
def test_an_equation_of_motion_has_no_idle_term(claim: Claim) -> None:
    """Each term exceeds a thousandth of the largest, so that the motion tests it."""
    observed = claim.witness.observe()

    sizes = [float(np.abs(term).max()) for term in terms(claim.residual, observed)]

    assert min(sizes) > 1e-3 * max(sizes)


@an_equation_of_motion
def test_an_equation_of_motion_is_tested_to_the_bound_of_its_motion(claim: Claim) -> None:
    assert claim.bound == (EXACT if claim.witness is SWING else HELD)


@an_equation_of_motion
def test_an_equation_of_motion_fails_if_g_or_b_is_wrong_by_1e_5(claim: Claim) -> None:
    """The acceleration of Eq. (15) has no b."""
    observed = claim.witness.observe()
    constants = ["g"] if claim is ACCELERATION else ["g", "b"]

    for constant in constants:
        changed = getattr(observed, constant) * (1 + 1e-5)
        wrong = Observation(**vars(observed) | {constant: changed})

        assert relative_residual(terms(claim.residual, wrong)) > claim.bound.error


def test_an_error_is_a_share_of_the_largest_term_or_of_a_scale() -> None:
    cancelling = [np.array([1.0, -4.0]), np.array([-1.0, 3.0])]
    assert relative_residual(cancelling) == 0.25
    assert relative_residual(cancelling, scale=np.array([2.0, -1.0])) == 0.5
    assert np.isnan(relative_residual([0.0, 0.0]))
