"""Films and plots to be written, many at once, in one process for each core."""

import io
import itertools
import pathlib
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any

import numpy as np
import rich.console
from PIL import Image

from mjbeer.drawing import video
from mjbeer.drawing.film import Film
from mjbeer.exceptions import AngleWarning, LiquidWarning, RenderingError, UntrustedWarning
from mjbeer.output import processes
from mjbeer.output.plots import Picture
from mjbeer.output.terminal import progress_bar


@dataclass(frozen=True)
class FilmJob:
    """A film to be written."""

    film: Film
    path: pathlib.Path  # its file, whose name ends in .mp4
    width: int
    height: int
    fps: float

    def write(self) -> bytes:
        """Write the film, and return its still picture as WebP."""
        plan, file = self.film.plan(), io.BytesIO()
        still = self.film.still or (2 * plan.start + plan.end) / 3  # at the start nothing has happened yet
        nearest, number = np.argmin(np.abs(plan.times(self.fps) - still)), itertools.count()

        def keep(picture: np.ndarray) -> None:
            if next(number) == nearest:
                Image.fromarray(picture).save(file, "WEBP", quality=70)

        video.write(plan, self.path, self.width, self.height, self.fps, keep, video.SMALL_RATE)
        return file.getvalue()


@dataclass(frozen=True)
class PlotJob:
    """A plot to be drawn."""

    draw: Callable[[Any], None]  # writes the plot to a path, with .svg appended, or into a `Picture`
    path: pathlib.Path
    in_memory: bool = False

    def write(self) -> Picture | None:
        """Write the plot, or return it."""
        picture = Picture(self.path.name) if self.in_memory else None
        self.draw(picture or self.path)
        return picture


def produce(orders: Sequence[Any], console: rich.console.Console) -> list[Any]:
    """Write what is ordered, with a progress bar, and return what the orders' `write` returns; begin with the first.

    An order can be pickled, and has a `path`: its file, which it writes whole or not at all, or one of its name.

    Raises:
      RenderingError: if ffmpeg or OpenGL does not work, or a process dies; the message says what to do.
      OutputError: if a file cannot be written.
    """
    try:
        with progress_bar(console, len(orders)) as begin, processes.pool(len(orders)) as executor:
            futures = {executor.submit(_done, order): order for order in orders}
            for future in as_completed(futures):
                name = futures[future].path.name
                try:
                    future.result()
                except BrokenProcessPool as error:
                    raise RenderingError(f"{name} was not made: a process died; is memory short?") from error
                begin(f"made {name}")
            return [future.result() for future in futures]
    finally:  # a process that was ended while it wrote leaves a hidden file
        for order in orders:
            for unfinished in order.path.parent.glob(f".{order.path.stem}-*"):
                unfinished.unlink(missing_ok=True)


def _done(order: Any) -> Any:
    """Write what is ordered: reports show on purpose what cannot be trusted."""
    with warnings.catch_warnings():
        for kind in (UntrustedWarning, LiquidWarning, AngleWarning):
            warnings.simplefilter("ignore", kind)
        return order.write()
