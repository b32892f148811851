"""Draws many films at once, in one process for each core, and a film once more whose process failed."""

import contextlib
import os
import pathlib
import signal
import time
import warnings
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait

import rich.console
from PIL import Image

from mjbeer.drawing import video
from mjbeer.drawing.film import Film
from mjbeer.exceptions import LiquidWarning, RenderingError, UntrustedWarning
from mjbeer.output import files, processes
from mjbeer.output.terminal import progress_bar

_PATIENCE = 60.0
"""How long a process may be at work without a new picture [s]; a picture takes a fraction of a second."""
_ATTEMPTS = 2
"""How often a film is begun whose process dies or stands still: a driver of OpenGL that fails by chance hardly fails
twice, and one that always fails must be reported."""


@dataclass(frozen=True)
class Order:
    """A film to be written, with a still picture of it as PNG beside it."""

    film: Film
    path: pathlib.Path
    """Its file, whose name ends in .mp4. The still picture's ends in -still.png."""
    width: int
    height: int
    fps: float

    def pictures(self) -> int:
        """Return how many pictures the film has, and the still picture."""
        return len(self.film.reel().times(self.fps)) + 1

    def write(self, count: Callable[[], None]) -> None:
        """Write film and still picture, each whole or not at all, and call `count` for each picture."""
        reel = self.film.reel()
        video.write(reel, self.path, self.width, self.height, self.fps, count)
        still = self.film.still or (2 * reel.start + reel.end) / 3  # at the start nothing has happened yet
        picture = video.still(reel, still, self.width, self.height)
        with files.whole(self.path.with_name(f"{self.path.stem}-still.png")) as temporary:
            Image.fromarray(picture).save(temporary)
        count()

    def clear(self) -> None:
        """Remove the hidden files that a process leaves which is ended while it writes."""
        for ending in (".mp4", ".png"):
            for unfinished in self.path.parent.glob(f".{self.path.stem}-*{ending}"):
                unfinished.unlink(missing_ok=True)


def produce(orders: Sequence[Order], console: rich.console.Console) -> None:
    """Write films and their still pictures, with a progress bar.

    A film whose process dies, or draws nothing for a minute, is drawn once more in a new process.

    Raises:
      RenderingError: if ffmpeg or OpenGL does not work, or a film's process fails twice; the message says what to do.
      OutputError: if a file cannot be written.
    """
    counts = {order.path: order.pictures() for order in orders}
    waiting = deque(sorted(orders, key=lambda order: -counts[order.path] * order.width * order.height))
    failures = dict.fromkeys(counts, 0)
    painters: list[_Painter] = []
    try:
        with progress_bar(console, sum(counts.values())) as begin:
            while waiting or painters:
                while waiting and len(painters) < (os.cpu_count() or 1):
                    painters.append(_Painter(waiting.popleft()))
                wait([painter.pipe for painter in painters], timeout=1.0)
                for painter in list(painters):
                    for _ in range(painter.listen()):
                        begin("drawing films")
                    if painter.failure:
                        painters.remove(painter)
                        painter.end()
                        failures[painter.order.path] += 1
                        if failures[painter.order.path] == _ATTEMPTS:
                            raise RenderingError(f"{painter.order.path.name} could not be drawn: {painter.failure}")
                        waiting.append(painter.order)
                    elif painter.done and waiting:
                        painter.take(waiting.popleft())
                    elif painter.done:
                        painters.remove(painter)
                        painter.end()
    finally:
        for painter in painters:
            painter.end()


class _Painter:
    """A process that draws one film after the other."""

    def __init__(self, order: Order) -> None:
        context = get_context("spawn")  # a copy of a process that has OpenGL would be of no use
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=_paint, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()  # so that the pipe ends when the process does
        self.take(order)

    def take(self, order: Order) -> None:
        """Begin a film."""
        self.order, self.done, self.failure = order, False, ""
        self._heard = time.monotonic()
        with contextlib.suppress(BrokenPipeError):  # a process that has just died is found out by `listen`
            self.pipe.send(order)

    def listen(self) -> int:
        """Return how many pictures were drawn since the last call, and note whether the film is done or has failed.

        Raises:
          MjbeerError: what the film's own process raised.
        """
        pictures = 0
        try:
            while not self.done and self.pipe.poll():
                self._heard = time.monotonic()
                word = self.pipe.recv()
                if isinstance(word, BaseException):
                    raise word
                self.done = word == "done"
                pictures += not self.done
        except (EOFError, ConnectionResetError):
            self._process.join()
            status = self._process.exitcode or 0
            memory = ": is memory short?" if -status == signal.SIGKILL else ""
            ended = (
                f"was ended by {signal.Signals(-status).name}{memory}" if status < 0 else f"ended with status {status}"
            )
            self.failure = f"its process {ended}"
        if not self.done and time.monotonic() - self._heard > _PATIENCE:
            self.failure = f"its process drew nothing for {_PATIENCE:g} s"
        return pictures

    def end(self) -> None:
        """End the process and the ffmpeg that it has started, and remove what they leave unfinished."""
        if self._process.pid is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        self._process.join()
        self.pipe.close()
        if not self.done:
            self.order.clear()


def _paint(pipe: Connection) -> None:
    """Write the films that come through a pipe, and answer with a word for each picture and at the end of each film."""
    os.setpgrp()  # one group with its ffmpeg, to be ended together
    processes.follow_parent()
    for kind in (UntrustedWarning, LiquidWarning):  # films show on purpose what cannot be trusted
        warnings.simplefilter("ignore", kind)
    while True:
        order: Order = pipe.recv()
        try:
            order.write(lambda: pipe.send("picture"))
        except Exception as error:
            pipe.send(error)
        else:
            pipe.send("done")
