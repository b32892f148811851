"""The strip below a film: charts of quantities over time, each with a dot in step with the film."""

import contextlib
import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from mjbeer.drawing.sheet import Colour, Sheet
from mjbeer.exceptions import MjbeerError
from mjbeer.output.plots import COLOURS, STYLE
from mjbeer.theory.scene import GRAVITY
from mjbeer.theory.trajectory import Trajectory, exact_motion

_THEORY = "#b4bcc8"  # colour of theory's lines, which are wide and lie below
_LETTERS = 1.15  # height of letters, in units
_INTERVALS = 50  # number of intervals of a motion over which forces are averaged


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a chart."""

    name: str
    time: np.ndarray  # times [s], shape (samples,)
    values: np.ndarray  # values at these times
    colour: Colour | None = None  # None for theory's line, which is seen from the beginning


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart over time."""

    title: str  # what it shows, with letter and unit
    lines: Sequence[Line]
    low: float = -math.inf  # least value that the chart has room for
    high: float = math.inf  # largest value that it has room for; the blow of a landing goes beyond
    least: float = 0.0  # least range of values that it shows: a straight line is not to look like a crooked one


def charts(trajectory: Trajectory, names: Sequence[str]) -> list[Chart]:
    """Return the charts of some quantities of a trajectory, by their names in QUANTITIES, with what theory says."""
    theory = None
    if trajectory.rolling != "exact" and trajectory.time[0] >= 0:
        times = np.linspace(trajectory.time[0], trajectory.time[-1], 1500)
        with contextlib.suppress(MjbeerError):  # a start that rounding decides has no exact motion
            theory = exact_motion(trajectory.scene, times, trajectory.phi0, trajectory.phi_dot0)
            rolls = theory.time <= theory.rolls_until()  # later the incline would have to pull
            if np.count_nonzero(rolls) < 2:
                theory = None
    source, drawn = "exact theory" if trajectory.rolling == "exact" else "MuJoCo", []
    for name in names:
        title, values, limits = QUANTITIES[name]
        lines = [Line(source, trajectory.time, values(trajectory), COLOURS[0])]
        if theory is not None:
            lines.append(Line("theory", theory.time[rolls], values(theory)[rolls]))
        if name == "normal" and trajectory.rolling == "contact":
            title = f"N [weights], {1e3 * np.ptp(trajectory.time) / _INTERVALS:.2g} ms means"
        if (peak := lines[0].values.max()) > limits.get("high", math.inf):
            title += f", up to {peak:.0f}"
        drawn.append(Chart(title, lines, **limits))
    return drawn


def wrapped(angle: np.ndarray | float) -> np.ndarray:
    """Return an angle [rad] in degrees between -180 and 180."""
    return (np.degrees(angle) + 180) % 360 - 180


def even(motion: Trajectory, time: np.ndarray) -> np.ndarray:
    """Return where a can would be at some times [s] that accelerates evenly [m]: the motion goes to and fro about it.

    It starts with the same momentum, and with its load at rest in it where that has an equilibrium. It has neither
    damping nor drag: what it gains on the motion is what they cost.
    """
    scene, u, u_dot = motion.scene, motion.u[0], motion.u_dot[0]
    scene = dataclasses.replace(scene, damping=0.0, drag=0.0) if scene.dissipates else scene
    if scene.attachment == "sliding":
        swing = scene.load.moment / scene.effective_mass
        u = u - swing * (math.sin(motion.phi[0]) - math.sin(scene.equilibrium()))
        u_dot = u_dot - swing * math.cos(motion.phi[0]) * motion.phi_dot[0]
    since = time - motion.time[0]
    return u + u_dot * since + scene.acceleration() * since**2 / 2


def forces(motion: Trajectory) -> np.ndarray:
    """Return the normal force and the friction, positive up the incline, also while the can slips or is in the air.

    They are in weights of can and load, without gravity those on earth, with the shape (2, samples). They follow from
    the change of the momentum over a fiftieth of the motion: a can that hardly presses on the ground rises and lands
    many times a second, and each landing is a blow.
    """
    scene, time, load = motion.scene, motion.time, motion.scene.load.moment
    across = scene.mass * motion.lift_dot + load * np.sin(motion.phi) * motion.phi_dot
    along = scene.mass * motion.u_dot - load * np.cos(motion.phi) * motion.phi_dot
    half = np.ptp(time) / _INTERVALS / 2
    first, last = np.maximum(time - half, time[0]), np.minimum(time + half, time[-1])
    ends = [[np.interp(end, time, momentum) for end in (first, last)] for momentum in (across, -along)]
    gravity = scene.mass * scene.gravity * np.array([[math.cos(scene.incline)], [math.sin(scene.incline)]])
    return (gravity + np.diff(ends, axis=1)[:, 0] / (last - first)) / (scene.mass * (scene.gravity or GRAVITY))


