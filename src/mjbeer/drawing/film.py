"""A film: a motion or a race, how fast it is shown, and its caption."""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from mjbeer import require
from mjbeer.drawing import frames
from mjbeer.drawing.overlay.look import Look
from mjbeer.exceptions import ParameterError
from mjbeer.theory.trajectory import Trajectory

_MOST_FRAMES = 1e6
"""Largest number of frames of a video: nine hours at 30 frames per second."""


@dataclass(frozen=True, eq=False)
class Reel:
    """What is needed to draw a film: its pictures as a function of their times and size."""

    start: float
    """Time of the first picture [s]."""
    end: float
    """Time at which the film ends [s]."""
    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    draw: Callable[[np.ndarray, int, int], Generator[np.ndarray]]
    """Draws the pictures at some times [s], of a width and a height [pixels]: arrays (height, width, 3), uint8."""

    def times(self, fps: float) -> np.ndarray:
        """Return the times [s] of the pictures at `fps` frames per second of the video.

        The video lasts as long as the motion, divided by `speed`.

        Raises:
          ParameterError: if `fps` or `speed` is not greater than 0, or the video would have too many frames.
        """
        fps, speed = require.positive("fps", fps, "1/s"), require.positive("speed", self.speed)
        duration = self.end - self.start
        count = duration * fps / speed
        if count > _MOST_FRAMES:
            raise ParameterError(
                f"a video must have at most {_MOST_FRAMES:g} frames, got {duration:g} s at {fps:g} frames per second "
                f"and a speed of {speed:g}, which are {count:.3g}"
            )
        return self.start + speed / fps * np.arange(max(1, round(count)))


class Film(Protocol):
    """A film. It can be pickled, so that another process can draw it."""

    @property
    def caption(self) -> str:
        """What is seen in it, in whole sentences, for the text beside the film."""
        ...

    @property
    def still(self) -> float:
        """Time of the motion that the still picture of the film shows [s]."""
        ...

    def reel(self) -> Reel:
        """Compute the motion, and return what is needed to draw it."""
        ...


@dataclass(frozen=True)
class Take:
    """The film of a motion."""

    trajectory: Callable[[], Trajectory]
    """A function that computes the motion, and that can be pickled."""
    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    look: Look | None = None
    """What is drawn; None is the usual look of such a motion."""
    still: float = 0.0
    """Time of the motion that the still picture of the film shows [s]; 0 is a third of the way through."""
    caption: str = ""
    """What is seen in it, in whole sentences, for the text beside the film."""

    def reel(self) -> Reel:
        """Compute the motion, and return what is needed to draw it."""
        trajectory = self.trajectory()
        return reel(trajectory, self.chosen(trajectory), self.speed)

    def chosen(self, trajectory: Trajectory) -> Look:
        """Return what is drawn of the motion."""
        return self.look or Look.usual(trajectory)


def reel(trajectory: Trajectory, look: Look | None = None, speed: float = 1.0) -> Reel:
    """Return what is needed to draw a trajectory; without a `look`, its usual one.

    Raises:
      ParameterError: if `trajectory` is not one.
    """
    require.instance("trajectory", trajectory, Trajectory)
    look = look or Look.usual(trajectory)
    start, end = float(trajectory.time[0]), float(trajectory.time[-1])
    return Reel(start, end, speed, partial(_draw, trajectory, look, speed))


def _draw(
    trajectory: Trajectory, look: Look, speed: float, times: np.ndarray, width: int, height: int
) -> Generator[np.ndarray]:
    return frames.draw(trajectory, times, width=width, height=height, look=look, speed=speed)
