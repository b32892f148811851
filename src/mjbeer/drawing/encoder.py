"""Frames to a video file, through mediapy and the ffmpeg that comes with imageio-ffmpeg."""

import errno
import os
import pathlib
import signal
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mjbeer.exceptions import RenderingError

if TYPE_CHECKING:
    import mediapy

_QUALITY = 20
"""Constant rate factor of H.264: 18 shows no loss, 23 is ffmpeg's default."""
_FASTER = "-preset veryfast -movflags +faststart"
"""Encoding then takes less time than drawing, and the video plays before all of it has been loaded."""
_COLOURS = "-vf scale=out_color_matrix=bt709:out_range=tv"
"""Otherwise they are those of SD television, which players do not expect of a larger picture."""
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Faults of the disk, which ffmpeg reports in the system's words."""


def encode(frames: Iterable[np.ndarray], path: pathlib.Path, width: int, height: int, fps: float) -> None:
    """Write frames of shape (height, width, 3), uint8, as they come: none is kept.

    Raises:
      RenderingError: if ffmpeg does not work; the message has the last line of what it wrote.
      OSError: if the disk is full, or broken.
    """
    # mediapy brings matplotlib and IPython, which takes a second or two that only videos should cost.
    import mediapy

    arguments = f"{_FASTER} {_COLOURS}"
    writer = mediapy.VideoWriter(path, (height, width), fps=fps, codec="h264", crf=_QUALITY, ffmpeg_args=arguments)
    try:
        _start(writer)
        complete = _feed(writer, frames)
        _, messages = writer._popen.communicate()
    finally:
        if writer._popen is not None:  # mediapy's own end would wait for a process that may never end
            writer._popen.kill()
            writer._popen.communicate()
    if writer._popen.returncode != 0 or not complete or path.stat().st_size == 0:
        raise _reason(writer._popen.returncode, messages.decode(errors="replace"))


def _start(writer: "mediapy.VideoWriter") -> None:
    """Start ffmpeg so that it never receives a signal that ends a command: it is ended by its writer.

    A terminal sends Ctrl-C to all processes of a command, and an ffmpeg that ended first would look like the fault.
    """
    import imageio_ffmpeg
    import mediapy

    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        writer.__enter__()
    except (OSError, RuntimeError) as error:
        raise _failure(str(error)) from error
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _feed(writer: "mediapy.VideoWriter", frames: Iterable[np.ndarray]) -> bool:
    """Return whether ffmpeg took all frames."""
    for frame in frames:
        try:
            writer.add_image(frame)
        except BrokenPipeError:
            return False
    return True


def _reason(status: int, messages: str) -> Exception:
    """Return the error of an ffmpeg that ended with `status`, or before the video did."""
    ended = f"it was ended by {signal.Signals(-status).name}" if status < 0 else "it ended before the video did"
    for number in _DISK:
        if os.strerror(number) in messages or (number == errno.EFBIG and "SIGXFSZ" in ended):
            return OSError(number, os.strerror(number))
    return _failure([ended, *messages.strip().splitlines()][-1])


def _failure(reason: str) -> RenderingError:
    remedy = "Reinstall it (`pip install --force-reinstall imageio-ffmpeg`), or name another in IMAGEIO_FFMPEG_EXE"
    return RenderingError(f"ffmpeg did not write the video: {reason}\n{remedy}")
