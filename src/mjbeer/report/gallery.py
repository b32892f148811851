"""The small gallery that the documents show: the report's films as animated pictures. `make renders` draws it anew."""

import pathlib
import sys

from mjbeer.drawing import video
from mjbeer.report.films import FILMS

WIDTH, HEIGHT, FPS = 720, 405, 20
"""Width and height [pixels] and pictures per second: each of the files then takes less than 1.5 MB."""


def write(folder: pathlib.Path) -> None:
    """Write each film of the report as an animated WebP into a folder.

    Raises:
      RenderingError: if OpenGL does not work; the message says what to do.
      OutputError: if a file cannot be written.
    """
    for name, film in FILMS.items():
        video.write_webp(film.reel(), folder / f"{name}.webp", WIDTH, HEIGHT, FPS)


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]))
