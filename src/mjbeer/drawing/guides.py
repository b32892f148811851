"""What is drawn over a picture to explain it: gravity's arrow, the angle of the incline, and texts."""

import functools
import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from mjbeer.drawing.camera import View
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

_INK = (40, 50, 65)
"""Colour of lines and texts."""
_PAPER = (255, 255, 255, 200)
"""Colour behind the texts."""
_FRONT = 0.0155
"""Distance of the level line from the can's near end [m]: just in front of the board."""
_UNDERSIDE = 0.01152
"""Depth of the board's underside [m]."""
_DEPTH = 0.15
"""Distance of the arrow from the camera [m]: in front of everything else."""


@dataclass(frozen=True, eq=False)
class Slope:
    """A horizontal line under the board, and the angle from it to the board."""

    corner: np.ndarray
    """Where the line meets the board's underside, below the can and a little downhill [m]."""
    uphill: float
    """Direction of u in which the board rises: -1 or 1."""
    angle: float
    """Angle of the incline, always positive [rad]."""
    unit: float
    """Unit of length of the guides [m]: the can's radius, or more where the can is small in the picture."""

    @classmethod
    def of(cls, scene: Scene, view: View, axis: np.ndarray) -> Self:
        """Return the line and the angle for a scene; `axis` is a point on the drawn can's axis [m]."""
        unit = max(RADIUS, 0.2 * view.depth(axis) * view.tangent[1])
        sine, cosine, uphill = math.sin(scene.incline), math.cos(scene.incline), -math.copysign(1.0, scene.incline)
        along = -uphill * min(1.7, 1.2 / max(abs(sine), 0.1)) * unit
        below = RADIUS + _UNDERSIDE
        front = scene.can.length / scene.can.radius * RADIUS / 2 + _FRONT
        corner = axis + np.array([along * cosine - below * sine, -front, -along * sine - below * cosine])
        return cls(corner, uphill=uphill, angle=abs(scene.incline), unit=unit)

    def at(self, distance: float, angle: float) -> np.ndarray:
        """Return the point [m] at a distance [units] from the corner and an `angle` [rad] above the horizontal line."""
        return self.corner + distance * self.unit * np.array([self.uphill * math.cos(angle), 0, math.sin(angle)])


def draw(picture: mujoco.MjvScene, scene: Scene, view: View, axis: np.ndarray) -> None:
    """Add gravity's arrow, the horizontal line and its arc to a picture; `axis` is a point on the can's axis [m]."""
    tail, head = _arrow(view)
    thickness = 0.04 * float(np.linalg.norm(head - tail))
    _add_line(picture, mujoco.mjtGeom.mjGEOM_ARROW, width=thickness, start=tail, end=head)
    if scene.incline != 0:
        slope = Slope.of(scene, view, axis)
        arc = [slope.at(2, angle) for angle in np.linspace(0, slope.angle, 16)]
        for start, end in [(slope.corner, slope.at(2.8, 0)), *pairwise(arc)]:
            _add_line(picture, mujoco.mjtGeom.mjGEOM_CAPSULE, width=0.015 * slope.unit, start=start, end=end)


def write(pixels: np.ndarray, scene: Scene, view: View, axis: np.ndarray, texts: tuple[str, str, str]) -> np.ndarray:
    """Return the picture with "g" at the arrow, the angle of the incline, and three texts: a title and two below it."""
    image = Image.fromarray(pixels)
    ink = ImageDraw.Draw(image, "RGBA")
    unit = image.height / 36

    def text(place: tuple[float, float], words: str, size: float, anchor: str = "lm") -> None:
        ink.text(place, words, fill=_INK, font=_font(size * unit), anchor=anchor)

    tail, head = _arrow(view)
    column, row = view.pixel((tail + head) / 2)
    text((column + unit, row), "g", 1.7)
    if scene.incline != 0:
        slope = Slope.of(scene, view, axis)
        label = degrees(scene.incline, ".3g")
        text(view.pixel(slope.at(2.45, slope.angle / 2)), label, size=1.5, anchor="mm")
    width = max(19 * unit, ink.textlength(texts[0], _font(1.4 * unit)))
    ink.rounded_rectangle((unit, unit, width + 2.6 * unit, 6 * unit), 0.5 * unit, fill=_PAPER)
    text((1.8 * unit, 2.3 * unit), texts[0], 1.4)
    text((1.8 * unit, 4.5 * unit), texts[1], 1.7)
    text((9.8 * unit, 4.5 * unit), texts[2], 1.7)
    return np.array(image)


def _arrow(view: View) -> tuple[np.ndarray, np.ndarray]:
    """Return tail and head [m] of gravity's arrow, in the upper right corner of the picture."""
    tail = view.at((0.88, 0.88), _DEPTH)
    return tail, tail - np.array([0, 0, 0.35 * _DEPTH * view.tangent[1]])


def _add_line(picture: mujoco.MjvScene, kind: mujoco.mjtGeom, width: float, start: np.ndarray, end: np.ndarray) -> None:
    """Add an arrow or a capsule of a `width` [m] from `start` to `end` [m]."""
    geom = picture.geoms[picture.ngeom]
    colour = np.array([*_INK, 255], np.float32) / 255
    mujoco.mjv_initGeom(geom, kind, size=np.zeros(3), pos=np.zeros(3), mat=np.zeros(9), rgba=colour)
    mujoco.mjv_connector(geom, kind, width, start, end)
    if kind == mujoco.mjtGeom.mjGEOM_ARROW:
        geom.size[2] *= 2  # MuJoCo draws an arrow half as long as the distance that it connects
    geom.emission = 1.0
    picture.ngeom += 1


def degrees(angle: float, form: str) -> str:
    """Return an `angle` [rad] as text in degrees, in a format such as ".1f"."""
    return f"{math.degrees(angle):{form}}\N{DEGREE SIGN}"


@functools.cache
def _font(size: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size)
