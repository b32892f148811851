"""Tracks of cans that roll as exact theory says, for the tests of this folder."""

import math
from typing import NamedTuple

import numpy as np

from mjbeer import Scene, Track, exact

# When a can is let go [s], and where [m].
RELEASED = 17.4
PLACE = 0.1


def filmed(
    scene: Scene,
    phi0: float | None = None,
    noise: float = 1e-3,
    seed: int = 0,
    seconds: float = 3.0,
) -> Track:
    """The track of a can from 17 s on, with a gap; it is let go with a level surface."""
    start = -scene.incline if phi0 is None else phi0
    time = np.arange(round(60 * seconds)) / 60
    since = time - (RELEASED - 17)
    rolls = since > 0
    distance = np.zeros(len(time))
    distance[rolls] = exact(scene, since[rolls], start).distance
    kept = (time < 1.5) | (time > 1.7)
    errors = noise * np.random.default_rng(seed).standard_normal(kept.sum())
    return Track(17 + time[kept], PLACE + distance[kept] + errors)


class Camera(NamedTuple):
    """A pinhole camera that looks at the middle of a board; its picture is 1920 pixels wide."""

    yaw: float
    """Angle between its view and the normal of the can's plane of motion, from above [rad]."""
    distance: float = 3.0
    """Distance from the middle of the board [m]."""
    height: float = 0.4
    """Height above the middle of the board [m]."""
    tilt: float = 0.0
    """Angle by which the picture is turned in its own plane [rad]."""
    focal_length: float = 2200.0
    """[pixels]."""

    def picture(self, along: np.ndarray, above: float, incline: float, middle: float) -> np.ndarray:
        """Where points of the plane of motion are seen [pixels], shape (points, 2), y downwards.

        They are `along` the board [m], `above` it [m] at a right angle; `middle` is half its
        length.
        """
        down = np.array([math.cos(incline), -math.sin(incline), 0.0])
        off = np.array([math.sin(incline), math.cos(incline), 0.0])
        points = np.outer(along - middle, down) + above * off
        view = np.array([math.sin(self.yaw), 0.0, math.cos(self.yaw)])
        eye = np.array([0.0, self.height, 0.0]) - self.distance * view
        view = -eye / np.linalg.norm(eye)
        level = np.cross([0.0, 1.0, 0.0], view)
        level /= np.linalg.norm(level)
        upright = np.cross(view, level)
        right = math.cos(self.tilt) * level + math.sin(self.tilt) * upright
        up = math.cos(self.tilt) * upright - math.sin(self.tilt) * level
        from_eye = points - eye
        depth = from_eye @ view
        x = 960 + self.focal_length * (from_eye @ right) / depth
        y = 540 - self.focal_length * (from_eye @ up) / depth
        return np.stack([x, y], axis=1)
