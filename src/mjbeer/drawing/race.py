"""The film of several cans that are let go together on one incline."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.drawing.board import Board
from mjbeer.drawing.camera import Edges, View, in_space, scale
from mjbeer.drawing.film import Film, RenderPlan
from mjbeer.drawing.overlay import HEIGHT, draw_title, draw_warning
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.words import in_degrees
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_APART = 1.875
"""Distance from lane to lane, in lengths of the longest can."""
_EYE_DISTANCE = 6.0
"""Distance of the eye from the middle of the race, in its lengths."""
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye: in front of the board, and so high above it that no can hides another."""
_BEFORE = 0.3
"""How much of the incline is seen before the start, for the names, in lengths of the race."""
_CLOSE_UPS = 12.4
"""Height of the row of close-ups below the picture, in units of the sheet."""
_TEXTS = 4.7
"""Height of the three lines above a close-up, in units."""
_DISTANCES = RADIUS
"""Height of the distances below the board, as drawn [m]."""
_GAP = 0.4
"""Distance between two close-ups, in units."""
_SEEN = np.array([-1.22, 1.12])
"""What is seen in a close-up, from below to above the axis, in radii."""
_READABLE = 40
"""Least width of a picture with close-ups, in units."""
_BEHIND = 1.5 * RADIUS
"""How far behind the axis of its can a plate ends, as drawn [m]."""
_LATE = 0.4
"""How long before the end of the film the plate of a can says that it comes too late [s]."""
_ORDINALS = ("1st", "2nd", "3rd", "4th", "5th")


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]
    """Colour of its label, its name and its lines."""
    load: tuple[float, float, float] | None = None
    """Colour of what is in it; None keeps that of beer or ice."""
    note: str = ""
    """What else to know about it, such as "μ = 0.35"."""

    @property
    def rough(self) -> bool:
        """Whether the model of its liquid gives no more than an order of magnitude."""
        return bool(self.trajectory.liquid_warnings)

    def shown(self, time: float) -> str:
        """Return a time [s] in words, with two digits if it is rough."""
        return f"≈ {time:.2g} s" if self.rough else f"{time:.2f} s"

    def finish(self, length: float) -> float:
        """Return the time [s] at which the can has come a `length` [m] down the incline.

        It is infinity if its motion ends before.
        """
        motion = self.trajectory
        beyond = motion.u - motion.u[0] - length
        passed = CubicHermiteSpline(motion.time, beyond, motion.u_dot).roots(extrapolate=False)
        return float(passed[0]) if len(passed) else math.inf

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at times [s], shape (times, 4).

        After the end of its motion the can stays where it is.
        """
        motion = self.trajectory
        return coordinates(motion, np.minimum(times, motion.time[-1])) - [motion.u[0], 0, 0, 0]


class Result(NamedTuple):
    """What a can's plate says from a time on."""

    time: float
    """[s]."""
    words: str


