"""Checks of models and of the paper: a measured error, its bound, and the reason for the bound."""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from mjbeer.checks.as_json import json_values


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
    """What else was measured, as JSON has it: the study that measured it knows the names."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound. NaN fails."""
        if self.bound == math.inf:
            return True
        return self.error is not None and self.error <= self.bound

    def fields(self) -> dict[str, Any]:
        """Return all fields by their names."""
        return asdict(self)

    def as_json(self) -> dict[str, Any]:
        """Return the fields that are not empty, as JSON has them: infinity and NaN are None."""
        fields = {
            name: value for name, value in self.fields().items() if value not in ("", {}, math.inf)
        }
        return json_values(fields)

    def summary_line(self) -> str:
        """Return the result in a line, as for a list of failures."""
        by = f" ({self.by})" if self.by else ""
        error = "-" if self.error is None else f"{self.error:.1e}"
        bound = f"{self.bound:.1e} {self.unit}".strip()
        return f"{self.group}: {self.name}{by}: error {error}, at most {bound}"


@dataclass(frozen=True)
class Measured:
    """What a check has measured, if that is more than a deviation."""

    deviation: float
    """The deviation with its sign, in the unit of the check."""
    values: dict[str, Any]
    """What else was measured, as JSON has it."""


@dataclass(frozen=True)
class Check:
    """A quantity to be measured. Fields that a `Result` has, too, mean the same there."""

    group: str
    name: str
    measure: Callable[[], float | Measured]
    """Returns the deviation with its sign, alone or with what else was measured."""
    by: str = ""
    bound: float = math.inf
    unit: str = ""
    reason: str = ""

    def result(self) -> Result:
        """Measure the quantity."""
        measured = self.measure()
        if not isinstance(measured, Measured):
            measured = Measured(measured, {})
        return Result(
            group=self.group,
            name=self.name,
            by=self.by,
            bound=self.bound,
            unit=self.unit,
            reason=self.reason,
            error=abs(float(measured.deviation)),
            values=measured.values,
        )
