"""Many films at once are all there, whole, and an error in one of them is told."""

import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from functools import partial
from multiprocessing import connection
from typing import Any

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

from mjbeer import exact, frozen
from mjbeer.drawing import studio, video
from mjbeer.drawing.film import Reel, Take, reel
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


@dataclass(frozen=True)
class Fragile:
    """A film whose process is ended by a `signal` before it draws, or stands still for want of one.

    It happens as often as there are files in `lives`, each of which one attempt takes.
    """

    lives: pathlib.Path
    signal: int | None
    still: float = 0.2
    caption: str = ""

    def reel(self) -> Reel:
        if multiprocessing.parent_process() is not None and (left := list(self.lives.iterdir())):
            left[0].unlink()
            (self.lives.parent / "films" / ".a-12345678.mp4").touch()  # what a film that is being written looks like
            if self.signal is None:
                time.sleep(600)
            else:
                os.kill(os.getpid(), self.signal)
        return TAKE.reel()


def fragile(folder: pathlib.Path, lives: int, signal: int | None) -> list[Order]:
    (folder / "films").mkdir()
    (folder / "lives").mkdir()
    for life in range(lives):
        (folder / "lives" / str(life)).touch()
    weak = Order(Fragile(folder / "lives", signal), folder / "films" / "a.mp4", 160, 90, 10)
    return [weak, *orders(folder / "films", "bc")]


@pytest.mark.costly
@pytest.mark.draws
def test_a_film_whose_process_dies_is_drawn_once_more(tmp_path: pathlib.Path) -> None:
    produce(fragile(tmp_path, 1, signal.SIGSEGV), Console(quiet=True))
    films = [f"{name}{ending}" for name in "abc" for ending in ("-still.png", ".mp4")]
    assert sorted(os.listdir(tmp_path / "films")) == films
    assert (tmp_path / "films/a.mp4").read_bytes() == (tmp_path / "films/b.mp4").read_bytes()


@pytest.mark.costly
@pytest.mark.draws
def test_a_film_that_stands_still_is_drawn_once_more(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (still, whole, _) = fragile(tmp_path, 1, None)
    patiences = [600.0]  # until the film stands still, and once more from then on: no clock is raced

    def wait(*arguments: Any, **named: Any) -> Any:
        stands = len(patiences) == 1 and not os.listdir(tmp_path / "lives")
        patiences.extend([-1.0, 600.0] if stands else [])
        monkeypatch.setattr(studio, "_PATIENCE", patiences.pop(1) if stands else 600.0)
        return connection.wait(*arguments, **named)

    monkeypatch.setattr(studio, "wait", wait)
    produce([still], Console(quiet=True))
    produce([whole], Console(quiet=True))
    assert len(patiences) == 2
    assert still.path.read_bytes() == whole.path.read_bytes()


@pytest.mark.costly
@pytest.mark.draws
@pytest.mark.parametrize(
    ("signal", "told"),
    [(signal.SIGSEGV, "was ended by SIGSEGV$"), (signal.SIGKILL, r"was ended by SIGKILL: is memory short\?$")],
)
def test_a_film_whose_process_dies_twice_is_an_error_that_names_the_signal(
    tmp_path: pathlib.Path, signal: int, told: str
) -> None:
    with pytest.raises(RenderingError, match=rf"^a\.mp4 could not be drawn: its process {told}"):
        produce(fragile(tmp_path, 2, signal), Console(quiet=True))
    assert [name for name in os.listdir(tmp_path / "films") if name.startswith(".")] == []


RASTERIZERS = """
import pathlib
from mjbeer.drawing import opengl
context = opengl.context(64, 64)
context.make_current()
from OpenGL import GL
threads = [(task / "comm").read_text() for task in pathlib.Path("/proc/self/task").iterdir()]
print(sum(name.startswith("llvmpipe") for name in threads), GL.glGetString(GL.GL_RENDERER).decode())
"""


@pytest.mark.draws
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere nothing is drawn by Mesa")
def test_mesa_draws_in_the_thread_that_calls_it_unless_the_user_says_otherwise() -> None:
    def rasterizers(**said: str) -> tuple[int, str]:
        given = {name: value for name, value in os.environ.items() if name != "LP_NUM_THREADS"} | said
        done = subprocess.run(
            [sys.executable, "-c", RASTERIZERS], env=given, capture_output=True, text=True, check=True
        )
        count, renderer = done.stdout.split(maxsplit=1)
        return int(count), renderer

    count, renderer = rasterizers()
    assert count == 0
    if "llvmpipe" in renderer:  # on a graphics card there are none whatever is said
        assert rasterizers(LP_NUM_THREADS="2")[0] == 2


@pytest.mark.draws
def test_an_animation_has_all_pictures_and_runs_forever(tmp_path: pathlib.Path) -> None:
    video.write_webp(reel(TAKE.trajectory()), tmp_path / "can.webp", 160, 90, 10)
    with Image.open(tmp_path / "can.webp") as image:
        assert (getattr(image, "n_frames", 1), image.info["loop"], image.size) == (5, 0, (160, 90))
        image.seek(3)
        shown = np.asarray(image.convert("RGB")).astype(int)
        assert image.info["duration"] == 100
    drawn = list(reel(TAKE.trajectory()).draw(np.arange(5) / 10, 160, 90))
    off = [np.abs(shown - picture).mean() for picture in drawn]
    assert np.argmin(off) == 3
