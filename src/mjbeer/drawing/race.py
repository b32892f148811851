"""The race: four cans let go together on one incline, and the order in which they reach its end."""

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing import frames
from mjbeer.drawing.canvas import Canvas
from mjbeer.drawing.display import Display, on_incline
from mjbeer.drawing.film import Reel
from mjbeer.drawing.header import HEIGHT, head
from mjbeer.drawing.painter import Painter, outline
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import Chart, Line, Strip
from mjbeer.drawing.view import View, circle
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.exact import exact
from mjbeer.theory.segment import segment
from mjbeer.theory.trajectory import Trajectory
from mjbeer.theory.words import in_degrees

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


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]

    @cached_property
    def distance(self) -> np.ndarray:
        """Return how far the can has rolled since the start [m], at each sample."""
        return self.trajectory.u - self.trajectory.u[0]

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s].

        Raises:
          ParameterError: if its motion ends before that.
        """
        if self.distance[-1] < length:
            raise ParameterError(f"{self.name} rolls {self.distance[-1]:.3g} m, and the race is over {length:g} m")

        def ahead(time: float) -> float:
            u, *_ = frames.coordinates(self.trajectory, np.array([time]))[0]
            return u - self.trajectory.u[0] - length

        return float(brentq(ahead, 0, self.trajectory.time[-1], xtol=1e-12))

    def finish_of_theory(self, length: float) -> float:
        """Return when exact theory has the can at a `length` [m] from the start, as a time [s]."""
        scene, phi0 = self.trajectory.scene, self.trajectory.phi0

        def ahead(time: float) -> float:
            motion = exact(scene, np.array([0.0, time]), phi0, self.trajectory.phi_dot0)
            return float(motion.u[1] - motion.u[0]) - length

        return float(brentq(ahead, 1e-3, self.trajectory.time[-1], xtol=1e-12))


@dataclass(frozen=True)
class Race:
    """A film of several cans of one size, let go together on one incline."""

    title: str
    runners: Callable[[], Sequence[Runner]]
    """A function that computes the motions, and that can be pickled."""
    length: float
    """Distance from start to finish [m]."""
    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    caption: str
    """What is seen, in whole sentences, for the text beside the film."""
    still: float
    """Time of the motion that the still picture of the film shows [s]."""
    after: float = 0.0
    """How long the film goes on after the last can has finished, in seconds of the motion [s]."""

    def reel(self) -> Reel:
        """Compute the motions, and return what is needed to draw them."""
        runners = self.runners()
        end = max(runner.finish(self.length) for runner in runners) + self.after

        def pictures(times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
            return draw(self.course(runners, width, height), times)

        return Reel(0.0, end, self.speed, pictures)

    def course(self, runners: Sequence[Runner], width: int, height: int) -> "Course":
        """Return what is drawn of the race, in pictures of a width and a height [pixels]."""
        return Course.of(self, runners, frames.whole("width", width), frames.whole("height", height))


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

    race: Race
    runners: Sequence[Runner]
    sheet: Sheet
    display: Display
    view: View
    strip: Strip
    results: "_Results"
    top: int
    """Row of the upper edge of the scene [pixels]."""
    unit: float
    """Unit of length of the sheet [pixels]."""

    @classmethod
    def of(cls, race: Race, runners: Sequence[Runner], width: int, height: int) -> "Course":
        """Return the course of a race in pictures of a width and a height [pixels]."""
        unit = height / frames.UNITS
        top, below = round(HEIGHT * unit), round(_STRIP * unit)
        scenes = [runner.trajectory.scene for runner in runners]
        display = Display.of(scenes, -_NAMES, race.length, APART, lines=(0.0, race.length))
        display.paint([runner.colour for runner in runners])
        view = _view(display, race, (width, height - top - below))
        strip = Strip([_chart(race, runners)], round(_CHART * width), below)
        results = _Results.of(race, runners)
        return cls(race, runners, Sheet(width, height), display, view, strip, results, top, unit)

    def positions(self, time: float) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] of each can at a time [s]."""
        return np.array([_position(runner, time) for runner in self.runners])

    def explain(self, time: float) -> None:
        """Draw title, names, chart and results at a `time` [s]."""
        sheet, below = self.sheet, self.top + self.view.pixels[1]
        _name(sheet, self.display, self.view, self.runners, self.top, self.unit)
        scene = f"{self.race.length:g} m, incline {in_degrees(self.display.scenes[0].incline)}"
        head(sheet, (self.race.title, scene), time, self.race.speed, self.unit, digits=2)
        self.strip.draw(sheet, time, below)
        self.results.draw(sheet, time, self.positions(time), (round(_CHART * sheet.width), below), self.unit)


