"""Draws many films at once, one process for each core."""

import os
import pathlib
import warnings
from collections.abc import Sequence
from concurrent.futures import Future, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.sharedctypes import Synchronized

import rich.console
from PIL import Image

from mjbeer.drawing import video
from mjbeer.drawing.film import Film
from mjbeer.exceptions import RenderingError, UntrustedWarning
from mjbeer.output import files, processes
from mjbeer.output.terminal import progress_bar

_OFTEN = 0.2
"""How often the progress bar is brought up to date [s]."""


@dataclass(frozen=True)
class Order:
    """A film to be written, with a still picture of it as PNG beside it."""

    film: Film
    path: pathlib.Path
    """Its file, whose name ends in .mp4. The still picture's ends in -still.png."""
    width: int
    """Width [pixels]."""
    height: int
    """Height [pixels]."""
    fps: float
    """Pictures per second."""

    def pictures(self) -> int:
        """Return how many pictures the film has, and the still picture."""
        return len(self.film.reel().times(self.fps)) + 1

    def write(self) -> None:
        """Write film and still picture, each whole or not at all."""
        reel = self.film.reel()
        video.write(reel, self.path, self.width, self.height, self.fps, _count)
        picture = video.still(reel, self.film.still, self.width, self.height)
        with files.whole(self.path.with_name(f"{self.path.stem}-still.png")) as temporary:
            Image.fromarray(picture).save(temporary)
        _count()


def produce(orders: Sequence[Order], console: rich.console.Console) -> None:
    """Write films and their still pictures, with a progress bar.

    Raises:
      RenderingError: if ffmpeg or OpenGL does not work; the message says what to do.
      OutputError: if a file cannot be written.
    """
    try:
        _produce(orders, console)
    except BaseException:
        for order in orders:  # a process that is ended leaves the hidden file that it was writing
            for ending in (".mp4", ".png"):
                for unfinished in order.path.parent.glob(f".{order.path.stem}-*{ending}"):
                    unfinished.unlink(missing_ok=True)
        raise


def _produce(orders: Sequence[Order], console: rich.console.Console) -> None:
    drawn = get_context("spawn").Value("l", 0)
    counts = {order.path: order.pictures() for order in orders}
    longest_first = sorted(orders, key=lambda order: -counts[order.path] * order.width * order.height)
    with (
        progress_bar(console, sum(counts.values())) as begin,
        processes.pool(len(orders), _prepare, (drawn,)) as executor,
    ):
        running: set[Future[None]] = {executor.submit(order.write) for order in longest_first}
        seen = 0
        while running:
            done, running = wait(running, timeout=_OFTEN)
            for _ in range(seen, drawn.value):
                begin("drawing films")
            seen = drawn.value
            for future in done:
                try:
                    future.result()
                except BrokenProcessPool as error:
                    raise RenderingError("a process that drew films was ended: is memory short?") from error


_drawn: list[Synchronized] = []
"""In a process that draws films, the number of pictures that all of them have drawn."""


def _prepare(drawn: Synchronized) -> None:
    """Prepare a process for drawing."""
    _drawn.append(drawn)
    warnings.simplefilter("ignore", UntrustedWarning)  # films show on purpose what cannot be trusted
    os.environ["LP_NUM_THREADS"] = "1"  # more threads of Mesa would only wait for each other's cores


def _count() -> None:
    for drawn in _drawn:
        with drawn.get_lock():
            drawn.value += 1
