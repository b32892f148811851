"""A claim of the paper, as printed and as it is right, and the measurement of how far a witness is from both."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.paper.letters import Terms

CONFIRMED = "confirmed"
CORRECTED = "confirmed after correction"
LIMIT = "limit of validity"
_AS_STATED = 0.05
"""Largest relative difference between the measured error of a misprint and the stated one, which has two digits."""


@dataclass(frozen=True)
class Finding:
    """The result of measuring a claim: a row of the audit.

    An error is the largest sum of the equation's terms at any sample, divided by the largest single term.
    """

    equation: str
    quantity: str
    verdict: str
    witness: str
    printed: float
    """Error of the printed form; for a limit of validity, its error beyond the limit."""
    right: float | None
    """Error of the corrected form, or of the printed one within its limit; None where the paper is right."""
    bound: float
    """Largest error that what is right may have."""
    misses_by: float | None
    """Error that the misprint, or the claim beyond its limit, must have; None where the paper is right."""
    reason: str
    """What causes the remaining error, and therefore sets the bound."""

    @property
    def passed(self) -> bool:
        """Whether what is right has an error within the bound, and a misprint has the error that is stated for it."""
        if self.right is None or self.misses_by is None:
            return self.printed <= self.bound
        return self.right <= self.bound and abs(self.printed / self.misses_by - 1) <= _AS_STATED


@dataclass(frozen=True)
class Claim:
    """A claim of the paper that can be measured against a witness. The fields are those of `Finding`, but for two."""

    equation: str
    quantity: str
    verdict: str
    witness: str
    printed: Callable[[], Terms]
    """Computes terms that sum to zero if the printed form holds; at least one of them comes from the witness."""
    right: Callable[[], Terms] | None
    """Computes the same terms for what is right; None where the printed form is."""
    bound: float
    misses_by: float | None
    reason: str

    @cached_property
    def terms(self) -> Terms:
        """The terms of what is right: the corrected form, or the printed one where that is right."""
        return (self.right or self.printed)()

    def measure(self) -> Finding:
        """Compute the errors of the printed and of the right form, and return both beside the bound."""
        return Finding(
            equation=self.equation,
            quantity=self.quantity,
            verdict=self.verdict,
            witness=self.witness,
            printed=miss(self.printed()),
            right=None if self.right is None else miss(self.terms),
            bound=self.bound,
            misses_by=self.misses_by,
            reason=self.reason,
        )


def miss(terms: Terms) -> float:
    """Return the largest sum of the terms at any sample, divided by the largest term; NaN if all are zero."""
    columns = [np.asarray(term, dtype=float) for term in terms]
    largest = max(float(np.abs(column).max()) for column in columns)
    return float(np.abs(np.asarray(sum(columns))).max()) / largest if largest > 0 else float("nan")


def confirmed(
    equation: str, quantity: str, witness: str, terms: Callable[[], Terms], bound: float, reason: str
) -> Claim:
    """Return a claim that holds as it is printed: its terms sum to zero within the bound."""
    return Claim(
        equation=equation,
        quantity=quantity,
        verdict=CONFIRMED,
        witness=witness,
        printed=terms,
        right=None,
        bound=bound,
        misses_by=None,
        reason=reason,
    )


def corrected(
    equation: str,
    quantity: str,
    witness: str,
    printed: Callable[[], Terms],
    right: Callable[[], Terms],
    misses_by: float,
    bound: float,
    reason: str,
) -> Claim:
    """Return a misprint with its correction: the printed terms must have the error `misses_by`, the right ones none
    above the bound."""
    return Claim(
        equation=equation,
        quantity=quantity,
        verdict=CORRECTED,
        witness=witness,
        printed=printed,
        right=right,
        bound=bound,
        misses_by=misses_by,
        reason=reason,
    )


def limit(
    equation: str,
    quantity: str,
    witness: str,
    beyond: Callable[[], Terms],
    within: Callable[[], Terms],
    misses_by: float,
    bound: float,
    reason: str,
) -> Claim:
    """Return a claim that holds only in a limit: far from it the terms must have the error `misses_by`, near it none
    above the bound."""
    return Claim(
        equation=equation,
        quantity=quantity,
        verdict=LIMIT,
        witness=witness,
        printed=beyond,
        right=within,
        bound=bound,
        misses_by=misses_by,
        reason=reason,
    )
