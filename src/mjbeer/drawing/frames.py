"""The pictures of a trajectory at given times, drawn one after the other."""

import math
from collections.abc import Generator

import mujoco
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer import require
from mjbeer.drawing import display, guides
from mjbeer.drawing.camera import View
from mjbeer.drawing.canvas import Canvas
from mjbeer.exceptions import ParameterError
from mjbeer.model import templates
from mjbeer.theory.trajectory import Trajectory

CAMERAS = ("side", "quarter", "overview")
"""A camera at the can's open end; one above and downhill; and one so far away that it shows the whole motion."""
_TITLES = {
    "sliding": "beer sliding in a can",
    "frozen": "beer frozen to a can",
    "pendulum": "pendulum in a wheel",
    "hoop": "weight on a hoop's rim",
}
_LARGEST = 4096
"""Largest width and height [pixels] that H.264 encoders support."""


def draw(
    trajectory: Trajectory, times: np.ndarray, width: int, height: int, camera: str = "side", speed: float = 1.0
) -> Generator[np.ndarray]:
    """Return a generator of the pictures at some times [s], each of shape (height, width, 3), uint8.

    `camera` is one of CAMERAS. A playback `speed` other than 1 is written into the picture.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: while the first picture is drawn, if OpenGL does not work.
    """
    require.instance("trajectory", trajectory, Trajectory)
    if (np.diff(trajectory.time) <= 0).any():
        raise ParameterError(
            f"the times of a trajectory must increase for it to be drawn, got {require.shown(trajectory.time)}"
        )
    width, height = whole("width", width), whole("height", height)
    require.choice("camera", camera, CAMERAS)
    return _draw(trajectory, times, width=width, height=height, camera=camera, speed=speed)


def whole(name: str, pixels: float) -> int:
    """Return a number of pixels as an integer.

    Raises:
      ParameterError: if it is not a whole number, not positive, or larger than encoders support.
    """
    number = require.positive(name, pixels)
    if number % 1 != 0 or number > _LARGEST:
        raise ParameterError(f"{name} must be a whole number of pixels up to {_LARGEST}, got {require.shown(pixels)}")
    return int(number)


def _draw(
    trajectory: Trajectory, times: np.ndarray, width: int, height: int, camera: str, speed: float
) -> Generator[np.ndarray]:
    scene = trajectory.scene
    model = display.display_model(scene, (trajectory.u.min(), trajectory.u.max()), width / height)
    data = mujoco.MjData(model)
    title = _TITLES[templates.name(scene)] + ("" if speed == 1 else f", {speed:g} x speed")
    duration = trajectory.time[-1] - trajectory.time[0]
    digits = max(2, math.ceil(-math.log10(duration)) + 1) if duration > 0 else 2
    with Canvas(model, width, height) as canvas:
        for time, (u, phi, roll, lift) in zip(times, coordinates(trajectory, times), strict=True):
            display.pose(model, data, scene, u=u, phi=phi, roll=roll, lift=lift)
            view, axis = View.of(model, data, camera, width=width, height=height), data.body("can").xpos
            pixels = canvas.draw(data, camera, lambda picture: guides.draw(picture, scene, view, axis))  # noqa: B023
            texts = title, f"t = {time:.{digits}f} s", f"phi = {guides.degrees(phi, '.1f')}"
            yield guides.write(pixels, scene, view, axis, texts)


def coordinates(trajectory: Trajectory, times: np.ndarray) -> np.ndarray:
    """Return u [m], phi [rad], roll [rad] and lift [m] at some times [s], shape (times, 4).

    Between two samples each is the cubic that has the samples' values and rates. Its error falls as the fourth power
    of the interval, so that the motion looks smooth even with 20 samples per second.
    """
    samples = np.stack([trajectory.u, trajectory.phi, trajectory.roll, trajectory.lift], axis=1)
    if len(samples) == 1:
        return np.repeat(samples, len(times), axis=0)
    rates = np.stack([trajectory.u_dot, trajectory.phi_dot, trajectory.roll_dot, trajectory.lift_dot], axis=1)
    return CubicHermiteSpline(trajectory.time, samples, rates)(times)
