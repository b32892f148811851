"""Films as files: MP4 by mediapy, whole or not at all; in a notebook; and as jobs, with plots."""

import contextlib
import errno
import io
import os
import pathlib
import re
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from mjbeer import require
from mjbeer.drawing.camera import CAMERAS, Camera
from mjbeer.drawing.film import Film, MotionFilm, RenderPlan
from mjbeer.drawing.style import FilmStyle
from mjbeer.exceptions import ParameterError, RenderingError
from mjbeer.output import files, terminal
from mjbeer.output.plots import Picture
from mjbeer.theory.trajectory import Trajectory

_LARGEST = 4096
"""Largest width and height [pixels] that H.264 encoders support."""
_RATE_FACTOR = 23
"""The rate factor of a file, ffmpeg's default: at 18 no loss is visible, and at 24 letters are
still sharp."""
_FFMPEG_OPTIONS = [
    # HD colours (BT.709), which players expect; ffmpeg's default is those of SD television.
    "-vf",
    "scale=out_color_matrix=bt709:out_range=tv",
    # A quick search for motion: files are a sixth larger, and take a quarter less time.
    "-preset",
    "veryfast",
    "-x264-params",
    "bframes=0:me=dia:subme=1:ref=1:weightp=0:threads=1",
    # A player can start before it has loaded the whole file.
    "-movflags",
    "+faststart",
]
_DISK_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Numbers of the errors that a disk causes; ffmpeg prints the system's messages for these."""


