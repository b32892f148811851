"""A story of the paper: a plot with its caption, and perhaps a film."""

import pathlib
from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.drawing.film import Film


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
