"""A film: a motion, its speed and a caption."""

from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True)
class Film:
    """A motion to draw."""

    speed: float
    """Playback speed."""
    trajectory: Callable[[], Trajectory]
