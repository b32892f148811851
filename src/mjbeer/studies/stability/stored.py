"""The maps of a stability study as a small file, and the one that comes with mjbeer, which the report draws."""

import datetime
import json
import pathlib
from typing import Any

from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability import damped_maps
from mjbeer.studies.stability.run import OPTIONS, Stability

SHIPPED = pathlib.Path(__file__).with_name("maps.json")
"""The maps that come with mjbeer; `mjbeer stability --maps` wrote them."""
_NAMES = ("name", "family", "integrator", "refsafe", "dampratio", "written", "same", "worst", "agrees")
_DAMPED_NAMES = ("name", "rolling", "integrator", "same", "worst", "warned", "agrees")
"""What is stored of a map beside its cells and boundaries."""
_DIGITS = 6
"""Significant digits of timesteps and stiffnesses; a boundary is known to a hundredth."""


def to_json(study: Stability, date: datetime.date) -> str:
    """Return the maps of a study as a JSON document, a line each, with its command, its machine and a date.

    A map has its cells as strings, a string for each stiffness and a digit for each timestep: 0 unstable, 1 stable and
    inaccurate, 2 stable and accurate. Its "boundaries" are the timesteps [s] up to which the motion is stable, measured
    and predicted, for each stiffness; null stands for a stable motion at all timesteps. A map of the damping has a
    string for each damping, with the outcomes of `damped_runs` as digits.
    """
    option = OPTIONS[study.settings["extent"]]
    command = f"{Stability.command} --{option}" if option else Stability.command
    head = json.dumps({"command": command, "date": date.isoformat(), "machine": study.machine}, indent=1)
    groups = {"maps": _NAMES, damped_maps.GROUP: _DAMPED_NAMES}
    parts = [f' "{group}": [\n{_lines(study.of(group), names)}\n]' for group, names in groups.items()]
    return head[: head.rindex("}")].rstrip() + ",\n" + ",\n".join(parts) + "}\n"


def load(path: pathlib.Path = SHIPPED) -> dict[str, Any]:
    """Return the document in a file that `to_json` wrote.

    Raises:
      ParameterError: if the file is missing, or is not such a document.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if not {"command", "date", "machine", "maps"} <= set(document):
            raise ValueError("it has no maps")
    except (OSError, ValueError, TypeError) as error:
        raise ParameterError(f"{path} was not written by `{Stability.command}`: {error}") from error
    return document


def _lines(results: list[dict[str, Any]], names: tuple[str, ...]) -> str:
    """Return maps as JSON, a line each, without what the others in it tell: the stiffness of a boundary, and theory."""
    small = [
        {name: _rounded(result[name]) for name in names}
        | {name: [_rounded(value) for value in result[name]] for name in ("timesteps", "values")}
        | {"measured": ["".join(map(str, row)) for row in result["measured"]]}
        | {"boundaries": [[_rounded(edge["measured"]), _rounded(edge["predicted"])] for edge in result["boundaries"]]}
        for result in results
    ]
    return ",\n".join(json.dumps(result, allow_nan=False) for result in small)


def _rounded(value: Any) -> Any:
    """Return a float to six significant digits, also in a dictionary, and anything else as it is."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    return float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
