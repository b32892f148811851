"""A row of the validation table: what is checked, by which means, and how far off it may be."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One row of the table, measured."""

    quantity: str
    by: str
    error: float
    bound: float
    unit: str
    reason: str
    """Which error dominates, and so where the bound comes from."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound; an error that is not a number is not."""
        return self.error <= self.bound


@dataclass(frozen=True)
class Row:
    """One row of the table, to be measured."""

    quantity: str
    by: str
    bound: float
    unit: str
    reason: str
    measure: Callable[[], float]

    def run(self) -> Check:
        """Measure it."""
        return Check(self.quantity, self.by, abs(float(self.measure())), self.bound, self.unit, self.reason)
