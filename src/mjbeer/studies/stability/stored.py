"""The maps of a stability study as a small file, and the one that comes with mjbeer, which the report draws."""

import datetime
import json
import pathlib
from typing import Any

from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability.run import OPTIONS, Stability

SHIPPED = pathlib.Path(__file__).with_name("maps.json")
"""The maps that come with mjbeer; `mjbeer stability --maps` wrote them."""
_DIGITS = 6
"""Significant digits of timesteps and stiffnesses; a boundary is known to a hundredth."""


def to_json(study: Stability, date: datetime.date) -> str:
    """Return the maps of a study as a JSON document, a line each, with its command, its machine and a date.

    A map has its cells as strings, a string for each stiffness and a digit for each timestep: 0 unstable, 1 stable and
    inaccurate, 2 stable and accurate. Its "boundaries" are the timesteps [s] up to which the motion is stable, measured
    and predicted, for each stiffness; null stands for a stable motion at all timesteps.
    """
    option = OPTIONS[study.settings["extent"]]
    command = f"{Stability.command} --{option}" if option else Stability.command
    head = json.dumps({"command": command, "date": date.isoformat(), "machine": study.machine}, indent=1)
    lines = [json.dumps(_small(result), allow_nan=False) for result in study.of("maps")]
    return head[: head.rindex("}")].rstrip() + ',\n "maps": [\n' + ",\n".join(lines) + "\n]}\n"


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


def _small(result: dict[str, Any]) -> dict[str, Any]:
    """Return a map without what the others in it tell: the stiffness of a boundary, and the predicted cells."""
    names = ("name", "family", "integrator", "refsafe", "dampratio", "written", "same", "worst", "agrees")
    return {
        **{name: _rounded(result[name]) for name in names},
        **{name: [_rounded(value) for value in result[name]] for name in ("timesteps", "values")},
        "measured": ["".join(map(str, row)) for row in result["measured"]],
        "boundaries": [[_rounded(edge["measured"]), _rounded(edge["predicted"])] for edge in result["boundaries"]],
    }


def _rounded(value: Any) -> Any:
    """Return a float to six significant digits, and anything else as it is."""
    return float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
