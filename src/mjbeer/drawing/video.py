"""Write a trajectory as a video, or one picture of it as a PNG or an array."""

import contextlib
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator

import numpy as np
from PIL import Image

from mjbeer import require
from mjbeer.drawing import encoder, frames
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.theory.trajectory import Trajectory

_MOST_FRAMES = 1e6
"""Largest number of frames of a video: four and a half hours at 60 frames per second."""


def render(
    trajectory: Trajectory,
    path: str | os.PathLike[str],
    width: int = 1280,
    height: int = 720,
    fps: float = 60,
    speed: float = 1.0,
    camera: str = "side",
    progress: bool = True,
) -> None:
    """Write a trajectory as a video, MP4 with H.264; if that fails, no file is left and an existing one is kept.

    `width` and `height` are in pixels, `fps` in frames per second of the video; `speed` is 1 for real time, 0.25 for
    four times slower. `camera` is "side" (the can's open end), "quarter" (from above and downhill) or "overview" (the
    whole motion). If `progress` is true and standard error is a terminal, it shows a progress bar.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    require.instance("trajectory", trajectory, Trajectory)
    target = _file(path, ".mp4")
    width, height = frames.whole("width", width), frames.whole("height", height)
    for name, pixels in (("width", width), ("height", height)):
        if pixels % 2 != 0:
            raise ParameterError(f"{name} must be even, as H.264 wants it, got {pixels!r}")
    fps, speed = require.positive("fps", fps, "1/s"), require.positive("speed", speed)
    progress = require.boolean("progress", progress)
    times = frame_times(trajectory, fps, speed)
    pictures = frames.draw(trajectory, times, width=width, height=height, camera=camera, speed=speed)
    console = terminal.STDERR if progress else None
    with (
        files.whole(target) as temporary,
        contextlib.closing(pictures),
        terminal.progress_bar(console, len(times)) as begin,
    ):
        counted = _count(pictures, begin, target.name)
        encoder.encode(counted, temporary, width=width, height=height, fps=fps)


def _count(pictures: Iterable[np.ndarray], begin: Callable[[str], None], name: str) -> Iterator[np.ndarray]:
    """Yield the pictures, and advance the progress bar at each."""
    for picture in pictures:
        begin(f"drawing {name}")
        yield picture


def save_frame(
    trajectory: Trajectory,
    time: float,
    path: str | os.PathLike[str],
    width: int = 1280,
    height: int = 720,
    camera: str = "side",
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
    trajectory: Trajectory, time: float, width: int = 1280, height: int = 720, camera: str = "side"
) -> np.ndarray:
    """Return the picture of a trajectory at a `time` [s] as an array of shape (height, width, 3), uint8.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL does not work; the message names what to install.
    """
    require.instance("trajectory", trajectory, Trajectory)
    start, end = float(trajectory.time[0]), float(trajectory.time[-1])
    moment = require.number("time", time, "s")
    if not start <= moment <= end:
        raise ParameterError(f"time must be within the trajectory, {start:g} to {end:g} s, got {require.shown(time)}")
    pictures = frames.draw(trajectory, np.array([moment]), width=width, height=height, camera=camera)
    with contextlib.closing(pictures):
        return next(pictures)


def frame_times(trajectory: Trajectory, fps: float, speed: float) -> np.ndarray:
    """Return the times [s] of a video's frames; the video lasts as long as the trajectory, divided by `speed`.

    Raises:
      ParameterError: if `fps` or `speed` is not greater than 0, or the video would have too many frames.
    """
    fps, speed = require.positive("fps", fps, "1/s"), require.positive("speed", speed)
    start, duration = float(trajectory.time[0]), float(trajectory.time[-1] - trajectory.time[0])
    count = duration * fps / speed
    if count > _MOST_FRAMES:
        raise ParameterError(
            f"a video must have at most {_MOST_FRAMES:g} frames, got {duration:g} s at {fps:g} frames per second and a "
            f"speed of {speed:g}, which are {count:.3g}"
        )
    return start + speed / fps * np.arange(max(1, round(count)))


def _file(path: str | os.PathLike[str], suffix: str) -> pathlib.Path:
    target = require.path(path)
    if target.suffix.lower() != suffix:
        raise ParameterError(f"the file's name must end in {suffix}, got {require.shown(str(path))}")
    return target
