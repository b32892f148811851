"""What is said on which stream, where writing may fail; and progress bars."""

import errno
import os
import sys
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, TextIO

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from mjbeer.exceptions import OutputError


class Teller(Console):
    """A console that has nobody reading it be an error like any other, where rich would end the program.

    It is none on standard error, where there is nothing more to say then.
    """

    def print(self, *objects: Any, **options: Any) -> None:
        try:
            super().print(*objects, **options)
        except OSError:
            if not self.stderr:
                raise
            _forget(sys.stderr)

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))


STDOUT = Teller()
STDERR = Teller(stderr=True)


def show(*tables: RenderableType) -> None:
    """Print tables to standard output.

    Raises:
      OutputError: if it cannot be written.
    """
    with printing():
        STDOUT.print(*tables)


def say(text: str, style: str = "") -> None:
    """A line on standard error; names of files may have brackets in them, which are no markup."""
    STDERR.print(text, style=style, highlight=False, markup=False, soft_wrap=True)


def counted(console: Console) -> Progress:
    """A bar with what is done, how many pieces of it, and since when; nothing where the console is no terminal."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}/{task.total}")
    return Progress(*columns, TimeElapsedColumn(), console=console, disable=not console.is_terminal)


@contextmanager
def printing() -> Generator[None]:
    """What is printed in the block is written to standard output, all of it before the block ends.

    Raises:
      OutputError: if it cannot be written, as into a pipe that nobody reads any more.
    """
    try:
        try:
            yield
        finally:  # --help prints, and ends the program
            sys.stdout.flush()
    except OSError as error:
        _forget(sys.stdout)
        raise OutputError(f"cannot write to standard output: {error.strerror or error}") from error


def write(text: str) -> None:
    """Write to standard output, all of it before this returns.

    Raises:
      OutputError: if it cannot be written.
    """
    with printing():
        sys.stdout.write(text)


def open_closed() -> None:
    """Give a program that was started with closed streams ones that say so when written to.

    The next file that is opened would take their place, and get what libraries print.
    """
    if sys.stdout is None:
        sys.stdout = open(os.devnull, encoding="utf-8")  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def _forget(stream: TextIO) -> None:
    """Let nobody have what is left in the buffer: it would fail once more, with a traceback, when Python ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