def render(
    trajectory: Trajectory,
    path: str | os.PathLike[str] | None,
    width: int = 1280,
    height: int = 720,
    fps: float = 30,
    speed: float = 1.0,
    camera: Camera = "auto",
    progress: bool = True,
) -> None:
    """Write a trajectory as a video, MP4 with H.264, or show it in a notebook if `path` is None.

    If writing fails, no file is left, and an existing one is kept.

    `width` and `height` are in pixels, `fps` in frames per second of the video. `speed` is 1 for
    real time, 0.25 for four times slower. `camera` is "fixed" (it stands still and shows the whole
    motion), "pan" (it moves with a constant acceleration), or "auto" (fixed, unless the can would
    be too small). If `progress` is true and standard error is a terminal, it shows a progress bar.

    Each picture of a run whose equations were not solved says so. To find out, a run with a fixed
    timestep is repeated with another, which takes twice its time.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    target = None if path is None else check_target(path, width, height)
    require.choice("progress", progress, (True, False))
    console = terminal.STDERR if progress else None
    require.instance("trajectory", trajectory, Trajectory)
    require.choice("camera", camera, CAMERAS)
    style = FilmStyle.usual(trajectory, camera)
    plan = MotionFilm(lambda: trajectory, style, speed=speed).plan()
    if target is None:
        with (
            contextlib.closing(_pictures(plan, width, height, fps)) as pictures,
            _mediapy() as mediapy,
        ):
            mediapy.show_video(pictures, fps=fps, autoplay=False)
        return
    with terminal.progress_bar(console, len(plan.times(fps))) as show_progress:
        write(plan, target, width, height, fps, show_progress)


def _show_nothing(_: str) -> None:
    """Stand for a progress bar that is not there."""


def check_target(path: str | os.PathLike[str], width: int, height: int) -> pathlib.Path:
    """Return the path of a video after checking it and the size [pixels], before a long run.

    Raises:
      ParameterError: if the name does not end in .mp4, or the size is not allowed.
      OutputError: if the file cannot be written.
    """
    target = require.path(path)
    if target.suffix.lower() != ".mp4":
        name = require.format_value(str(path))
        raise ParameterError(f"the file's name must end in .mp4, got {name}")
    _check_size("width", width)
    _check_size("height", height)
    files.check_writable(target)
    return target


def write(
    plan: RenderPlan,
    path: pathlib.Path,
    width: int,
    height: int,
    fps: float,
    show_progress: Callable[[str], None] = _show_nothing,
) -> None:
    """Write a film as `render` does; `show_progress` is told of each picture as it is drawn."""
    with (
        files.atomic_write(path) as temporary,
        contextlib.closing(_pictures(plan, width, height, fps)) as pictures,
        _mediapy() as mediapy,
    ):
        writer = mediapy.VideoWriter(
            temporary,
            (int(height), int(width)),
            fps=fps,
            crf=_RATE_FACTOR,
            ffmpeg_args=_FFMPEG_OPTIONS,
        )
        writer.__enter__()
        try:
            try:
                for picture in pictures:
                    show_progress(f"drawing {path.name}")
                    writer.add_image(picture)
            except BrokenPipeError:
                writer.close()  # which now raises what ffmpeg said
                raise
            writer.close()
        except BaseException:
            _kill_ffmpeg(writer)
            raise


def _kill_ffmpeg(writer: Any) -> None:
    """End the ffmpeg of a `mediapy.VideoWriter`.

    Closing the writer would wait for ffmpeg, which may hang.
    """
    process = writer._proc
    if process is None:
        return
    process.kill()
    process.wait()
    with contextlib.suppress(OSError):  # the last picture has no reader now
        process.stdin.close()
    process.stderr.close()


def _pictures(plan: RenderPlan, width: int, height: int, fps: float) -> Generator[np.ndarray]:
    _check_size("width", width)
    _check_size("height", height)
    return plan.draw(plan.times(fps), int(width), int(height))


def _check_size(name: str, pixels: int) -> None:
    require.positive(name, pixels)
    if pixels % 2 or pixels > _LARGEST:
        raise ParameterError(
            f"{name} must be an even number of pixels up to {_LARGEST}, as H.264 wants it, "
            f"got {require.format_value(pixels)}"
        )


@contextlib.contextmanager
def _mediapy() -> Generator[Any]:
    """Yield mediapy with the ffmpeg of imageio-ffmpeg, and say what is wrong if ffmpeg fails.

    Raises:
      OSError: if the disk is full or broken.
      RenderingError: if ffmpeg fails for another reason.
    """
    import imageio_ffmpeg
    import mediapy  # it loads IPython: half a second, which only films should cost

    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        yield mediapy
    except (OSError, RuntimeError) as error:
        cause = error.__context__
        if cause is not None and not isinstance(cause, OSError | RuntimeError):
            # It was not ffmpeg that failed first: the drawing did, or Ctrl-C ended both.
            raise cause from None
        # Mediapy puts words of its own before those of ffmpeg.
        messages = re.sub("^Error writing '.*?': ", "", str(error)).strip()
        for number in _DISK_ERRORS:
            if os.strerror(number) in messages:
                raise OSError(number, os.strerror(number)) from error
        reason = messages.splitlines()[-1] if messages else "it ended before the video did"
        raise RenderingError(
            f"ffmpeg did not write the video: {reason}\n"
            "Reinstall it (`pip install --force-reinstall imageio-ffmpeg`), "
            "or name another in IMAGEIO_FFMPEG_EXE"
        ) from error


@dataclass(frozen=True)
class FilmJob:
    """A film to be written."""

    film: Film
    path: pathlib.Path
    """Its file, whose name ends in .mp4."""
    width: int
    """[pixels]."""
    height: int
    """[pixels]."""
    fps: float
    """Pictures per second of the video."""

    def write(self) -> bytes:
        """Write the film, and return its still picture as WebP."""
        plan = self.film.plan()
        write(plan, self.path, self.width, self.height, self.fps)
        still = self.film.still
        if still is None:  # not the first picture: at the start nothing has happened yet
            still = (2 * plan.start + plan.end) / 3
        (picture,) = plan.draw(np.array([still]), self.width, self.height)
        file = io.BytesIO()
        Image.fromarray(picture).save(file, "WEBP", quality=70)
        return file.getvalue()


@dataclass(frozen=True)
class PlotJob:
    """A plot to be drawn."""

    draw: Callable[[Any], None]
    """Writes the plot to a path, with .svg appended, or into a `Picture`."""
    path: pathlib.Path
    in_memory: bool = False
    """Whether the plot is returned, and no file is written."""

    def write(self) -> Picture | None:
        """Write the plot, or return it."""
        picture = Picture(self.path.name) if self.in_memory else None
        self.draw(picture or self.path)
        return picture
