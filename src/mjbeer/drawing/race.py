"""The film of several cans let go together on one incline: a race, or two motions to be compared with charts."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing.camera import View, in_space, scale
from mjbeer.drawing.film import RenderPlan
from mjbeer.drawing.overlay import HEIGHT, head
from mjbeer.drawing.scene import Display, Painter, Scenery, coordinates
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.words import in_degrees
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_APART = 0.225  # distance from lane to lane as drawn [m]; a can is 0.12 m long
_BEFORE = 0.4  # room for the names on the board before the start, in lengths of the race
_MARGIN = 0.01  # margin around what must be seen, in widths of the picture
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye: in front of the board, and so high above it that no can hides another."""
_FAR = 6.0  # distance of the eye, in lengths of the race


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
        end = self.trajectory.time[-1]

        def ahead(time: float) -> float:
            return self.positions(np.array([time]))[0, 0] - length

        return float(brentq(ahead, 1e-3, end, xtol=1e-12)) if ahead(end) >= 0 else math.inf

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at some times [s], shape (times, 4).

        At times after the last sample they are those of the last sample.
        """
        moments = np.minimum(times, self.trajectory.time[-1])
        return coordinates(self.trajectory, moments) - [self.trajectory.u[0], 0, 0, 0]


@dataclass(frozen=True)
class Race:
    """A film of several cans of one size, let go together on one incline; each has its time by its name at the finish.

    With `centres` it is no race: the cans' centres of mass are marked and joined, from one line on, for as long as all
    motions last.
    """

    title: str
    runners: Callable[[], Sequence[Runner]]  # a function that computes the motions, and that can be pickled
    length: float  # distance from start to finish, or that is seen from the start on [m]
    speed: float
    told: Callable[[], str]  # a function that says what is seen, in whole sentences, for the text beside the film
    still: float
    after: float = 0.0  # how long it goes on after the last can that it waits for has finished [s]
    missing: int = 0  # how many cans it does not wait for; the film then ends with the times that they will need
    facts: str = ""  # what holds for all cans besides the incline, such as "tan α = 0.5"; it stands below the title
    caveat: str = ""  # what is not so in reality; it stands at the bottom of the scene
    centres: bool = False

    @property
    def caption(self) -> str:
        """Return what is seen."""
        return self.told()

    def plan(self) -> RenderPlan:
        """Compute the motions, and return what is needed to draw them."""
        runners = self.runners()
        if self.centres:
            end = min(float(runner.trajectory.time[-1]) for runner in runners)
        else:
            end = sorted(runner.finish(self.length) for runner in runners)[-1 - self.missing] + self.after
        return RenderPlan(0.0, end, self.speed, partial(self._pictures, runners, end))

    def _pictures(
        self, runners: Sequence[Runner], end: float, times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        sheet, scenes = Sheet(width, height), [runner.trajectory.scene for runner in runners]
        top, size = round(HEIGHT * sheet.unit), scale(scenes[0])
        display = Display.of(scenes, _APART)
        scenery = Scenery(scenes[0], display.model, (0.0,) if self.centres else (0.0, self.length))
        display.paint([runner.colour for runner in runners], [runner.load for runner in runners])
        ends = [np.array([u, 0.0, 0.0, 0.0]) for u in (-_BEFORE * self.length, self.length)]
        outlines = [display.outline(lane, end).reshape(-1, 3) for lane in range(len(scenes)) for end in ends]
        points = np.concatenate(outlines)
        eye = points.mean(axis=0) + _FAR * self.length * _EYE
        view = View.towards(eye, points, (sheet.width, sheet.height - top), _MARGIN)
        facts = [f"{self.length:g} m"] * (not self.centres) + [f"incline {in_degrees(scenes[0].incline)}"]
        words = self.title, ", ".join(facts + [self.facts] * bool(self.facts))
        results = [(math.inf, "")] * len(runners) if self.centres else self._results(runners)
        starts = [runner.trajectory.u[0] * self.centres for runner in runners]  # in a race all start at one line
        with closing(Painter(display, scenery, *view.pixels, still=True)) as painter:
            for time in times:
                sheet.boxes.clear()
                now = np.concatenate([runner.positions(np.array([time])) for runner in runners])
                now[:, 0] += starts
                painter.paint(sheet, view, now, top)
                head(sheet, words, time, self.speed)
                shown = zip(runners, results, display.lanes, now[:, 0] * size, strict=True)
                for runner, (finish, result), lane, u in shown:
                    said = [(runner.note, False, INK)] * bool(runner.note)
                    if time >= finish:
                        said = [(result, True, INK)]
                    elif end < finish < math.inf and time >= end - self.after:
                        said = [(f"needs {finish:.2f} s", True, INK)]
                    # It travels with the can, and stays at the finish.
                    along = min(u, self.length) - 1.5 * RADIUS
                    column, row = view.pixel(in_space(scenes[0], along, 0.0, lane), top)
                    sheet.plate((column, row), [(runner.name, True, runner.colour), *said], (1, 0.5))
                if self.centres:
                    _join(sheet, view.pixel(np.array([display.centre(*of) for of in enumerate(now)]), top))
                sheet.text((1.2 * sheet.unit, height - 1.5 * sheet.unit), self.caveat, 1.1 * sheet.unit, halo=True)
                yield sheet.picture()

    def _results(self, runners: Sequence[Runner]) -> list[tuple[float, str]]:
        """Return when each can finishes [s], and what its plate then says."""
        finishes = [runner.finish(self.length) for runner in runners]
        places = [sorted(finishes).index(finish) for finish in finishes]
        ordinals = "1st", "2nd", "3rd", *(f"{place + 1}th" for place in range(3, len(runners)))
        return [(finish, f"{ordinals[at]}: {finish:.2f} s") for finish, at in zip(finishes, places, strict=True)]


def _join(sheet: Sheet, places: np.ndarray) -> None:
    """Mark centres of mass, of which the first is the nearest, and join them."""
    sheet.line(places, 0.2 * sheet.unit, INK, dashes=(3, 3))
    for place in places:
        sheet.disc(place, 0.5 * sheet.unit, (0.1, 0.1, 0.1))
    sheet.text(places[0] + sheet.unit * np.array([1.0, 1.2]), "centre of mass", 1.1 * sheet.unit, halo=True)
