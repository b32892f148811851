"""A story of the paper: a named scenario with a plot, and a film where there is something to see."""

import pathlib
from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.trajectory import Trajectory


@dataclass(frozen=True)
class Film:
    """A motion to draw."""

    speed: float
    """Playback speed."""
    trajectory: Callable[[], Trajectory]


@dataclass(frozen=True)
class Story:
    """A scenario."""

    name: str
    """Of its files."""
    caption: str
    """What is to be seen."""
    draw: Callable[[pathlib.Path], None]
    """Draws the plot, to a path with .svg and .png."""
    film: Film | None = None
