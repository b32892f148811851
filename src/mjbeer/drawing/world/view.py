"""What an eye sees of the drawn world: which pixel shows a point, and the part of a view that a crop shows."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Axes of an eye that looks along the can's axis: right is downhill, up is up, and backwards is towards the reader."""


@dataclass(frozen=True, eq=False)
class View:
    """A perspective view. An eye that looks along the can's axis sees every plane across it without distortion."""

    eye: np.ndarray
    """Where the eye is [m]."""
    axes: np.ndarray
    """Unit vectors in its rows: to the right, up, and backwards from the eye."""
    low: np.ndarray
    """The lower left corner of what is seen, as distances to the right and up over the distance from the eye."""
    high: np.ndarray
    """The upper right corner, likewise."""
    distance: float
    """Distance of what is looked at from the eye [m]."""
    pixels: tuple[int, int]
    """Width and height of the picture [pixels]."""

    @classmethod
    def facing(
        cls, centre: np.ndarray, metres: np.ndarray, distance: float, above: float, pixels: tuple[int, int]
    ) -> Self:
        """Return the view along the can's axis of a rectangle in a plane across it.

        `centre` is the rectangle's centre and `metres` its width and height [m]. The eye is `distance` [m] in front of
        that plane, and `above` [m] over the centre, so that it sees a little of the board's upper side.
        """
        eye = centre + np.array([0.0, -distance, above])
        foot = np.array([0.0, -above])
        return cls(
            eye,
            LEVEL,
            low=(foot - metres / 2) / distance,
            high=(foot + metres / 2) / distance,
            distance=distance,
            pixels=pixels,
        )

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
        return cls(eye, axes, low=middle - half, high=middle + half, distance=distance, pixels=pixels)

    def pixel(self, points: np.ndarray) -> np.ndarray:
        """Return column and row of points [m] of shape (..., 3), from the upper left corner of the picture."""
        right, up, back = np.moveaxis((np.asarray(points) - self.eye) @ self.axes.T, -1, 0)
        across = (np.stack([right, up], axis=-1) / -back[..., None] - self.low) / (self.high - self.low)
        return np.stack([across[..., 0], 1 - across[..., 1]], axis=-1) * self.pixels

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


def circle(radius: float, count: int = 48) -> np.ndarray:
    """Return points (x, z) of a circle about the origin, shape (count + 1, 2), the last of them the first."""
    turn = np.linspace(0, 2 * math.pi, count + 1)
    return radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
