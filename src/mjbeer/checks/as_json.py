"""Results as JSON, which has no infinity and no NaN: both become null."""

import json
from collections.abc import Iterable, Mapping
from typing import Any


def json_values(content: Any) -> Any:
    """Return content as JSON represents it, with None for infinity and NaN."""
    return json.loads(json.dumps(content), parse_constant=lambda _: None)


def to_json(content: Any, indent: int | None = None) -> str:
    """Return content as JSON text, in one line unless it is indented."""
    return json.dumps(json_values(content), indent=indent) + "\n"


def document(about: Mapping[str, Any], name: str, rows: Iterable[Mapping[str, Any]]) -> str:
    """Return a study as JSON: what it is about, and under `name` its rows, each on a line.

    The numbers in the rows have six digits.
    """
    lines = []
    for row in rows:
        rounded = json.loads(to_json(row), parse_float=_six_digits)
        lines.append(json.dumps(rounded))
    head = json.dumps(about).removesuffix("}")
    return f'{head}, "{name}": [\n' + ",\n".join(lines) + "\n]}\n"


def _six_digits(number: str) -> float:
    return float(f"{float(number):.6g}")
