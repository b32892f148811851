"""Lines, arrows and texts drawn over a picture, with smooth edges."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox

Colour = str | tuple[float, float, float]
"""A colour as matplotlib takes it."""
Box = tuple[float, float, float, float]
"""Left, top, right and bottom [pixels]."""

INK = "#1f2933"
"""Colour of texts and of lines that explain."""
_HEAD = 3.2
"""Length of an arrow's head, in widths of its line."""


class Sheet:
    """A picture to draw on with matplotlib's renderer; places are (column, row) from its upper left corner [pixels]."""

    def __init__(self, width: int, height: int) -> None:
        self._renderer = RendererAgg(width, height, 72)  # at 72 dots per inch a point is a pixel
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        self._pixels[:] = 255
        self._flip = Affine2D().scale(1, -1).translate(0, height)
        self.width, self.height = width, height
        self.boxes: list[Box] = []
        """The boxes of all texts since this list was last emptied."""
        self._clip: Box | None = None

    def put(self, picture: np.ndarray, left: int = 0, top: int = 0) -> None:
        """Put a picture of shape (height, width, 3), uint8, on the sheet, with its upper left corner at a place."""
        rows, columns, _ = picture.shape
        self._pixels[top : top + rows, left : left + columns, :3] = picture

    def blank(self, left: int, top: int, right: int, bottom: int) -> None:
        """Make a part of the sheet white."""
        self._pixels[top:bottom, left:right] = 255

    def picture(self) -> np.ndarray:
        """Return a copy of what is on the sheet, shape (height, width, 3), uint8."""
        return np.ascontiguousarray(self._pixels[:, :, :3])

    def clip(self, box: Box | None) -> None:
        """Draw only within a box from now on, or everywhere."""
        self._clip = box

    def line(
        self, places: np.ndarray, width: float, colour: Colour = INK, alpha: float = 1.0, dashes: Sequence[float] = ()
    ) -> None:
        """Draw a line through places of shape (n, 2); `dashes` are lengths on and off, in widths of the line."""
        pen = self._pen(width, colour, alpha)
        if dashes:
            pen.set_dashes(0, [width * length for length in dashes])
        self._renderer.draw_path(pen, Path(places), self._flip)

    def area(self, places: np.ndarray, colour: tuple[float, float, float], alpha: float = 1.0) -> None:
        """Fill the polygon with corners at places of shape (n, 2)."""
        pen = self._pen(0, colour, alpha)
        self._renderer.draw_path(pen, Path(places, closed=False), self._flip, (*colour, alpha))

    def disc(self, place: np.ndarray, radius: float, colour: tuple[float, float, float]) -> None:
        """Draw a disc with a white rim."""
        pen = self._pen(radius / 3, "white", 1.0)
        self._renderer.draw_path(
            pen, Path.unit_circle(), Affine2D().scale(radius).translate(*place) + self._flip, colour
        )

    def arrow(self, tail: np.ndarray, head: np.ndarray, width: float, colour: tuple[float, float, float]) -> None:
        """Draw an arrow; one shorter than its head is drawn as a smaller arrow."""
        way = np.asarray(head) - tail
        length = float(np.hypot(*way))
        if length < 1:
            return
        width = min(width, length / _HEAD)
        along = way / length
        across = np.array([-along[1], along[0]])
        neck = head - _HEAD * width * along
        shape = [
            tail + across * width / 2, neck + across * width / 2, neck + across * 1.5 * width, head,
            neck - across * 1.5 * width, neck - across * width / 2, tail - across * width / 2,
        ]  # fmt: skip
        self.area(np.array(shape), colour)

    def text(
        self,
        place: np.ndarray | tuple[float, float],
        words: str,
        size: float,
        colour: Colour = INK,
        anchor: tuple[float, float] = (0.0, 0.5),
        bold: bool = False,
        halo: bool = False,
    ) -> Box:
        """Write a text and return its box. `anchor` is the point of the box that lies at the place: (0, 0) upper left.

        With a `halo` the text has a white edge, so that it can be read on anything.
        """
        font = _font(round(size), bold)
        width, height, descent = self._renderer.get_text_width_height_descent(words, font, False)
        left, top = place[0] - anchor[0] * width, place[1] - anchor[1] * height
        foot = top + height - descent
        shifts = [(x, y) for x in (-1.5, 0, 1.5) for y in (-1.5, 0, 1.5) if x or y] if halo else []
        for right, down in shifts:
            self._renderer.draw_text(self._pen(1, "white", 0.8), left + right, foot + down, words, font, 0)
        self._renderer.draw_text(self._pen(1, colour, 1.0), left, foot, words, font, 0)
        self.boxes.append((left, top, left + width, top + height))
        return self.boxes[-1]

    def _pen(self, width: float, colour: Colour, alpha: float):
        pen = self._renderer.new_gc()
        pen.set_linewidth(width)
        pen.set_foreground(colour)
        pen.set_alpha(alpha)
        pen.set_capstyle("round")
        pen.set_joinstyle("round")
        if self._clip is not None:
            left, top, right, bottom = self._clip
            pen.set_clip_rectangle(Bbox([[left, self.height - bottom], [right, self.height - top]]))
        return pen


@cache
def _font(size: int, bold: bool) -> FontProperties:
    return FontProperties(size=size, weight="bold" if bold else "normal")
