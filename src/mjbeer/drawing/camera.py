"""What an eye sees: which pixel shows a point, and how a camera follows a motion."""

import math
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, Self

import numpy as np
from numpy.polynomial import Polynomial

from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

Camera = Literal["auto", "fixed", "pan"]
"""fixed: the camera stands still, so far away that the whole motion is seen. pan: it moves along
the incline with the constant acceleration that fits the motion best. auto: fixed, or pan where
the can would be small."""
CAMERAS: tuple[Camera, ...] = ("auto", "fixed", "pan")

AROUND = 1.9
"""At least so many radii around the can's axis are seen: the can and the angle of its load."""
BELOW = 2.3
"""At least so many radii below its axis: the board, and what is written under it."""
_SMALLEST = 0.11
"""Least radius of the can, divided by the picture's height, with which "auto" stands still."""


def scale(scene: Scene) -> float:
    """Return at which length [m] a metre is drawn: all cans are drawn with one radius."""
    return RADIUS / scene.can.radius


def on_incline(scene: Scene, along: np.ndarray | float, height: np.ndarray | float) -> np.ndarray:
    """Return x and z of points `along` the incline, `height` above it, shape (..., 2)."""
    return in_space(scene, along, height, 0.0)[..., ::2]


def in_space(
    scene: Scene, along: np.ndarray | float, height: np.ndarray | float, y: float
) -> np.ndarray:
    """Return x, y and z of the points of `on_incline`, all with one `y`, shape (..., 3)."""
    downhill = [math.cos(scene.incline), 0, -math.sin(scene.incline)]
    upward = [math.sin(scene.incline), 0, math.cos(scene.incline)]
    return np.multiply.outer(along, downhill) + np.multiply.outer(height, upward) + [0, y, 0]


def circle(radius: float, count: int = 48) -> np.ndarray:
    """Return points of a circle about the origin, shape (count + 1, 2), the first also last."""
    return radius * unit_vectors(np.linspace(0, 2 * math.pi, count + 1))


def unit_vectors(angle: float | np.ndarray) -> np.ndarray:
    """Return unit vectors at angles [rad] from the first axis to the second, shape (..., 2)."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


class Edges(NamedTuple):
    """The edges of a part of a picture, in columns and rows of the picture [pixels]."""

    left: int
    upper: int
    right: int
    lower: int


@dataclass(frozen=True, eq=False)
class View:
    """A perspective view of a rectangle.

    An eye that looks along the can's axis sees every plane across that axis without distortion.
    """

    eye: np.ndarray
    """Where the eye is [m]."""
    axes: np.ndarray
    """Unit vectors in its rows: to the right, up, and backwards from the eye."""
    low: np.ndarray
    """Lower left corner of what is seen: how far right and up it is, at one metre from the eye."""
    high: np.ndarray
    """The upper right corner, likewise."""
    distance: float
    """Distance from the eye to what it looks at [m]."""
    pixels: tuple[int, int]
    """Width and height of the picture [pixels]."""
    top: int = 0
    """Row of the sheet at which the picture begins."""

    @classmethod
    def facing(cls, centre: np.ndarray, metres: np.ndarray, pixels: tuple[int, int]) -> Self:
        """Return the view along the can's axis of a rectangle across it.

        `centre` is the rectangle's centre [m], `metres` are its width and height [m].
        """
        # The farther the eye is, the less of the inside of the can's wall is seen.
        distance = 4 * float(np.hypot(*metres))
        # From a little above, the upper side of the board is seen.
        above = 0.18 * float(metres[1])
        eye = centre + np.array([0.0, -distance, above])
        axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        middle = np.array([0.0, -above])
        low = (middle - metres / 2) / distance
        high = (middle + metres / 2) / distance
        return cls(eye, axes, low, high, distance, pixels)

    @classmethod
    def towards(
        cls, eye: np.ndarray, points: np.ndarray, pixels: tuple[int, int], top: int, margin: float
    ) -> Self:
        """Return the upright view from an `eye` [m] that just shows some points [m], shape (n, 3).

        The picture begins at the row `top` of the sheet. The `margin` around the points is a share
        of the size of what is seen.
        """
        away = eye - points.mean(axis=0)
        distance = float(np.linalg.norm(away))
        right = np.array([-away[1], away[0], 0.0]) / np.hypot(away[0], away[1])
        axes = np.array([right, np.cross(away, right) / distance, away / distance])
        seen = (points - eye) @ axes.T
        across = seen[:, :2] / -seen[:, 2:]
        low = across.min(axis=0)
        high = across.max(axis=0)
        per_pixel = ((high - low) / pixels).max()
        half = (0.5 + margin) * per_pixel * np.array(pixels)
        middle = (low + high) / 2
        return cls(eye, axes, middle - half, middle + half, distance, pixels, top)

    def pixel(self, points: np.ndarray) -> np.ndarray:
        """Return column and row on the sheet of points [m] of shape (..., 3)."""
        seen = (np.asarray(points) - self.eye) @ self.axes.T
        across = (seen[..., :2] / -seen[..., 2:] - self.low) / (self.high - self.low)
        return (across * [1, -1] + [0, 1]) * self.pixels + np.array([0, self.top])

    def corners(self, y: float) -> np.ndarray:
        """Return x and z [m] of the picture's corners, in the plane at `y`, shape (4, 2)."""
        left, low = self.low
        right, high = self.high
        sights = [(left, low, -1.0), (right, low, -1.0), (right, high, -1.0), (left, high, -1.0)]
        rays = np.array(sights) @ self.axes
        points = self.eye + rays * ((y - self.eye[1]) / rays[:, 1:2])
        return points[:, [0, 2]]

    def scale(self, point: np.ndarray) -> float:
        """Return how many pixels wide a metre across the view is at the distance of a point [m]."""
        distance = float((self.eye - point) @ self.axes[2])
        return self.pixels[0] / (float(self.high[0] - self.low[0]) * distance)

    def crop(self, edges: Edges) -> Self:
        """Return the view of a part of the picture, at the top of a sheet of its own."""
        per_pixel = (self.high - self.low) / self.pixels
        height = self.pixels[1]
        low = self.low + per_pixel * [edges.left, height - edges.lower]
        high = self.low + per_pixel * [edges.right, height - edges.upper]
        pixels = (edges.right - edges.left, edges.lower - edges.upper)
        return replace(self, low=low, high=high, pixels=pixels, top=0)

    def edges(self, points: np.ndarray, margin: float) -> Edges:
        """Return the edges of what points [m] span in the picture, with a `margin` [pixels]."""
        places = self.pixel(points).reshape(-1, 2) - [0, self.top]
        low = np.clip(np.floor(places.min(axis=0) - margin), 0, self.pixels)
        high = np.clip(np.ceil(places.max(axis=0) + margin), 0, self.pixels)
        return Edges(int(low[0]), int(low[1]), int(high[0]), int(high[1]))


