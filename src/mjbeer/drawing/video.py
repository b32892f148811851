"""Videos and single pictures of a trajectory, as files."""

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
    """Write a trajectory as a video, MP4 with H.264, which appears whole or not at all.

    `fps` are frames per second of the video; `speed` is 1 for real time, 0.25 for four times slower; `camera`
    is "side" (the can's open end), "quarter" (from above) or "overview" (the whole way). A bar on standard
    error, where that is a terminal, shows the `progress`.

    Raises:
      ParameterError: on a parameter that is not allowed.
      RenderingError: if there is no OpenGL or no ffmpeg that works; the message says what to do.
      OutputError: if the file cannot be written.
    """
    target = _file(path, ".mp4")
    for name, pixels in (("width", width), ("height", height)):
        if require.number(name, pixels) % 2 != 0:
            raise ParameterError(f"{name} must be even, as H.264 wants it, got {pixels!r}")
    times = frame_times(trajectory, fps, speed)
    drawn = frames.draw(trajectory, times, width, height, camera, speed)
    console = terminal.STDERR if progress else None
    with (
        files.whole(target) as temporary,
        contextlib.closing(drawn),
        terminal.progress_bar(console, len(times)) as begin,
    ):
        encoder.encode(_announced(drawn, begin, target.name), temporary, int(width), int(height), fps)


def _announced(drawn: Iterable[np.ndarray], begin: Callable[[str], None], name: str) -> Iterator[np.ndarray]:
    for picture in drawn:
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
    """Write the picture of a trajectory at a `time` [s] as a PNG, which appears whole or not at all.

    Raises:
      ParameterError: on a parameter that is not allowed.
      RenderingError: if there is no OpenGL that works; the message says what to install.
      OutputError: if the file cannot be written.
    """
    target = _file(path, ".png")
    picture = frame(trajectory, time, width, height, camera)
    with files.whole(target) as temporary:
        Image.fromarray(picture).save(temporary)


def frame(
    trajectory: Trajectory, time: float, width: int = 1280, height: int = 720, camera: str = "side"
) -> np.ndarray:
    """The picture of a trajectory at a `time` [s], shape (height, width, 3), uint8.

    Raises:
      ParameterError: on a parameter that is not allowed.
      RenderingError: if there is no OpenGL that works; the message says what to install.
    """
    start, end = float(trajectory.time[0]), float(trajectory.time[-1])
    if not start <= require.number("time", time, "s") <= end:
        raise ParameterError(f"time must be within the trajectory, {start:g} to {end:g} s, got {time!r}")
    with contextlib.closing(frames.draw(trajectory, np.array([time]), width, height, camera)) as drawn:
        return next(drawn)


def frame_times(trajectory: Trajectory, fps: float, speed: float) -> np.ndarray:
    """The times [s] of the frames of a video, which lasts as long as the trajectory does at its speed.

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
