"""Films as files: MP4 by mediapy, an animated WebP, one picture as a PNG or an array. Whole, or not at all."""

import contextlib
import errno
import os
import pathlib
import re
import signal
import subprocess
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from PIL import Image

from mjbeer import require
from mjbeer.drawing.camera import CAMERAS, Camera
from mjbeer.drawing.film import Reel, reel
from mjbeer.drawing.overlay import Look
from mjbeer.drawing.sheet import whole
from mjbeer.exceptions import ParameterError, RenderingError
from mjbeer.output import files, terminal
from mjbeer.theory.trajectory import Trajectory

_RATE = 21
"""The rate factor of a file: at 18 no loss is visible, 23 is ffmpeg's default."""
_ENCODED = (
    # HD colours (BT.709), which players expect; the default are those of SD television.
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv"),
    # A search for motion that is quick and not deep: files are a sixth larger, and take a quarter less time.
    *("-preset", "veryfast", "-x264-params", "bframes=0:me=dia:subme=1:ref=1:weightp=0:threads=1"),
    *("-movflags", "+faststart"),  # a player can start before it has loaded the whole file
)
"""What ffmpeg is told about a file besides."""
_HELD = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXFSZ)
"""Signals that ffmpeg does not hear. A terminal sends Ctrl-C to all processes of a command; if ffmpeg ended first, the
interruption would be reported as its fault. By the last one the system would end it where a file may grow no more."""
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Errors of the disk. ffmpeg prints the system's message for them."""
_REMEDY = "Reinstall it (`pip install --force-reinstall imageio-ffmpeg`), or name another in IMAGEIO_FFMPEG_EXE"
_WEBP = {"quality": 60, "method": 4}
"""At this quality letters of 13 pixels are still sharp; `method` is how long WebP looks for a smaller file, 0 to 6."""


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
    if (target := require.path(path)).suffix.lower() != ".mp4":
        raise ParameterError(f"the file's name must end in .mp4, got {require.shown(str(path))}")
    console = terminal.STDERR if require.boolean("progress", progress) else None
    film = _reel(trajectory, camera, require.positive("speed", speed))
    with terminal.progress_bar(console, len(film.times(fps))) as begin:
        write(film, target, width, height, fps, lambda _: begin(f"drawing {target.name}"))


def show(
    trajectory: Trajectory, width: int, height: int, fps: float = 30, speed: float = 1.0, camera: Camera = "auto"
) -> None:
    """Show a trajectory as a video in a notebook. Arguments and errors are those of `render`."""
    film = _reel(trajectory, camera, require.positive("speed", speed))
    with contextlib.closing(_pictures(film, width, height, fps)) as pictures, _mediapy() as mediapy:
        mediapy.show_video(pictures, fps=fps, autoplay=False)


def write(
    film: Reel, path: pathlib.Path, width: int, height: int, fps: float, seen: Callable[[np.ndarray], None]
) -> None:
    """Write a film as a video, as `render` does, and call `seen` with each picture."""
    pictures = _pictures(film, width, height, fps)

    def shown() -> Iterator[np.ndarray]:
        for picture in pictures:
            seen(picture)
            yield picture

    with files.whole(path) as temporary, contextlib.closing(pictures):
        encode(shown(), temporary, int(width), int(height), fps)


def _pictures(film: Reel, width: int, height: int, fps: float) -> Generator[np.ndarray]:
    for name, pixels in (("width", width), ("height", height)):
        if whole(name, pixels) % 2 != 0:
            raise ParameterError(f"{name} must be even, as H.264 wants it, got {pixels!r}")
    return film.draw(film.times(fps), width, height)


def write_webp(film: Reel, path: pathlib.Path, width: int, height: int, fps: float) -> None:
    """Write a film as an animated WebP that runs forever, which a page shows without a player."""
    with contextlib.closing(film.draw(film.times(fps), width, height)) as pictures:
        first, *others = (Image.fromarray(picture) for picture in pictures)
    with files.whole(path) as temporary:
        first.save(temporary, "WEBP", save_all=True, append_images=others, duration=round(1000 / fps), loop=0, **_WEBP)


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
    with contextlib.closing(film.draw(np.array([moment]), width, height)) as pictures:
        return next(pictures)


def _reel(trajectory: Trajectory, camera: Camera, speed: float) -> Reel:
    require.instance("trajectory", trajectory, Trajectory)
    require.choice("camera", camera, CAMERAS)
    return reel(trajectory, Look.usual(trajectory, camera), speed)


def problem() -> str | None:
    """Return why no video can be encoded here, or None if ffmpeg starts."""
    import imageio_ffmpeg

    try:
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-version"]
        subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, check=True)
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        return str(error)
    return None


def missing(films: Sequence[str]) -> str:
    """Return the line that names the films that are missing because there is no ffmpeg, and what brings it."""
    return f"not drawn because ffmpeg does not start: {', '.join(films)}. {_REMEDY}"


def encode(frames: Iterable[np.ndarray], path: pathlib.Path, width: int, height: int, fps: float) -> None:
    """Write frames of shape (height, width, 3), uint8, one at a time, so that memory holds only one.

    Raises:
      RenderingError: if ffmpeg fails; the message has the last line that ffmpeg wrote.
      OSError: if the disk is full or broken.
    """
    with _mediapy() as mediapy:
        film = mediapy.VideoWriter(path, (height, width), fps=fps, crf=_RATE, ffmpeg_args=_ENCODED)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, _HELD)
        try:
            film.__enter__()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
    complete = False
    try:
        with contextlib.suppress(BrokenPipeError):
            for frame in frames:
                film.add_image(frame)
            complete = True
    finally:
        told = _end(film)
    for number in _DISK:
        if os.strerror(number) in told:
            raise OSError(number, os.strerror(number))
    if told or not complete or path.stat().st_size == 0:
        raise _failure(told)


def _end(film: Any) -> str:
    """Let ffmpeg end a film, also one that was interrupted, and return what mediapy says if it failed."""
    try:
        with contextlib.suppress(BrokenPipeError):
            film.close()
        film.close()  # of an ffmpeg that was gone, only now with what it said
    except RuntimeError as error:
        return str(error)
    return ""


@contextlib.contextmanager
def _mediapy() -> Generator[Any]:
    """Yield mediapy with the ffmpeg of imageio-ffmpeg; what fails in the block is told as ffmpeg's fault."""
    import imageio_ffmpeg
    import mediapy  # which loads matplotlib and IPython: half a second that only films take

    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        yield mediapy
    except (OSError, RuntimeError) as error:
        if isinstance(error.__context__, KeyboardInterrupt):  # a notebook sends it to ffmpeg as well
            raise error.__context__ from None
        raise _failure(str(error)) from error


def _failure(told: str) -> RenderingError:
    said = re.sub("^Error writing '.*?': ", "", told).strip()  # mediapy's words, before those of ffmpeg
    reason = ["it ended before the video did", *said.splitlines()][-1]
    return RenderingError(f"ffmpeg did not write the video: {reason}\n{_REMEDY}")
