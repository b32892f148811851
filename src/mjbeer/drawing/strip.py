"""The strip below a film: charts of quantities over time, each with a dot in step with the film."""

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import BboxBase, Transform

from mjbeer.drawing.quantities import QUANTITIES
from mjbeer.drawing.sheet import INK, Colour, Sheet
from mjbeer.exceptions import MjbeerError
from mjbeer.output.plots import COLOURS, STYLE
from mjbeer.theory.trajectory import Trajectory, exact_motion

_THEORY = "#b4bcc8"
"""Colour of theory's lines, which are wide and lie below the others."""
_MOST_OF_A_TURN = 270.0
"""Range of an angle [degrees] from which on its chart shows a whole turn."""
_LITTLE = 0.08
"""So much of the range of the values may lie beyond the round value at an end of the axis."""
_LETTERS = 1.15
"""Height of the letters, in units: tenths of the strip's height."""


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a chart."""

    name: str
    time: np.ndarray
    """Times [s], shape (samples,)."""
    values: np.ndarray
    """Values at these times."""
    colour: Colour | None = None
    """None is for a line that is seen from the beginning, such as theory's."""
    thin: bool = False
    """Whether such a line is thin and dashed: a value that is not a motion's."""


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart over time."""

    title: str
    """What it shows, with its letter and unit."""
    lines: Sequence[Line]
    low: float = -math.inf
    """Least value that the chart has room for."""
    high: float = math.inf
    """Largest value that it has room for."""
    least: float = 0.0
    """Least range of values that it shows: a straight line must not look like a crooked one."""

    def ticks(self) -> np.ndarray:
        """Return round values from the least to the largest that the chart shows, two to four."""
        values = np.concatenate([line.values[np.isfinite(line.values)] for line in self.lines])
        low = max(float(values.min()), self.low)
        high = min(float(values.max()), self.high)
        room = max(0.0, self.least - (high - low)) / 2
        if high - low > _MOST_OF_A_TURN and self.title.endswith("[°]"):
            return np.array([-180.0, 0.0, 180.0])
        little = _LITTLE * (high - low)
        return _round_values(low - room + little, high + room - little)


def _round_values(low: float, high: float) -> np.ndarray:
    """Return two to four successive multiples of 1, 2, 3 or 5 times a power of ten.

    They reach from `low` or below to `high` or beyond.
    """
    if high == low:
        high = low + 1
    power = 10.0 ** math.floor(math.log10((high - low) / 3))
    for factor in (1, 2, 3, 5, 10, 20):
        step = factor * power
        first = math.floor(low / step)
        last = max(math.ceil(high / step), first + 1)
        if last - first <= 3:
            break
    return step * np.arange(first, last + 1)


class Stage(NamedTuple):
    """Times at which something happens, and the ground that they have in the charts."""

    spans: Sequence[tuple[float, float]]
    """From when to when [s] it happens."""
    ground: Colour


def charts(
    trajectory: Trajectory,
    names: Sequence[str],
    equilibrium: bool = False,
) -> list[Chart]:
    """Return charts of the quantities of these names in QUANTITIES, with theory's lines.

    The chart of phi can show its `equilibrium`.
    """
    theory = _theory(trajectory)
    shown = [_chart(trajectory, theory, name) for name in names]
    if equilibrium and "phi" in names:
        rest = np.full(2, math.degrees(trajectory.scene.equilibrium()))
        line = Line("equilibrium", trajectory.time[[0, -1]], rest, thin=True)
        place = names.index("phi")
        shown[place] = replace(shown[place], lines=[*shown[place].lines, line])
    return shown


def _chart(trajectory: Trajectory, theory: Trajectory | None, name: str) -> Chart:
    quantity = QUANTITIES[name]
    source = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
    values = quantity.values(trajectory)
    lines = [Line(source, trajectory.time, values, COLOURS[0])]
    if theory is not None:
        rolls = _rolls(theory)
        lines.append(Line("theory", theory.time[rolls], quantity.values(theory)[rolls]))
    title = quantity.title
    if name == "normal" and trajectory.rolling == "contact":
        title += ", smoothed"
    if values.max() > quantity.high:
        title += f", up to {values.max():.0f}"
    return Chart(title, lines, quantity.low, quantity.high, quantity.least)


def _theory(trajectory: Trajectory) -> Trajectory | None:
    """Return the exact motion from the start of a simulated one, or None if there is none to show.

    The start is at t = 0, and theory has nothing to show before it.
    """
    if trajectory.rolling == "exact" or trajectory.time[0] < 0:
        return None
    times = np.linspace(trajectory.time[0], trajectory.time[-1], 1500)
    with contextlib.suppress(MjbeerError):  # a start that rounding decides has no exact motion
        theory = exact_motion(trajectory.scene, times, trajectory.phi0, trajectory.phi_dot0)
        if np.count_nonzero(_rolls(theory)) >= 2:
            return theory
    return None


def _rolls(theory: Trajectory) -> np.ndarray:
    """Return at which samples the can rolls: later the incline would have to pull it."""
    return theory.time <= theory.rolls_until()


class ChartStrip:
    """Charts side by side, below the pictures of a film.

    Lines that have a colour are drawn up to the time of the picture, with a dot at their end.
    Theory's lines are there from the beginning.
    """

    def __init__(
        self,
        charts: Sequence[Chart],
        width: int,
        height: int,
        stages: Sequence[Stage] = (),
    ) -> None:
        """Prepare to draw charts of so many pixels, with the grounds of some `stages`.

        All is drawn twice, at the beginning and at the end of the film. A picture takes what is to
        the left of its time from the second.
        """
        self._charts = charts
        self._height = height
        self._unit = height / 10
        letters = _LETTERS * self._unit
        style: dict[str, Any] = {
            "font.family": "DejaVu Sans",
            "font.size": letters,
            "legend.fontsize": letters,
            "axes.titlesize": letters,
            "axes.linewidth": 0.06 * self._unit,
        }
        with rc_context(STYLE | style):
            figure = Figure(figsize=(width / 72, height / 72), dpi=72)  # an inch is 72 pixels
            canvas = FigureCanvasAgg(figure)
            panels = self._make_panels(figure, letters)
            growing = []
            for panel, chart in zip(panels, charts, strict=True):
                for stage in stages:
                    for first, last in stage.spans:
                        panel.axvspan(first, last, color=stage.ground, linewidth=0)
                growing += self._draw_panel(panel, chart)
            self._add_key(figure, panels)
            canvas.draw()
            self._beginning = np.array(canvas.buffer_rgba())
            for line in growing:
                figure.draw_artist(line)
            self._complete = np.array(canvas.buffer_rgba())
        self._panels: list[tuple[Transform, BboxBase]] = [
            (panel.transData, panel.get_window_extent()) for panel in panels
        ]

    def _make_panels(self, figure: Figure, letters: float) -> list[Axes]:
        """Return a panel for each chart, with room for `letters` of this height [pixels]."""
        width, height = figure.bbox.size
        count = len(self._charts)
        panels = figure.subplots(1, count, squeeze=False)[0]
        figure.subplots_adjust(
            left=4.5 * letters / width,
            right=1 - 2 * letters / width,
            top=1 - 1.8 * letters / height,
            bottom=3 * letters / height,
            wspace=6 * letters / (width / count - 6 * letters),
        )
        return list(panels)

    def _draw_panel(self, panel: Axes, chart: Chart) -> list[Line2D]:
        """Draw a chart without the lines that grow with the film, and return these."""
        unit = self._unit
        for line in sorted(chart.lines, key=lambda line: line.colour is not None):
            colour = line.colour or (INK if line.thin else _THEORY)
            width = 0.18 if line.colour or line.thin else 0.5  # theory's are wide
            panel.plot(
                line.time,
                unbroken(line.values),
                color=colour,
                animated=line.colour is not None,
                linewidth=width * unit,
                linestyle="--" if line.thin else "-",
                label=line.name,
            )
        panel.set_title(chart.title, pad=0.45 * unit)
        panel.xaxis.set_major_formatter("{x:g} s")
        start = min(line.time[0] for line in chart.lines)
        end = max(line.time[-1] for line in chart.lines)
        panel.set_xlim(start, end)
        ticks = chart.ticks()
        margin = 1.5 * _LITTLE * np.ptp(ticks)  # more than goes beyond the last of them
        panel.set_yticks(ticks)
        panel.set_ylim(ticks[0] - margin, ticks[-1] + margin)
        panel.yaxis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "\u2212"))
        panel.tick_params(pad=0.25 * unit, length=0.3 * unit)
        return [line for line in panel.lines if line.get_animated()]

    def _add_key(self, figure: Figure, panels: Sequence[Axes]) -> None:
        """Name the lines of the panels below the charts, unless they have one name."""
        named = {}
        for panel in panels:
            handles, names = panel.get_legend_handles_labels()
            named |= dict(zip(names, handles, strict=True))
        if len(named) > 1:
            figure.legend(
                named.values(),
                named,
                loc="lower right",
                bbox_to_anchor=(1 - self._unit / figure.bbox.width, 0.0),
                ncols=4,
                borderaxespad=0.1,
                borderpad=0,
                handlelength=1.2,
                columnspacing=1.0,
            )

    def draw(self, sheet: Sheet, time: float, top: int) -> None:
        """Draw the strip as it is at a `time` [s], with its upper edge at the row `top`."""
        shown = self._beginning.copy()
        for transform, extent in self._panels:
            left = int(extent.x0)
            now = int(transform.transform((time, 0))[0])
            shown[:, left:now] = self._complete[:, left:now]
        sheet.put(shown, top)
        for (transform, extent), chart in zip(self._panels, self._charts, strict=True):
            for line in chart.lines:
                sample = max(int(np.searchsorted(line.time, time, side="right")) - 1, 0)
                place = (min(time, line.time[-1]), line.values[sample])
                column, up = transform.transform(place)
                if line.colour and extent.y0 - 1 <= up <= extent.y1 + 1:
                    dot = np.array([column, top + self._height - up])
                    sheet.disc(dot, 0.5 * self._unit, line.colour)


def unbroken(values: np.ndarray) -> np.ndarray:
    """Return values with a gap (NaN) where they jump, as a wrapped angle does.

    A jump is a change of more than half of their range.
    """
    finite = values[np.isfinite(values)]
    limit = np.ptp(finite) / 2 if len(finite) else 0
    jumps = np.abs(np.diff(values, prepend=values[:1])) > limit
    return np.where(jumps, np.nan, values)
