"""The pictures of a race: the board with all lanes, the names, the ways over time, and the results."""

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from mjbeer.drawing.overlay.header import HEIGHT, head
from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.overlay.strip import Chart, Line, Strip
from mjbeer.drawing.painter import Painter, outline
from mjbeer.drawing.results import Results
from mjbeer.drawing.runner import Runner
from mjbeer.drawing.size import UNITS
from mjbeer.drawing.world.canvas import Canvas
from mjbeer.drawing.world.display import Display, on_incline
from mjbeer.drawing.world.view import View
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.exact import exact
from mjbeer.theory.named import in_degrees

APART = 0.225
"""Distance from lane to lane as drawn [m]; a can is 0.12 m long."""
_STRIP = 11
"""Height of chart and table, in units of the picture."""
_CHART = 0.5
"""Width of the chart, in widths of the picture."""
_NAMES = 0.26
"""Room for the names on the board before the start [m]."""
_MARGIN = 0.01
"""Margin around what must be seen, in widths of the picture."""
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye: in front of the board, and so high above it that no can hides another."""
_SMOOTH = 400
"""Number of points of a line in the chart."""
_FAR = 6.0
"""Distance of the eye, in lengths of the race."""


def draw(course: "Course", times: np.ndarray) -> Generator[np.ndarray]:
    """Return a generator of the pictures at some times [s], each of shape (height, width, 3), uint8.

    Raises:
      RenderingError: while the first picture is drawn, if OpenGL does not work.
    """
    with Canvas(course.display.model, *course.view.pixels) as canvas:
        painter = Painter(canvas, course.display, still=True)
        for time in times:
            course.sheet.boxes.clear()
            painter.paint(course.sheet, course.view, course.positions(time), course.top)
            course.explain(time)
            yield course.sheet.picture()


@dataclass(frozen=True, eq=False)
class Course:
    """Everything in the pictures of a race but what OpenGL draws."""

    title: str
    length: float
    """Distance from start to finish [m]."""
    speed: float
    """Playback speed."""
    runners: Sequence[Runner]
    sheet: Sheet
    display: Display
    view: View
    strip: Strip
    results: Results
    top: int
    """Row of the upper edge of the scene [pixels]."""
    unit: float
    """Unit of length of the sheet [pixels]."""

    @classmethod
    def of(
        cls, title: str, length: float, speed: float, runners: Sequence[Runner], width: int, height: int
    ) -> "Course":
        """Return the course of a race over a `length` [m] in pictures of a width and a height [pixels]."""
        unit = height / UNITS
        top, below = round(HEIGHT * unit), round(_STRIP * unit)
        scenes = [runner.trajectory.scene for runner in runners]
        display = Display.of(scenes, -_NAMES, length, APART, lines=(0.0, length))
        display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        view = _view(display, length, (width, height - top - below))
        strip = Strip([_chart(length, runners)], round(_CHART * width), below)
        results = Results.of(length, runners, last(runners, length))
        sheet = Sheet(width, height)
        return cls(title, length, speed, runners, sheet, display, view, strip, results, top, unit)

    def positions(self, time: float) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] of each can at a time [s]."""
        return np.concatenate([runner.positions(np.array([time])) for runner in self.runners])

    def explain(self, time: float) -> None:
        """Draw title, names, chart and results at a `time` [s]."""
        sheet, below = self.sheet, self.top + self.view.pixels[1]
        _name(sheet, self.display, self.view, self.runners, self.top, self.unit)
        scene = f"{self.length:g} m, incline {in_degrees(self.display.scenes[0].incline)}"
        head(sheet, (self.title, scene), time, self.speed, self.unit, digits=2)
        self.strip.draw(sheet, time, below)
        self.results.draw(sheet, time, self.positions(time), (round(_CHART * sheet.width), below), self.unit)


def last(runners: Sequence[Runner], length: float) -> float:
    """Return when the last of those cans finishes that do finish a race over a `length` [m], as a time [s].

    Raises:
      ParameterError: if none does.
    """
    times = [time for runner in runners if (time := runner.finish(length)) < math.inf]
    if not times:
        raise ParameterError(f"no can finishes: none rolls {length:g} m while its motion lasts")
    return max(times)


def _view(display: Display, length: float, pixels: tuple[int, int]) -> View:
    """Return the view that shows all cans from start to finish, and their names."""
    ends = [np.array([u, 0.0, 0.0, 0.0]) for u in (-_NAMES, length)]
    lanes = range(len(display.scenes))
    points = np.concatenate([outline(display, lane, end).reshape(-1, 3) for lane in lanes for end in ends])
    eye = points.mean(axis=0) + _FAR * length * _EYE
    return View.towards(eye, points, pixels, _MARGIN)


def _chart(length: float, runners: Sequence[Runner]) -> Chart:
    """Return the chart of the ways of all cans from the start to the finish; who looks on is to guess who wins."""
    lines, end = [], last(runners, length)
    for runner in runners:
        motion = runner.trajectory
        times = np.linspace(0, min(runner.finish(length), end), _SMOOTH)
        lines.append(Line("MuJoCo", times, runner.positions(times)[:, 0], runner.colour))
        theory = exact(motion.scene, times, motion.phi0, motion.phi_dot0)
        lines.append(Line("theory", times, theory.u - theory.u[0]))
    return Chart("way [m]", lines, tells=False)


def _name(sheet: Sheet, display: Display, view: View, runners: Sequence[Runner], top: int, unit: float) -> None:
    """Write the runners' names on their lanes, before the start."""
    x, z = on_incline(display.scenes[0], -1.6 * RADIUS, 0.0)
    for runner, lane in zip(runners, display.lanes, strict=True):
        place = view.pixel(np.array([x, lane, z])) + np.array([0, top])
        sheet.text(place, runner.name, 1.05 * unit, runner.colour, anchor=(1, 0.5), halo=True)
