"""Texts, tables and a progress bar on standard output and standard error.

A failure to print is an error.
"""

import os
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import rich.table
from rich.console import Console
from rich.markup import escape
from rich.progress import Progress

from mjbeer.exceptions import OutputError

STDERR = Console(stderr=True)


@dataclass(frozen=True)
class Table:
    """A title, the headings of the columns, and rows of text."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    left: tuple[int, ...] = (0,)
    """Indices of the columns that are aligned to the left; columns of numbers are not."""

    def __rich__(self) -> rich.table.Table:
        table = rich.table.Table(title=self.title)
        for index, name in enumerate(self.columns):
            side = "left" if index in self.left else "right"
            table.add_column(name, justify=side, overflow="fold")
        for row in self.rows:
            table.add_row(*row)
        return table

    def markdown(self) -> str:
        """Return the table as Markdown, with the title in bold above it if there is one."""
        heading = f"**{self.title}**\n\n" if self.title else ""
        sides = ["---" if index in self.left else "---:" for index in range(len(self.columns))]
        lines = [f"| {' | '.join(row)} |\n" for row in (self.columns, *self.rows)]
        head, *rows = lines
        return "".join([heading, head, f"|{'|'.join(sides)}|\n", *rows])

    def tabbed(self) -> str:
        """Return the headings and the rows as lines with tabs between the columns."""
        return "".join("\t".join(row) + "\n" for row in (self.columns, *self.rows))


def show(*tables: Table) -> None:
    """Print tables to standard output, with the errors of `printing`.

    Unless it is a terminal, each table is its title behind a #, and lines with tabs between the
    columns.
    """
    if sys.stdout.isatty():
        with printing():
            Console(markup=False).print(*tables)  # [rad] is a unit
    else:
        write("\n".join(f"# {table.title}\n{table.tabbed()}" for table in tables))


def say(text: str, style: str = "") -> None:
    """Print a line to standard error. Brackets, as in names of files, are no markup."""
    STDERR.print(text, style=style, highlight=False, markup=False, soft_wrap=True)


@contextmanager
def status(text: str) -> Generator[None]:
    """Show on a terminal what the block does; the line disappears when the block ends."""
    if STDERR.is_terminal:
        with STDERR.status(escape(text)):
            yield
    else:
        yield


@contextmanager
def progress_bar(console: Console | None, total: int) -> Generator[Callable[[str], None]]:
    """Yield a function to be called once for each of `total` pieces of work, with its name.

    No bar is shown if `console` is None or not a terminal.
    """
    hidden = console is None or not console.is_terminal
    with Progress(console=console, transient=True, disable=hidden, expand=True) as progress:
        task = progress.add_task("", total=total)
        yield lambda name: progress.update(task, description=escape(name), advance=1)


@contextmanager
def printing() -> Generator[None]:
    """Flush standard output at the end of the block, so that an error in writing is raised here.

    Raises:
      OutputError: if standard output cannot be written to: it is closed, a pipe that nobody reads,
        or a full disk.
    """
    if sys.stdout is None:  # as after `>&-`: the next file that is opened would take its place
        raise OutputError("cannot write to standard output: it is closed")
    try:
        try:
            yield
        finally:  # also at SystemExit: --help prints and then ends the program
            sys.stdout.flush()
    except OSError as error:
        # Python flushes the buffer once more when it ends; without this, that would fail with a
        # traceback.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OutputError(f"cannot write to standard output: {error.strerror or error}") from error


def write(text: str) -> None:
    """Write a text to standard output, and flush it, with the errors of `printing`."""
    with printing():
        sys.stdout.write(text)
