"""Printing to standard output and standard error, with errors raised if that fails; and a progress bar."""

import errno
import os
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager

import rich.console
from rich.console import RenderableType
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from mjbeer.exceptions import OutputError


class Console(rich.console.Console):
    """A rich console that raises BrokenPipeError when its output is no longer read, instead of ending the program."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))


STDOUT = Console()
STDERR = Console(stderr=True)


def show(*tables: RenderableType) -> None:
    """Print tables to standard output.

    Raises:
      OutputError: if standard output cannot be written to.
    """
    with printing():
        STDOUT.print(*tables)


def say(text: str, style: str = "") -> None:
    """Print a line to standard error. Brackets are printed as they are: names of files may contain them."""
    STDERR.print(text, style=style, highlight=False, markup=False, soft_wrap=True)


@contextmanager
def progress_bar(console: rich.console.Console | None, total: int) -> Generator[Callable[[str], None]]:
    """Yield a function to be called at the start of each of `total` pieces of work, with the name of the piece.

    The bar shows the name, how many pieces have been started, and the time since the block began. No bar is shown if
    `console` is None or not a terminal.
    """
    columns = TextColumn("{task.description}", markup=False), BarColumn(), TextColumn("{task.completed}/{task.total}")
    hidden = console is None or not console.is_terminal
    with Progress(*columns, TimeElapsedColumn(), console=console, transient=True, disable=hidden) as progress:
        task = progress.add_task("", total=total)
        yield lambda name: progress.update(task, description=name[:72], advance=1)


@contextmanager
def printing() -> Generator[None]:
    """Flush standard output at the end of the block, so that an error in writing is raised here.

    Raises:
      OutputError: if standard output cannot be written to, such as a closed pipe or a full disk.
    """
    try:
        try:
            yield
        finally:  # also at SystemExit: --help prints and then ends the program
            sys.stdout.flush()
    except OSError as error:
        # Python flushes the buffer once more when it ends; without this, that would fail with a traceback.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OutputError(f"cannot write to standard output: {error.strerror or error}") from error


def write(text: str) -> None:
    """Write a text to standard output, and flush it.

    Raises:
      OutputError: if standard output cannot be written to.
    """
    with printing():
        sys.stdout.write(text)