@dataclass(frozen=True, eq=False)
class CameraPath:
    """How a camera films a motion: it stands still, or moves along the incline beside the can."""

    scene: Scene
    along: Polynomial
    """How far down the incline the camera is over time [s], as drawn [m]."""
    middle: np.ndarray
    """Middle of what is seen, x and z from the place of the camera on the incline [m]."""
    metres: np.ndarray
    """Width and height of what is seen [m]."""
    front: float
    """The plane y of the can's near end [m], in which they are measured."""
    pixels: tuple[int, int]
    """Width and height of the picture [pixels]."""

    @property
    def still(self) -> bool:
        """Whether it always sees the same."""
        return self.along.degree() == 0

    def view(self, time: float) -> View:
        """Return what the camera sees at a time [s]."""
        x, z = on_incline(self.scene, self.along(time), 0.0) + self.middle
        return View.facing(np.array([x, self.front, z]), self.metres, self.pixels)


def follow(
    motion: Trajectory,
    camera: Camera,
    front: float,
    pixels: tuple[int, int],
) -> CameraPath:
    """Return how a camera films a can that moves, in a picture of some `pixels`.

    The can's near end is in the plane y = `front` [m].
    """
    u = motion.u * scale(motion.scene)
    half_way = Polynomial([(u.min() + u.max()) / 2])
    still = _path(motion, half_way, front, pixels)
    if camera == "fixed" or len(motion.time) < 3:  # so few places have no acceleration
        return still
    if camera == "auto" and RADIUS / still.metres[1] >= _SMALLEST:
        return still
    parabola = Polynomial.fit(motion.time, u, 2).convert()
    return _path(motion, parabola, front, pixels)


def _path(
    motion: Trajectory, along: Polynomial, front: float, pixels: tuple[int, int]
) -> CameraPath:
    """Return the path of a camera that is `along` the incline, and just shows the whole motion."""
    scene = motion.scene
    u = motion.u * scale(scene) - along(motion.time)
    height = RADIUS + motion.lift * scale(scene)
    axis = on_incline(scene, u, height)
    low = axis.min(axis=0) - RADIUS * np.array([AROUND, BELOW])
    high = axis.max(axis=0) + RADIUS * AROUND
    shape = np.array(pixels) / pixels[1]
    metres = ((high - low) / shape).max() * shape
    return CameraPath(scene, along, (low + high) / 2, metres, front, pixels)
