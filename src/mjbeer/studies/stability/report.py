"""What the stability study writes: its runs as CSV, its plots, and a summary with the tables."""

import pathlib

from mjbeer.output import files
from mjbeer.studies.stability import plots, tables
from mjbeer.studies.stability.run import Stability

_READ = """
A run is **stable and accurate** if phi and u/a stay within 0.01 rad of exact theory (relative beyond 1 rad), **stable,
inaccurate** if they do not and the run says so, **unstable, detected** if it blows up, and is raised or flagged,
**refused** if it ends in an error that says why, and **wrong and silent** if it is trusted and off by more: there must
be none of those.
"""
_ENDURANCE = (
    "stability-endurance: energy drifts with the number of swings by laws that theory gives. It stays in bounds where "
    "semi-implicit Euler is symplectic; where each step loses a share, were it by rounded coefficients, it falls in "
    "proportion."
)


def write(found: Stability, folder: pathlib.Path) -> None:
    """Write runs.csv, the plots, and last summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "runs.csv", tables.runs(found))
    plots.draw_endurance(found.of("endurance"), folder / "stability-endurance")
    pictures = [*plots.draw(found.of("limits"), found.of("maps"), folder), _ENDURANCE]
    lines = ["# mjbeer: stability", "", f"{_words(found)}", _READ]
    lines += [tables.verdicts(found).markdown()]
    for name, caption in (each.split(": ", 1) for each in pictures):
        lines += [f"![{name}]({name}.svg)", "", f"{caption[0].upper()}{caption[1:]}", ""]
    lines += [table.markdown() for table in tables.tables(found)[1:]]
    lines += [tables.catalogue(found).markdown(), tables.reasons(found).markdown()]
    files.write(folder / "summary.md", "\n".join(lines))


def _words(found: Stability) -> str:
    count = len(found.unexpected)
    return "All came out as theory expects." if not count else f"**{count} did not come out as theory expects.**"
