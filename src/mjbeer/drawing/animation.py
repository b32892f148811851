"""Write a film as an animated WebP, which a page shows without a player."""

import contextlib
import pathlib

from PIL import Image

from mjbeer.drawing.film import Reel
from mjbeer.output import files

_QUALITY = 60
"""WebP's quality, from 0 to 100: at 60 letters of 13 pixels are still sharp."""
_EFFORT = 4
"""How long WebP looks for a smaller file, from 0 to 6."""


def write(film: Reel, path: pathlib.Path, width: int, height: int, fps: float) -> None:
    """Write a film as an animated WebP that runs forever, of `width` by `height` pixels.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    with contextlib.closing(film.draw(film.times(fps), width, height)) as pictures:
        first, *others = (Image.fromarray(picture) for picture in pictures)
    with files.whole(path) as temporary:
        first.save(
            temporary, "WEBP", save_all=True, append_images=others, duration=round(1000 / fps), loop=0,
            quality=_QUALITY, method=_EFFORT,
        )  # fmt: skip
