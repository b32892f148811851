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
    target = _file(path, ".mp4")
    for name, pixels in (("width", width), ("height", height)):
        if require.number(name, pixels) % 2 != 0:
            raise ParameterError(f"{name} must be even, as H.264 wants it, got {pixels!r}")
    times = frame_times(trajectory, fps, speed)
    pictures = frames.draw(trajectory, times, width=width, height=height, camera=camera, speed=speed)
    console = terminal.STDERR if progress else None
    with (
        files.whole(target) as temporary,
        contextlib.closing(pictures),
        terminal.progress_bar(console, len(times)) as begin,
    ):
        counted = _count(pictures, begin, target.name)
        encoder.encode(counted, temporary, width=int(width), height=int(height), fps=fps)


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
    start, end = float(trajectory.time[0]), float(trajectory.time[-1])
    if not start <= require.number("time", time, "s") <= end:
        raise ParameterError(f"time must be within the trajectory, {start:g} to {end:g} s, got {time!r}")
    pictures = frames.draw(trajectory, np.array([time]), width=width, height=height, camera=camera)
    with contextlib.closing(pictures):
        return next(pictures)


def frame_times(trajectory: Trajectory, fps: float, speed: float) -> np.ndarray:
    """Return the times [s] of a video's frames; the video lasts as long as the trajectory, divided by `speed`.

    Raises:
      ParameterError: if `fps` or `speed` is not greater than 0.
    """
    require.positive("fps", fps, "1/s")
    require.positive("speed", speed)
    start, duration = trajectory.time[0], trajectory.time[-1] - trajectory.time[0]
    return start + speed / fps * np.arange(max(1, round(duration * fps / speed)))


def _file(path: str | os.PathLike[str], suffix: str) -> pathlib.Path:
    target = pathlib.Path(path)
    if target.suffix.lower() != suffix:
        raise ParameterError(f"the file's name must end in {suffix}, got {str(path)!r}")
    return target
