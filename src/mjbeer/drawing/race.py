"""The film of a race: cans let go together on one incline, and the order in which they reach its end."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing.camera import View, circle, on_incline
from mjbeer.drawing.film import Reel
from mjbeer.drawing.overlay import HEIGHT, head
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import UNITS, Sheet, whole
from mjbeer.drawing.strip import Chart, Line, Strip
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.exact import exact
from mjbeer.theory.load import segment
from mjbeer.theory.named import in_degrees
from mjbeer.theory.trajectory import Trajectory

_APART = 0.225
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
_FAR = 6.0
"""Distance of the eye, in lengths of the race."""
_SMOOTH = 400
"""Number of points of a line in the chart."""


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]
    """Colour of its label, its name and its line."""
    load: tuple[float, float, float] | None = None
    """Colour of what is in it; None is that of beer, or of ice if it is frozen."""

    @cached_property
    def distance(self) -> np.ndarray:
        """Return how far the can has rolled since the start [m], at each sample."""
        return self.trajectory.u - self.trajectory.u[0]

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s]; infinite if it ends before."""
        if self.distance[-1] < length:
            return math.inf
        return self._when(lambda time: self.positions(np.array([time]))[0, 0] - length)

    def finish_of_theory(self, length: float) -> float:
        """Return when exact theory has the can at a `length` [m] from the start [s]; infinite where `finish` is."""
        if self.way_of_theory(self.trajectory.time[-1]) < length:
            return math.inf
        return self._when(lambda time: self.way_of_theory(time) - length)

    def _when(self, ahead: Callable[[float], float]) -> float:
        return float(brentq(ahead, 1e-3, self.trajectory.time[-1], xtol=1e-12))

    def way_of_theory(self, time: float) -> float:
        """Return how far exact theory has the can from the start at a `time` [s], in metres."""
        motion = self.trajectory
        theory = exact(motion.scene, np.array([0.0, time]), motion.phi0, motion.phi_dot0)
        return float(theory.u[1] - theory.u[0])

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at some times [s], shape (times, 4).

        At times after the last sample they are those of the last sample.
        """
        moments = np.minimum(times, self.trajectory.time[-1])
        return coordinates(self.trajectory, moments) - [self.trajectory.u[0], 0, 0, 0]


@dataclass(frozen=True)
class Race:
    """A film of several cans of one size, let go together on one incline."""

    title: str
    runners: Callable[[], Sequence[Runner]]
    """A function that computes the motions, and that can be pickled."""
    length: float
    """Distance from start to finish [m]."""
    speed: float
    told: Callable[[], str]
    """A function that says what is seen, in whole sentences, for the text beside the film."""
    still: float
    after: float = 0.0
    """How long the film goes on after the last can has finished, in seconds of the motion [s]."""

    @property
    def caption(self) -> str:
        """Return what is seen."""
        return self.told()

    def reel(self) -> Reel:
        """Compute the motions, and return what is needed to draw them.

        A can that does not finish is followed until the others have.

        Raises:
          ParameterError: if no can finishes, or the motion of one that does not ends before that of the film.
        """
        runners = self.runners()
        end = _last(runners, self.length) + self.after
        for runner in runners:
            if runner.finish(self.length) == math.inf and not runner.trajectory.time[-1] >= end:
                raise ParameterError(
                    f"{runner.name} rolls {runner.distance[-1]:.3g} m to t = {runner.trajectory.time[-1]:.3g} s, and "
                    f"the race is over {self.length:g} m and lasts {end:.3g} s"
                )

        def pictures(times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
            return Course(self, runners, whole("width", width), whole("height", height)).draw(times)

        return Reel(0.0, end, self.speed, pictures)


def _last(runners: Sequence[Runner], length: float) -> float:
    """Return when the last of those cans finishes that do finish a race over a `length` [m], as a time [s].

    Raises:
      ParameterError: if none does.
    """
    times = [time for runner in runners if (time := runner.finish(length)) < math.inf]
    if not times:
        raise ParameterError(f"no can finishes: none rolls {length:g} m while its motion lasts")
    return max(times)


class Course:
    """What the pictures of a race are drawn with: board and lanes, names, the chart of the ways, and the table."""

    def __init__(self, race: Race, runners: Sequence[Runner], width: int, height: int) -> None:
        length, self.unit = race.length, height / UNITS
        self.race, self.runners, self.sheet = race, runners, Sheet(width, height)
        self.top, below = round(HEIGHT * self.unit), round(_STRIP * self.unit)
        scenes = [runner.trajectory.scene for runner in runners]
        self.display = Display.of(scenes, -_NAMES, length, _APART, lines=(0.0, length))
        self.display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        ends = [np.array([u, 0.0, 0.0, 0.0]) for u in (-_NAMES, length)]
        outlines = [self.display.outline(lane, end).reshape(-1, 3) for lane in range(len(scenes)) for end in ends]
        points = np.concatenate(outlines)
        eye = points.mean(axis=0) + _FAR * length * _EYE
        self.view = View.towards(eye, points, (width, height - self.top - below), _MARGIN)
        self.end = _last(runners, length)
        self.strip = Strip([self._chart()], round(_CHART * width), below)
        self.finish = [runner.finish(length) for runner in runners]
        self.words = [self._words(runner) for runner in runners]
        """What the table has of each can once it has finished, or all have: by MuJoCo, and by theory."""

    def _chart(self) -> Chart:
        """Return the chart of the ways of all cans from start to finish; who looks on is to guess who wins."""
        lines = []
        for runner in self.runners:
            motion = runner.trajectory
            times = np.linspace(0, min(runner.finish(self.race.length), self.end), _SMOOTH)
            lines.append(Line("MuJoCo", times, runner.positions(times)[:, 0], runner.colour))
            theory = exact(motion.scene, times, motion.phi0, motion.phi_dot0)
            lines.append(Line("theory", times, theory.u - theory.u[0]))
        return Chart("way [m]", lines, tells=False)

    def _words(self, runner: Runner) -> tuple[str, str]:
        """Return when a can has finished, or how far it has come when the last of the others has."""
        if (time := runner.finish(self.race.length)) < math.inf:
            return f"{time:.2f} s", f"{runner.finish_of_theory(self.race.length):.2f} s"
        return f"{runner.positions(np.array([self.end]))[0, 0]:.2f} m", f"{runner.way_of_theory(self.end):.2f} m"

    def draw(self, times: np.ndarray) -> Generator[np.ndarray]:
        """Return a generator of the pictures at some times [s], each of shape (height, width, 3), uint8.

        Raises:
          RenderingError: while the first picture is drawn, if OpenGL does not work.
        """
        with closing(Painter(self.display, *self.view.pixels, still=True)) as painter:
            for time in times:
                self.sheet.boxes.clear()
                painter.paint(self.sheet, self.view, self.positions(time), self.top)
                self.explain(time)
                yield self.sheet.picture()

    def positions(self, time: float) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] of each can at a time [s]."""
        return np.concatenate([runner.positions(np.array([time])) for runner in self.runners])

    def explain(self, time: float) -> None:
        """Draw title, names before the start, chart and table at a `time` [s]."""
        sheet, unit, below = self.sheet, self.unit, self.top + self.view.pixels[1]
        incline = self.display.scenes[0].incline
        x, z = on_incline(self.display.scenes[0], -1.6 * RADIUS, 0.0)
        for runner, lane in zip(self.runners, self.display.lanes, strict=True):
            place = self.view.pixel(np.array([x, lane, z])) + np.array([0, self.top])
            sheet.text(place, runner.name, 1.05 * unit, runner.colour, anchor=(1, 0.5), halo=True)
        scene = f"{self.race.length:g} m, incline {in_degrees(incline)}"
        head(sheet, (self.race.title, scene), time, self.race.speed, unit)
        self.strip.draw(sheet, time, below)
        self._table(time, (round(_CHART * sheet.width), below))

    def _table(self, time: float, corner: tuple[int, int]) -> None:
        """Draw each can from its end, and when it has finished; `corner` is the table's upper left one."""
        sheet, unit, (left, top) = self.sheet, self.unit, corner
        sheet.blank(*corner, sheet.width, sheet.height)
        columns = left + unit * np.array([1.6, 3.6, 19.5, 25.0])
        for column, by in zip(columns[2:], ("MuJoCo", "theory"), strict=True):
            sheet.text((column, top + 1.2 * unit), by, 0.95 * unit, "#52606d", anchor=(0.5, 0.5))
        order, table = (
            sorted(self.finish),
            zip(self.runners, self.finish, self.words, self.positions(time), strict=True),
        )
        for row, (runner, finish, words, position) in enumerate(table):
            middle = top + (2.9 + 2.25 * row) * unit
            _section(sheet, np.array([columns[0], middle]), 0.95 * unit, runner, position)
            sheet.text((columns[1], middle), runner.name, 1.05 * unit, bold=time >= finish == order[0])
            if time >= finish:
                place = f"{order.index(finish) + 1}."
                sheet.text((columns[2] - 3.6 * unit, middle), place, 1.05 * unit, runner.colour, (1, 0.5), bold=True)
            if time >= min(finish, self.end):
                for column, number in zip(columns[2:], words, strict=True):
                    sheet.text((column, middle), number, 1.05 * unit, anchor=(0.5, 0.5))


def _section(sheet: Sheet, centre: np.ndarray, radius: float, runner: Runner, position: np.ndarray) -> None:
    """Draw a can as seen along its axis, with its beer: a close-up of what is small in the picture."""
    scene, (_, phi, roll, _) = runner.trajectory.scene, position
    fill, tilt = scene.load.fill or 0.0, phi + scene.incline
    if fill > 1e-3:
        half = segment(fill).half_angle
        angles = tilt + np.linspace(-half, half, 40)
        usual = (0.92, 0.58, 0.06) if scene.attachment == "sliding" else (0.62, 0.78, 0.90)
        sheet.area(centre + radius * np.stack([-np.sin(angles), np.cos(angles)], axis=1), runner.load or usual)
    sheet.line(centre + circle(radius), 0.14 * radius, runner.colour)
    turned = np.array([math.sin(roll + scene.incline), -math.cos(roll + scene.incline)])
    sheet.line(centre + radius * np.array([[0.72], [1.0]]) * turned, 0.2 * radius, "#c0272d")
