"""The picture of the can test: error over run time, with a panel for each case."""

import itertools
import math
import pathlib
from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes

from mjbeer.output.plots import COLOURS, GREY, Picture, chart
from mjbeer.studies.engines.engine_tables import order_cell
from mjbeer.studies.engines.results import CASES, CurveKey, Results, Row, order_of


class _Style(NamedTuple):
    """How the curves of an engine are drawn."""

    colour: str
    marker: str


_COLOURS = (*COLOURS, "#882255", "#808000", "#44AA99", GREY)
_STYLES = [_Style(colour, marker) for colour, marker in zip(_COLOURS, "osD^vPX*<h>", strict=True)]
_CEILING = 100.0
"""Points with larger errors [rad] are not drawn."""
_FLOOR = 1e-7
"""Nor are those with smaller ones: no contact has them."""
_LABELS = 1.03
"""Where the labels begin, in widths of a panel."""
_APART = 0.026
"""Least distance of two labels, in heights of a panel."""
_SUBTITLE = (
    "Each point is one timestep: 4, 2, 1, 0.4 and 0.1 ms from left to right. Dashed: an engine's "
    "defaults; solid: tuned. A full marker's error falls with the timestep h as the label says; an "
    "open one's has a floor [rad]. SciPy has tolerances instead; errors below 1e-7 are left out."
)


def draw(results: Results, path: pathlib.Path | Picture) -> None:
    """Draw all curves, and write them to `path` with .svg appended.

    Raises:
      OutputError: if a file cannot be written.
    """
    title = "Error over run time of a can in physics engines"
    styles = dict(zip(_engines(results), itertools.cycle(_STYLES), strict=False))
    with chart(path, len(CASES), 1, 12, 8.2 * len(CASES), title, _SUBTITLE) as panels:
        for axes, case in zip(panels, CASES.values(), strict=True):
            curves = results.curves(case.name)
            ends = {}
            for key, rows in curves.items():
                shown = [row for row in rows if _FLOOR < row.error < _CEILING and row.seconds]
                if shown:
                    _draw_curve(axes, shown, styles[key.engine])
                    ends[key] = shown
            axes.set(
                xscale="log",
                yscale="log",
                title=f"{case.name}: {case.about}",
                ylim=(_FLOOR, _CEILING),
            )
            axes.set_xlabel("processor time of 2 s of motion [ms]")
            axes.set_ylabel("largest error of φ and u/a [rad]")
            axes.xaxis.set_major_formatter("{x:g}")
            axes.minorticks_off()
            _name_ends(axes, ends, styles)


def _engines(results: Results) -> list[str]:
    return list(dict.fromkeys(row.engine for row in results.rows))


def _draw_curve(axes: Axes, shown: Sequence[Row], style: _Style) -> None:
    order = order_of(shown)
    converges = order is not None and order.converges
    axes.plot(
        [1e3 * min(row.seconds) for row in shown],
        [row.error for row in shown],
        "-" if shown[0].tuned else "--",
        marker=style.marker,
        color=style.colour,
        markerfacecolor=style.colour if converges else "white",
        markersize=4.5,
        linewidth=1.2,
    )


def _name_ends(axes: Axes, ends: dict[CurveKey, list[Row]], styles: dict[str, _Style]) -> None:
    """Name the curves to the right of the panel, in the order of their ends."""
    low, high = (math.log10(limit) for limit in axes.get_ylim())
    keys = sorted(ends, key=lambda key: ends[key][-1].error)
    heights = [(math.log10(ends[key][-1].error) - low) / (high - low) for key in keys]
    for key, height in zip(keys, spread(heights, _APART), strict=True):
        last = ends[key][-1]
        words = f"{key.engine}, {key.shape}, {key.setting}"
        fall = order_cell(order_of(ends[key]))
        axes.annotate(
            f"{words}: {fall}" if fall else words,
            xy=(1e3 * min(last.seconds), last.error),
            xytext=(_LABELS, height),
            textcoords="axes fraction",
            color=styles[key.engine].colour,
            fontsize=8.5,
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
