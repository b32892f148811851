"""Writes films as animated WebP of less than 1 MB.

`python docs/figures/renders.py renders` writes them into renders.
"""

import pathlib
import sys

from PIL import Image

from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.report.films import FILMS

WIDTH = 640
"""[pixels]"""
HEIGHT = 400
"""[pixels]"""
FPS = 12
"""Pictures per second."""

OF_STORIES = {"rocking"}
"""The films of the paper's stories that a document links to."""
DRAWN = dict(FILMS)
DRAWN |= {story.name: story.film for story in stories.STORIES if story.name in OF_STORIES}

for name, film in DRAWN.items():
    plan = film.plan()
    pictures = plan.draw(plan.times(FPS), WIDTH, HEIGHT)
    first, *others = (Image.fromarray(picture) for picture in pictures)
    target = pathlib.Path(sys.argv[1]) / f"{name}.webp"
    with files.atomic_write(target) as temporary:  # at 45, letters are sharp
        first.save(
            temporary,
            "WEBP",
            save_all=True,
            append_images=others,
            duration=1000 // FPS,
            loop=0,
            quality=45,
            method=4,
        )
