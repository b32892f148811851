"""A sheet that keeps what is drawn on it."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mjbeer.drawing.sheet import Box, Colour, Sheet


class Arrow(NamedTuple):
    """An arrow on a sheet [pixels]."""

    tail: np.ndarray
    tip: np.ndarray


class Recorder(Sheet):
    """A sheet that keeps the places of lines, arrows and discs, and the texts.

    Of these it draws the texts only.
    """

    def __init__(self, width: int, height: int) -> None:
        super().__init__(width, height)
        self.lines: list[np.ndarray] = []
        self.arrows: list[Arrow] = []
        self.discs: list[np.ndarray] = []
        self.words: list[str] = []

    def line(
        self,
        places: np.ndarray,
        width: float,
        colour: Colour = "black",
        alpha: float = 1.0,
        dashes: Sequence[float] = (),
    ) -> None:
        self.lines.append(places)

    def arrow(self, tail: np.ndarray, tip: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.arrows.append(Arrow(np.asarray(tail), np.asarray(tip)))

    def disc(self, place: np.ndarray, radius: float, colour: Colour) -> None:
        self.discs.append(place)

    def text(self, place: Any, words: str, *arguments: Any, **more: Any) -> Box:
        self.words.append(words)
        return super().text(place, words, *arguments, **more)
