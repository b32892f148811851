"""Write a trajectory as a video, or one picture of it as a PNG or an array."""

import contextlib
import os
import pathlib
from collections.abc import Callable, Iterator

import numpy as np
from PIL import Image

from mjbeer import require
from mjbeer.drawing import encoder
from mjbeer.drawing.film import Reel, reel
from mjbeer.drawing.overlay.look import Look
from mjbeer.drawing.size import whole
from mjbeer.drawing.world.cameras import CAMERAS, Camera
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.theory.trajectory import Trajectory


def render(
    trajectory: Trajectory,
    path: str | os.PathLike[str],
    width: int = 1280,
    height: int = 720,
    fps: float = 30,
    speed: float = 1.0,
    camera: Camera = "auto",
    progress: bool = True,
) -> None:
    """Write a trajectory as a video, MP4 with H.264; if that fails, no file is left and an existing one is kept.

    `width` and `height` are in pixels, `fps` in frames per second of the video; `speed` is 1 for real time, 0.25 for
    four times slower. `camera` is "fixed" (it stands still and shows the whole motion), "pan" (it moves with a constant
    acceleration), "close" (it goes along with the can), or "auto" (fixed, unless the can would be too small). If
    `progress` is true and standard error is a terminal, it shows a progress bar.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    target = _file(path, ".mp4")
    console = terminal.STDERR if require.boolean("progress", progress) else None
    film = _reel(trajectory, camera, require.positive("speed", speed))
    with terminal.progress_bar(console, len(film.times(fps))) as begin:
        write(film, target, width, height, fps, lambda: begin(f"drawing {target.name}"))


def write(
    film: Reel, path: pathlib.Path, width: int, height: int, fps: float, count: Callable[[], None] = lambda: None
) -> None:
    """Write a film as a video, as `render` does, and call `count` for each picture.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    width, height = whole("width", width), whole("height", height)
    for name, pixels in (("width", width), ("height", height)):
        if pixels % 2 != 0:
            raise ParameterError(f"{name} must be even, as H.264 wants it, got {pixels!r}")
    pictures = film.draw(film.times(fps), width, height)

    def counted() -> Iterator[np.ndarray]:
        for picture in pictures:
            count()
            yield picture

    with files.whole(path) as temporary, contextlib.closing(pictures):
        encoder.encode(counted(), temporary, width=width, height=height, fps=fps)


def save_frame(
    trajectory: Trajectory,
    time: float,
    path: str | os.PathLike[str],
    width: int = 1280,
    height: int = 720,
    camera: Camera = "auto",
) -> None:
    """Write the picture of a trajectory at a `time` [s] as a PNG, of `width` by `height` pixels.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL does not work; the message names what to install.
      OutputError: if the file cannot be written.
    """
    target = _file(path, ".png")
    picture = frame(trajectory, time, width=width, height=height, camera=camera)
    with files.whole(target) as temporary:
        Image.fromarray(picture).save(temporary)


def frame(
    trajectory: Trajectory, time: float, width: int = 1280, height: int = 720, camera: Camera = "auto"
) -> np.ndarray:
    """Return the picture of a trajectory at a `time` [s] as an array of shape (height, width, 3), uint8.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL does not work; the message names what to install.
    """
    film = _reel(trajectory, camera, 1.0)
    moment = require.number("time", time, "s")
    if not film.start <= moment <= film.end:
        raise ParameterError(
            f"time must be within the trajectory, {film.start:g} to {film.end:g} s, got {require.shown(time)}"
        )
    return still(film, moment, width, height)


def still(film: Reel, time: float, width: int, height: int) -> np.ndarray:
    """Return the picture of a film at a `time` [s] as an array of shape (height, width, 3), uint8."""
    pictures = film.draw(np.array([time]), width, height)
    with contextlib.closing(pictures):
        return next(pictures)


def _reel(trajectory: Trajectory, camera: Camera, speed: float) -> Reel:
    require.instance("trajectory", trajectory, Trajectory)
    require.choice("camera", camera, CAMERAS)
    return reel(trajectory, Look.usual(trajectory, camera), speed)


def _file(path: str | os.PathLike[str], suffix: str) -> pathlib.Path:
    target = require.path(path)
    if target.suffix.lower() != suffix:
        raise ParameterError(f"the file's name must end in {suffix}, got {require.shown(str(path))}")
    return target
