"""The film of several cans that are let go together on one incline."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.drawing.camera import View, in_space, scale
from mjbeer.drawing.film import Film, RenderPlan
from mjbeer.drawing.overlay import HEIGHT, draw_title, draw_warning
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.words import in_degrees
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_APART = 0.225  # distance from lane to lane as drawn [m]; a can is 0.12 m long
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye: in front of the board, and so high above it that no can hides another."""
_ORDINALS = ("1st", "2nd", "3rd", "4th")


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]
    """Colour of its label, its name and its lines."""
    load: tuple[float, float, float] | None = None
    """Colour of what is in it; None is that of beer or ice."""
    note: str = ""
    """What else is to be known of it, such as "μ = 0.35"; it stands below the name."""

    def finish(self, length: float) -> float:
        """Return when the can has rolled a `length` [m] [s], infinity if its motion ends before."""
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
    """What a can's plate says from some time on."""

    time: float
    """[s]."""
    words: str


@dataclass(frozen=True)
class Race(Film):
    """A film of several cans of one size that are let go together on one incline.

    Each has its time by its name at the finish. With `centres` it is no race: the cans' centres of
    mass are marked and joined, from one line on.
    """

    title: str
    runners: Callable[[], Sequence[Runner]]
    """A function that computes the motions, and that can be pickled."""
    length: float
    """Distance from start to finish, or that is seen from the start on [m]."""
    duration: float
    """[s]."""
    facts: str = ""
    """What holds for all cans besides the incline, such as "all full"; it stands below the
    title."""
    centres: bool = False

    def plan(self) -> RenderPlan:
        return RenderPlan(0.0, self.duration, self.speed, partial(self._pictures, self.runners()))

    def results(self, runners: Sequence[Runner]) -> list[Result]:
        """Return what each can's plate says from its finish on.

        That of a can that comes too late says so from 0.4 s before the end on. Cans whose times are
        the same as shown share a place.
        """
        finishes = [runner.finish(self.length) for runner in runners]
        shown = [round(finish, 2) for finish in finishes]
        results = []
        for finish, time in zip(finishes, shown, strict=True):
            if finish < self.duration:
                place = _ORDINALS[sum(other < time for other in shown)]
                shared = "shared " if shown.count(time) > 1 else ""
                results.append(Result(finish, f"{shared}{place}: {time:.2f} s"))
            else:
                results.append(Result(self.duration - 0.4, f"needs {time:.2f} s"))
        return results

    def _pictures(
        self, runners: Sequence[Runner], times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        sheet = Sheet(width, height)
        top = round(HEIGHT * sheet.unit)
        display = self._display(runners)
        view = self._view(display, (width, height - top), top)
        positions = np.stack([runner.positions(times) for runner in runners], axis=1)
        if self.centres:  # they begin at one line, while in a race the axes do
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
                for lane, (runner, result) in enumerate(zip(runners, results, strict=True)):
                    below_name = result.words if time >= result.time else runner.note
                    place = self._plate_place(display, view, lane, now[lane][0])
                    lines = [runner.name, below_name] if below_name else [runner.name]
                    sheet.plate(place, lines, runner.colour, (1, 0.5))
                if self.centres:
                    _join_centres(sheet, view, display, now)
                draw_warning(sheet, doubts, top)
                yield sheet.picture()

    def _display(self, runners: Sequence[Runner]) -> Display:
        scenes = [runner.trajectory.scene for runner in runners]
        display = Display(scenes, _APART, lines=[0.0] if self.centres else [0.0, self.length])
        display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        return display

    def _view(self, display: Display, pixels: tuple[int, int], top: int) -> View:
        """Return the view of all lanes, with room for the names before the start."""
        outlines = [
            display.outline(lane, np.array([u, 0.0, 0.0, 0.0]))
            for lane in range(len(display.lanes))
            for u in (-0.4 * self.length, self.length)
        ]
        points = np.reshape(outlines, (-1, 3))
        eye = points.mean(axis=0) + 6 * self.length * _EYE
        return View.towards(eye, points, pixels, top, margin=0.01)

    def _words(self, display: Display) -> str:
        """Return what holds for all cans."""
        facts = [f"incline {in_degrees(display.scenes[0].incline)}"]
        if not self.centres:
            facts.insert(0, f"{self.length:g} m")
        if self.facts:
            facts.append(self.facts)
        return ", ".join(facts)

    def _plate_place(self, display: Display, view: View, lane: int, u: float) -> np.ndarray:
        """Return where a can's plate is: it travels behind the can, and stays at the finish."""
        scene = display.scenes[0]
        along = min(u * scale(scene), self.length) - 1.5 * RADIUS
        return view.pixel(in_space(scene, along, 0.0, display.lanes[lane]))


def _join_centres(sheet: Sheet, view: View, display: Display, positions: np.ndarray) -> None:
    """Mark the cans' centres of mass at their near ends, and join them."""
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
    sheet.text(beside, "centre of mass", 1.1 * sheet.unit, halo=True)
