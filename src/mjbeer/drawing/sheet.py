"""A picture to draw on: its size, and lines, arrows and texts over it, with smooth edges."""

import math
import pathlib
from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np
from matplotlib import get_data_path
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_hex
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox
from PIL import Image, ImageDraw, ImageFont

from mjbeer import require
from mjbeer.exceptions import ParameterError

Colour = str | tuple[float, float, float]
"""A colour as matplotlib takes it."""
Box = tuple[float, float, float, float]
"""Left, top, right and bottom [pixels]."""

_UNITS, _SMALL = (36, 33), 800
"""Height of a picture in units, and of one up to so many pixels wide, which has larger letters and a single chart."""
_LARGEST = 4096  # largest width and height [pixels] that H.264 encoders support
INK = "#1f2933"
"""Colour of texts and of lines that explain."""
_EDGE = 2  # width of the white edge around a text that may lie on anything [pixels]
_HEAD = 3.2  # length of an arrow's head, in widths of its line
_LINE = 1.5  # height of a line on a plate, in units


def require_pixels(name: str, pixels: float) -> int:
    """Return a number of pixels as an integer.

    Raises:
      ParameterError: if it is not a whole number, not positive, or larger than encoders support.
    """
    number = require.positive(name, pixels)
    if number % 1 != 0 or number > _LARGEST:
        raise ParameterError(
            f"{name} must be a whole number of pixels up to {_LARGEST}, got {require.format_value(pixels)}"
        )
    return int(number)


class Sheet:
    """A picture to draw on with matplotlib's renderer; places are (column, row) from its upper left corner [pixels]."""

    def __init__(self, width: int, height: int) -> None:
        self._renderer = RendererAgg(width, height, 72)  # at 72 dots per inch a point is a pixel
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        self._pixels[:] = 255
        self._flip = Affine2D().scale(1, -1).translate(0, height)
        self.width, self.height, self.small = width, height, width <= _SMALL
        self.unit = height / _UNITS[self.small]
        """The unit of length of letters and margins [pixels]."""
        self.boxes: list[Box] = []
        """The boxes of all texts since this list was last emptied."""
        self._clip: Box | None = None
        self._unclipped = self._renderer.new_gc()

    def put(self, picture: np.ndarray, left: int = 0, top: int = 0) -> None:
        """Put a picture of shape (height, width, 4), uint8, with a last channel of 255, below and right of a place."""
        rows, columns, _ = picture.shape
        self._pixels[top : top + rows, left : left + columns] = picture

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

    def blank(self, left: int, top: int, right: int, bottom: int) -> None:
        """Make a part of the sheet white."""
        self._pixels[top:bottom, left:right] = 255

    def picture(self) -> np.ndarray:
        """Return a copy of what is on the sheet, shape (height, width, 3), uint8; it can only be read."""
        whole = Image.frombuffer("RGBX", (self.width, self.height), self._pixels, "raw", "RGBX", 0, 1)
        return np.frombuffer(whole.tobytes("raw", "RGB"), np.uint8).reshape(self.height, self.width, 3)

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
        half, wide = across * width / 2, across * 1.5 * width
        shape = [tail + half, neck + half, neck + wide, head, neck - wide, neck - half, tail - half]
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
        left, _, _, bottom = box = self.box(place, words, size, anchor, bold)
        for edge, ink in [(_EDGE, "white")] * halo + [(0, colour)]:
            written = _written(words, size, bold, edge, ink)
            self._renderer.draw_image(self._unclipped, left - _EDGE, self.height - bottom - _EDGE, written)
        self.boxes.append(box)
        return box

    def box(
        self,
        place: np.ndarray | tuple[float, float],
        words: str,
        size: float,
        anchor: tuple[float, float] = (0.0, 0.5),
        bold: bool = False,
    ) -> tuple[int, int, int, int]:
        """Return the box that a text would have."""
        width, height = _size(words, size, bold)
        left, top = round(float(place[0]) - anchor[0] * width), round(float(place[1]) - anchor[1] * height)
        return left, top, left + width, top + height

    def plate(
        self,
        place: np.ndarray | tuple[float, float],
        lines: Sequence[tuple[str, bool, Colour]],
        anchor: tuple[float, float],
        ground: tuple[float, float, float] = (1.0, 1.0, 1.0),
    ) -> None:
        """Draw a plate with lines, each with whether it is bold, and its colour; `anchor` is as for texts."""
        unit, size = self.unit, [(1.05 if number else 1.2) * self.unit for number in range(len(lines))]
        wide = max(
            self.box((0, 0), words, each, bold=bold)[2] for (words, bold, _), each in zip(lines, size, strict=True)
        )
        width, height = wide + 1.2 * unit, (len(lines) * _LINE + 0.5) * unit
        left, top = float(place[0]) - anchor[0] * width, float(place[1]) - anchor[1] * height
        corners = [[left, top], [left + width, top], [left + width, top + height], [left, top + height]]
        self.area(np.array(corners), ground)
        for number, (words, bold, colour) in enumerate(lines):
            row = top + ((number + 0.5) * _LINE + 0.25) * unit
            self.text((left + 0.6 * unit, row), words, size[number], colour, bold=bold)

    def _pen(self, width: float, colour: Colour, alpha: float):
        pen = self._renderer.new_gc()
        pen.set_linewidth(width)
        pen.set_foreground(colour)
        pen.set_alpha(alpha)
        pen.set_capstyle("round")
        pen.set_joinstyle("round")
        pen.set_snap(False)  # what moves must not jump from pixel to pixel
        if self._clip is not None:
            left, top, right, bottom = self._clip
            pen.set_clip_rectangle(Bbox([[left, self.height - bottom], [right, self.height - top]]))
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


def _font(size: float, bold: bool) -> ImageFont.FreeTypeFont:
    """Return the font that comes with matplotlib, in whole pixels: of fonts of that name a system may have another."""
    return _load(max(1, round(size)), "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf")


@cache
def _load(size: int, name: str) -> ImageFont.FreeTypeFont:
    # Pillow's other layout needs the system's FriBiDi, and sets letters elsewhere; where that is absent, it falls back.
    path = pathlib.Path(get_data_path()) / "fonts" / "ttf" / name
    return ImageFont.truetype(path, size, layout_engine=ImageFont.Layout.BASIC)
