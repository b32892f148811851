"""The work-precision diagram: error over run time, with one panel for each scene."""

import pathlib
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from mjbeer.model.setting import GAUSS_JACKSON, ROLLINGS
from mjbeer.output.plots import COLOURS, GREY, chart, name_below
from mjbeer.predictions.semi_implicit_euler import euler_error
from mjbeer.studies.benchmark import frontier
from mjbeer.studies.benchmark.curves import CHOSEN, TOLERANCE, USUAL, Curve
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.benchmark.tables import setting
from mjbeer.studies.cases import MEASURED
from mjbeer.theory.named import in_degrees, in_words

_METHODS = {"Euler": 0, "implicit": 4, "implicitfast": 5, "discrete": 3, "RK4": 1, "DOP853": 2, "GaussJackson": 6}
_METHODS[CHOSEN] = _METHODS["DOP853"]
"""Colours of the integrators; runs to a tolerance have hollow markers."""
_LINES = {"reduced": ("-", "o"), "equality": ("--", "s"), "contact": (":", "^")}
"""Lines and markers of the ways of rolling."""
_USUAL = {"equality, slide first": "X", "equality, hinge first": "P", "contact, defaults": "*"}
"""Markers of models as people usually write them."""
_PEERS = ("v", "<", ">", "D", "+", "x", "*")
"""Markers of other tools."""
_SHORT = "GJ"
"""GaussJackson in the labels beside points; the legend says so."""
_FLOOR = 1e-15
"""Smaller errors [rad] are drawn here, since a logarithmic axis has no zero."""


def draw(study: Benchmark, path: pathlib.Path) -> None:
    """Draw the diagram of a study, and write it to `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    cases = study.cases
    columns = min(2, len(cases))
    rows = -(-len(cases) // columns)
    title = "Error against run time: how long a simulation takes, and how far it is from exact theory"
    subtitle = (
        "reduced: rolling is built into the coordinates; equality: a constraint of two joints; contact: friction. "
        f"{study.machine['processor']}"
    )
    size: dict[str, Any] = {"width": 7.5 * columns, "height": 6.2 * rows + 2.5}
    with chart(path, rows, columns, **size, title=title, subtitle=subtitle) as panels:
        for axes, case in zip(panels, cases, strict=False):
            _panel(axes, study, case)
        for axes in panels[len(cases) :]:
            axes.set_visible(False)
        name_below(panels, 4, _legend(panels))


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


def _panel(axes: Axes, study: Benchmark, case: str) -> None:
    """Draw the points of a case, the front, and the prediction for semi-implicit Euler."""
    points = frontier.drawn(study.of(case))
    ran = {point.way for point in frontier.drawn(study.points) if point.failure is None}
    peers = sorted(ran - {*ROLLINGS, *USUAL})
    for curve in dict.fromkeys(point.curve for point in points):
        times, errors = _coordinates([point for point in points if point.curve == curve])
        if curve.way in USUAL:
            style: dict[str, Any] = {
                "linestyle": "none",
                "marker": _USUAL[curve.way],
                "markersize": 13,
                "color": "#000000",
            }
            axes.plot(times, errors, label=f"as usually written, 2 ms: {curve.way}", zorder=4, **style)
        elif curve.way in ROLLINGS:
            _line(axes, curve, times=times, errors=errors)
        else:
            marker = _PEERS[peers.index(curve.way) % len(_PEERS)]
            axes.plot(times, errors, color=GREY, linewidth=1, marker=marker, markersize=4, label=curve.way)
    _front(axes, points)
    _prediction(axes, case, points)
    start = MEASURED[case]
    axes.set(xscale="log", yscale="log", ylim=(_FLOOR / 2, 20))
    axes.minorticks_off()
    begun = "" if start.scene.dissipates else f", from φ = {in_degrees(start.phi0)}"
    axes.set_title(f"{case}: {in_words(start.scene)}{begun}")
    axes.set(xlabel="run time of 2 s of motion [ms]", ylabel="largest error of φ and u/a [rad]")


def _coordinates(points: list[Point]) -> tuple[list[float], list[float]]:
    """Return run times [ms] and errors [rad] of points, as they are drawn."""
    return [1e3 * point.time for point in points], [max(point.error, _FLOOR) for point in points]


def _line(axes: Axes, curve: Curve, times: list[float], errors: list[float]) -> None:
    """Draw a curve of mjbeer's own models: markers are hollow for runs to a tolerance."""
    line, marker = _LINES[curve.way]
    colour = COLOURS[_METHODS[curve.method]]
    adaptive = curve.knob == TOLERANCE
    face = "white" if adaptive else colour
    method = f"{curve.method} ({_SHORT})" if curve.method == GAUSS_JACKSON else curve.method
    label = f"{method}{' to a tolerance' if adaptive else ''}, {curve.way}"
    style: dict[str, Any] = {
        "linestyle": line,
        "marker": marker,
        "markersize": 4,
        "linewidth": 1.1,
        "markerfacecolor": face,
    }
    axes.plot(times, errors, color=colour, label=label, **style)


def _front(axes: Axes, points: list[Point]) -> None:
    """Draw the front of mjbeer's own settings, and name the fastest for every second decade of error."""
    best = frontier.front(frontier.ours(points))
    times, errors = _coordinates(best)
    axes.plot(
        times,
        errors,
        color=COLOURS[2],
        linewidth=7,
        alpha=0.25,
        solid_capstyle="round",
        label="the best of mjbeer",
        zorder=1,
    )
    labelled = {}
    for level in frontier.LEVELS:
        point = frontier.cheapest(best, level)
        if point is not None:
            labelled[id(point)] = point  # one point may be the fastest for several levels
    for point in labelled.values():
        place = (1e3 * point.time, max(point.error, _FLOOR))
        name = setting(point) + ("" if point.way == "reduced" else f", {point.way}")
        name = name.replace(GAUSS_JACKSON, _SHORT)
        axes.annotate(name, xy=place, xytext=(-7, -3), textcoords="offset points", ha="right", fontsize=8)


def _prediction(axes: Axes, case: str, points: list[Point]) -> None:
    """Draw the error of semi-implicit Euler that backward error analysis predicts, at the measured run times."""
    euler = [point for point in points if point.way == "reduced" and point.method == "Euler"]
    start = MEASURED[case]
    if not euler or start.scene.dissipates:  # the theory of its error conserves energy
        return
    slope = float(abs(euler_error(start.scene, start.times, start.phi0)).max())
    times = [1e3 * point.time for point in euler]
    style: dict[str, Any] = {"color": "#000000", "linewidth": 0.9, "linestyle": (0, (1, 1)), "zorder": 5}
    axes.plot(
        times, [slope * point.value for point in euler], label="Euler, reduced: error as theory predicts", **style
    )
