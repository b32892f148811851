"""Many films at once are all there, whole, and an error in one of them is told."""

import multiprocessing
import os
import pathlib
import signal
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from mjbeer import exact, frozen
from mjbeer.drawing.film import Reel, Take
from mjbeer.drawing.studio import Filmed, Order, produce
from mjbeer.exceptions import RenderingError

pytestmark = [pytest.mark.slow, pytest.mark.draws, pytest.mark.costly]

TAKE = Take(partial(exact, frozen(), np.linspace(0, 0.5, 51), 1.0), speed=1.0, still=0.2)


@dataclass(frozen=True)
class Fragile:
    """A film whose process is killed before it draws, as often as there are files in `lives`."""

    lives: pathlib.Path
    still: float = 0.2
    caption: str = ""

    def reel(self) -> Reel:
        if multiprocessing.parent_process() is not None and (left := list(self.lives.iterdir())):
            left[0].unlink()
            (self.lives.parent / "films" / ".b-12345678.mp4").touch()  # what a film that is being written looks like
            os.kill(os.getpid(), signal.SIGKILL)
        return TAKE.reel()


def orders(folder: pathlib.Path, lives: int) -> list[Order]:
    (folder / "films").mkdir()
    (folder / "lives").mkdir()
    for life in range(lives):
        (folder / "lives" / str(life)).touch()
    films = {"a": TAKE, "b": Fragile(folder / "lives"), "c": TAKE}
    return [Filmed(film, folder / "films" / f"{name}.mp4", 160, 90, 10) for name, film in films.items()]


@pytest.mark.parametrize("lives", [0, 1])
def test_films_are_written_with_a_still_picture_of_each_even_if_a_process_dies_once(
    lives: int, tmp_path: pathlib.Path
) -> None:
    produce(orders(tmp_path, lives), Console(quiet=True))
    films = [f"{name}{ending}" for name in "abc" for ending in ("-still.png", ".mp4")]
    assert sorted(os.listdir(tmp_path / "films")) == films
    assert (tmp_path / "films/a.mp4").read_bytes() == (tmp_path / "films/b.mp4").read_bytes()
    with Image.open(tmp_path / "films/b-still.png") as image:
        assert image.size == (160, 90)


def test_a_film_whose_process_dies_twice_is_an_error(tmp_path: pathlib.Path) -> None:
    with pytest.raises(RenderingError, match=r"^b\.mp4 could not be made: its process died twice"):
        produce(orders(tmp_path, 2), Console(quiet=True))
    assert [name for name in os.listdir(tmp_path / "films") if name.startswith(".")] == []


def test_a_film_that_fails_is_an_error(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "nowhere"))
    with pytest.raises(RenderingError, match="nowhere' is not found"):
        produce(orders(tmp_path, 0), Console(quiet=True))
    assert os.listdir(tmp_path / "films") == []
