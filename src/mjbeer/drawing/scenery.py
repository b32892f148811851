"""Wall and board behind the cans. They are flat, and a sheet draws them in a tenth of the time that OpenGL takes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.drawing.camera import View, on_incline
from mjbeer.drawing.sheet import Sheet
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

_STRIPE = math.pi / 2 * RADIUS
"""Length of a stripe of the board [m], a quarter turn of the can; a pale one begins at x = 0, as in the templates."""
_SQUARE = 0.1
"""Distance of the lines on the wall [m]: it repeats its texture, whose edge is a line, with x = 0 in its middle."""
_PAINT, _STROKE = np.array([0.15, 0.17, 0.2]), 0.003
"""Colour of lines across the board, and half their width [m]."""
_NEAR = np.array([0.0, -1.0, 0.0])
"""Unit vector towards the reader."""


@dataclass(frozen=True, eq=False)
class Scenery:
    """The wall and the board of a model, in the model's colours and light."""

    scene: Scene
    model: mujoco.MjModel
    lines: Sequence[float] = ()
    """Distances down the incline at which a line crosses the board [m]. All lengths are as drawn."""

    def draw(self, sheet: Sheet, view: View, top: int) -> None:
        """Draw what a view shows onto a sheet, below a row of it."""
        sheet.clip((0, top, view.pixels[0], top + view.pixels[1]))
        self._wall(sheet, view, top)
        self._board(sheet, view, top)
        sheet.clip(None)

    def _wall(self, sheet: Sheet, view: View, top: int) -> None:
        shift = np.array([0, top])
        y, texture = float(self.model.geom("wall").pos[1]), self._texture("grid")
        corners = view.corners(y)
        low, high = corners.min(axis=0), corners.max(axis=0)
        ranges = np.floor(np.stack([low, high], axis=1) / _SQUARE + 0.5)
        x, z = (_SQUARE * (np.arange(*each) + 0.5) for each in ranges)
        plumb = np.stack([np.stack([x, np.full_like(x, end)], axis=-1) for end in (low[1], high[1])], axis=1)
        level = np.stack([np.stack([np.full_like(z, end), z], axis=-1) for end in (low[0], high[0])], axis=1)
        lines = np.insert(np.concatenate([plumb, level]), 1, y, axis=-1)
        sheet.area(view.pixel(np.insert(corners, 1, y, axis=-1)) + shift, self._lit(texture[64, 64], _NEAR, view))
        width = 2 * _SQUARE / len(texture) * view.scale(np.insert(low, 1, y))
        sheet.line(_apart(view.pixel(lines) + shift), width, self._lit(texture[0, 0], _NEAR, view))

    def _board(self, sheet: Sheet, view: View, top: int) -> None:
        board, texture, shift = self.model.geom("board"), self._texture("planks"), np.array([0, top])
        (front, back), (under, over) = ((board.pos[i] - board.size[i], board.pos[i] + board.size[i]) for i in (1, 2))
        seen = np.concatenate([view.corners(front), view.corners(back)]) @ on_incline(self.scene, 1.0, 0.0)
        stripes = _STRIPE * np.arange(seen.min() // _STRIPE - 1, seen.max() // _STRIPE + 2)
        dark = stripes[np.round(stripes / _STRIPE) % 2 == 1]
        up = np.insert(on_incline(self.scene, 0.0, 1.0), 1, 0.0)
        faces = ((up, (front, over), (back, over)), (-up, (front, under), (back, under)))
        for normal, one, other in (*faces, (_NEAR, (front, under), (front, over))):

            def bands(begin: np.ndarray, length: float, edges=(one, one, other, other)) -> np.ndarray:
                """Return the places of the parts of this face that begin somewhere down the incline."""
                ends = zip((begin, begin + length, begin + length, begin), edges, strict=True)
                points = [np.insert(on_incline(self.scene, along, z), 1, y, axis=-1) for along, (y, z) in ends]
                return _apart(view.pixel(np.stack(points, axis=1)) + shift)

            if (view.eye - np.insert(on_incline(self.scene, 0.0, one[1]), 1, one[0])) @ normal <= 0:
                continue
            sheet.area(bands(stripes[:1], float(np.ptp(stripes))), self._lit(texture[16, 16], normal, view))
            sheet.area(bands(dark, _STRIPE), self._lit(texture[16, 48], normal, view))
            if len(self.lines) and normal is up:
                sheet.area(bands(np.array(self.lines) - _STROKE, 2 * _STROKE), self._lit(255 * _PAINT, normal, view))

    def _texture(self, name: str) -> np.ndarray:
        """Return the texture of a name, shape (height, width, 3)."""
        texture = self.model.tex(name)
        shape = int(texture.height[0]), int(texture.width[0]), int(texture.nchannel[0])
        return self.model.tex_data[int(texture.adr[0]) :][: math.prod(shape)].reshape(shape)

    def _lit(self, colour: np.ndarray, normal: np.ndarray, view: View) -> tuple[float, float, float]:
        """Return the colour of a face that is turned to a `normal`, lit by the sun and from the eye."""
        head, sun = self.model.vis.headlight, self.model.light_diffuse[0] * max(0.0, -normal @ self.model.light_dir[0])
        light = head.ambient + head.diffuse * max(0.0, float(normal @ view.axes[2])) + sun
        red, green, blue = np.minimum(colour / 255 * light, 1.0).tolist()
        return red, green, blue


def _apart(shapes: np.ndarray) -> np.ndarray:
    """Return places of several lines or polygons of shape (n, k, 2) as one path, with gaps (NaN)."""
    return np.insert(shapes, shapes.shape[1], np.nan, axis=1).reshape(-1, 2)
