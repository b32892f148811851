"""Many films at once are all there, whole, and an error in one of them is told."""

import os
import pathlib
from collections.abc import Sequence
from functools import partial

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from mjbeer import exact, frozen
from mjbeer.drawing import animation, studio
from mjbeer.drawing.film import Take, reel
from mjbeer.drawing.studio import Order, produce
from mjbeer.exceptions import RenderingError

pytestmark = pytest.mark.slow

TAKE = Take(partial(exact, frozen(), np.linspace(0, 0.5, 51), 1.0), speed=1.0, still=0.2)


def orders(folder: pathlib.Path, names: str) -> list[Order]:
    return [Order(TAKE, folder / f"{name}.mp4", 160, 90, 10) for name in names]


@pytest.mark.draws
def test_films_are_written_with_a_still_picture_of_each(tmp_path: pathlib.Path) -> None:
    produce(orders(tmp_path, "ab"), Console(quiet=True))
    assert sorted(os.listdir(tmp_path)) == ["a-still.png", "a.mp4", "b-still.png", "b.mp4"]
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    with Image.open(tmp_path / "a-still.png") as image:
        assert image.size == (160, 90)


@pytest.mark.draws
def test_a_film_that_fails_is_an_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "nowhere"))
    with pytest.raises(RenderingError, match="nowhere' is not found"):
        produce(orders(tmp_path, "ab"), Console(quiet=True))
    assert os.listdir(tmp_path) == []


@pytest.mark.draws
def test_a_film_that_another_process_was_writing_leaves_nothing(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(orders: Sequence[Order], _: Console) -> None:
        (tmp_path / ".a-12345678.mp4").touch()
        (tmp_path / ".a-still-12345678.png").touch()
        raise KeyboardInterrupt

    monkeypatch.setattr(studio, "_produce", interrupted)
    (tmp_path / "a.mp4").write_text("an older film")
    with pytest.raises(KeyboardInterrupt):
        produce(orders(tmp_path, "a"), Console(quiet=True))
    assert os.listdir(tmp_path) == ["a.mp4"]


@pytest.mark.draws
def test_an_animation_has_all_pictures_and_runs_forever(tmp_path: pathlib.Path) -> None:
    animation.write(reel(TAKE.trajectory()), tmp_path / "can.webp", 160, 90, 10)
    with Image.open(tmp_path / "can.webp") as image:
        assert (getattr(image, "n_frames", 1), image.info["loop"], image.size) == (5, 0, (160, 90))
        image.seek(3)
        shown = np.asarray(image.convert("RGB")).astype(int)
        assert image.info["duration"] == 100
    drawn = list(reel(TAKE.trajectory()).draw(np.arange(5) / 10, 160, 90))
    off = [np.abs(shown - picture).mean() for picture in drawn]
    assert np.argmin(off) == 3
