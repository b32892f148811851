"""Films: pictures one after the other, their speed, and a caption; and the film of one motion."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from mjbeer import require
from mjbeer.drawing.annotations import Annotations
from mjbeer.drawing.board import Board
from mjbeer.drawing.camera import Edges, follow
from mjbeer.drawing.overlay import (
    HEADER,
    NOTE,
    STRIP,
    draw_answer,
    draw_header,
    draw_note,
    draw_warning,
    timed_notes,
)
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import ChartStrip, Stage, charts
from mjbeer.drawing.style import FilmStyle
from mjbeer.exceptions import ParameterError
from mjbeer.theory.trajectory import Trajectory

_MOST_FRAMES = 1e6
"""Largest number of frames of a video: nine hours at 30 frames per second."""
_READABLE = 24
"""Least width of a picture with charts, in units of the sheet: in a narrower one they cannot be
read."""


@dataclass(frozen=True, eq=False)
class RenderPlan:
    """What is needed to draw a film: its pictures as a function of their times and size."""

    start: float
    """Time of the first picture [s]."""
    end: float
    """Time at which the film ends [s]."""
    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    draw: Callable[[np.ndarray, int, int], Generator[np.ndarray]]
    """Draws the pictures at some times [s], of a width and a height [pixels]: arrays (height,
    width, 3), uint8."""
    hold: float = 0.0
    """How long the video shows the end, which stands still [s of the video]."""

    def times(self, fps: float) -> np.ndarray:
        """Return the times [s] of the pictures at `fps` frames per second of the video."""
        fps = require.positive("fps", fps, "1/s")
        speed = require.positive("speed", self.speed)
        count = (self.end - self.start) / speed * fps
        if count > _MOST_FRAMES:
            raise ParameterError(
                f"a video must have at most {_MOST_FRAMES:g} frames, "
                f"got {self.end - self.start:g} s at {fps:g} frames per second "
                f"and a speed of {speed:g}, which are {count:.3g}"
            )
        moving = self.start + speed / fps * np.arange(max(1, round(count)))
        return np.append(moving, np.full(round(self.hold * fps), self.end))


@dataclass(frozen=True, kw_only=True)
class Film(ABC):
    """A film, which can be pickled so that another process can draw it."""

    speed: float
    """Playback speed: 1 is real time."""
    hold: float = 0.0
    """How long the film shows its end, which stands still [s of the video]."""
    still: float | None = None
    """Time of the picture that stands for the film [s]; None is a third of the way through."""
    caption: str = ""
    """What is seen, in whole sentences, for the text beside the film."""

    @abstractmethod
    def plan(self) -> RenderPlan:
        """Compute the motion, and return what is needed to draw it."""


@dataclass(frozen=True)
class MotionFilm(Film):
    """The film of a motion.

    Raises:
      ParameterError: when it is planned, if the times of the motion do not increase.
    """

    trajectory: Callable[[], Trajectory]
    """A function that computes the motion, and that can be pickled."""
    style: FilmStyle | None = None
    """What is drawn; None is the usual style of such a motion."""

    def plan(self) -> RenderPlan:
        motion = self.trajectory()
        if (np.diff(motion.time) <= 0).any():
            raise ParameterError(
                "the times of a trajectory must increase for it to be drawn, "
                f"got {require.format_value(motion.time)}"
            )
        style = self.style or FilmStyle.usual(motion)
        draw = partial(_pictures, motion, style, self.speed)
        start = float(motion.time[0])
        end = float(motion.time[-1])
        return RenderPlan(start, end, self.speed, draw, self.hold)


def _pictures(
    trajectory: Trajectory,
    style: FilmStyle,
    speed: float,
    times: np.ndarray,
    width: int,
    height: int,
) -> Generator[np.ndarray]:
    """Draw the pictures of a motion: the header above, the scene, and the charts below."""
    sheet = Sheet(width, height)
    display = Display([trajectory.scene])
    has_charts = bool(style.strips) and len(trajectory.time) > 1 and width > _READABLE * sheet.unit
    below = round(STRIP * sheet.unit) if has_charts else 0
    top = round(HEADER * sheet.unit)
    has_notes = bool(style.notes or style.answer) and not style.notes_aside
    for_notes = round(NOTE * sheet.unit) if has_notes else 0
    scene_height = height - top - below

    # The camera keeps the can below the notes; the scene goes on behind them.
    front = display.ends()[0]
    below_notes = (width, scene_height - for_notes)
    camera = follow(trajectory, style.camera, front, below_notes)
    with_notes = Edges(left=0, upper=-for_notes, right=width, lower=scene_height - for_notes)

    annotations = Annotations(trajectory, style, front)
    board = Board(display, float(trajectory.u[0] - trajectory.distance[0]))
    notes = timed_notes(trajectory, style.notes)
    doubts = trajectory.solver_warnings
    strip = None
    if has_charts:
        stages = [Stage(note.spans, note.ground) for note in notes]
        shown = charts(trajectory, style.strips, "equilibrium" in style.marks)
        strip = ChartStrip(shown, width, below, stages)

    with closing(Painter(display, (width, scene_height), camera.still)) as painter:
        for time, now in zip(times, coordinates(trajectory, times), strict=True):
            view = replace(camera.view(time).crop(with_notes), top=top)
            painter.paint(sheet, view, now[None])
            annotations.draw(sheet, view, time, now)
            board.draw(sheet, view)
            draw_header(sheet, style, trajectory, time, speed)
            if style.answer and time >= trajectory.time[-1]:
                draw_answer(sheet, style.answer, top)
            else:
                draw_note(sheet, notes, time, top)
            draw_warning(sheet, doubts, top + for_notes)
            if strip is not None:
                strip.draw(sheet, time, height - below)
            yield sheet.picture()
