"""Checks of models and of the paper: a measured error, its bound, and the reason for the bound."""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from mjbeer.checks.as_json import json_values

_EXPECTED_WITHIN = 0.05
"""Largest relative difference between the error of a misprint and the expected one, which has two
digits."""


@dataclass(frozen=True)
class Result:
    """A measured quantity, its error, and the bound on that error."""

    group: str
    """The part of a study to which the quantity belongs, or the equation of the paper."""
    name: str
    """The quantity."""
    by: str = ""
    """The scene and the setting, or the witness, with which it was measured."""
    bound: float = math.inf
    """Largest error that passes, in `unit`; infinite where nothing is judged."""
    unit: str = ""
    reason: str = ""
    """The error that dominates, from which the bound follows."""
    error: float | None = None
    """Size of the deviation from the expected value, in `unit`; None if nothing is compared, or the
    deviation is not finite."""
    values: dict[str, Any] = field(default_factory=dict)
    """Other measured values, as JSON has them. For a misprint of the paper, "printed" is its error
    and "expected_error" the error that it must have."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound, and a misprint's error as expected. NaN fails."""
        if not self._misprint_is_as_expected:
            return False
        if self.bound == math.inf:
            return True
        return self.error is not None and self.error <= self.bound

    @property
    def _misprint_is_as_expected(self) -> bool:
        """Whether the misprint, if there is one, has the error that it must have."""
        expected = self.values.get("expected_error")
        if expected is None:
            return True
        printed = self.values["printed"]
        return printed is not None and abs(printed / expected - 1) <= _EXPECTED_WITHIN

    def as_json(self) -> dict[str, Any]:
        """Return the fields that are not empty, as JSON has them: infinity and NaN are None."""
        fields = {
            name: value for name, value in asdict(self).items() if value not in ("", {}, math.inf)
        }
        return json_values(fields)

    def summary_line(self) -> str:
        """Return the result in a line, as for a list of failures."""
        by = f" ({self.by})" if self.by else ""
        error = "-" if self.error is None else f"{self.error:.1e}"
        bound = f"{self.bound:.1e} {self.unit}".strip()
        line = f"{self.group}: {self.name}{by}: error {error}, at most {bound}"
        if "expected_error" in self.values:
            printed = self.values["printed"]
            expected = self.values["expected_error"]
            line += f"; as printed {printed:.2g}, expected {expected:.2g}"
        return line


@dataclass(frozen=True)
class Check:
    """A quantity to be measured. Fields that a `Result` has, too, mean the same there."""

    group: str
    name: str
    measure: Callable[[], float | dict[str, Any]]
    """Returns the deviation with its sign, or a dictionary of values as JSON has them, in which
    the deviation may be "error"."""
    by: str = ""
    bound: float = math.inf
    unit: str = ""
    reason: str = ""

    def result(self) -> Result:
        """Measure the quantity."""
        measured = self.measure()
        values = dict(measured) if isinstance(measured, dict) else {"error": measured}
        deviation = values.pop("error", None)
        error = None if deviation is None else abs(float(deviation))
        return Result(
            self.group, self.name, self.by, self.bound, self.unit, self.reason, error, values
        )
