"""A film: a motion, how fast it is shown, and what is said of it."""

from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True)
class Film:
    """A motion to draw."""

    speed: float
    """Playback speed."""
    trajectory: Callable[[], Trajectory]
    """Makes the motion."""
    caption: str = ""
    still: float = 0.0
    """When the picture beside the film is taken [s]."""
