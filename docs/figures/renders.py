"""Writes each film as an animated WebP, less than 1.5 MB each: `python docs/figures/renders.py renders`."""

import pathlib
import sys

from PIL import Image

from mjbeer.output import files
from mjbeer.report.films import FILMS

WIDTH, HEIGHT, FPS = 720, 450, 18
"""Width and height [pixels] and pictures per second."""

for name, film in FILMS.items():
    plan = film.plan()
    first, *others = (Image.fromarray(each) for each in plan.draw(plan.times(FPS), WIDTH, HEIGHT))
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
