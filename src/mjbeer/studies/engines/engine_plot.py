"""The picture of the can test: error over run time, with a panel for each case."""

import itertools
import math
import pathlib
from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes

from mjbeer.output.numbers import number
from mjbeer.output.plots import COLOURS, GREY, Picture, chart
from mjbeer.studies.can_test import CASES
from mjbeer.studies.engines.engine_tables import (
    COARSE,
    closest_defaults,
    order_cell,
    worst_error,
)
from mjbeer.studies.engines.results import EQUATION, CurveKey, Results, Row, order_of


class _Style(NamedTuple):
    """How the curves of an engine are drawn."""

    colour: str
    marker: str


_COLOURS = (*COLOURS, "#882255", "#808000", "#44AA99", GREY)
_STYLES = [_Style(colour, marker) for colour, marker in zip(_COLOURS, "osD^vPX*<h>", strict=True)]
_CEILING = 100.0
"""Points with larger errors [rad] are not drawn."""
_FLOOR = 1e-8
"""Nor are those with smaller ones: no contact has them."""
_FASTEST = 0.7
_SLOWEST = 4e4
"""The ends of the axis of processor time [ms]."""
_LABELS = 1.02
"""Where the labels begin, in widths of a panel."""
_APART = 0.06
"""Least distance of two labels, in heights of a panel."""
_PALE = 0.3
"""Opacity of the curves without a name."""
_SMALL = 22
_LARGE = 75
"""Areas of the markers, the second at 1 ms [square points]."""
_SUBTITLE = (
    "Each point is one timestep: 4, 2, 1 (large), 0.4 and 0.1 ms from left to right. Each engine's "
    "closest curve at 1 ms is named; its other shapes and settings are pale. Full markers: the "
    "error falls with the timestep h as the name says. Open markers: it has a floor [rad], or no "
    "power. SciPy is no engine; it has tolerances in place of timesteps, as Drake's error control "
    "has. Errors below 1e-8 rad are left out."
)


def draw(results: Results, path: pathlib.Path | Picture) -> None:
    """Draw all curves, and write them to `path` with .svg appended.

    Each case has a panel for the engines' defaults, and one for settings that are tuned. In a
    panel the closest curve of each engine is named.

    Raises:
      OutputError: if a file cannot be written.
    """
    styles = dict(zip(_engines(results), itertools.cycle(_STYLES), strict=False))
    with chart(
        path, 2 * len(CASES), 1, 8.5, 7.2 * len(CASES), _title(results), _SUBTITLE
    ) as panels:
        places = itertools.product(CASES.values(), (False, True))
        for axes, (case, tuned) in zip(panels, places, strict=True):
            curves = {}
            for key, rows in results.curves(case.name).items():
                shown = [row for row in rows if _FLOOR < row.error < _CEILING and row.seconds]
                if shown and shown[0].tuned == tuned:
                    curves[key] = shown
            named = _closest(curves)
            for key, shown in curves.items():
                _draw_curve(axes, shown, styles[key.engine], pale=key not in named)
            settings = "tuned" if tuned else "at the engines' defaults"
            axes.set(
                xscale="log",
                yscale="log",
                title=f"{case.name}, {settings}",
                xlim=(_FASTEST, _SLOWEST),
                ylim=(_FLOOR, _CEILING),
            )
            axes.set_xlabel("processor time of 2 s of motion [ms]")
            axes.set_ylabel("largest error of φ and u/a [rad]")
            axes.xaxis.set_major_formatter("{x:,g}")
            axes.minorticks_off()
            _name_ends(axes, named, styles)


def _closest(curves: dict[CurveKey, list[Row]]) -> dict[CurveKey, list[Row]]:
    """Return the curve of each engine whose error at 1 ms is the least."""
    closest: dict[str, CurveKey] = {}
    for key, rows in curves.items():
        best = closest.setdefault(key.engine, key)
        if _error_at_coarse(rows) < _error_at_coarse(curves[best]):
            closest[key.engine] = key
    return {key: curves[key] for key in closest.values()}


def _error_at_coarse(rows: Sequence[Row]) -> float:
    """Return the error at 1 ms [rad], or infinity if it is not drawn."""
    return next((row.error for row in rows if row.timestep == COARSE), math.inf)


def _title(results: Results) -> str:
    """Return how far engines are off at their defaults: the larger error of all cases, at 1 ms."""
    errors = [worst_error(results, way) for way in closest_defaults(results).values()]
    return (
        f"At their defaults and 1 ms, engines are {number(min(errors))} to {number(max(errors))} "
        "rad off in 2 s, each with its closest shape"
    )


def _engines(results: Results) -> list[str]:
    return list(dict.fromkeys(row.engine for row in results.rows))


def _draw_curve(axes: Axes, shown: Sequence[Row], style: _Style, pale: bool) -> None:
    order = order_of(shown)
    converges = order is not None and order.converges
    times = [1e3 * min(row.seconds) for row in shown]
    errors = [row.error for row in shown]
    if pale:
        axes.plot(times, errors, "-", color=style.colour, linewidth=0.9, alpha=_PALE, zorder=1)
        return
    axes.plot(times, errors, "-", color=style.colour, linewidth=1.6, zorder=2)
    axes.scatter(
        times,
        errors,
        [_area(row) for row in shown],
        marker=style.marker,
        edgecolors=style.colour,
        facecolors=style.colour if converges else "white",
        zorder=3,
    )


def _area(row: Row) -> float:
    """Return the area of a marker, which is large at 1 ms [square points]."""
    return _LARGE if row.timestep == COARSE and row.engine != EQUATION else _SMALL


def _name_ends(axes: Axes, ends: dict[CurveKey, list[Row]], styles: dict[str, _Style]) -> None:
    """Name curves to the right of the panel, in the order of their ends."""
    low, high = (math.log10(limit) for limit in axes.get_ylim())
    keys = sorted(ends, key=lambda key: ends[key][-1].error)
    heights = [(math.log10(ends[key][-1].error) - low) / (high - low) for key in keys]
    for key, height in zip(keys, spread(heights, _APART), strict=True):
        last = ends[key][-1]
        words = f"{key.engine}, {key.shape}"
        fall = order_cell(order_of(ends[key]))
        axes.annotate(
            f"{words}: {fall}" if fall else words,
            xy=(1e3 * min(last.seconds), last.error),
            xytext=(_LABELS, height),
            textcoords="axes fraction",
            color=styles[key.engine].colour,
            fontsize=9.5,
            va="center",
            annotation_clip=False,
            arrowprops={
                "arrowstyle": "-",
                "color": styles[key.engine].colour,
                "linewidth": 0.5,
                "relpos": (0.0, 0.5),
                "shrinkA": 1,
            },
        )


def spread(places: Sequence[float], apart: float) -> list[float]:
    """Return ascending places moved as little as it takes that each is `apart` from the next.

    Groups of places that would overlap stand around their mean.
    """
    groups: list[list[float]] = []
    for place in places:
        groups.append([place])
        while len(groups) > 1 and _start(groups[-1], apart) < _end(groups[-2], apart) + apart:
            last = groups.pop()
            groups[-1] += last
    moved = []
    for group in groups:
        moved += [_start(group, apart) + apart * index for index in range(len(group))]
    return moved


def _start(group: Sequence[float], apart: float) -> float:
    return sum(group) / len(group) - apart * (len(group) - 1) / 2


def _end(group: Sequence[float], apart: float) -> float:
    return _start(group, apart) + apart * (len(group) - 1)