def _position(runner: Runner, time: float) -> np.ndarray:
    """Return u from the start [m], phi, roll from the start [rad] and lift [m] of a can at a time [s]."""
    moment = np.array([min(time, runner.trajectory.time[-1])])
    return frames.coordinates(runner.trajectory, moment)[0] - [runner.trajectory.u[0], 0, 0, 0]


def _view(display: Display, race: Race, pixels: tuple[int, int]) -> View:
    """Return the view that shows all cans from start to finish, and their names."""
    ends = [np.array([u, 0.0, 0.0, 0.0]) for u in (-_NAMES, race.length)]
    lanes = range(len(display.scenes))
    points = np.concatenate([outline(display, lane, end).reshape(-1, 3) for lane in lanes for end in ends])
    eye = points.mean(axis=0) + _FAR * race.length * _EYE
    return View.towards(eye, points, pixels, _MARGIN)


def _chart(race: Race, runners: Sequence[Runner]) -> Chart:
    """Return the chart of the ways of all cans from the start to the finish."""
    lines = []
    for runner in runners:
        motion = runner.trajectory
        times = np.linspace(0, runner.finish(race.length), _SMOOTH)
        u = frames.coordinates(motion, times)[:, 0]
        lines.append(Line("MuJoCo", times, u - motion.u[0], runner.colour))
        theory = exact(motion.scene, times, motion.phi0, motion.phi_dot0)
        lines.append(Line("theory", times, theory.u - theory.u[0]))
    return Chart("way [m]", lines)


def _name(sheet: Sheet, display: Display, view: View, runners: Sequence[Runner], top: int, unit: float) -> None:
    """Write the runners' names on their lanes, before the start."""
    x, z = on_incline(display.scenes[0], -1.6 * RADIUS, 0.0)
    for runner, lane in zip(runners, display.lanes, strict=True):
        place = view.pixel(np.array([x, lane, z])) + np.array([0, top])
        sheet.text(place, runner.name, 1.05 * unit, runner.colour, anchor=(1, 0.5), halo=True)


@dataclass(frozen=True, eq=False)
class _Results:
    """The table of the race: each can from its end, and when it has finished, by MuJoCo and by theory."""

    runners: Sequence[Runner]
    finish: Sequence[float]
    theory: Sequence[float]

    @classmethod
    def of(cls, race: Race, runners: Sequence[Runner]) -> "_Results":
        return cls(
            runners,
            [runner.finish(race.length) for runner in runners],
            [runner.finish_of_theory(race.length) for runner in runners],
        )

    def draw(self, sheet: Sheet, time: float, positions: np.ndarray, corner: tuple[int, int], unit: float) -> None:
        """Draw the table as it is at a `time` [s]; `corner` is its upper left corner."""
        sheet.blank(*corner, sheet.width, sheet.height)
        left, top = corner
        columns = left + unit * np.array([1.6, 3.6, 19.5, 25.0])
        for column, words in zip(columns[2:], ("MuJoCo", "theory"), strict=True):
            sheet.text((column, top + 1.2 * unit), words, 0.95 * unit, "#52606d", anchor=(0.5, 0.5))
        order = sorted(self.finish)
        for row, (runner, finish, theory, position) in enumerate(
            zip(self.runners, self.finish, self.theory, positions, strict=True)
        ):
            middle = top + (2.9 + 2.25 * row) * unit
            _section(sheet, np.array([columns[0], middle]), 0.95 * unit, runner, position)
            sheet.text((columns[1], middle), runner.name, 1.05 * unit, bold=time >= finish == order[0])
            if time >= finish:
                place = f"{order.index(finish) + 1}."
                sheet.text((columns[2] - 3.6 * unit, middle), place, 1.05 * unit, runner.colour, (1, 0.5), bold=True)
                sheet.text((columns[2], middle), f"{finish:.4f} s", 1.05 * unit, anchor=(0.5, 0.5))
                sheet.text((columns[3], middle), f"{theory:.4f} s", 1.05 * unit, anchor=(0.5, 0.5))


def _section(sheet: Sheet, centre: np.ndarray, radius: float, runner: Runner, position: np.ndarray) -> None:
    """Draw a can as seen along its axis, with its beer: a close-up of what is small in the picture."""
    scene, (_, phi, roll, _) = runner.trajectory.scene, position
    fill, tilt = scene.load.fill or 0.0, phi + scene.incline
    if fill > 1e-3:
        half = segment(fill).half_angle
        angles = tilt + np.linspace(-half, half, 40)
        arc = centre + radius * np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        sheet.area(arc, (0.92, 0.58, 0.06) if scene.attachment == "sliding" else (0.62, 0.78, 0.90))
    sheet.line(centre + circle(radius), 0.14 * radius, runner.colour)
    turned = np.array([math.sin(roll + scene.incline), -math.cos(roll + scene.incline)])
    sheet.line(centre + radius * np.array([[0.72], [1.0]]) * turned, 0.2 * radius, "#c0272d")
