"""Films as files: MP4 by mediapy, whole or not at all; in a notebook; and as jobs, beside those of plots."""

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
from mjbeer.drawing.overlay import Look
from mjbeer.exceptions import ParameterError, RenderingError
from mjbeer.output import files, terminal
from mjbeer.output.plots import Picture
from mjbeer.theory.trajectory import Trajectory

_LARGEST = 4096  # largest width and height [pixels] that H.264 encoders support
_RATE = 23  # the rate factor of a file, ffmpeg's default: at 18 no loss is visible, and at 24 letters are still sharp
_ENCODED = (  # what ffmpeg is told besides
    # HD colours (BT.709), which players expect; the default are those of SD television.
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv"),
    # A search for motion that is quick and not deep: files are a sixth larger, and take a quarter less time.
    *("-preset", "veryfast", "-x264-params", "bframes=0:me=dia:subme=1:ref=1:weightp=0:threads=1"),
    *("-movflags", "+faststart"),  # a player can start before it has loaded the whole file
)
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)  # ffmpeg prints the system's message for them


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
    """Write a trajectory as a video, MP4 with H.264; if that fails, no file is left and an existing one is kept.

    Where `path` is None it is shown in a notebook. `width` and `height` are in pixels, `fps` in frames per second of
    the video; `speed` is 1 for real time, 0.25 for four times slower. `camera` is "fixed" (it stands still and shows
    the whole motion), "pan" (it moves with a constant acceleration), or "auto" (fixed, unless the can would be too
    small). If `progress` is true and standard error is a terminal, it shows a progress bar.

    Where the equations of a run were not solved, each picture says so. A run of a fixed timestep is judged by a second
    one, which takes twice its time.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    target = None if path is None else require.path(path)
    if target and target.suffix.lower() != ".mp4":
        raise ParameterError(f"the file's name must end in .mp4, got {require.format_value(str(path))}")
    console = terminal.STDERR if require.choice("progress", progress, (True, False)) else None
    require.instance("trajectory", trajectory, Trajectory)
    require.choice("camera", camera, CAMERAS)
    film = MotionFilm(lambda: trajectory, Look.usual(trajectory, camera), speed=speed).plan()
    if target is None:
        with contextlib.closing(_pictures(film, width, height, fps)) as pictures, _mediapy() as mediapy:
            mediapy.show_video(pictures, fps=fps, autoplay=False)
        return
    with terminal.progress_bar(console, len(film.times(fps))) as begin:
        write(film, target, width, height, fps, begin)


def write(
    plan: RenderPlan, path: pathlib.Path, width: int, height: int, fps: float, begin: Callable[[str], Any] = str
) -> None:
    """Write a film as a video, as `render` does, picture by picture; `begin` gets the words of a progress bar."""
    with (
        files.atomic_write(path) as temporary,
        contextlib.closing(_pictures(plan, width, height, fps)) as pictures,
        _mediapy() as mediapy,
    ):
        shape = int(height), int(width)
        writer = mediapy.VideoWriter(temporary, shape, fps=fps, crf=_RATE, ffmpeg_args=_ENCODED)
        writer.__enter__()
        try:
            try:
                for picture in pictures:
                    begin(f"drawing {path.name}")
                    writer.add_image(picture)
            except BrokenPipeError:
                writer.close()  # which now raises what ffmpeg said
                raise
            writer.close()
        except BaseException:
            _kill_ffmpeg(writer)
            raise


def _kill_ffmpeg(writer: Any) -> None:
    """End the ffmpeg of a `mediapy.VideoWriter`: to close the writer is to wait for it, and it may hang."""
    process = writer._proc
    if process is None:
        return
    process.kill()
    process.wait()
    with contextlib.suppress(OSError):  # the last picture has no reader now
        process.stdin.close()
    process.stderr.close()


def _pictures(plan: RenderPlan, width: int, height: int, fps: float) -> Generator[np.ndarray]:
    for name, pixels in (("width", width), ("height", height)):
        if require.positive(name, pixels) % 2 or pixels > _LARGEST:
            raise ParameterError(
                f"{name} must be an even number of pixels up to {_LARGEST}, as H.264 wants it, "
                f"got {require.format_value(pixels)}"
            )
    return plan.draw(plan.times(fps), int(width), int(height))


@contextlib.contextmanager
def _mediapy() -> Generator[Any]:
    """Yield mediapy with the ffmpeg of imageio-ffmpeg; what fails in the block is told as ffmpeg's fault."""
    import imageio_ffmpeg
    import mediapy  # which loads matplotlib and IPython: half a second that only films take

    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        yield mediapy
    except (OSError, RuntimeError) as error:
        if not isinstance(error.__context__, OSError | RuntimeError | None):  # drawing failed, or Ctrl-C ended both
            raise error.__context__ from None
        said = re.sub("^Error writing '.*?': ", "", str(error)).strip()  # mediapy's words, before those of ffmpeg
        for number in _DISK:
            if os.strerror(number) in said:
                raise OSError(number, os.strerror(number)) from error
        reason = (said or "it ended before the video did").splitlines()[-1]
        raise RenderingError(
            f"ffmpeg did not write the video: {reason}\nReinstall it (`pip install --force-reinstall imageio-ffmpeg`), "
            "or name another in IMAGEIO_FFMPEG_EXE"
        ) from error


@dataclass(frozen=True)
class FilmJob:
    """A film to be written."""

    film: Film
    path: pathlib.Path  # its file, whose name ends in .mp4
    width: int
    height: int
    fps: float

    def write(self) -> bytes:
        """Write the film, and return its still picture as WebP."""
        plan, file = self.film.plan(), io.BytesIO()
        still = self.film.still or (2 * plan.start + plan.end) / 3  # at the start nothing has happened yet
        write(plan, self.path, self.width, self.height, self.fps)
        (picture,) = plan.draw(np.array([still]), self.width, self.height)
        Image.fromarray(picture).save(file, "WEBP", quality=70)
        return file.getvalue()


@dataclass(frozen=True)
class PlotJob:
    """A plot to be drawn."""

    draw: Callable[[Any], None]  # writes the plot to a path, with .svg appended, or into a `Picture`
    path: pathlib.Path
    in_memory: bool = False

    def write(self) -> Picture | None:
        """Write the plot, or return it."""
        picture = Picture(self.path.name) if self.in_memory else None
        self.draw(picture or self.path)
        return picture
