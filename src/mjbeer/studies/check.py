"""Check: a quantity to be measured, with the bound of its error. Result: its error, once it is measured."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Result:
    """The outcome of a check: the error that was measured, beside the bound."""

    quantity: str
    """What was compared with theory."""
    by: str
    """The scene and the setting that it was measured with."""
    error: float
    """Size of the deviation, in `unit`."""
    bound: float
    """Largest error that passes, in `unit`."""
    unit: str
    reason: str
    """Which error dominates; the bound follows from it."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound; NaN never is."""
        return self.error <= self.bound


@dataclass(frozen=True)
class Check:
    """A quantity to be measured; the fields are those of Result, but for the function that measures the error."""

    quantity: str
    by: str
    bound: float
    unit: str
    reason: str
    deviation: Callable[[], float]
    """Returns by how much the quantity deviates from theory, with its sign."""

    def measure(self) -> Result:
        """Measure the quantity and return its error beside its bound."""
        error = abs(float(self.deviation()))
        return Result(
            quantity=self.quantity, by=self.by, error=error, bound=self.bound, unit=self.unit, reason=self.reason
        )
