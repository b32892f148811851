"""A table of text that can be printed to the terminal, or written as Markdown or with tabs between its columns."""

from collections.abc import Sequence
from dataclasses import dataclass

import rich.table
from rich.text import Text


@dataclass(frozen=True)
class Table:
    """A title, the headings of the columns, and rows of text. A rich console can print it directly."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    left: tuple[int, ...] = (0,)
    """Indices of the columns that are aligned to the left; the others, of numbers, are aligned to the right."""

    def __rich__(self) -> rich.table.Table:
        """Return the table for rich to print; rich's markup in cells takes effect."""
        table = rich.table.Table(title=self.title)
        for index, name in enumerate(self.columns):
            table.add_column(name, justify="left" if index in self.left else "right", overflow="fold")
        for row in self.rows:
            table.add_row(*row)
        return table

    def markdown(self, title: bool = True) -> str:
        """Return the table as Markdown; `title` says whether the title is in bold above it."""
        heading = [f"**{self.title}**", ""] if title else []
        rule = "|".join("---" if index in self.left else "---:" for index in range(len(self.columns)))
        rows = [f"| {' | '.join(row)} |" for row in (self.columns, *self.rows)]
        return "\n".join([*heading, rows[0], f"|{rule}|", *rows[1:]]) + "\n"

    def tabbed(self) -> str:
        """Return the headings and the rows as lines with tabs between the columns, without rich's markup."""
        rows = [[Text.from_markup(cell).plain for cell in row] for row in self.rows]
        return "".join("\t".join(row) + "\n" for row in (self.columns, *rows))
