"""A picture to draw on: its size, and lines, arrows and texts over it, with smooth edges."""

import math
import pathlib
from collections.abc import Sequence
from functools import cache, lru_cache
from typing import Any

import numpy as np
from matplotlib import get_data_path
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_hex, to_rgba
from matplotlib.patches import FancyArrow
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from PIL import Image, ImageDraw, ImageFont

Colour = str | tuple[float, float, float]  # as matplotlib takes it
Pair = np.ndarray | tuple[float, float]  # a column and a row [pixels], or shares of a width and a height
Box = tuple[float, float, float, float]  # left, top, right and bottom [pixels]

INK = "#1f2933"  # colour of texts and of lines that explain
_EDGE = 2  # width of the white edge around a text that may lie on anything [pixels]
_HEAD = 3.2  # length of an arrow's head, in widths of its line


class Sheet:
    """A picture to draw on with matplotlib's renderer; places are (column, row) from its upper left corner [pixels]."""

    def __init__(self, width: int, height: int) -> None:
        self._renderer = RendererAgg(width, height, 72)  # at 72 dots per inch a point is a pixel
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        self._pixels[:] = 255
        self._flip = Affine2D().scale(1, -1).translate(0, height)
        self.width, self.height, self.unit = width, height, height / 34  # the unit is that of letters and margins
        self.boxes: list[Box] = []  # of all texts on this picture
        self._pasting = self._renderer.new_gc()

    def put(self, rows: np.ndarray, top: int) -> None:
        """Put a picture as wide as the sheet, shape (height, width, 4), uint8, below a row of it."""
        self._pixels[top : top + len(rows)] = rows

    def part(self, top: int, bottom: int) -> np.ndarray:
        """Return a copy of some rows of the sheet, which can be `put` there again."""
        return self._pixels[top:bottom].copy()

    def composite(self, picture: np.ndarray, left: int, top: int) -> None:
        """Lay a picture of shape (height, width, 4) on the sheet, whose last channel is how much it covers.

        Its colours are darker by that share.
        """
        rows, columns, _ = picture.shape
        part = self._pixels[top : top + rows, left : left + columns]
        uncovered = 255 - picture[..., 3].astype(np.uint16)
        for channel in range(3):
            part[..., channel] = picture[..., channel] + (part[..., channel] * uncovered + 127) // 255

    def blank(self, top: int, bottom: int) -> None:
        """Make some rows of the sheet white."""
        self._pixels[top:bottom] = 255

    def picture(self) -> np.ndarray:
        """Return a copy of what is on the sheet, shape (height, width, 3), uint8, and forget where texts are."""
        self.boxes.clear()
        whole = Image.frombuffer("RGBX", (self.width, self.height), self._pixels, "raw", "RGBX", 0, 1)
        return np.frombuffer(whole.tobytes("raw", "RGB"), np.uint8).reshape(self.height, self.width, 3)

    def line(
        self, places: np.ndarray, width: float, colour: Colour = INK, alpha: float = 1.0, dashes: Sequence[float] = ()
    ) -> None:
        """Draw a line through places of shape (n, 2); `dashes` are lengths on and off, in widths of the line."""
        pen = self._pen(width, colour, alpha)
        if dashes:
            pen.set_dashes(0, [width * length for length in dashes])
        self._renderer.draw_path(pen, Path(places), self._flip)

    def area(self, places: np.ndarray, colour: Colour, alpha: float = 1.0) -> None:
        """Fill the polygon with corners at places of shape (n, 2)."""
        pen = self._pen(0, colour, alpha)
        self._renderer.draw_path(pen, Path(places, closed=False), self._flip, to_rgba(colour, alpha))

    def disc(self, place: np.ndarray, radius: float, colour: Colour) -> None:
        """Draw a disc with a white rim."""
        pen = self._pen(radius / 3, "white", 1.0)
        shape = Affine2D().scale(radius).translate(*place) + self._flip
        self._renderer.draw_path(pen, Path.unit_circle(), shape, to_rgba(colour))

    def arrow(self, tail: np.ndarray, head: np.ndarray, width: float, colour: Colour) -> None:
        """Draw an arrow; one shorter than its head is drawn as a smaller arrow."""
        way = np.asarray(head) - tail
        if (length := float(np.hypot(*way))) >= 1:
            width = min(width, length / _HEAD)
            sizes: Any = {"width": width, "head_width": 3 * width, "head_length": _HEAD * width}
            self.area(FancyArrow(*tail, *way, length_includes_head=True, **sizes).get_xy(), colour)

    def text(
        self,
        place: Pair,
        words: str,
        size: float,
        colour: Colour = INK,
        anchor: Pair = (0.0, 0.5),
        bold: bool = False,
        halo: bool = False,
    ) -> Box:
        """Write a text and return its box. `anchor` is the point of the box that lies at the place: (0, 0) upper left.

        With a `halo` the text has a white edge, so that it can be read on anything.
        """
        left, _, _, bottom = box = self.box(place, words, size, anchor, bold)
        for edge, ink in [(_EDGE, "white")] * halo + [(0, colour)]:
            written = _written(words, size, bold, edge, ink)
            self._renderer.draw_image(self._pasting, left - _EDGE, self.height - bottom - _EDGE, written)
        self.boxes.append(box)
        return box

    def box(self, place: Pair, words: str, size: float, anchor: Pair = (0.0, 0.5), bold: bool = False) -> Box:
        """Return the box that a text would have."""
        width, height = _size(words, size, bold)
        left, top = round(float(place[0]) - anchor[0] * width), round(float(place[1]) - anchor[1] * height)
        return left, top, left + width, top + height

    def plate(
        self, place: np.ndarray, lines: Sequence[str], colour: Colour, anchor: Pair, ground: Colour = "white"
    ) -> None:
        """Draw a plate with lines, the first of them bold and in a colour; `anchor` is as for texts."""
        unit, sizes = self.unit, [(1.05 if number else 1.2) * self.unit for number in range(len(lines))]
        wide = max(self.box((0, 0), *of, bold=of[0] == lines[0])[2] for of in zip(lines, sizes, strict=True))
        width, height = wide + 1.2 * unit, (1.5 * len(lines) + 0.5) * unit
        corner = place - np.multiply(anchor, [width, height])
        self.area(corner + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * [width, height], ground)
        for number, (words, size) in enumerate(zip(lines, sizes, strict=True)):
            start = corner + np.array([0.6, 1.5 * number + 1]) * unit
            self.text(start, words, size, INK if number else colour, bold=number == 0)

    def _pen(self, width: float, colour: Colour, alpha: float):
        pen = self._renderer.new_gc()
        pen.set_linewidth(width)
        pen.set_foreground(colour)
        pen.set_alpha(alpha)
        pen.set_capstyle("round")
        pen.set_joinstyle("round")
        pen.set_snap(False)  # what moves must not jump from pixel to pixel
        return pen


