"""What the paper claims, printed and right, and what a witness says to it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.paper.letters import Terms

CONFIRMED = "confirmed"
CORRECTED = "confirmed after correction"
LIMIT = "limit of validity"
_AS_STATED = 0.05
"""How far a misprint may be from missing by the stated amount, which has two digits."""


@dataclass(frozen=True)
class Finding:
    """A claim that was measured: a row of the audit."""

    equation: str
    quantity: str
    verdict: str
    witness: str
    printed: float
    """Error of the printed form, or beyond its limit: the largest sum of the equation's terms, over the largest
    term of any sample."""
    right: float | None
    """Error of the corrected form, or within the limit; None where what is printed is right."""
    bound: float
    misses_by: float | None
    """What a misprint's error must be."""
    reason: str
    """Which error dominates, and so where the bound comes from."""

    @property
    def passed(self) -> bool:
        """Whether what is right is within the bound, and a misprint misses by what is stated."""
        if self.right is None or self.misses_by is None:
            return self.printed <= self.bound
        return self.right <= self.bound and abs(self.printed / self.misses_by - 1) <= _AS_STATED


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, to be measured against a witness."""

    equation: str
    quantity: str
    verdict: str
    witness: str
    printed: Callable[[], Terms]
    """Terms that sum to zero if the printed form holds; one of them is the witness's."""
    right: Callable[[], Terms] | None
    bound: float
    misses_by: float | None
    reason: str

    @cached_property
    def terms(self) -> Terms:
        """Those of what is right."""
        return (self.right or self.printed)()

    def measure(self) -> Finding:
        """Measure by how much the printed form misses, and the right one, and return both beside the bound."""
        return Finding(
            self.equation, self.quantity, self.verdict, self.witness, printed=miss(self.printed()),
            right=None if self.right is None else miss(self.terms), bound=self.bound, misses_by=self.misses_by,
            reason=self.reason,
        )  # fmt: skip


def miss(terms: Terms) -> float:
    """The largest sum of the terms, over the largest of them; not a number if they are all zero."""
    columns = [np.asarray(each, dtype=float) for each in terms]
    largest = max(float(np.abs(each).max()) for each in columns)
    return float(np.abs(np.asarray(sum(columns))).max()) / largest if largest > 0 else float("nan")


def confirmed(
    equation: str, quantity: str, witness: str, terms: Callable[[], Terms], bound: float, reason: str
) -> Claim:
    """A claim that holds as it is printed."""
    return Claim(equation, quantity, CONFIRMED, witness, terms, None, bound, None, reason)


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
    """A misprint, and what is right."""
    return Claim(equation, quantity, CORRECTED, witness, printed, right, bound, misses_by, reason)


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
    """A claim that holds only in a limit: what it misses by beyond, and within."""
    return Claim(equation, quantity, LIMIT, witness, beyond, within, bound, misses_by, reason)
