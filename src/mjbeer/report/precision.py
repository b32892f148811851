"""Error against run time as an interactive plot: the points of a benchmark, and what each tells."""

from typing import Any

from mjbeer.model.setting import OWN, ROLLINGS
from mjbeer.studies.benchmark import points as benchmark
from mjbeer.studies.benchmark.points import CHOSEN, USUAL, Benchmark, Point, milliseconds
from mjbeer.studies.cases import CASES, DURATION

TOOLS = ("mjbeer", "MuJoCo", "MuJoCo as usually written", "SciPy", "heyoka")
"""The tools that have a colour each; every point belongs to one of them."""
_BY_HAND = "equations by hand"
_ROLLINGS = (*ROLLINGS, _BY_HAND)
_SHAPES = ("circle", "square", "triangle-up", "diamond")
"""The shape of a point, by what makes the can roll."""
_FLOOR = 1e-15
"""Smaller errors [rad] are drawn here, since a logarithmic axis has no zero."""
_TOLD = {
    "tool": "tool",
    "integrator": "integrator",
    "rolling": "rolling",
    "setting": "setting",
    "told_error": "error",
    "told_time": "run time",
    "ratio": "run time over the cheapest",
}
"""What a point tells, by the names of its fields, and what it is called."""


def cases(study: Benchmark) -> list[dict[str, Any]]:
    """Return a record for each case of a study: its name, its story, and the rows of the table of `cheapest`."""
    return [
        {"name": case, "story": CASES[case].story if case in CASES else case, "rows": _cheapest(study.of(case))}
        for case in study.cases
    ]


def plot(study: Benchmark) -> dict[str, Any]:
    """Return the plot in Vega-Lite's format, with all points in it.

    Its parameter `scene` is the name of the case that is shown, and `shown` the list of the tools.
    """
    points = [record for case in study.cases for record in _records(benchmark.drawn(study.of(case)))]
    x = {"field": "time", "type": "quantitative", "scale": {"type": "log"}}
    y = {"field": "error", "type": "quantitative", "scale": {"type": "log"}}
    span = f"run time of {DURATION:.1f} s of motion [ms]"
    x["axis"] = {"title": span, "format": "~g", "tickCount": 6}
    y["axis"] = {"title": "largest error of φ and u/a [rad]", "format": "~e", "tickCount": 8}
    colour = {
        "field": "tool",
        "scale": {"domain": list(TOOLS), "range": [f"var(--tool-{place})" for place in range(len(TOOLS))]},
        "legend": None,
    }
    shape = {"field": "rolling", "scale": {"domain": list(_ROLLINGS), "range": list(_SHAPES)}, "legend": None}
    tooltip = [{"field": field, "title": title, "type": "nominal"} for field, title in _TOLD.items()]
    hover = {"name": "hover", "select": {"type": "point", "on": "pointerover", "nearest": True, "clear": "pointerout"}}
    return {
        "description": "Error against run time of every setting, on logarithmic axes. The table below has the "
        "cheapest settings.",
        "width": "container",
        "height": 460,
        "params": [{"name": "scene", "value": study.cases[0]}, {"name": "shown", "value": list(TOOLS)}],
        "data": {"values": points},
        "transform": [{"filter": "datum.case === scene && indexof(shown, datum.tool) >= 0"}],
        "encoding": {"x": x, "y": y},
        "layer": [
            {
                "transform": [{"filter": "datum.front"}],
                "mark": {"type": "line", "strokeWidth": 9, "opacity": 0.22, "stroke": "var(--tool-0)"},
                "encoding": {"order": {"field": "time"}},
            },
            {
                "mark": {"type": "line", "strokeWidth": 1, "opacity": 0.45},
                "encoding": {"color": colour, "detail": {"field": "curve"}, "order": {"field": "rung"}},
            },
            {
                "transform": [{"filter": "datum.cheapest !== null"}],
                "mark": {"type": "point", "size": 190, "strokeWidth": 2, "stroke": "var(--ink)", "filled": False},
            },
            {
                "transform": [{"filter": "datum.cheapest !== null"}],
                "mark": {
                    "type": "text", "align": "right", "dx": -13, "dy": 4, "fontSize": 12, "fontWeight": 600,
                    "fill": "var(--ink)", "stroke": "var(--paper)", "strokeWidth": 4, "strokeJoin": "round",
                    "aria": False,
                },
                "encoding": {"text": {"field": "cheapest"}},
            },
            {
                "transform": [{"filter": "datum.cheapest !== null"}],
                "mark": {
                    "type": "text", "align": "right", "dx": -13, "dy": 4, "fontSize": 12, "fontWeight": 600,
                    "fill": "var(--ink)",
                },
                "encoding": {"text": {"field": "cheapest"}},
            },
            {
                "params": [hover],
                "mark": {"type": "point", "filled": True, "opacity": 1},
                "encoding": {
                    "color": colour,
                    "shape": shape,
                    "size": {"condition": {"param": "hover", "empty": False, "value": 200}, "value": 42},
                    "tooltip": tooltip,
                },
            },
        ],
    }  # fmt: skip


