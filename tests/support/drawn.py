"""A sheet that remembers what was drawn on it."""

from typing import Any

import numpy as np

from mjbeer.drawing.sheet import Box, Sheet


class Recorder(Sheet):
    """A sheet that keeps the places of lines and arrows, and the texts."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__(width, height)
        self.lines: list[np.ndarray] = []
        self.arrows: list[tuple[np.ndarray, np.ndarray]] = []
        self.discs: list[np.ndarray] = []
        self.words: list[str] = []

    def line(self, places: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.lines.append(places)
        super().line(places, *arguments, **more)

    def arrow(self, tail: np.ndarray, head: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.arrows.append((np.asarray(tail), np.asarray(head)))
        super().arrow(tail, head, *arguments, **more)

    def disc(self, place: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.discs.append(place)
        super().disc(place, *arguments, **more)

    def text(self, place: Any, words: str, *arguments: Any, **more: Any) -> Box:
        self.words.append(words)
        return super().text(place, words, *arguments, **more)
