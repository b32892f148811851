"""Frames to a video file, through mediapy and the ffmpeg that comes with imageio-ffmpeg."""

import pathlib
from collections.abc import Iterable

import numpy as np

from mjbeer.drawing.ffmpeg import Ffmpeg, no_video
from mjbeer.output.interruption import undoing, withheld

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
      OSError: if the disk is full, or broken.
    """
    # mediapy brings matplotlib and IPython, which takes a second or two that only videos should cost.
    import imageio_ffmpeg
    import mediapy

    try:
        mediapy.set_ffmpeg(imageio_ffmpeg.get_ffmpeg_exe())
        arguments = f"{_FASTER} {_COLOURS}"
        writer = mediapy.VideoWriter(path, (height, width), fps=fps, codec="h264", crf=_QUALITY, ffmpeg_args=arguments)
    except (OSError, RuntimeError) as error:
        raise no_video(error) from error
    program = Ffmpeg(writer)
    with program, undoing(program.kill):
        with withheld():
            program.start()
        for each in frames:
            program.write(each)
        program.end()
    if path.stat().st_size == 0:
        raise no_video("it ended well, but wrote nothing")
