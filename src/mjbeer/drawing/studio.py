"""Writes many files at once, in one process for each core: films, plots, and whatever else takes long."""

import contextlib
import itertools
import pathlib
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import rich.console
from PIL import Image

from mjbeer.drawing import video
from mjbeer.drawing.film import Film
from mjbeer.exceptions import AngleWarning, LiquidWarning, RenderingError, UntrustedWarning
from mjbeer.output import files, processes
from mjbeer.output.terminal import progress_bar


class Order(Protocol):
    """Something to be written. It can be pickled, so that another process can do it."""

    @property
    def path(self) -> pathlib.Path:
        """Its file; other files of it begin with the same name."""
        ...

    def write(self) -> Any:
        """Write all of its files, each whole or not at all, and return what is to be known of it besides."""
        ...


@dataclass(frozen=True)
class Filmed:
    """A film to be written, with a still picture of it as PNG beside it."""

    film: Film
    path: pathlib.Path
    """Its file, whose name ends in .mp4. The still picture's ends in -still.png."""
    width: int
    height: int
    fps: float

    def write(self) -> None:
        """Write film and still picture."""
        reel = self.film.reel()
        still = self.film.still or (2 * reel.start + reel.end) / 3  # at the start nothing has happened yet
        nearest, number, kept = np.argmin(np.abs(reel.times(self.fps) - still)), itertools.count(), []

        def keep(picture: np.ndarray) -> None:
            if next(number) == nearest:
                kept.append(picture)

        video.write(reel, self.path, self.width, self.height, self.fps, keep)
        with files.whole(self.path.with_name(f"{self.path.stem}-still.png")) as temporary:
            Image.fromarray(kept[0]).save(temporary)


@dataclass(frozen=True)
class Plotted:
    """A plot to be drawn."""

    draw: Callable[[pathlib.Path], None]
    """Writes the plot to a path, with .svg appended."""
    path: pathlib.Path

    def write(self) -> None:
        """Write the plot."""
        self.draw(self.path)


def produce(orders: Sequence[Order], console: rich.console.Console) -> list[Any]:
    """Write what is ordered, with a progress bar, and return what the orders return; begin with the first of them.

    A driver of OpenGL may crash by chance, which hardly happens twice: what is then missing is made once more.

    Raises:
      RenderingError: if ffmpeg or OpenGL does not work, or an order's process dies twice; the message says what to do.
      OutputError: if a file cannot be written.
    """
    told: dict[int, Any] = {}
    with _swept(orders), progress_bar(console, len(orders)) as begin:
        for most in (len(orders), 1):
            _write(orders, told, most, begin)
    if left := [order.path.name for number, order in enumerate(orders) if number not in told]:
        raise RenderingError(f"{left[0]} could not be made: its process died twice; is memory short?")
    return [told[number] for number in range(len(orders))]


def _write(orders: Sequence[Order], told: dict[int, Any], most: int, begin: Callable[[str], None]) -> None:
    """Write in up to `most` processes what is not yet `told`, and tell it, but for that whose process died."""
    with processes.pool(most) as executor:
        left = {number: order for number, order in enumerate(orders) if number not in told}
        futures = {executor.submit(_done, order): number for number, order in left.items()}
        for future in as_completed(futures):
            with contextlib.suppress(BrokenProcessPool):
                told[futures[future]] = future.result()
                begin(f"wrote {orders[futures[future]].path.name}")


def _done(order: Order) -> Any:
    """Write what is ordered: reports show on purpose what cannot be trusted."""
    with warnings.catch_warnings():
        for kind in (UntrustedWarning, LiquidWarning, AngleWarning):
            warnings.simplefilter("ignore", kind)
        return order.write()


@contextlib.contextmanager
def _swept(orders: Sequence[Order]) -> Generator[None]:
    """Remove the hidden files at the end that a process leaves which is ended while it writes."""
    try:
        yield
    finally:
        for order in orders:
            for unfinished in order.path.parent.glob(f".{order.path.stem}-*"):
                unfinished.unlink(missing_ok=True)
