"""Writes every film as an animated WebP of less than 1.5 MB.

`python docs/figures/renders.py renders` writes them into renders.
"""

import pathlib
import sys

from PIL import Image

from mjbeer.output import files
from mjbeer.report.films import FILMS

WIDTH = 720
"""[pixels]"""
HEIGHT = 450
"""[pixels]"""
FPS = 18
"""Pictures per second."""

for name, film in FILMS.items():
    plan = film.plan()
    pictures = plan.draw(plan.times(FPS), WIDTH, HEIGHT)
    first, *others = (Image.fromarray(picture) for picture in pictures)
    target = pathlib.Path(sys.argv[1]) / f"{name}.webp"
    with files.atomic_write(target) as temporary:  # at 55, letters are sharp
        first.save(
            temporary,
            "WEBP",
            save_all=True,
            append_images=others,
            duration=1000 // FPS,
            loop=0,
            quality=55,
            method=4,
        )
