"""The diagrams of a benchmark, error over run time: all curves with a panel for each scene, and a few of them."""

import math
import pathlib
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from mjbeer.model.setting import DOP853, GAUSS_JACKSON, ROLLINGS
from mjbeer.output.plots import COLOURS, GREY, chart, name_below
from mjbeer.predictions.semi_implicit_euler import euler_error
from mjbeer.studies.benchmark import points
from mjbeer.studies.benchmark.points import CHOSEN, TOLERANCE, USUAL, Benchmark, Curve, Point
from mjbeer.studies.cases import MEASURED
from mjbeer.theory.named import in_degrees, in_words

_METHODS = {"Euler": 0, "implicit": 4, "implicitfast": 5, "discrete": 3, "RK4": 1, DOP853: 2, CHOSEN: 2}
_METHODS[GAUSS_JACKSON] = 6
"""Colours of the integrators; runs to a tolerance have hollow markers."""
_LINES = {"reduced": "-o", "equality": "--s", "contact": ":^"}
"""Lines and markers of the ways of rolling."""
_USUAL = {"equality, slide first": "X", "equality, hinge first": "P", "contact, defaults": "*"}
"""Markers of models as people usually write them."""
_PEERS = ("v", "<", ">", "D", "+", "x", "*")
"""Markers of other tools."""
_SHORT = "GJ"
"""GaussJackson in the labels beside points; the legend says so."""
_FLOOR = 1e-15
"""Smaller errors [rad] are drawn here, since a logarithmic axis has no zero."""
_OVERVIEW: dict[Curve, tuple[str, int, float, tuple[int, int], str]] = {
    Curve("reduced", "Euler"): ("MuJoCo Euler", 4, 1e-5, (6, 18), "right"),
    Curve("reduced", "RK4"): ("MuJoCo RK4", 1, 1e-9, (-9, -4), "right"),
    Curve("reduced", DOP853): ("mjbeer:\nDOP853", 0, 1e-7, (8, 0), "left"),
    Curve("reduced", GAUSS_JACKSON): ("Gauss-\nJackson", 6, 2e-5, (-7, 0), "right"),
    Curve("SciPy DOP853", "", TOLERANCE): ("SciPy DOP853", 3, 1e-6, (9, 0), "left"),
    Curve("heyoka", "", TOLERANCE): ("heyoka", 2, 1e-10, (9, 0), "left"),
}
"""Curves of the overview: name, colour, and where the name stands: beside the point nearest to an error [rad], at a
distance [points] to the right and up, with this end of it."""


