"""The scenery of a film: the board and the wall behind it, and the shadows of cans on the board.

It is drawn as flat areas, which takes a tenth of the time that OpenGL takes.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.drawing.camera import View, in_space, on_incline
from mjbeer.drawing.sheet import Colour, Sheet
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

_STRIPE = math.pi / 2 * RADIUS
"""Length of a stripe of the board [m]. Stripe 0, a pale one, begins at x = 0, as in the
templates."""
_PALE = np.array([0.94, 0.84, 0.69])
_DARK = np.array([0.84, 0.71, 0.54])
"""Colours of the stripes, as in mjcf/assets.xml."""
_SQUARE = 0.1
"""Distance of the lines on the wall [m]; x = 0 is half-way between two of them."""
_LINE = _SQUARE / 64
"""Width of these lines [m]: two of the 128 pixels of a square in the templates' texture."""
_WALL = np.array([0.985, 0.99, 1.0])
_GRID = np.array([0.84, 0.87, 0.92])
"""Colours of the wall and of its lines, as in mjcf/scene.xml."""
_PAINT = np.array([0.15, 0.17, 0.2])
"""Colour of lines across the board, such as the start of a race."""
_STROKE = 0.003
"""Half the width of these lines [m]."""
_NEAR = np.array([0.0, -1.0, 0.0])
"""Unit vector towards the viewer."""


