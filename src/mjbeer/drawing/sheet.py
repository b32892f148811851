"""A picture to draw on: its size, and lines, arrows and texts on it, with smooth edges."""

import math
import pathlib
from collections.abc import Sequence
from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np
from matplotlib import get_data_path
from matplotlib.backend_bases import GraphicsContextBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_hex, to_rgba
from matplotlib.patches import FancyArrow
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from PIL import Image, ImageDraw, ImageFont

Colour = str | tuple[float, float, float]
"""A colour as matplotlib takes it."""
Pair = np.ndarray | tuple[float, float]
"""A column and a row [pixels], or shares of a width and a height."""

INK = "#1f2933"
"""Colour of texts, and of lines that explain."""
_HALO = 2
"""Width of the white edge around a text that may lie on anything [pixels]."""
_HEAD = 3.2
"""Length of an arrow's head, in widths of its line."""
_HEADING = 1.2
"""Size of the first line on a plate, in units."""
_TEXT = 1.05
"""Size of its other lines, in units."""
_LINE = 1.5
"""Height of a line on a plate, in units."""
_ASIDE = 0.6
"""Distance of the lines from the left and the right edge of a plate, in units."""
_ABOVE = 0.25
"""Distance of the lines from the upper and the lower edge of a plate, in units."""


class Box(NamedTuple):
    """A rectangle on a sheet [pixels]."""

    left: float
    top: float
    right: float
    bottom: float


class Sheet:
    """A picture to draw on with matplotlib's renderer.

    Places are (column, row) from its upper left corner [pixels].
    """

    def __init__(self, width: int, height: int) -> None:
        self.width = width
        self.height = height
        self.unit = height / 34
        """The unit of letters and margins [pixels]: the sheet is 34 of them high."""
        self.boxes: list[Box] = []
        """The boxes of all texts on this picture, and of other places where no text may be."""
        self._renderer = RendererAgg(width, height, 72)  # at 72 dots per inch a point is a pixel
        self._pixels = np.asarray(self._renderer.buffer_rgba())
        self._pixels[:] = 255
        # The renderer counts rows from below.
        self._flip = Affine2D().scale(1, -1).translate(0, height)
        self._pasting = self._renderer.new_gc()

    def put(self, rows: np.ndarray, top: int) -> None:
        """Put a picture as wide as the sheet, shape (height, width, 4), uint8, below a row."""
        self._pixels[top : top + len(rows)] = rows

    def part(self, top: int, bottom: int) -> np.ndarray:
        """Return a copy of some rows of the sheet, which can be `put` there again."""
        return self._pixels[top:bottom].copy()

    def composite(self, picture: np.ndarray, left: int, top: int) -> None:
        """Lay a picture of shape (height, width, 4), uint8, on the sheet.

        Its last channel is how much it covers, up to 255. Its colours are multiplied by that share
        already.
        """
        rows, columns, _ = picture.shape
        below = self._pixels[top : top + rows, left : left + columns]
        uncovered = 255 - picture[..., 3].astype(np.uint16)
        for channel in range(3):
            # 127 is half of 255: the quotient is rounded, and not cut off.
            seen_through = (below[..., channel] * uncovered + 127) // 255
            below[..., channel] = picture[..., channel] + seen_through

    def blank(self, top: int, bottom: int) -> None:
        """Make some rows of the sheet white."""
        self._pixels[top:bottom] = 255

    def picture(self) -> np.ndarray:
        """Return a copy of what is on the sheet, shape (height, width, 3), uint8.

        The list of `boxes` is emptied for the next picture.
        """
        self.boxes.clear()
        size = (self.width, self.height)
        whole = Image.frombuffer("RGBX", size, self._pixels, "raw", "RGBX", 0, 1)
        colours = np.frombuffer(whole.tobytes("raw", "RGB"), np.uint8)
        return colours.reshape(self.height, self.width, 3)

    def line(
        self,
        places: np.ndarray,
        width: float,
        colour: Colour = INK,
        alpha: float = 1.0,
        dashes: Sequence[float] = (),
    ) -> None:
        """Draw a line through places of shape (n, 2), with a gap at each that is NaN.

        `dashes` are the lengths of what is drawn and left out in turn, in widths of the line.
        """
        pen = self._pen(width, colour, alpha)
        if dashes:
            pen.set_dashes(0, [width * length for length in dashes])
        self._renderer.draw_path(pen, Path(places), self._flip)

    def area(self, places: np.ndarray, colour: Colour, alpha: float = 1.0) -> None:
        """Fill the polygon with corners at places of shape (n, 2), or polygons with NaN between."""
        pen = self._pen(0, colour, alpha)
        polygon = Path(places, closed=False)
        self._renderer.draw_path(pen, polygon, self._flip, to_rgba(colour, alpha))

    def disc(self, place: np.ndarray, radius: float, colour: Colour) -> None:
        """Draw a disc with a white rim."""
        pen = self._pen(radius / 3, "white", 1.0)
        shape = Affine2D().scale(radius).translate(*place) + self._flip
        self._renderer.draw_path(pen, Path.unit_circle(), shape, to_rgba(colour))

    def arrow(
        self,
        tail: np.ndarray,
        tip: np.ndarray,
        width: float,
        colour: Colour,
        halo: bool = False,
    ) -> None:
        """Draw an arrow. One that would be shorter than its head is made smaller as a whole.

        With a `halo` it has a white edge.
        """
        along = np.asarray(tip) - tail
        length = float(np.hypot(*along))
        if length < 1:
            return
        width = min(width, length / _HEAD)
        shape = FancyArrow(
            *tail,
            *along,
            length_includes_head=True,
            width=width,
            head_width=3 * width,
            head_length=_HEAD * width,
        )
        outline = np.asarray(shape.get_xy())
        if halo:
            self.line(outline, width / 2, "white")
        self.area(outline, colour)

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
        """Write a text and return its box.

        `anchor` is the point of the box that lies at the place: (0, 0) is its upper left corner.
        With a `halo` the text has a white edge, so that it can be read on anything.
        """
        box = self.box(place, words, size, anchor, bold)
        if halo:
            self._paste(_rasterize(words, size, bold, _HALO, "white"), box)
        self._paste(_rasterize(words, size, bold, 0, colour), box)
        self.boxes.append(box)
        return box

    def box(
        self, place: Pair, words: str, size: float, anchor: Pair = (0.0, 0.5), bold: bool = False
    ) -> Box:
        """Return the box that a text would have."""
        width, height = _size(words, size, bold)
        left = round(float(place[0]) - anchor[0] * width)
        top = round(float(place[1]) - anchor[1] * height)
        return Box(left, top, left + width, top + height)

    def plate(
        self,
        place: np.ndarray,
        lines: Sequence[str],
        colour: Colour,
        anchor: Pair,
        ground: Colour = "white",
    ) -> None:
        """Draw a plate with lines of text; the first of them is bold and in a colour.

        `anchor` is the point of the plate that lies at the place, as for texts.
        """
        unit = self.unit
        large = _HEADING * unit
        small = _TEXT * unit
        heading, *others = lines
        widths = [self.box((0, 0), heading, large, bold=True).right]
        widths += [self.box((0, 0), line, small).right for line in others]
        width = max(widths) + 2 * _ASIDE * unit
        height = (_LINE * len(lines) + 2 * _ABOVE) * unit
        corner = place - np.multiply(anchor, (width, height))
        self.area(corner + np.array([[0, 0], [width, 0], [width, height], [0, height]]), ground)
        begin = corner + np.array([_ASIDE, _ABOVE + _LINE / 2]) * unit
        self.text(begin, heading, large, colour, bold=True)
        for number, line in enumerate(others, start=1):
            self.text(begin + np.array([0, number * _LINE * unit]), line, small)

    def _paste(self, text: np.ndarray, box: Box) -> None:
        """Lay a text, which has room for a halo, on the sheet where its box is."""
        left = box.left - _HALO
        bottom = self.height - box.bottom - _HALO
        self._renderer.draw_image(self._pasting, left, bottom, text)

    def _pen(self, width: float, colour: Colour, alpha: float) -> GraphicsContextBase:
        pen = self._renderer.new_gc()
        pen.set_linewidth(width)
        pen.set_foreground(colour)
        pen.set_alpha(alpha)
        pen.set_capstyle("round")
        pen.set_joinstyle("round")
        pen.set_snap(False)  # what moves must not jump from pixel to pixel
        return pen


