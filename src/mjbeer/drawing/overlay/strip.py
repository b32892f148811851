"""The strip below a film: charts over time, MuJoCo's lines over theory's, each with a dot in step with the film."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from mjbeer.drawing.overlay.sheet import Sheet

MUJOCO = (0.0, 0.447, 0.698)
"""Colour of a simulation's line, where there is one only."""
_THEORY = "#b4bcc8"
"""Colour of theory's lines, which are wide and lie below."""
_STYLE: dict[Any, Any] = {
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.family": "DejaVu Sans",  # matplotlib's own, whatever the user's settings are
    "grid.alpha": 0.35,
    "legend.frameon": False,
}


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a chart."""

    name: str
    time: np.ndarray
    """Times [s], shape (samples,)."""
    values: np.ndarray
    """Values at these times."""
    colour: tuple[float, float, float] | None = None
    """Its colour; None for theory's line, which is seen from the beginning."""
    possible: float = math.inf
    """Time [s] from which the line is dotted, because the motion is not possible."""


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart over time."""

    title: str
    """What it shows, with letter and unit."""
    lines: Sequence[Line]
    low: float = -math.inf
    """Least value that the chart has room for."""
    high: float = math.inf
    """Largest value that it has room for."""
    least: float = 0.0
    """Least range of values that it shows: a straight line is not to look like a crooked one."""
    tells: bool = True
    """Whether theory's lines are there from the beginning, and tell what will be."""


class Strip:
    """Charts side by side. Lines with a colour are drawn up to now; theory's may be there from the beginning."""

    def __init__(self, charts: Sequence[Chart], width: int, height: int) -> None:
        self._charts = charts
        self._height, self._unit = height, height / 10
        unit = self._unit
        with rc_context(_STYLE | {"font.size": 0.9 * unit, "axes.linewidth": 0.06 * unit}):
            figure = Figure(figsize=(width / 72, height / 72), dpi=72)
            canvas = FigureCanvasAgg(figure)
            panels = figure.subplots(1, len(charts), squeeze=False)[0]
            sides = {"left": 4.5 * unit / width, "right": 1 - 2 * unit / width}
            figure.subplots_adjust(**sides, top=0.84, bottom=0.27, wspace=10 * unit / (width / len(charts)))
            drawn = [self._draw(panel, chart) for panel, chart in zip(panels, charts, strict=True)]
            if len({line.name for line in charts[0].lines}) > 1:
                handles, names = panels[0].get_legend_handles_labels()
                named = dict(zip(names, handles, strict=True))
                figure.legend(
                    named.values(), named, loc="lower right", bbox_to_anchor=(1 - unit / width, 0), ncols=2,
                    borderaxespad=0.1,
                    borderpad=0, handlelength=1.5, columnspacing=1.2,
                )  # fmt: skip
            canvas.draw()
            self._complete = np.array(canvas.buffer_rgba())
            for line in itertools.chain(*drawn):
                line.set_visible(False)
            canvas.draw()
            self._beginning = np.array(canvas.buffer_rgba())
            self._panels = [(panel.transData, panel.get_window_extent()) for panel in panels]

    def _draw(self, panel: Axes, chart: Chart) -> list:
        """Draw a chart, and return the lines that are to be seen up to now only."""
        unit, drawn = self._unit, []
        for line in sorted(chart.lines, key=lambda line: line.colour is not None):
            possible = line.time <= line.possible
            style: dict[str, Any] = {
                "color": line.colour or _THEORY,
                "linewidth": (0.18 if line.colour else 0.5) * unit,
            }
            drawn += panel.plot(line.time, unbroken(np.where(possible, line.values, np.nan)), **style, label=line.name)
            if not possible.all():
                style |= {"linestyle": ":", "linewidth": 0.25 * unit}
                panel.plot(line.time, unbroken(np.where(possible, np.nan, line.values)), **style)
            if line.colour is None and chart.tells:
                drawn.pop()
        panel.set_title(chart.title, fontsize=1.05 * unit, loc="left", pad=0.45 * unit)
        panel.set_xlim(min(line.time[0] for line in chart.lines), max(line.time[-1] for line in chart.lines))
        low, high = panel.get_ylim()
        room = max(0.0, chart.least - (high - low)) / 2
        panel.set_ylim(max(low - room, chart.low), min(high + room, chart.high))
        panel.set_xlabel("time [s]", labelpad=0.1 * unit, loc="left")
        panel.tick_params(pad=0.25 * unit, length=0.3 * unit)
        return drawn

    def draw(self, sheet: Sheet, time: float, top: int) -> None:
        """Draw the strip as it is at a `time` [s], with its upper edge at a row of the sheet."""
        shown = self._beginning.copy()
        for transform, extent in self._panels:
            left, now = int(extent.x0), int(transform.transform((time, 0))[0])
            shown[:, left:now] = self._complete[:, left:now]
        sheet.put(shown, 0, top)
        for (transform, extent), chart in zip(self._panels, self._charts, strict=True):
            for line in chart.lines:
                if line.colour is None:
                    continue
                value = line.values[max(np.searchsorted(line.time, time, side="right") - 1, 0)]
                column, up = transform.transform((min(time, line.time[-1]), value))
                if extent.y0 - 1 <= up <= extent.y1 + 1:
                    sheet.disc(np.array([column, top + self._height - up]), 0.5 * self._unit, line.colour)


def unbroken(values: np.ndarray) -> np.ndarray:
    """Return values with a gap wherever they jump by more than half of their range, as a wrapped angle does."""
    finite = values[np.isfinite(values)]
    jumps = np.abs(np.diff(values, prepend=values[:1])) > (np.ptp(finite) / 2 if len(finite) else 0)
    return np.where(jumps, np.nan, values)
