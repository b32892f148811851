"""Frames to a video file, through mediapy and the ffmpeg that comes with imageio-ffmpeg."""

import pathlib
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


def encode(frames: Iterable[np.ndarray], path: pathlib.Path, width: int, height: int, fps: float) -> None:
    """Write frames of shape (height, width, 3), uint8, as they come: none is kept.

    Raises:
      RenderingError: if ffmpeg does not work; the message has what it says.
    """
    # mediapy brings matplotlib and IPython, which takes a second or two that only videos should cost.
    import imageio_ffmpeg
    import mediapy

    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        arguments = f"{_FASTER} {_COLOURS}"
        writer = mediapy.VideoWriter(path, (height, width), fps=fps, codec="h264", crf=_QUALITY, ffmpeg_args=arguments)
        writer.__enter__()
    except (OSError, RuntimeError) as error:
        raise _no_video(error) from error
    try:
        for each in frames:
            try:
                writer.add_image(each)
            except (OSError, RuntimeError) as error:
                raise _no_video(_close(writer) or error) from error
    except BaseException:
        _close(writer)
        raise
    if (failure := _close(writer)) is not None:
        raise _no_video(failure)
    if path.stat().st_size == 0:
        raise _no_video("it ended well, but wrote nothing")


def _close(writer: "mediapy.VideoWriter") -> RuntimeError | None:
    """Let ffmpeg end; what it says, if it ended with an error."""
    for _ in range(2):  # a broken pipe fails the first time, before what ffmpeg says is read
        try:
            writer.close()
        except RuntimeError as error:
            return error
        except OSError:
            continue
        return None
    return None


def _no_video(reason: Exception | str) -> RenderingError:
    return RenderingError(
        f"ffmpeg did not write the video: {str(reason).strip()}\n"
        "Reinstall it with `pip install --force-reinstall imageio-ffmpeg`, or name one that works in the environment "
        "variable IMAGEIO_FFMPEG_EXE"
    )
