"""The film of several cans let go together on one incline: a race, or two motions to be compared."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.drawing.camera import View, in_space, scale
from mjbeer.drawing.film import Film, RenderPlan
from mjbeer.drawing.overlay import HEIGHT, head
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.words import in_degrees
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_APART = 0.225  # distance from lane to lane as drawn [m]; a can is 0.12 m long
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye: in front of the board, and so high above it that no can hides another."""


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]  # colour of its label, its name and its lines
    load: tuple[float, float, float] | None = None
    """Colour of what is in it; None is that of beer, or of ice if it is frozen."""
    note: str = ""  # what else is to be known of it, such as "μ = 0.35"; it stands below the name

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s]; infinite if it ends before."""
        motion, way = self.trajectory, self.trajectory.u - self.trajectory.u[0] - length
        passed = CubicHermiteSpline(motion.time, way, motion.u_dot).roots(extrapolate=False)
        return float(passed[0]) if len(passed) else math.inf

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at some times [s], shape (times, 4).

        At times after the last sample they are those of the last sample.
        """
        moments = np.minimum(times, self.trajectory.time[-1])
        return coordinates(self.trajectory, moments) - [self.trajectory.u[0], 0, 0, 0]


@dataclass(frozen=True)
class Race(Film):
    """A film of several cans of one size, let go together on one incline; each has its time by its name at the finish.

    With `centres` it is no race: the cans' centres of mass are marked and joined, from one line on.
    """

    title: str
    runners: Callable[[], Sequence[Runner]]  # a function that computes the motions, and that can be pickled
    length: float  # distance from start to finish, or that is seen from the start on [m]
    duration: float  # [s]
    facts: str = ""  # what holds for all cans besides the incline, such as "all full"; it stands below the title
    centres: bool = False

    def plan(self) -> RenderPlan:
        return RenderPlan(0.0, self.duration, self.speed, partial(self._pictures, self.runners()))

    def results(self, runners: Sequence[Runner]) -> list[tuple[float, str]]:
        """Return from when on a can's plate has its time [s], 0.4 s before the end at the latest, and what it says."""
        finishes, end = [runner.finish(self.length) for runner in runners], self.duration
        ordinals = dict(zip(sorted(finishes), ("1st", "2nd", "3rd", "4th"), strict=False))
        results = [(finish, f"{ordinals[finish]}: {finish:.2f} s") for finish in finishes]
        return [of if of[0] < end else (end - 0.4, f"needs {of[0]:.2f} s") for of in results]

    def _pictures(self, runners: Sequence[Runner], times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
        sheet, scenes = Sheet(width, height), [runner.trajectory.scene for runner in runners]
        top, size, facts = round(HEIGHT * sheet.unit), scale(scenes[0]), [f"incline {in_degrees(scenes[0].incline)}"]
        display = Display(scenes, _APART, lines=[0.0] if self.centres else [0.0, self.length])
        display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        ends = np.outer([-0.4 * self.length, self.length], [1, 0, 0, 0])  # names have room before the start
        points = np.reshape([display.outline(lane, end) for lane in range(len(scenes)) for end in ends], (-1, 3))
        eye = points.mean(axis=0) + 6 * self.length * _EYE
        view = View.towards(eye, points, (width, height - top), top, margin=0.01)
        positions = np.stack([runner.positions(times) for runner in runners], axis=1)
        if self.centres:  # they begin at one line, and in a race the axes do
            positions[..., 0] += [runner.trajectory.u[0] for runner in runners]
            results = [(math.inf, "")] * len(runners)
        else:
            results, facts = self.results(runners), [f"{self.length:g} m", *facts]
        words = ", ".join([*facts, self.facts]).removesuffix(", ")
        with closing(Painter(display, view.pixels)) as painter:
            for time, now in zip(times, positions, strict=True):
                painter.paint(sheet, view, now)
                head(sheet, self.title, words, time, self.speed)
                for runner, (finish, result), lane, (u, *_) in zip(runners, results, display.lanes, now, strict=True):
                    said = result if time >= finish else runner.note
                    # It travels with the can, and stays at the finish.
                    place = view.pixel(in_space(scenes[0], min(u * size, self.length) - 1.5 * RADIUS, 0.0, lane))
                    sheet.plate(place, [runner.name, *[said] * bool(said)], runner.colour, (1, 0.5))
                if self.centres:
                    _join(sheet, view, display, now)
                yield sheet.picture()


def _join(sheet: Sheet, view: View, display: Display, positions: np.ndarray) -> None:
    """Mark the cans' centres of mass at their near ends, of which the first is the nearest, and join them."""
    places = []
    for lane, (scene, (u, phi, _, lift)) in enumerate(zip(display.scenes, positions, strict=True)):
        along, height = u - scene.load.offset * math.sin(phi), lift - scene.load.offset * math.cos(phi)
        size, (near, _) = scale(scene), display.ends(lane)
        places.append(view.pixel(in_space(scene, along * size, RADIUS + height * size, near)))
    sheet.line(np.array(places), 0.2 * sheet.unit, INK, dashes=(3, 3))
    for place in places:
        sheet.disc(place, 0.5 * sheet.unit, (0.1, 0.1, 0.1))
    sheet.text(places[0] + sheet.unit * np.array([1.0, 1.2]), "centre of mass", 1.1 * sheet.unit, halo=True)