QUANTITIES: dict[str, tuple[str, Callable[[Trajectory], np.ndarray], dict[str, float]]] = {
    "phi": ("angle of the load, φ [°]", lambda motion: wrapped(motion.phi), {"least": 10.0}),
    "u": ("distance [m]", lambda motion: motion.u - motion.u[0], {}),
    "u_dot": ("speed [m/s]", lambda motion: motion.u_dot, {}),
    "ahead": ("ahead of even acceleration [mm]", lambda motion: 1e3 * (motion.u - even(motion, motion.time)), {}),
    "normal": ("normal force, N [weights]", lambda motion: forces(motion)[0], {"low": -1.0, "high": 4.0}),
    "lift": ("height of flight [mm]", lambda motion: 1e3 * motion.lift, {}),
    "slip": ("slid instead of rolled [mm]", lambda motion: 1e3 * (motion.slip - motion.slip[0]), {}),
}
"""What a chart can show, by name: its title, its values, shape (samples,), and the chart's limits."""


class Strip:
    """Charts side by side. Lines with a colour are drawn up to now; theory's may be there from the beginning."""

    def __init__(
        self, charts: Sequence[Chart], width: int, height: int, marked: Sequence[tuple[float, float]] = ()
    ) -> None:
        """Prepare to draw charts, in which some spans of time are `marked`."""
        self._charts, self._height, self._unit, self._marked = charts, height, height / 10, marked
        letters = _LETTERS * self._unit
        sizes = {"font.size": letters, "legend.fontsize": letters, "axes.titlesize": letters}
        with rc_context(STYLE | sizes | {"axes.linewidth": 0.06 * self._unit, "font.family": "DejaVu Sans"}):
            figure = Figure(figsize=(width / 72, height / 72), dpi=72)
            canvas = FigureCanvasAgg(figure)
            panels = figure.subplots(1, len(charts), squeeze=False)[0]
            sides = {"left": 4.5 * letters / width, "right": 1 - 2 * letters / width}
            between = 6 * letters / (width / len(charts) - 6 * letters)
            figure.subplots_adjust(**sides, top=1 - 1.8 * letters / height, bottom=3 * letters / height, wspace=between)
            drawn = [line for pair in zip(panels, charts, strict=True) for line in self._draw(*pair)]
            handles, names = panels[0].get_legend_handles_labels()
            if len(named := dict(zip(names, handles, strict=True))) > 1:
                room: Any = {"borderaxespad": 0.1, "borderpad": 0, "handlelength": 1.2, "columnspacing": 1.0}
                room["bbox_to_anchor"] = (1 - self._unit / width, 0.0)
                figure.legend(named.values(), named, loc="lower right", ncols=4, **room)
            canvas.draw()
            self._beginning = np.array(canvas.buffer_rgba())
            for line in drawn:
                figure.draw_artist(line)
            self._complete = np.array(canvas.buffer_rgba())
            self._panels = [(panel.transData, panel.get_window_extent()) for panel in panels]

    def _draw(self, panel: Axes, chart: Chart) -> list:
        """Draw a chart but for the lines that are to be seen up to now only, and return those."""
        unit = self._unit
        for line in sorted(chart.lines, key=lambda line: line.colour is not None):
            style: dict[str, Any] = {"color": line.colour or _THEORY, "animated": line.colour is not None}
            width = (0.18 if line.colour else 0.5) * unit
            panel.plot(line.time, unbroken(line.values), **style, linewidth=width, label=line.name)
        for first, last in self._marked:
            panel.axvspan(first, last, color="#fff1b8", linewidth=0)
        panel.set_title(chart.title, pad=0.45 * unit)
        panel.xaxis.set_major_formatter("{x:g} s")
        panel.set_xlim(min(line.time[0] for line in chart.lines), max(line.time[-1] for line in chart.lines))
        low, high = panel.get_ylim()
        room = max(0.0, chart.least - (high - low)) / 2
        panel.set_ylim(max(low - room, chart.low), min(high + room, chart.high))
        panel.tick_params(pad=0.25 * unit, length=0.3 * unit)
        return [line for line in panel.lines if line.get_animated()]

    def draw(self, sheet: Sheet, time: float, top: int) -> None:
        """Draw the strip as it is at a `time` [s], with its upper edge at a row of the sheet."""
        shown = self._beginning.copy()
        for transform, extent in self._panels:
            left, now = int(extent.x0), int(transform.transform((time, 0))[0])
            shown[:, left:now] = self._complete[:, left:now]
        sheet.put(shown, top)
        for (transform, extent), chart in zip(self._panels, self._charts, strict=True):
            for line in chart.lines:
                value = line.values[max(int(np.searchsorted(line.time, time, side="right")) - 1, 0)]
                column, up = transform.transform((min(time, line.time[-1]), value))
                if line.colour and extent.y0 - 1 <= up <= extent.y1 + 1:
                    sheet.disc(np.array([column, top + self._height - up]), 0.5 * self._unit, line.colour)


def unbroken(values: np.ndarray) -> np.ndarray:
    """Return values with a gap wherever they jump by more than half of their range, as a wrapped angle does."""
    finite = values[np.isfinite(values)]
    jumps = np.abs(np.diff(values, prepend=values[:1])) > (np.ptp(finite) / 2 if len(finite) else 0)
    return np.where(jumps, np.nan, values)
