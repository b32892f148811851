"""How a film looks at a motion: the camera stands still before the wall, or pans evenly, or goes along with the can."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import Polynomial

from mjbeer.drawing.world.cameras import Camera
from mjbeer.drawing.world.display import on_incline, scale
from mjbeer.drawing.world.view import View
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

_AROUND = 1.95
"""What is seen around the can's axis on each side, at least, in radii: the can, its angle, and a little air."""
_BELOW = 1.95
"""What is seen below it, in radii: the board too, with the numbers below it."""
_FORCES = 3.0
"""The same where the arrows of forces are below the board."""
_LARGEST = 0.22
"""Largest radius of a can, in heights of the picture."""
_SMALLEST = 0.11
"""Radius below which the camera pans, unless told otherwise, in heights of the picture."""
_FAR = 8.0
"""Distance of the eye, in half diagonals of the picture: the longer, the less of the can's inside is seen."""
_ABOVE = 0.18
"""How far the eye is above the middle of the picture, in heights: it sees the board's upper side."""


@dataclass(frozen=True, eq=False)
class Shot:
    """A camera's way along the drawn world, and what it shows of it."""

    scene: Scene
    way: Callable[[np.ndarray | float], np.ndarray | float]
    """Distance of the picture's middle down the incline over time [s], as drawn [m]."""
    middle: np.ndarray
    """From the incline at that distance to the middle of the picture, to the right and up [m]."""
    metres: np.ndarray
    """Width and height of what is seen at the can's near end [m]."""
    plane: float
    """Coordinate y of the can's near end [m]."""
    pixels: tuple[int, int]
    still: bool
    """Whether the camera stands still."""

    def view(self, time: float) -> View:
        """Return what is seen at a `time` [s]."""
        x, z = on_incline(self.scene, self.way(time), 0.0) + self.middle
        centre = np.array([x, self.plane, z])
        above, distance = _ABOVE * float(self.metres[1]), _FAR * float(np.hypot(*self.metres)) / 2
        return View.facing(centre, self.metres, distance=distance, above=above, pixels=self.pixels)

    @classmethod
    def fit(
        cls, scene: Scene, camera: Camera, time: np.ndarray, u: np.ndarray, lift: np.ndarray, plane: float,
        pixels: tuple[int, int], forces: bool = False,
    ) -> "Shot":  # fmt: skip
        """Return the shot that shows a can that is at `u` and `lift` [m] at some times [s].

        With `forces`, there is room for arrows below the can.
        """
        along, height = u * scale(scene), lift * scale(scene)
        if camera == "auto":
            fixed = cls.fit(scene, "fixed", time, u, lift, plane, pixels, forces)
            radius = RADIUS / fixed.metres[1]
            camera = "fixed" if radius >= _SMALLEST else "pan"
        if camera == "fixed" or len(time) < 3 or np.ptp(time) == 0:
            way = Polynomial([(along.min() + along.max()) / 2])
        elif camera == "pan":
            way = Polynomial.fit(time, along, 2).convert()
        else:
            way = partial(np.interp, xp=time, fp=along)
        places = on_incline(scene, along - way(time), height + RADIUS)
        low = places.min(axis=0) - RADIUS * np.array([_AROUND, _FORCES if forces else _BELOW])
        high = places.max(axis=0) + RADIUS * _AROUND
        shape = np.array(pixels) / pixels[1]
        tall = max(float(((high - low) / shape).max()), RADIUS / _LARGEST)
        return cls(
            scene,
            way,
            middle=(low + high) / 2,
            metres=tall * shape,
            plane=plane,
            pixels=pixels,
            still=camera == "fixed",
        )
