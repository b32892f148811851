"""What goes to which stream, where writing may fail; and a progress bar."""

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
    """A rich console that raises BrokenPipeError when its reader has gone, instead of exiting."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))


STDOUT = Console()
STDERR = Console(stderr=True)


def show(*tables: RenderableType) -> None:
    """Print tables to standard output.

    Raises:
      OutputError: if it cannot be written.
    """
    with printing():
        STDOUT.print(*tables)


def say(text: str, style: str = "") -> None:
    """Print a line to standard error; names of files may have brackets in them, which are no markup."""
    STDERR.print(text, style=style, highlight=False, markup=False, soft_wrap=True)


@contextmanager
def progress_bar(console: rich.console.Console | None, total: int) -> Generator[Callable[[str], None]]:
    """Yield a function to call with the name of each of `total` pieces of work when it is begun.

    A bar shows the name, how many have been begun and for how long; nothing where the console is no terminal or None.
    """
    columns = TextColumn("{task.description}", markup=False), BarColumn(), TextColumn("{task.completed}/{task.total}")
    hidden = console is None or not console.is_terminal
    with Progress(*columns, TimeElapsedColumn(), console=console, transient=True, disable=hidden) as progress:
        task = progress.add_task("", total=total)
        yield lambda name: progress.update(task, description=name[:72], advance=1)


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
        # What is left in the buffer would fail once more, with a traceback, when Python ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OutputError(f"cannot write to standard output: {error.strerror or error}") from error


def write(text: str) -> None:
    """Write to standard output, all of it before this returns.

    Raises:
      OutputError: if it cannot be written.
    """
    with printing():
        sys.stdout.write(text)
