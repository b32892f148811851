"""Checks of models, of the paper and of how runs end: a measured error, its bound, and the reason for the bound."""

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True)
class Result:
    """A measured quantity, and the error that it may have."""

    group: str
    """The part of a study that it belongs to, or the equation of the paper."""
    name: str
    """The quantity."""
    by: str = ""
    """The scene and the setting, or the witness, that it was measured with."""
    bound: float = math.inf
    """Largest error that passes, in `unit`; infinite where nothing is judged."""
    unit: str = ""
    reason: str = ""
    """Which error dominates; the bound follows from it."""
    error: float | None = None
    """Size of the deviation from what is expected, in `unit`; None if there is none, or none that is finite."""
    values: dict[str, Any] = field(default_factory=dict)
    """Other measured values, as JSON has them. For a misprint of the paper its error is "printed", and the one that it
    must have "expected_error"."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound, which NaN never is, and a misprint misses by what is stated."""
        if (expected := self.values.get("expected_error")) is not None:
            printed = self.values["printed"]
            if printed is None or not abs(printed / expected - 1) <= 0.05:  # it is stated with two digits
                return False
        return self.bound == math.inf or (self.error is not None and self.error <= self.bound)

    def as_json(self) -> dict[str, Any]:
        """Return the fields as JSON has them: those that are not empty, and None for numbers that are not finite."""
        return json_values({name: value for name, value in asdict(self).items() if value not in ("", {}, math.inf)})

    def summary_line(self) -> str:
        """Return the result in a line, such as one that failed."""
        by = f" ({self.by})" if self.by else ""
        error = "-" if self.error is None else f"{self.error:.1e}"
        line = f"{self.group}: {self.name}{by}: error {error}, at most {self.bound:.1e} {self.unit}".strip()
        if "expected_error" in self.values:
            line += f"; as printed {self.values['printed']:.2g}, expected {self.values['expected_error']:.2g}"
        return line


def json_values(content: Any) -> Any:
    """Return content as JSON has it, in which infinity and NaN are None."""
    return json.loads(json.dumps(content), parse_constant=lambda _: None)


def to_json(content: Any, indent: int | None = None) -> str:
    """Return content as JSON, in one line unless it is indented."""
    return json.dumps(json_values(content), indent=indent) + "\n"


@dataclass(frozen=True)
class Check:
    """A quantity to be measured; the fields are those of `Result`, but for the function that measures it."""

    group: str
    name: str
    measure: Callable[[], float | dict[str, Any]]
    """Returns the deviation with its sign, or values as JSON has them, among which may be the deviation as "error"."""
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
        return Result(self.group, self.name, self.by, self.bound, self.unit, self.reason, error, values)