def overlap(one: Box, other: Box) -> bool:
    """Return whether two boxes have an area in common."""
    in_columns = min(one.right, other.right) > max(one.left, other.left)
    in_rows = min(one.bottom, other.bottom) > max(one.top, other.top)
    return in_columns and in_rows


@lru_cache(maxsize=512)
def _size(words: str, size: float, bold: bool) -> tuple[int, int]:
    """Return width and height of a text [pixels]."""
    font = _font(size, bold)
    return math.ceil(font.getlength(words)), sum(font.getmetrics())


@lru_cache(maxsize=512)
def _rasterize(words: str, size: float, bold: bool, edge: int, colour: Colour) -> np.ndarray:
    """Return a text as a picture of red, green, blue and opacity, uint8, the lowest row first.

    Its letters are wider by an `edge` [pixels] all around. There is room for a halo on all sides.
    """
    width, height = _size(words, size, bold)
    opacity = Image.new("L", (width + 2 * _HALO, height + 2 * _HALO))
    font = _font(size, bold)
    ImageDraw.Draw(opacity).text((_HALO, _HALO), words, 255, font, stroke_width=edge)
    text = Image.new("RGB", opacity.size, to_hex(colour))
    text.putalpha(opacity)
    return np.asarray(text)[::-1].copy()


@cache
def _font(size: float, bold: bool) -> ImageFont.FreeTypeFont:
    """Return the font that comes with matplotlib, with a size rounded to whole pixels.

    The system may have another font of that name.
    """
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    path = pathlib.Path(get_data_path()) / "fonts" / "ttf" / name
    # Pillow's other layout needs FriBiDi, and falls back to this one on a system without it: then
    # letters would not be in the same places everywhere.
    layout = ImageFont.Layout.BASIC
    return ImageFont.truetype(path, max(1, round(size)), layout_engine=layout)