@dataclass(frozen=True)
class Race(Film):
    """A film of up to five cans of one radius that are let go together on one incline.

    At the finish each can is held, and its time is written below its name. A time that the model of
    a liquid cannot tell well is written with two digits. Below the picture there is a close-up of
    each can, where there is room. With `centres` the film is no race: the centres of mass of the
    loads start at one line, and are marked and joined.

    Raises:
      ParameterError: when it is planned, if the cans differ in their radii or inclines.
    """

    title: str
    runners: Callable[[], Sequence[Runner]]
    """A function that computes the motions, and that can be pickled."""
    length: float
    """Distance from the start to the finish, or, with `centres`, to the end of the picture [m]."""
    duration: float
    """[s]."""
    facts: str = ""
    """What is the same for all cans besides the incline, such as "all full"; it stands below the
    title."""
    centres: bool = False
    """Whether the centres of mass are compared, in place of times."""

    def plan(self) -> RenderPlan:
        runners = self.runners()
        _check_equal_terms(runners)
        draw = partial(self._pictures, runners)
        return RenderPlan(0.0, self.duration, self.speed, draw, self.hold)

    def results(self, runners: Sequence[Runner]) -> list[Result]:
        """Return what each can's plate says from its finish on.

        Shortly before the end of the film, the plate of a can that arrives later says when. Cans
        whose times are the same as shown share a place.
        """
        finishes = [runner.finish(self.length) for runner in runners]
        shown = [round(finish, 2) for finish in finishes]
        results = []
        for runner, finish, time in zip(runners, finishes, shown, strict=True):
            if finish < self.duration:
                quicker = sum(other < time for other in shown)
                shared = "shared " if shown.count(time) > 1 else ""
                place = f"{shared}{_ORDINALS[quicker]}"
                results.append(Result(finish, f"{place}: {runner.shown(finish)}"))
            elif math.isfinite(finish):
                results.append(Result(self.duration - _LATE, f"needs {runner.shown(finish)}"))
            else:
                end = runner.trajectory.time[-1]
                results.append(Result(self.duration - _LATE, f"not there after {end:.2f} s"))
        return results

    def _pictures(
        self, runners: Sequence[Runner], times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        sheet = Sheet(width, height)
        top = round(HEIGHT * sheet.unit)
        display = self._display(runners)
        has_close_ups = not self.centres and width > _READABLE * sheet.unit
        below = round(_CLOSE_UPS * sheet.unit) if has_close_ups else 0
        board = Board(display)
        view = self._view(display, board, (width, height - top - below), top)
        positions = np.stack([self._positions(runner, times) for runner in runners], axis=1)
        if self.centres:  # the centres of mass start at one line; in a race the axes do
            positions[..., 0] += [runner.trajectory.u[0] for runner in runners]
            results = [Result(math.inf, "")] * len(runners)
        else:
            results = self.results(runners)
        words = self._words(display)
        doubts = [
            f"{runner.name}: {warning}"
            for runner in runners
            for warning in runner.trajectory.solver_warnings
        ]
        with closing(Painter(display, view.pixels)) as painter:
            for time, now in zip(times, positions, strict=True):
                painter.paint(sheet, view, now)
                draw_title(sheet, self.title, words, time, self.speed)
                sheet.blank(height - below, height)
                for lane, (runner, result) in enumerate(zip(runners, results, strict=True)):
                    place = self._plate_place(display, view, lane, now[lane, 0])
                    outcome = result.words if time >= result.time else ""
                    lines = [runner.name]
                    if has_close_ups:
                        panel = _panel(sheet, lane, len(runners), height - below)
                        _draw_close_up(painter, display, lane, now[lane], panel, sheet)
                        _name(sheet, panel, runner, outcome)
                    else:
                        lines += [said for said in (runner.note, outcome) if said]
                    sheet.plate(place, lines, runner.colour, (1, 0.5))
                if self.centres:
                    board.draw_distances(sheet, view)
                    _join_centres(sheet, view, display, now)
                draw_warning(sheet, doubts, top)
                yield sheet.picture()

    def _positions(self, runner: Runner, times: np.ndarray) -> np.ndarray:
        """Return a can's positions at times [s] as `Runner` has them, held at the finish."""
        if self.centres:
            return runner.positions(times)
        return runner.positions(np.minimum(times, runner.finish(self.length)))

    def _display(self, runners: Sequence[Runner]) -> Display:
        scenes = [runner.trajectory.scene for runner in runners]
        size = scale(scenes[0])
        apart = _APART * size * max(scene.can.length for scene in scenes)
        lines = [0.0] if self.centres else [0.0, self.length * size]
        display = Display(scenes, apart, lines)
        display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        return display

    def _view(self, display: Display, board: Board, pixels: tuple[int, int], top: int) -> View:
        """Return the view of all lanes from before the start to the finish.

        With `centres` there is room for distances below the board.
        """
        outlines = [
            display.outline(lane, np.array([u, 0.0, 0.0, 0.0]))
            for lane in range(len(display.lanes))
            for u in (-_BEFORE * self.length, self.length)
        ]
        points = np.reshape(outlines, (-1, 3))
        if self.centres:
            along = np.array([0.0, self.length]) * scale(display.scenes[0])
            below = board.under - _DISTANCES
            points = np.vstack([points, in_space(display.scenes[0], along, below, board.front)])
        distance = _EYE_DISTANCE * self.length * scale(display.scenes[0])
        eye = points.mean(axis=0) + distance * _EYE
        return View.towards(eye, points, pixels, top, margin=0.03)

    def _words(self, display: Display) -> str:
        """Return what holds for all cans."""
        facts = [f"incline {in_degrees(display.scenes[0].incline)}"]
        if not self.centres:
            facts = [f"{self.length:g} m", *facts]
        if self.facts:
            facts.append(self.facts)
        return ", ".join(facts)

    def _plate_place(self, display: Display, view: View, lane: int, u: float) -> np.ndarray:
        """Return where a can's plate is: it travels behind the can, and stays at the finish."""
        scene = display.scenes[0]
        along = min(u, self.length) * scale(scene) - _BEHIND
        return view.pixel(in_space(scene, along, 0.0, display.lanes[lane]))


def _panel(sheet: Sheet, lane: int, count: int, top: int) -> Edges:
    """Return where the close-up of the can in a lane is, below a row `top`, without its texts."""
    gap = _GAP * sheet.unit
    width = (sheet.width - gap) / count
    left = gap + lane * width
    upper = top + _TEXTS * sheet.unit
    lower = sheet.height - gap
    return Edges(round(left), round(upper), round(left + width - gap), round(lower))


def _draw_close_up(
    painter: Painter,
    display: Display,
    lane: int,
    position: np.ndarray,
    panel: Edges,
    sheet: Sheet,
) -> None:
    """Draw the near end of a can, which a `painter` has put at a position, into a panel."""
    pixels = (panel.right - panel.left, panel.lower - panel.upper)
    near, _ = display.ends(lane)
    scene = display.scenes[lane]
    u, lift = position[[0, 3]] * scale(scene)
    centre = in_space(scene, u, RADIUS + lift, near)
    centre[2] += _SEEN.mean() * RADIUS
    height = np.ptp(_SEEN) * RADIUS
    view = View.facing(centre, np.array([height * pixels[0] / pixels[1], height]), pixels)
    small = Sheet(*pixels)
    painter.paint_end(small, view, lane, position)
    sheet.composite(small.part(0, pixels[1]), panel.left, panel.upper)


def _name(sheet: Sheet, panel: Edges, runner: Runner, result: str) -> None:
    """Write a can's name, its note and its result above its close-up."""
    row = _TEXTS * sheet.unit / 3
    size = 1.2 * sheet.unit
    lowest = panel.upper - 0.6 * row
    sheet.text((panel.left, lowest - 2 * row), runner.name, size, runner.colour, bold=True)
    sheet.text((panel.left, lowest - row), runner.note, size)
    sheet.text((panel.left, lowest), result, size, bold=True)


def _check_equal_terms(runners: Sequence[Runner]) -> None:
    """Check that all cans have one radius, since they are drawn with one, and one incline.

    Raises:
      ParameterError: if they have not.
    """
    scenes = [runner.trajectory.scene for runner in runners]
    first = scenes[0]
    for scene in scenes:
        if scene.can.radius != first.can.radius:
            raise ParameterError(
                "the cans of a race must have one radius, "
                f"got {first.can.radius:g} m and {scene.can.radius:g} m"
            )
        if scene.incline != first.incline:
            raise ParameterError(
                "the cans of a race must be on one incline, "
                f"got {first.incline:g} rad and {scene.incline:g} rad"
            )


def _join_centres(sheet: Sheet, view: View, display: Display, positions: np.ndarray) -> None:
    """Mark the loads' centres of mass on the near ends of the cans, and join them."""
    places = []
    for lane, (scene, position) in enumerate(zip(display.scenes, positions, strict=True)):
        u, phi, _, lift = position
        along = u - scene.load.offset * math.sin(phi)
        height = lift - scene.load.offset * math.cos(phi)
        size = scale(scene)
        near = display.ends(lane)[0]
        place = in_space(scene, along * size, RADIUS + height * size, near)
        places.append(view.pixel(place))
    sheet.line(np.array(places), 0.2 * sheet.unit, INK, dashes=(3, 3))
    for place in places:
        sheet.disc(place, 0.5 * sheet.unit, (0.1, 0.1, 0.1))
    beside = places[0] + sheet.unit * np.array([1.0, 1.2])
    sheet.text(beside, "centre of mass", 1.2 * sheet.unit, halo=True)
