"""A table that goes to the terminal or into Markdown."""

from collections.abc import Sequence
from dataclasses import dataclass

import rich.table


@dataclass(frozen=True)
class Table:
    """A title, the heads of the columns, and rows of text. `print` of a rich console takes it as it is."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    left: tuple[int, ...] = (0,)
    """The columns of words, which are aligned to the left; the others have numbers."""

    def __rich__(self) -> rich.table.Table:
        """Return the table as rich prints it; cells may have its markup."""
        table = rich.table.Table(title=self.title)
        for index, name in enumerate(self.columns):
            table.add_column(name, justify="left" if index in self.left else "right")
        for row in self.rows:
            table.add_row(*row)
        return table

    def markdown(self, title: bool = True) -> str:
        """Return the table as Markdown, with its title as a line in bold above it if asked for."""
        heading = [f"**{self.title}**", ""] if title else []
        rule = "|".join("---" if index in self.left else "---:" for index in range(len(self.columns)))
        rows = [f"| {' | '.join(row)} |" for row in (self.columns, *self.rows)]
        return "\n".join([*heading, rows[0], f"|{rule}|", *rows[1:]]) + "\n"