def overlap(one: Box, other: Box) -> bool:
    """Return whether two boxes have a point in common."""
    return min(one[2], other[2]) > max(one[0], other[0]) and min(one[3], other[3]) > max(one[1], other[1])


@lru_cache(maxsize=512)
def _size(words: str, size: float, bold: bool) -> tuple[int, int]:
    """Return width and height of a text [pixels]."""
    font = _font(size, bold)
    return math.ceil(font.getlength(words)), sum(font.getmetrics())


@lru_cache(maxsize=512)
def _written(words: str, size: float, bold: bool, edge: int, colour: Colour) -> np.ndarray:
    """Return a text with an edge as red, green, blue and opacity, uint8, with room for a halo; the lowest row first."""
    width, height = _size(words, size, bold)
    image = Image.new("L", (width + 2 * _EDGE, height + 2 * _EDGE))
    ImageDraw.Draw(image).text((_EDGE, _EDGE), words, 255, _font(size, bold), stroke_width=edge)
    written = Image.new("RGB", image.size, to_hex(colour))
    written.putalpha(image)
    return np.asarray(written)[::-1].copy()


@cache
def _font(size: float, bold: bool) -> ImageFont.FreeTypeFont:
    """Return the font that comes with matplotlib, in whole pixels: of fonts of that name a system may have another."""
    path = pathlib.Path(get_data_path()) / "fonts" / "ttf" / ("DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf")
    # Pillow's other layout needs the system's FriBiDi, and sets letters elsewhere; where that is absent, it falls back.
    return ImageFont.truetype(path, max(1, round(size)), layout_engine=ImageFont.Layout.BASIC)
