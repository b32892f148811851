"""Films, of a motion or of several cans let go together: pictures one after the other, their speed, and a caption."""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer import require
from mjbeer.drawing.camera import AROUND, View, follow, in_space, scale
from mjbeer.drawing.overlay import HEADER, HEIGHT, NOTE, STRIP, Board, Look, Marks, head, header, note, spans, warn
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import INK, Sheet
from mjbeer.drawing.strip import Strip, charts
from mjbeer.drawing.words import in_degrees
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_APART = 0.225  # distance from lane to lane as drawn [m]; a can is 0.12 m long
_EYE = np.array([0.0, -math.cos(0.6), math.sin(0.6)])
"""Direction of the eye in a race: in front of the board, and so high above it that no can hides another."""
_ORDINALS = "1st", "2nd", "3rd", "4th"
_MOST_FRAMES = 1e6  # largest number of frames of a video: nine hours at 30 frames per second


@dataclass(frozen=True, eq=False)
class RenderPlan:
    """What is needed to draw a film: its pictures as a function of their times and size."""

    start: float  # time of the first picture [s]
    end: float  # time at which the film ends [s]
    speed: float  # playback speed: 1 is real time, 0.5 is half as fast
    draw: Callable[[np.ndarray, int, int], Generator[np.ndarray]]
    """Draws the pictures at some times [s], of a width and a height [pixels]: arrays (height, width, 3), uint8."""

    def times(self, fps: float) -> np.ndarray:
        """Return the times [s] of the pictures at `fps` frames per second of the video."""
        fps, speed = require.positive("fps", fps, "1/s"), require.positive("speed", self.speed)
        count = (self.end - self.start) / speed * fps
        if count > _MOST_FRAMES:
            raise ParameterError(
                f"a video must have at most {_MOST_FRAMES:g} frames, got {self.end - self.start:g} s at {fps:g} frames "
                f"per second and a speed of {speed:g}, which are {count:.3g}"
            )
        return self.start + speed / fps * np.arange(max(1, round(count)))


@dataclass(frozen=True, kw_only=True)
class Film:
    """A film, which can be pickled so that another process can draw it."""

    speed: float
    still: float = 0.0  # time of the picture that stands for the film [s]; 0 is a third of the way through
    caption: str = ""  # what is seen, in whole sentences, for the text beside the film

    def plan(self) -> RenderPlan:
        """Compute what moves, and return what is needed to draw it."""
        raise NotImplementedError


@dataclass(frozen=True)
class MotionFilm(Film):
    """The film of a motion."""

    trajectory: Callable[[], Trajectory]  # a function that computes the motion, and that can be pickled
    look: Look | None = None  # what is drawn; None is the usual look of such a motion

    def plan(self) -> RenderPlan:
        motion = self.trajectory()
        if (np.diff(motion.time) <= 0).any():
            raise ParameterError(
                f"the times of a trajectory must increase for it to be drawn, got {require.format_value(motion.time)}"
            )
        drawn = partial(_pictures, motion, self.look or Look.usual(motion), self.speed)
        return RenderPlan(float(motion.time[0]), float(motion.time[-1]), self.speed, drawn)


def _pictures(
    trajectory: Trajectory, look: Look, speed: float, times: np.ndarray, width: int, height: int
) -> Generator[np.ndarray]:
    sheet, display = Sheet(width, height), Display([trajectory.scene])
    has_room = len(trajectory.time) > 1 and width > 24 * sheet.unit  # in a narrower picture charts are not readable
    below = round(STRIP * sheet.unit) if has_room and look.strips else 0
    top, spare = round(HEADER * sheet.unit), round(NOTE * sheet.unit) if look.notes else 0
    seen = height - top - below  # of the scene, where notes are above what the camera shows
    plane = display.ends()[0]
    under = 3.0 if "normal" in look.marks else AROUND  # in radii: the arrows of forces are below the can
    camera, still = follow(trajectory, look.camera, plane, (width, seen - spare), under)
    marks, board = Marks(trajectory, look, plane), Board(display, float(trajectory.u[0]))
    notes = spans(trajectory, look.notes)
    marked = next(iter(notes.values()), ())
    doubts = trajectory.solver_warnings
    strip = Strip(charts(trajectory, look.strips), width, below, marked) if below else None
    with closing(Painter(display, (width, seen), still)) as painter:
        for time, now in zip(times, coordinates(trajectory, times), strict=True):
            view = replace(camera(time).crop(0, -spare, width, seen - spare), top=top)
            painter.paint(sheet, view, now[None])
            marks.draw(sheet, view, time, now)
            board.draw(sheet, view)
            header(sheet, look, trajectory, time, speed)
            note(sheet, notes, time, top)
            warn(sheet, doubts, top + spare)
            if strip is not None:
                strip.draw(sheet, time, height - below)
            yield sheet.picture()


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]  # colour of its label, its name and its lines
    load: tuple[float, float, float] | None = None  # colour of what is in it; None is that of beer or ice
    note: str = ""  # what else is to be known of it, such as "μ = 0.35"; it stands below the name

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s]; infinite if it ends before."""
        motion, way = self.trajectory, self.trajectory.u - self.trajectory.u[0] - length
        passed = CubicHermiteSpline(motion.time, way, motion.u_dot).roots(extrapolate=False)
        return float(passed[0]) if len(passed) else math.inf

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad], lift [m] at times [s], also after the end, shape (times, 4)."""
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
        """Return from when on a can's plate has its time [s], 0.4 s before the end at the latest, and what it says.

        Cans whose times are the same as shown share a place.
        """
        finishes = [runner.finish(self.length) for runner in runners]
        shown = [round(finish, 2) for finish in finishes]
        results = []
        for finish, time in zip(finishes, shown, strict=True):
            if finish < self.duration:
                place = _ORDINALS[sum(other < time for other in shown)]
                shared = "shared " if shown.count(time) > 1 else ""
                results.append((finish, f"{shared}{place}: {time:.2f} s"))
            else:
                results.append((self.duration - 0.4, f"needs {time:.2f} s"))
        return results

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
        doubts = [f"{runner.name}: {found}" for runner in runners for found in runner.trajectory.solver_warnings]
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
                warn(sheet, doubts, top)
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
