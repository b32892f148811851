"""Tables of studies that take too long to be computed anew for each page."""

import json
import pathlib
from collections.abc import Mapping

from mjbeer.output import files
from mjbeer.output.terminal import Table


def save(path: pathlib.Path, tables: Mapping[str, Table]) -> None:
    """Write tables, by their names, to a JSON file.

    Raises:
      OutputError: if the file cannot be written.
    """
    stored = {
        name: {"columns": table.columns, "rows": table.rows, "left": table.left}
        for name, table in tables.items()
    }
    files.write(path, json.dumps(stored, indent=1, ensure_ascii=False) + "\n")


def load(path: pathlib.Path, name: str) -> Table:
    """Return a stored table."""
    stored = json.loads(path.read_text(encoding="utf-8"))[name]
    rows = [tuple(row) for row in stored["rows"]]
    return Table("", tuple(stored["columns"]), rows, tuple(stored["left"]))
