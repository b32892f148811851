"""The geometry of a camera: which pixel shows a point, and which point is shown at a place in the picture."""

import math
from dataclasses import dataclass
from typing import Self

import mujoco
import numpy as np


@dataclass(frozen=True, eq=False)
class View:
    """The view of a camera of a posed model. A place in the picture is (right, up), both from -1 to 1."""

    position: np.ndarray
    """Where the camera is [m]."""
    axes: np.ndarray
    """Unit vectors in its rows: to the right, up, and backwards from the camera."""
    tangent: np.ndarray
    """Half width and half height of what is seen, over the distance from the camera."""
    pixels: np.ndarray
    """Width and height of the picture [pixels]."""

    @classmethod
    def of(cls, model: mujoco.MjModel, data: mujoco.MjData, camera: str, width: int, height: int) -> Self:
        """Return the view of a camera, by its name, in a picture of `width` by `height` pixels."""
        upwards = math.tan(math.radians(float(model.camera(camera).fovy[0])) / 2)
        pose, pixels = data.camera(camera), np.array([width, height])
        return cls(
            position=pose.xpos.copy(),
            axes=pose.xmat.reshape(3, 3).T.copy(),
            tangent=upwards * pixels / height,
            pixels=pixels,
        )

    def at(self, place: tuple[float, float], depth: float) -> np.ndarray:
        """Return the point [m] seen at a `place` of the picture and at a distance `depth` [m] before the camera."""
        right, up = self.tangent * place
        return self.position + depth * np.array([right, up, -1]) @ self.axes

    def depth(self, point: np.ndarray) -> float:
        """Return how far in front of the camera a point is [m]."""
        return float(-self.axes[2] @ (point - self.position))

    def pixel(self, point: np.ndarray) -> tuple[float, float]:
        """Return the column and the row at which a point [m] is seen, from the upper left corner of the picture."""
        across = self.axes[:2] @ (point - self.position) / self.depth(point) / self.tangent
        column, row = (1 + across * [1, -1]) / 2 * self.pixels
        return float(column), float(row)
