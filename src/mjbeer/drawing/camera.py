"""What an eye sees of the drawn world: which pixel shows a point, and how a camera follows a motion."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, Self

import numpy as np
from numpy.polynomial import Polynomial

from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

Camera = Literal["auto", "fixed", "pan", "close"]
"""fixed: still, and so far away that all of the motion is seen. pan: moves along the incline with the constant
acceleration that fits the motion best. close: goes along with the can. auto: fixed, or pan where the can would be
small."""
CAMERAS: tuple[Camera, ...] = ("auto", "fixed", "pan", "close")
_LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Axes of an eye that looks along the can's axis: right is downhill, up is up, and backwards is towards the reader."""
_AROUND = 1.75
"""What is seen around the can's axis on each side, and below it, at least, in radii: the can, its angle, the board."""
_SMALLEST = 0.11  # radius below which the camera pans, unless told otherwise, in heights of the picture
_FAR = 8.0  # distance of the eye, in half diagonals of the picture: the longer, the less of the can's inside is seen
_ABOVE = 0.18  # how far the eye is above the middle of the picture, in heights: it sees the board's upper side


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
    low: np.ndarray
    """The lower left corner of what is seen, as distances to the right and up over the distance from the eye."""
    high: np.ndarray  # the upper right corner, likewise
    distance: float  # distance of what is looked at from the eye [m]
    pixels: tuple[int, int]  # width and height of the picture [pixels]

    @classmethod
    def facing(
        cls, centre: np.ndarray, metres: np.ndarray, distance: float, above: float, pixels: tuple[int, int]
    ) -> Self:
        """Return the view along the can's axis of a rectangle in a plane across it.

        `centre` is the rectangle's centre and `metres` its width and height [m]. The eye is `distance` [m] in front of
        that plane, and `above` [m] over the centre, so that it sees a little of the board's upper side.
        """
        eye, foot = centre + np.array([0.0, -distance, above]), np.array([0.0, -above])
        return cls(eye, _LEVEL, (foot - metres / 2) / distance, (foot + metres / 2) / distance, distance, pixels)

    @classmethod
    def towards(cls, eye: np.ndarray, points: np.ndarray, pixels: tuple[int, int], margin: float) -> Self:
        """Return the upright view from an `eye` [m] that just shows some points [m], shape (n, 3).

        Around them there is a `margin`, in widths of the picture.
        """
        away = eye - points.mean(axis=0)
        distance = float(np.linalg.norm(away))
        right = np.array([-away[1], away[0], 0.0]) / np.hypot(away[0], away[1])
        axes = np.array([right, np.cross(away, right) / distance, away / distance])
        whole = cls(eye, axes, low=np.zeros(2), high=np.ones(2), distance=distance, pixels=(1, 1))
        places = whole.pixel(points) * [1, -1] + [0, 1]
        low, high = places.min(axis=0), places.max(axis=0)
        shape = np.array(pixels) / pixels[0]
        half = (((high - low) / shape).max() / 2 + margin * float(high[0] - low[0])) * shape
        middle = (low + high) / 2
        return replace(whole, low=middle - half, high=middle + half, pixels=pixels)

    def pixel(self, points: np.ndarray, top: int = 0) -> np.ndarray:
        """Return column and row of points [m] of shape (..., 3), on a sheet where the picture begins at row `top`."""
        seen = (np.asarray(points) - self.eye) @ self.axes.T
        across = (seen[..., :2] / -seen[..., 2:] - self.low) / (self.high - self.low)
        return (across * [1, -1] + [0, 1]) * self.pixels + np.array([0, top])

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

    def crop(self, left: int, top: int, right: int, bottom: int) -> Self:
        """Return the view of a part of the picture, given by its edges [pixels]."""
        size = (self.high - self.low) / self.pixels
        low = self.low + size * [left, self.pixels[1] - bottom]
        high = self.low + size * [right, self.pixels[1] - top]
        return replace(self, low=low, high=high, pixels=(right - left, bottom - top))

    def box(self, points: np.ndarray, margin: float = 0) -> tuple[int, int, int, int]:
        """Return left, top, right and bottom [pixels] of what points [m] span, with a margin [pixels]."""
        places = self.pixel(points).reshape(-1, 2)
        low = np.clip(np.floor(places.min(axis=0) - margin), 0, self.pixels)
        high = np.clip(np.ceil(places.max(axis=0) + margin), 0, self.pixels)
        return int(low[0]), int(low[1]), int(high[0]), int(high[1])


@dataclass(frozen=True, eq=False)
class CameraPath:
    """A camera's way along the drawn world, and what it shows of it."""

    scene: Scene
    way: Callable[[np.ndarray | float], np.ndarray | float]
    """Distance of the picture's middle down the incline over time [s], as drawn [m]."""
    middle: np.ndarray  # from the incline at that distance to the middle of the picture, to the right and up [m]
    metres: np.ndarray  # width and height of what is seen at the can's near end [m]
    plane: float  # coordinate y of the can's near end [m]
    pixels: tuple[int, int]
    still: bool  # whether the camera stands still

    def view(self, time: float) -> View:
        """Return what is seen at a `time` [s]."""
        x, z = on_incline(self.scene, self.way(time), 0.0) + self.middle
        above, distance = _ABOVE * float(self.metres[1]), _FAR * float(np.hypot(*self.metres)) / 2
        return View.facing(np.array([x, self.plane, z]), self.metres, distance, above, self.pixels)

    @classmethod
    def fit(
        cls,
        scene: Scene,
        camera: Camera,
        time: np.ndarray,
        u: np.ndarray,
        lift: np.ndarray,
        plane: float,
        pixels: tuple[int, int],
        around: float = _AROUND,
        below: float = _AROUND,
    ) -> "CameraPath":
        """Return the path that shows a can that is at `u` and `lift` [m] at some times [s].

        At least so many radii are seen `around` the can's axis, and `below` it.
        """
        along, height = u * scale(scene), lift * scale(scene)
        if camera == "auto":
            fixed = cls.fit(scene, "fixed", time, u, lift, plane, pixels, around, below)
            camera = "fixed" if RADIUS / fixed.metres[1] >= _SMALLEST else "pan"
        if camera == "fixed" or len(time) < 3 or np.ptp(time) == 0:
            way = Polynomial([(along.min() + along.max()) / 2])
        elif camera == "pan":
            way = Polynomial.fit(time, along, 2).convert()
        else:
            way = partial(np.interp, xp=time, fp=along)
        places = on_incline(scene, along - way(time), height + RADIUS)
        low = places.min(axis=0) - RADIUS * np.array([around, below])
        high = places.max(axis=0) + RADIUS * around
        shape = np.array(pixels) / pixels[1]
        tall = float(((high - low) / shape).max())
        return cls(scene, way, (low + high) / 2, tall * shape, plane, pixels, still=camera == "fixed")
