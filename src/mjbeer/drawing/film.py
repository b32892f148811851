"""A film to be drawn: a motion, its playback speed, its caption, and the time of a still picture."""

from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True)
class Film:
    """A motion to draw as a video."""

    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    trajectory: Callable[[], Trajectory]
    """A function that computes the motion."""
    caption: str = ""
    still: float = 0.0
    """Time of the motion that the still picture beside the film shows [s]."""
