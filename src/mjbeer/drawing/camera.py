"""What an eye sees of the drawn world: which pixel shows a point, and how a camera follows a motion."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Self

import numpy as np
from numpy.polynomial import Polynomial

from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

Camera = Literal["auto", "fixed", "pan"]
"""fixed: still, and so far away that all of the motion is seen. pan: moves along the incline with the constant
acceleration that fits the motion best. auto: fixed, or pan where the can would be small."""
CAMERAS: tuple[Camera, ...] = ("auto", "fixed", "pan")
_LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # axes of an eye along the can's axis
AROUND = 1.9  # radii that are seen around the can's axis at least: the can, its angle, the board
_SMALLEST = 0.11  # radius below which the camera pans, unless told otherwise, in heights of the picture


def scale(scene: Scene) -> float:
    """Return the length [m] at which one metre of the scene is drawn: all cans are drawn with one radius."""
    return RADIUS / scene.can.radius


def on_incline(scene: Scene, along: np.ndarray | float, height: np.ndarray | float) -> np.ndarray:
    """Return x and z of points `along` the incline and at a `height` over it, in one unit, shape (..., 2)."""
    return in_space(scene, along, height, 0.0)[..., ::2]


def in_space(scene: Scene, along: np.ndarray | float, height: np.ndarray | float, y: float) -> np.ndarray:
    """Return x, y and z of such points at one `y`, shape (..., 3)."""
    sine, cosine = math.sin(scene.incline), math.cos(scene.incline)
    return np.multiply.outer(along, [cosine, 0, -sine]) + np.multiply.outer(height, [sine, 0, cosine]) + [0, y, 0]


def circle(radius: float, count: int = 48) -> np.ndarray:
    """Return points (x, z) of a circle about the origin, shape (count + 1, 2), the last of them the first."""
    turn = np.linspace(0, 2 * math.pi, count + 1)
    return radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)


@dataclass(frozen=True, eq=False)
class View:
    """A perspective view. An eye that looks along the can's axis sees every plane across it without distortion."""

    eye: np.ndarray  # where the eye is [m]
    axes: np.ndarray  # unit vectors in its rows: to the right, up, and backwards from the eye
    low: np.ndarray  # lower left corner of what is seen, as distances to the right and up over that from the eye
    high: np.ndarray  # the upper right corner, likewise
    distance: float  # distance of what is looked at from the eye [m]
    pixels: tuple[int, int]  # width and height of the picture [pixels]
    top: int = 0  # row of the sheet at which the picture begins

    @classmethod
    def facing(cls, centre: np.ndarray, metres: np.ndarray, pixels: tuple[int, int]) -> Self:
        """Return the view along the can's axis of a rectangle across it, from its centre and its size in `metres`."""
        # The longer the distance, the less of the can's inside is seen; from above, the board's upper side is.
        distance, above = 4 * float(np.hypot(*metres)), 0.18 * float(metres[1])
        foot = np.array([0.0, -above])
        low, high = (foot - metres / 2) / distance, (foot + metres / 2) / distance
        return cls(centre + np.array([0.0, -distance, above]), _LEVEL, low, high, distance, pixels)

    @classmethod
    def towards(cls, eye: np.ndarray, points: np.ndarray, pixels: tuple[int, int], top: int, margin: float) -> Self:
        """Return the upright view from an `eye` [m] that just shows some points [m], shape (n, 3), with a `margin`
        around them, in sizes of the picture."""
        away = eye - points.mean(axis=0)
        distance = float(np.linalg.norm(away))
        right = np.array([-away[1], away[0], 0.0]) / np.hypot(away[0], away[1])
        axes = np.array([right, np.cross(away, right) / distance, away / distance])
        seen = (points - eye) @ axes.T
        across = seen[:, :2] / -seen[:, 2:]
        low, high = across.min(axis=0), across.max(axis=0)
        half = (0.5 + margin) * ((high - low) / pixels).max() * np.array(pixels)
        middle = (low + high) / 2
        return cls(eye, axes, middle - half, middle + half, distance, pixels, top)

    def pixel(self, points: np.ndarray) -> np.ndarray:
        """Return column and row on the sheet of points [m] of shape (..., 3)."""
        seen = (np.asarray(points) - self.eye) @ self.axes.T
        across = (seen[..., :2] / -seen[..., 2:] - self.low) / (self.high - self.low)
        return (across * [1, -1] + [0, 1]) * self.pixels + np.array([0, self.top])

    def corners(self, y: float) -> np.ndarray:
        """Return x and z [m] of the picture's corners, in turn, in a plane across the can's axis, shape (4, 2)."""
        (left, low), (right, high) = self.low, self.high
        rays = np.array([(left, low, -1.0), (right, low, -1.0), (right, high, -1.0), (left, high, -1.0)]) @ self.axes
        points = self.eye + rays * ((y - self.eye[1]) / rays[:, 1:2])
        return points[:, [0, 2]]

    def scale(self, point: np.ndarray) -> float:
        """Return how many pixels wide a metre across the view is at the distance of a point [m]."""
        distance = float((self.eye - point) @ self.axes[2])
        return self.pixels[0] / (float(self.high[0] - self.low[0]) * distance)

    def crop(self, left: int, upper: int, right: int, lower: int) -> Self:
        """Return the view of a part of the picture, given by its edges in it [pixels], at the top of a sheet."""
        size = (self.high - self.low) / self.pixels
        low = self.low + size * [left, self.pixels[1] - lower]
        high = self.low + size * [right, self.pixels[1] - upper]
        return replace(self, low=low, high=high, pixels=(right - left, lower - upper), top=0)

    def box(self, points: np.ndarray, margin: float) -> tuple[int, int, int, int]:
        """Return the edges in the picture [pixels] of what points [m] span, with a margin [pixels]."""
        places = self.pixel(points).reshape(-1, 2) - [0, self.top]
        low = np.clip(np.floor(places.min(axis=0) - margin), 0, self.pixels)
        high = np.clip(np.ceil(places.max(axis=0) + margin), 0, self.pixels)
        return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def follow(
    motion: Trajectory, camera: Camera, front: float, pixels: tuple[int, int], below: float = AROUND
) -> tuple[Callable[[float], View], bool]:
    """Return the view at a time [s] that a camera has of a moving can, and whether the camera stands still.

    The can's near end is in the plane y = `front` [m], and so many radii `below` its axis are seen, at least.
    """
    scene, time, shape = motion.scene, motion.time, np.array(pixels) / pixels[1]
    along, height = motion.u * scale(scene), motion.lift * scale(scene)

    def shown(way: Polynomial) -> tuple[np.ndarray, np.ndarray]:
        """Return the middle of what is seen, from the point at the way's distance, and its width and height [m]."""
        axis = on_incline(scene, along - way(time), height + RADIUS)
        low = axis.min(axis=0) - RADIUS * np.array([AROUND, below])
        high = axis.max(axis=0) + RADIUS * AROUND
        return (low + high) / 2, ((high - low) / shape).max() * shape

    way = Polynomial([(along.min() + along.max()) / 2])  # distance of the camera down the incline, as drawn [m]
    middle, metres = shown(way)
    still = camera == "fixed" or bool(len(time) < 3 or (camera == "auto" and RADIUS / metres[1] >= _SMALLEST))
    if not still:
        way = Polynomial.fit(time, along, 2).convert()
        middle, metres = shown(way)

    def view(time: float) -> View:
        x, z = on_incline(scene, way(time), 0.0) + middle
        return View.facing(np.array([x, front, z]), metres, pixels)

    return view, still
