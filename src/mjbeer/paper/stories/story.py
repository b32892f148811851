"""A story of the paper: a plot with its caption, and perhaps a film."""

import pathlib
from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.drawing.film import Take


@dataclass(frozen=True)
class Story:
    """A scenario of the paper."""

    name: str
    """Name of its files, without an ending."""
    caption: str
    """What the plot and the film show."""
    draw: Callable[[pathlib.Path], None]
    """Writes the plot to a path, once with .svg and once with .png appended."""
    film: Take | None = None
