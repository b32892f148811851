"""Draws many films at once, in one process for each core, and once more those whose process died."""

import contextlib
import pathlib
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass

import rich.console
from PIL import Image

from mjbeer.drawing import video
from mjbeer.drawing.film import Film
from mjbeer.exceptions import LiquidWarning, RenderingError, UntrustedWarning
from mjbeer.output import files, processes
from mjbeer.output.terminal import progress_bar


@dataclass(frozen=True)
class Order:
    """A film to be written, with a still picture of it as PNG beside it."""

    film: Film
    path: pathlib.Path
    """Its file, whose name ends in .mp4. The still picture's ends in -still.png."""
    width: int
    height: int
    fps: float

    def write(self) -> None:
        """Write film and still picture, each whole or not at all."""
        with warnings.catch_warnings():
            for kind in (UntrustedWarning, LiquidWarning):  # films show on purpose what cannot be trusted
                warnings.simplefilter("ignore", kind)
            reel = self.film.reel()
            video.write(reel, self.path, self.width, self.height, self.fps)
            still = self.film.still or (2 * reel.start + reel.end) / 3  # at the start nothing has happened yet
            picture = video.still(reel, still, self.width, self.height)
            with files.whole(self.path.with_name(f"{self.path.stem}-still.png")) as temporary:
                Image.fromarray(picture).save(temporary)


def produce(orders: Sequence[Order], console: rich.console.Console) -> None:
    """Write films and their still pictures, with a progress bar.

    A driver of OpenGL may crash by chance, which hardly happens twice: what is then missing is drawn once more.

    Raises:
      RenderingError: if ffmpeg or OpenGL does not work, or a film's process dies twice; the message says what to do.
      OutputError: if a file cannot be written.
    """
    with _swept(orders), progress_bar(console, len(orders)) as begin:
        left = _write(orders, len(orders), begin)
        if left := _write(left, 1, begin):
            raise RenderingError(f"{left[0].path.name} could not be drawn: its process died twice; is memory short?")


def _write(orders: Sequence[Order], most: int, begin: Callable[[str], None]) -> list[Order]:
    """Write films in up to `most` processes, and return those that are missing because a process died."""
    left = list(orders)
    with processes.pool(most) as executor:
        futures = {executor.submit(order.write): order for order in orders}
        for future in as_completed(futures):
            with contextlib.suppress(BrokenProcessPool):
                future.result()
                begin("drawing films")
                left.remove(futures[future])
    return left


@contextlib.contextmanager
def _swept(orders: Sequence[Order]) -> Generator[None]:
    """Remove the hidden files at the end that a process leaves which is ended while it writes."""
    try:
        yield
    finally:
        for order in orders:
            for unfinished in order.path.parent.glob(f".{order.path.stem}-*"):
                unfinished.unlink(missing_ok=True)