def draw(study: Benchmark, path: pathlib.Path) -> None:
    """Draw all curves of a study, and write them to `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    columns = min(2, len(study.cases))
    rows = -(-len(study.cases) // columns)
    title = "Error against run time: how long a simulation takes, and how far it is from exact theory"
    subtitle = "reduced: rolling is built into the coordinates; equality: a constraint of two joints; contact: friction"
    size: dict[str, Any] = {"width": 7.5 * columns, "height": 6.2 * rows + 2.5}
    size["subtitle"] = f"{subtitle}. {study.machine['processor']}"
    peers = sorted({point.way for point in points.drawn(study.points) if point.failure is None} - {*ROLLINGS, *USUAL})
    with chart(path, rows, columns, **size, title=title) as panels:
        for axes in panels[len(study.cases) :]:
            axes.set_visible(False)
        for axes, case in zip(panels, study.cases, strict=False):
            found = points.drawn(study.of(case))
            for curve in dict.fromkeys(point.curve for point in found):
                on_curve = [point for point in found if point.curve == curve]
                axes.plot(*_coordinates(on_curve), **_style(curve, peers))
            _front(axes, found)
            _prediction(axes, case, found)
            begun = "" if MEASURED[case].scene.dissipates else f", from φ = {in_degrees(MEASURED[case].phi0)}"
            _finish(axes, f"{case}: {in_words(MEASURED[case].scene)}{begun}")
            axes.minorticks_off()
        name_below(panels, 4, _legend(panels))


def draw_overview(study: Benchmark, path: pathlib.Path) -> None:
    """Draw six curves of two cases, each with its name beside it, as `path` with .svg and with .png.

    Nothing is drawn of a study that has neither case.

    Raises:
      OutputError: if a file cannot be written.
    """
    cases = [case for case in ("frozen", "sliding") if case in study.cases]
    if not cases:
        return
    title = "The same motion, ever more exactly: what accuracy costs"
    subtitle = f"each line: one tool, from coarse at its top to fine; {study.machine['processor']}"
    with chart(path, columns=len(cases), width=5.2 * len(cases), height=5.2, title=title, subtitle=subtitle) as panels:
        for axes, case in zip(panels, cases, strict=True):
            for curve, (name, colour, level, offset, side) in _OVERVIEW.items():
                found = [point for point in study.of(case) if point.curve == curve and point.error < 1]
                if not found:
                    continue
                axes.plot(*_coordinates(found), marker=".", color=COLOURS[colour])
                beside = min(found, key=lambda point: abs(math.log(max(point.error, _FLOOR) / level)))
                _name(axes, name, beside, offset, color=COLOURS[colour], fontsize=9, ha=side, va="center")
            written = [point for point in study.of(case) if point.way in USUAL]
            axes.plot(*_coordinates(written), "k*", markersize=9)
            for point in written[:1]:
                _name(axes, "as usually written", point, (8, 3), fontsize=9)
            start = MEASURED[case]
            _finish(axes, f"{in_words(start.scene)}, from {in_degrees(start.phi0)}")


def _coordinates(found: list[Point]) -> tuple[list[float], list[float]]:
    """Return run times [ms] and errors [rad] of points, as they are drawn."""
    return [1e3 * point.time for point in found], [max(point.error, _FLOOR) for point in found]


def _finish(axes: Axes, title: str) -> None:
    axes.set(xscale="log", yscale="log", ylim=(_FLOOR / 2, 20), title=title)
    axes.set(xlabel="run time of 2 s of motion [ms]", ylabel="largest error of φ and u/a [rad]")


def _name(axes: Axes, name: str, point: Point, offset: tuple[int, int], **style: Any) -> None:
    """Write a name beside a point, at a distance [points] to the right and up."""
    place = 1e3 * point.time, max(point.error, _FLOOR)
    axes.annotate(name, place, offset, textcoords="offset points", **style)


def _style(curve: Curve, peers: list[str]) -> dict[str, Any]:
    """Return how a curve is drawn: a large marker, a line of one of mjbeer's models, or a grey one of another tool."""
    if curve.way in USUAL:
        style = {"linestyle": "none", "marker": _USUAL[curve.way], "markersize": 13, "color": "#000000", "zorder": 4}
        return style | {"label": f"as usually written, 2 ms: {curve.way}"}
    if curve.way not in ROLLINGS:
        marker = _PEERS[peers.index(curve.way) % len(_PEERS)]
        return {"color": GREY, "linewidth": 1, "marker": marker, "markersize": 4, "label": curve.way}
    adaptive, colour = curve.knob == TOLERANCE, COLOURS[_METHODS[curve.method]]
    method = f"{curve.method} ({_SHORT})" if curve.method == GAUSS_JACKSON else curve.method
    style = {"linestyle": _LINES[curve.way][:-1], "marker": _LINES[curve.way][-1], "markersize": 4, "linewidth": 1.1}
    style |= {"color": colour, "markerfacecolor": "white" if adaptive else colour}
    return style | {"label": f"{method}{' to a tolerance' if adaptive else ''}, {curve.way}"}


def _front(axes: Axes, found: list[Point]) -> None:
    """Draw the front of mjbeer's own settings, and name the fastest for every second decade of error."""
    best = points.front(points.ours(found))
    style: dict[str, Any] = {"linewidth": 7, "alpha": 0.25, "solid_capstyle": "round", "zorder": 1}
    axes.plot(*_coordinates(best), color=COLOURS[2], label="the best of mjbeer", **style)
    levels = (points.cheapest(best, level) for level in points.LEVELS)
    for point in {id(point): point for point in levels if point}.values():  # one may be the fastest for several
        name = point.setting + ("" if point.way == "reduced" else f", {point.way}")
        _name(axes, name.replace(GAUSS_JACKSON, _SHORT), point, (-7, -3), ha="right", fontsize=8)


def _prediction(axes: Axes, case: str, found: list[Point]) -> None:
    """Draw the error of semi-implicit Euler that backward error analysis predicts, at the measured run times."""
    euler = [point for point in found if point.curve == Curve("reduced", "Euler")]
    start = MEASURED[case]
    if not euler or start.scene.dissipates:  # the theory of its error conserves energy
        return
    slope = float(abs(euler_error(start.scene, start.times, start.phi0)).max())
    style: dict[str, Any] = {"color": "#000000", "linewidth": 0.9, "linestyle": (0, (1, 1)), "zorder": 5}
    predicted = [slope * point.value for point in euler]
    axes.plot(_coordinates(euler)[0], predicted, label="Euler, reduced: error as theory predicts", **style)


def _legend(panels: list[Axes]) -> list[Artist]:
    """Return the legend's entries in four columns: the ways of rolling, and what is not a model of mjbeer."""
    named = {name: line for axes in panels for line, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    columns: dict[str, list[Artist]] = {way: [] for way in (*ROLLINGS, "other")}
    for name, line in named.items():
        columns[next((way for way in ROLLINGS if way in name), "other")].append(line)
    for column in columns.values():  # ways of writing and the front come last
        column.sort(key=lambda line: str(line.get_label()).startswith(("as usually", "the best")))
    longest = max(len(column) for column in columns.values())
    blank = Line2D([], [], linestyle="none", label=" ")
    return [entry for column in columns.values() for entry in column + [blank] * (longest - len(column))]
