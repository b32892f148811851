"""The stability maps as interactive plots: each stretch of timesteps with the same outcome is a box that tells it."""

import math
from itertools import groupby
from typing import Any

from mjbeer.studies.stability.stiff_maps import FIGURES, SHADES, VALUES

_STRIPES = ("var(--unstable)", "var(--inaccurate)", "var(--accurate)")


def groups(maps: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return a record for each figure that has maps: its name, its title, its caption, and the plots of its maps."""
    found = []
    for figure in FIGURES:
        shown = [result for result in maps if figure.holds(result)]
        if shown:
            plots = [{"title": _title(result), "plot": plot(result)} for result in shown]
            words = {"name": figure.name, "title": figure.title, "caption": figure.caption}
            found.append(words | {"plots": plots})
    return found


def plot(result: dict[str, Any]) -> dict[str, Any]:
    """Return a map in Vega-Lite's format: timestep to the right, stiffness upwards, both logarithmic."""
    title = VALUES[result["family"]]
    times = _edges(result["timesteps"])
    x = {"type": "quantitative", "scale": {"type": "log", "domain": [times[0], times[-1]], "nice": False}}
    heights = _edges(result["values"])
    y = {"type": "quantitative", "scale": {"type": "log", "domain": [heights[0], heights[-1]], "nice": False}}
    fields = {
        "outcome": "outcome",
        "told_value": title.partition(" [")[0],
        "told_times": "timesteps",
        "limit": "limit of stability, measured",
        "theory": "limit of stability, theory",
    }
    tooltip = [{"field": field, "title": name, "type": "nominal"} for field, name in fields.items()]
    colour = {
        "field": "outcome",
        "scale": {"domain": list(SHADES), "range": list(_STRIPES)},
        "legend": None,
    }
    measured, predicted = (_boundary(result, place) for place in (0, 1))
    axis = {"grid": False, "format": "~e", "tickCount": 4, "labelOverlap": True}
    return {
        "description": f"{_title(result)}: which timesteps are stable, by {title}.",
        "width": "container",
        "height": 220,
        "layer": [
            {
                "data": {"values": _boxes(result)},
                "mark": {"type": "rect", "aria": False},
                "encoding": {
                    "x": {"field": "from", **x, "axis": {"title": "timestep h [s]", **axis}},
                    "x2": {"field": "to"},
                    "y": {"field": "below", **y, "axis": {"title": title, **axis}},
                    "y2": {"field": "above"},
                    "color": colour,
                    "tooltip": tooltip,
                },
            },
            {
                "data": {"values": predicted},
                "mark": {
                    "type": "line", "strokeWidth": 1.8, "stroke": "var(--ink)", "clip": True, "aria": False,
                    "tooltip": None,
                },
                "encoding": {"x": {"field": "time", **x}, "y": {"field": "value", **y}, "order": {"field": "value"}},
            },
            {
                "data": {"values": measured},
                "mark": {
                    "type": "point", "size": 16, "filled": True, "fill": "var(--paper)", "stroke": "var(--ink)",
                    "strokeWidth": 1, "opacity": 1, "clip": True, "aria": False, "tooltip": None,
                },
                "encoding": {"x": {"field": "time", **x}, "y": {"field": "value", **y}},
            },
        ],
    }  # fmt: skip


def _title(result: dict[str, Any]) -> str:
    """Return the name of a map without its family, which the figure's title has."""
    return result["name"].partition(", ")[2]


def _boxes(result: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the boxes of a map: for each stiffness, the stretches of timesteps [s] with the same outcome."""
    times, heights = _edges(result["timesteps"]), _edges(result["values"])
    unit = VALUES[result["family"]].partition("[")[2].rstrip("]")
    boxes = []
    for row, (value, cells) in enumerate(zip(result["values"], result["measured"], strict=True)):
        measured, predicted = result["boundaries"][row]
        place = 0
        for outcome, run in groupby(cells):
            first, place = place, place + len(list(run))
            boxes.append(
                {
                    "from": times[first],
                    "to": times[place],
                    "below": heights[row],
                    "above": heights[row + 1],
                    "outcome": list(SHADES)[int(outcome)],
                    "told_value": f"{value:.2g} {unit}",
                    "told_times": f"{result['timesteps'][first]:.2g} to {result['timesteps'][place - 1]:.2g} s",
                    "limit": _limit(measured, result["timesteps"]),
                    "theory": _limit(predicted, result["timesteps"]),
                }
            )
    return boxes


def _limit(boundary: float | None, timesteps: list[float]) -> str:
    """Return the timestep [s] of a limit of stability in words."""
    if boundary is None:
        return f"above {timesteps[-1]:.2g} s"
    return f"below {timesteps[0]:.2g} s" if boundary <= timesteps[0] else f"{boundary:.3g} s"


def _boundary(result: dict[str, Any], place: int) -> list[dict[str, float]]:
    """Return the points of a boundary inside the map; `place` is 0 for the measured and 1 for the predicted one."""
    first, last = result["timesteps"][0], result["timesteps"][-1]
    rows = zip(result["values"], result["boundaries"], strict=True)
    return [{"time": edge[place], "value": value} for value, edge in rows if edge[place] and first < edge[place] < last]


def _edges(centres: list[float]) -> list[float]:
    """Return the edges of cells whose centres are in geometric progression, to four digits."""
    half = math.sqrt(centres[1] / centres[0])
    return [float(f"{edge:.4g}") for edge in (*(centre / half for centre in centres), centres[-1] * half)]
