"""A film of a motion: its pictures one after the other, how fast it is shown, and its caption."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from mjbeer import require
from mjbeer.drawing.camera import CameraPath
from mjbeer.drawing.overlay import NOTE, STRIP, Board, Look, Marks, guides, header, header_height, note
from mjbeer.drawing.scene import Display, Painter, Scenery, coordinates
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import Strip, charts, spans
from mjbeer.exceptions import ParameterError
from mjbeer.theory.trajectory import Trajectory

_MOST_FRAMES = 1e6  # largest number of frames of a video: nine hours at 30 frames per second
_NARROW = 24  # width up to which a picture has no charts below, in units
_FINE = 2000  # points of a path
_AROUND, _BOARD, _BELOW = (1.35, 1.95), 1.75, 3.0
"""What is seen around the can's axis without and with its angle; below it at least, and with forces; in radii."""


@dataclass(frozen=True, eq=False)
class RenderPlan:
    """What is needed to draw a film: its pictures as a function of their times and size."""

    start: float  # time of the first picture [s]
    end: float  # time at which the film ends [s]
    speed: float  # playback speed: 1 is real time, 0.5 is half as fast
    draw: Callable[[np.ndarray, int, int], Generator[np.ndarray]]
    """Draws the pictures at some times [s], of a width and a height [pixels]: arrays (height, width, 3), uint8."""

    def times(self, fps: float) -> np.ndarray:
        """Return the times [s] of the pictures at `fps` frames per second of the video.

        The video lasts as long as the motion, divided by the playback speed.

        Raises:
          ParameterError: if `fps` or `speed` is not greater than 0, or the video would have too many frames.
        """
        fps, speed = require.positive("fps", fps, "1/s"), require.positive("speed", self.speed)
        duration = self.end - self.start
        count = duration / speed * fps
        if count > _MOST_FRAMES:
            raise ParameterError(
                f"a video must have at most {_MOST_FRAMES:g} frames, got {duration:g} s at {fps:g} frames per second "
                f"and a speed of {speed:g}, which are {count:.3g}"
            )
        return self.start + speed / fps * np.arange(max(1, round(count)))


class Film(Protocol):
    """A film. It can be pickled, so that another process can draw it.

    Its caption says what is seen, in whole sentences, for the text beside the film. Its still picture shows a time [s].
    `plan` computes the motion, and returns what is needed to draw it.
    """

    @property
    def caption(self) -> str: ...

    @property
    def still(self) -> float: ...

    def plan(self) -> RenderPlan: ...


@dataclass(frozen=True)
class MotionFilm:
    """The film of a motion."""

    trajectory: Callable[[], Trajectory]  # a function that computes the motion, and that can be pickled
    speed: float
    look: Look | None = None  # what is drawn; None is the usual look of such a motion
    still: float = 0.0
    """Time of the motion that the still picture of the film shows [s]; 0 is a third of the way through."""
    caption: str = ""

    def plan(self) -> RenderPlan:
        """Compute the motion, and return what is needed to draw it.

        Raises:
          ParameterError: if its times do not increase.
        """
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
    sheet, scene = Sheet(width, height), trajectory.scene
    has_room = len(trajectory.time) > 1 and width > _NARROW * sheet.unit
    below = round(STRIP * sheet.unit) if has_room and look.strips else 0
    top, spare = header_height(look, sheet.unit), round(NOTE * sheet.unit) if look.notes else 0
    seen = height - top - below  # of the scene, where notes are above what the camera shows
    fine = np.linspace(trajectory.time[0], trajectory.time[-1], _FINE)
    positions = coordinates(trajectory, fine)
    display = Display.of([scene])
    plane, around = display.front(), _AROUND["phi" in look.marks]
    under = _BELOW if "normal" in look.marks else max(around, _BOARD)
    motion = fine, positions[:, 0], positions[:, 3]
    path = CameraPath.fit(scene, look.camera, *motion, plane, (width, seen - spare), around, under)
    marks = Marks(trajectory, look.marks, plane, fine, positions, look.measured)
    board = Board.of(scene, display.model, float(trajectory.u[0]))
    notes = {name: spans(trajectory, name) for name in look.notes}
    shown, marked = charts(trajectory, look.strips[: 1 if sheet.small else None]), next(iter(notes.values()), ())
    strip = Strip(shown, width, below, marked) if below else None
    with closing(Painter(display, Scenery(scene, display.model), width, seen, path.still)) as painter:
        for time, now in zip(times, coordinates(trajectory, times), strict=True):
            view = path.view(time).crop(0, -spare, width, seen - spare)
            sheet.boxes.clear()
            painter.paint(sheet, view, now[None], top)
            marks.draw(sheet, view, top, time, now)
            guides(sheet, board, view, top)
            header(sheet, look, trajectory, time, speed)
            note(sheet, trajectory, notes, time, top)
            if strip is not None:
                strip.draw(sheet, time, height - below)
            yield sheet.picture()
