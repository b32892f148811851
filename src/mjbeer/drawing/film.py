"""Films: pictures one after the other, how fast they are shown, and a caption; and the film of one motion."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from mjbeer import require
from mjbeer.drawing.camera import AROUND, follow
from mjbeer.drawing.overlay import HEADER, NOTE, STRIP, Board, Look, Marks, header, note, spans
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import Strip, charts
from mjbeer.exceptions import ParameterError
from mjbeer.theory.trajectory import Trajectory

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
    strip = Strip(charts(trajectory, look.strips), width, below, marked) if below else None
    with closing(Painter(display, (width, seen), still)) as painter:
        for time, now in zip(times, coordinates(trajectory, times), strict=True):
            view = replace(camera(time).crop(0, -spare, width, seen - spare), top=top)
            painter.paint(sheet, view, now[None])
            marks.draw(sheet, view, time, now)
            board.draw(sheet, view)
            header(sheet, look, trajectory, time, speed)
            note(sheet, notes, time, top)
            if strip is not None:
                strip.draw(sheet, time, height - below)
            yield sheet.picture()
