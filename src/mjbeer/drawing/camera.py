"""Where things are in the picture that a camera of a model takes."""

import math
from dataclasses import dataclass
from typing import Self

import mujoco
import numpy as np


@dataclass(frozen=True, eq=False)
class View:
    """A camera's view. Places in the picture are (right, up), each from -1 to 1."""

    position: np.ndarray
    axes: np.ndarray
    """Rows: the directions right, up and back."""
    tangent: np.ndarray
    """Half width and half height of what is seen at a distance of 1."""
    pixels: np.ndarray
    """Width and height of the picture."""

    @classmethod
    def of(cls, model: mujoco.MjModel, data: mujoco.MjData, camera: str, width: int, height: int) -> Self:
        """The view from a camera of a posed model."""
        upwards = math.tan(math.radians(float(model.camera(camera).fovy[0])) / 2)
        seen, pixels = data.camera(camera), np.array([width, height])
        return cls(seen.xpos.copy(), seen.xmat.reshape(3, 3).T.copy(), upwards * pixels / height, pixels)

    def at(self, place: tuple[float, float], depth: float) -> np.ndarray:
        """The point that is seen at a place, `depth` [m] before the camera."""
        right, up = self.tangent * place
        return self.position + depth * np.array([right, up, -1]) @ self.axes

    def depth(self, point: np.ndarray) -> float:
        """How far before the camera a point is [m]."""
        return float(-self.axes[2] @ (point - self.position))

    def pixel(self, point: np.ndarray) -> tuple[float, float]:
        """Column and row where a point is seen, from the upper left corner of the picture."""
        across = self.axes[:2] @ (point - self.position) / self.depth(point) / self.tangent
        column, row = (1 + across * [1, -1]) / 2 * self.pixels
        return float(column), float(row)
