"""The animated pictures of the documents are small, and are what today's templates and films look like."""

import pathlib

import numpy as np
import pytest
from PIL import Image

from mjbeer.report.films import FILMS, GALLERY

pytestmark = pytest.mark.slow

RENDERS = pathlib.Path(__file__).parents[2] / "renders"
LARGEST = 1.5e6
BLOCK = 9
# WebP's compression changes the mean of 81 pixels by up to 15 of 255, at letters; beer of another amber does by 34.
COMPRESSION = 20


def test_there_is_one_of_each_film() -> None:
    assert {path.stem for path in RENDERS.glob("*.webp")} == set(FILMS)
    assert max(path.stat().st_size for path in RENDERS.glob("*.webp")) < LARGEST


@pytest.mark.draws
@pytest.mark.parametrize("name", FILMS)
def test_it_is_of_today(name: str) -> None:
    """Two of its pictures, drawn anew, are the same but for the compression; after a change, `make renders` is due."""
    width, height, fps = GALLERY
    reel = FILMS[name].reel()
    times = reel.times(fps)
    with Image.open(RENDERS / f"{name}.webp") as image:
        assert getattr(image, "n_frames", 1) == len(times)
        for place in (len(times) // 3, len(times) - 1):
            image.seek(place)
            kept = np.asarray(image.convert("RGB")).astype(float)
            (drawn,) = reel.draw(times[place : place + 1], width, height)
            blocks = (kept - drawn).reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3)
            assert np.abs(blocks.mean(axis=(1, 3))).max() < COMPRESSION
