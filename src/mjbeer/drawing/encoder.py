"""Write frames to a video file, with mediapy and the ffmpeg that comes with imageio-ffmpeg."""

import errno
import os
import pathlib
import signal
import subprocess
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjbeer.exceptions import RenderingError

if TYPE_CHECKING:
    import mediapy

_QUALITY = 20
"""Constant rate factor of H.264: at 18 no loss is visible, 23 is ffmpeg's default."""
_FASTER = "-preset veryfast -movflags +faststart"
"""With these, encoding takes less time than drawing, and a player can start before it has loaded the whole file."""
_COLOURS = "-vf scale=out_color_matrix=bt709:out_range=tv"
"""HD colours (BT.709), which players expect of a picture this size; the default is those of SD television."""
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Errors of the disk. ffmpeg prints the system's message for them."""
_REMEDY = "Reinstall it (`pip install --force-reinstall imageio-ffmpeg`), or name another in IMAGEIO_FFMPEG_EXE"


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
    # mediapy imports matplotlib and IPython: a second or two that only videos should take.
    import mediapy

    arguments = f"{_FASTER} {_COLOURS}"
    writer = mediapy.VideoWriter(path, (height, width), fps=fps, codec="h264", crf=_QUALITY, ffmpeg_args=arguments)
    try:
        _start(writer)
        complete = _feed(writer, frames)
        _, messages = writer._popen.communicate()
    finally:
        if writer._popen is not None:  # mediapy would wait for ffmpeg, which may never end by itself
            writer._popen.kill()
            writer._popen.communicate()
    if writer._popen.returncode != 0 or not complete or path.stat().st_size == 0:
        raise _error(writer._popen.returncode, messages.decode(errors="replace"))


def _start(writer: "mediapy.VideoWriter") -> None:
    """Start ffmpeg with signals blocked, so that only this process ends it.

    A terminal sends Ctrl-C to all processes of a command. If ffmpeg ended first, the interruption would be reported as
    a fault of ffmpeg.
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
    """Pass all frames to ffmpeg, and return False if ffmpeg ended before the last."""
    for frame in frames:
        try:
            writer.add_image(frame)
        except BrokenPipeError:
            return False
    return True


def _error(status: int, messages: str) -> Exception:
    """Return the error to raise for an ffmpeg that failed, from its exit status and the text it wrote."""
    ended = f"it was ended by {signal.Signals(-status).name}" if status < 0 else "it ended before the video did"
    for number in _DISK:
        if os.strerror(number) in messages or (number == errno.EFBIG and "SIGXFSZ" in ended):
            return OSError(number, os.strerror(number))
    return _failure([ended, *messages.strip().splitlines()][-1])


def _failure(reason: str) -> RenderingError:
    return RenderingError(f"ffmpeg did not write the video: {reason}\n{_REMEDY}")
