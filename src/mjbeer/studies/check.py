"""What studies check against a bound: by which means, and how far off it may be."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Result:
    """A check that was measured."""

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
class Check:
    """A quantity to be measured, and its bound."""

    quantity: str
    by: str
    bound: float
    unit: str
    reason: str
    deviation: Callable[[], float]
    """Measures by how much the quantity is off, with its sign."""

    def measure(self) -> Result:
        """Measure the quantity and return its error beside its bound."""
        error = abs(float(self.deviation()))
        return Result(self.quantity, self.by, error=error, bound=self.bound, unit=self.unit, reason=self.reason)