def _records(points: list[Point]) -> list[dict[str, Any]]:
    """Return the points of a case as the plot has them: errors [rad], run times [ms], and what they tell in words."""
    ours = benchmark.ours(points)
    front = {id(point) for point in benchmark.front(ours)}
    marked = {id(best): f"{level:.0e}" for level, best in _levels(ours)}
    rungs: dict[Any, int] = {}
    records = []
    for point in points:
        rung = rungs[point.curve] = rungs.get(point.curve, -1) + 1
        records.append(
            {
                "case": point.case,
                "curve": point.curve.label,
                "rung": rung,
                "tool": _tool(point),
                "integrator": point.method or point.way,
                "rolling": point.way if point.way in ROLLINGS else _rolling(point),
                "setting": point.setting if point.method else f"{point.knob} {point.value:g}",
                "time": float(f"{1e3 * point.time:.4g}"),
                "error": float(f"{max(point.error, _FLOOR):.3g}"),
                "told_time": milliseconds(point.time),
                "told_error": f"{point.error:.1e} rad",
                "ratio": _ratio(point.time, benchmark.time_for(ours, point.error)),
                "front": id(point) in front,
                "cheapest": marked.get(id(point)),
            }
        )
    return records


def _cheapest(points: list[Point]) -> list[dict[str, str | float]]:
    """Return a row for each error: the cheapest setting of mjbeer's own, its time, and how much longer others take."""
    ours = benchmark.ours(points)
    rivals = {
        "rk4": [point for point in ours if point.method == "RK4"],
        "scipy": [point for point in points if point.way.startswith("SciPy")],
        "heyoka": [point for point in points if point.way == "heyoka"],
    }
    rows = []
    for level, best in _levels(ours):
        times = {name: benchmark.cheapest(found, level) for name, found in rivals.items()}
        row: dict[str, str | float] = {
            name: "\N{EN DASH}" if found is None else _ratio(found.time, best.time) for name, found in times.items()
        }
        rows.append(row | {"level": level, "setting": best.setting, "rolling": best.way, "time": best.time})
    return rows


def _levels(points: list[Point]) -> list[tuple[float, Point]]:
    """Return the errors of `benchmark.LEVELS` [rad] that can be reached, with the cheapest point of each."""
    found = [(level, benchmark.cheapest(points, level)) for level in benchmark.LEVELS]
    return [(level, best) for level, best in found if best is not None]


def _tool(point: Point) -> str:
    """Return which of `TOOLS` a point belongs to."""
    if point.way in ROLLINGS:
        return "mjbeer" if point.method in (*OWN, CHOSEN) else "MuJoCo"
    if point.way in USUAL:
        return "MuJoCo as usually written"
    return next(tool for tool in TOOLS if point.way.startswith(tool))


def _rolling(point: Point) -> str:
    """Return what makes the can roll in a point that is not one of mjbeer's own models."""
    return USUAL[point.way].rolling if point.way in USUAL else _BY_HAND


def _ratio(time: float, best: float) -> str:
    """Return a run time over the best one, in two digits."""
    return f"{time / best:.2g} \N{MULTIPLICATION SIGN}" if best < float("inf") else "no other is as accurate"