class Scenery:
    """The board and the wall of a model that shows cans on an incline. Lengths are as drawn."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, lines: Sequence[float] = ()) -> None:
        """Take the board, wall and lights of a `model`, on the incline of a scene.

        At each distance [m] down the incline in `lines` a line crosses the board.
        """
        self._model = model
        self._scene = scene
        self._lines = np.array(lines)

    def draw(self, sheet: Sheet, view: View) -> None:
        """Draw wall and board.

        What is on the sheet above and below the view may be drawn over.
        """
        self._draw_wall(sheet, view)
        self._draw_board(sheet, view)

    def _draw_wall(self, sheet: Sheet, view: View) -> None:
        """Draw the wall behind the board, and a grid of lines on it."""
        y = float(self._model.geom("wall").pos[1])
        corners = view.corners(y)
        left, low = corners.min(axis=0)
        right, high = corners.max(axis=0)
        upright = [[(x, y, low), (x, y, high)] for x in _grid(left, right)]
        level = [[(left, y, z), (right, y, z)] for z in _grid(low, high)]
        grid = _separated(np.reshape(upright + level, (-1, 2, 3)))
        width = _LINE * view.scale(np.array([left, y, low]))
        sheet.area(view.pixel(np.insert(corners, 1, y, axis=1)), self.lit(_WALL, _NEAR, view))
        sheet.line(view.pixel(grid), width, self.lit(_GRID, _NEAR, view))

    def _draw_board(self, sheet: Sheet, view: View) -> None:
        """Draw the upper side of the board and its front: every eye sees these two."""
        scene = self._scene
        board = self._model.geom("board")
        front = board.pos[1] - board.size[1]
        back = board.pos[1] + board.size[1]
        under = board.pos[2] - board.size[2]
        over = board.pos[2] + board.size[2]
        edge = in_space(scene, 0.0, over, front)
        up = in_space(scene, 0.0, 1.0, 0.0)
        upper_side = _Face(scene, edge, in_space(scene, 0.0, over, back), up)
        front_side = _Face(scene, edge, in_space(scene, 0.0, under, front), _NEAR)

        # From a stripe before what is seen of the incline to the last that is seen.
        seen = np.concatenate([view.corners(front), view.corners(back)])
        along = seen @ on_incline(scene, 1.0, 0.0)
        numbers = np.arange(along.min() // _STRIPE - 1, along.max() // _STRIPE + 1)
        self._draw_stripes(sheet, view, upper_side, numbers)
        if len(self._lines):
            painted = upper_side.bands(self._lines - _STROKE, 2 * _STROKE)
            sheet.area(view.pixel(painted), self.lit(_PAINT, up, view))
        self._draw_stripes(sheet, view, front_side, numbers)

    def _draw_stripes(self, sheet: Sheet, view: View, face: "_Face", numbers: np.ndarray) -> None:
        """Draw the stripes of a face that have some successive `numbers`; the odd ones are dark."""
        ground = face.bands(_STRIPE * numbers[:1], _STRIPE * len(numbers))
        dark = face.bands(_STRIPE * numbers[numbers % 2 == 1], _STRIPE)
        sheet.area(view.pixel(ground), self.lit(_PALE, face.normal, view))
        sheet.area(view.pixel(dark), self.lit(_DARK, face.normal, view))

    def draw_slice(self, sheet: Sheet, view: View, y: float) -> None:
        """Draw a wall, and before it the front of the board as if that were in the plane at `y`."""
        board = self._model.geom("board")
        corners = view.corners(y)
        along = corners @ on_incline(self._scene, 1.0, 0.0)
        numbers = np.arange(along.min() // _STRIPE, along.max() // _STRIPE + 1)
        edge = in_space(self._scene, 0.0, board.pos[2] + board.size[2], y)
        under = in_space(self._scene, 0.0, board.pos[2] - board.size[2], y)
        front = _Face(self._scene, edge, under, _NEAR)
        sheet.area(view.pixel(np.insert(corners, 1, y, axis=1)), self.lit(_WALL, _NEAR, view))
        self._draw_stripes(sheet, view, front, numbers)

    def shade(self, sheet: Sheet, view: View, outline: np.ndarray) -> None:
        """Draw a can's shadow on the board.

        The `outline` is points around its near and its far end [m], shape (2, points, 3). The
        shadow is the quadrilateral between the shadows of both ends.
        """
        along = in_space(self._scene, 1.0, 0.0, 0.0)
        up = in_space(self._scene, 0.0, 1.0, 0.0)
        light = self._model.light_dir[0]
        board = self._model.geom("board")
        height = outline @ up - board.pos[2] - board.size[2]
        near, far = outline - np.multiply.outer(height / (light @ up), light)
        corners = np.array(
            [
                near[(near @ along).argmin()],
                near[(near @ along).argmax()],
                far[(far @ along).argmax()],
                far[(far @ along).argmin()],
            ]
        )
        middle = corners.mean(axis=0)
        for share in (0.8, 0.95):  # two layers make a soft edge
            shadow = middle + share * (corners - middle)
            sheet.area(view.pixel(shadow), (0.25, 0.15, 0.05), alpha=0.16)

    def lit(self, colour: np.ndarray, normal: np.ndarray, view: View) -> Colour:
        """Return the colour of a face with a `normal`, lit by the sun and by a lamp at the eye."""
        model = self._model
        head = model.vis.headlight
        sun = model.light_diffuse[0] * max(0.0, -normal @ model.light_dir[0])
        light = head.ambient + head.diffuse * max(0.0, float(normal @ view.axes[2])) + sun
        red, green, blue = np.minimum(colour * light, 1.0).tolist()
        return red, green, blue


class _Face(NamedTuple):
    """A face of the board between two edges, which both run down the incline without end."""

    scene: Scene
    edge: np.ndarray
    """The point of one edge at the distance 0 down the incline [m], shape (3,)."""
    opposite: np.ndarray
    """That of the other edge."""
    normal: np.ndarray
    """Unit vector out of the board."""

    def bands(self, begin: np.ndarray, length: float) -> np.ndarray:
        """Return bands across the face as one path with gaps, shape (points, 3).

        They `begin` at some distances down the incline and have a `length` along it [m].
        """
        first = in_space(self.scene, begin, 0.0, 0.0)
        last = in_space(self.scene, begin + length, 0.0, 0.0)
        corners = [
            first + self.edge,
            last + self.edge,
            last + self.opposite,
            first + self.opposite,
        ]
        return _separated(np.stack(corners, axis=1))


def _grid(low: float, high: float) -> np.ndarray:
    """Return the places of the lines on the wall between two places [m]."""
    first, last = np.floor(np.array([low, high]) / _SQUARE + 0.5)
    return _SQUARE * (np.arange(first, last) + 0.5)


def _separated(shapes: np.ndarray) -> np.ndarray:
    """Return n lines or polygons of k points, shape (n, k, d), as one path with gaps (NaN)."""
    gap = np.full_like(shapes[:, :1], np.nan)
    return np.concatenate([shapes, gap], axis=1).reshape(-1, shapes.shape[2])
