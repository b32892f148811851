"""The stability study: two ideas, limits by linear theory and a search for runs that are wrong and do not say so."""

import datetime
import json
import os
import pathlib

from rich.console import Console

from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies import rows
from mjbeer.studies.rows import Row, Study
from mjbeer.studies.stability import limits, search, stiff_maps

COMMAND = "mjbeer stability"
EXTENTS = ("quick", "usual", "long", "maps")
"""How much a study measures: "long" everything, "maps" nothing but all maps; the other two differ in the number of
random runs."""
_READ = """
A run is **stable and accurate** if phi and u/a stay within 0.01 rad of exact theory (relative beyond 1 rad). It is
**stable, inaccurate** if they do not and the run carries a warning, **unstable, detected** if it blows up and ends in
an error or carries a warning, **refused** if it ends in an error that states the reason, and **wrong and silent** if it
is trusted although its error is larger. A **tolerance** is **missed** if the error is above it, and **theories differ**
if the exact motion and one that is integrated from the Lagrangian are farther apart than rounding explains. There must
be none of the last three.

Among the accurate random runs there are **false alarms**: runs that are right from the start to the last sample, and
warn of more than a can that would leave the incline. They do not count as such if the can **slips or lifts** by more
than is trusted, if the run is right at its samples and wrong on the **way**, or if the start is so **sensitive** that
another one, nearer than models are made, moves the exact motion by more than is trusted.
"""
"""How to read the first table of the summary, and that of the random runs."""


def plan(extent: str) -> list[Row]:
    """Return all rows of a study of this extent, one of `EXTENTS`."""
    if extent == "maps":
        return stiff_maps.rows()
    sample = extent != "long"
    return [*limits.rows(sample), *stiff_maps.rows(sample), *search.rows(extent)]


def conduct(folder: pathlib.Path, extent: str, console: Console) -> Study:
    """Measure the rows that the study in `folder` lacks, on all cores, and return the study, kept as stability.jsonl.

    The summary of an earlier study is removed first.

    Raises:
      OutputError: if the folder cannot be written to.
      OSError: if the system ends one of the processes.
      ParameterError: if stability.jsonl is there but is not such a study.
    """
    (folder / "summary.md").unlink(missing_ok=True)
    path, processes = folder / "stability.jsonl", os.cpu_count() or 1
    return rows.run(plan(extent), console, path, COMMAND, {"extent": extent}, processes)


def tables(study: Study) -> list[Table]:
    """Return the tables for the terminal that have a row; those with a line a case appear only in the summary."""
    ended, *others = search.tables(study.results) or [Table("", (), [])]
    damped = "Maps of timestep and damping: how runs ended"
    shown = (
        ended,
        limits.table(study.of(limits.GROUP)),
        stiff_maps.table("Maps of timestep and stiffness", study.of(stiff_maps.STIFF), list(stiff_maps.SHADES)),
        stiff_maps.table(damped, study.of(stiff_maps.DAMPED), list(stiff_maps.DAMPED_SHADES)),
        *others,
    )
    return [table for table in shown if table.rows]


def to_json(study: Study) -> str:
    """Return the study as one JSON document."""
    about = {"command": study.command, "settings": study.settings, "machine": study.machine}
    results = [json.loads(result.line()) for result in study.results]
    return json.dumps(about | {"failed": [result.name for result in study.failed], "results": results}) + "\n"


def write(study: Study, folder: pathlib.Path) -> None:
    """Write maps.json, the plots of the maps, and at the end summary.md into a folder.

    Raises:
      OutputError: if a file cannot be written.
    """
    maps = stiff_maps.to_json(study, datetime.date.today())
    files.write(folder / "maps.json", maps)
    count = len(study.failed)
    verdict = f"**{count} did not come out as theory expects.**" if count else "All came out as theory expects."
    first, *others = tables(study)
    lines = ["# mjbeer: stability", "", verdict, _READ, first.markdown()]
    for name, draw in stiff_maps.figures(json.loads(maps)).items():
        draw(folder / name)
        lines += [f"![{name}]({name}.svg)", "", stiff_maps.FIGURES[name].caption, ""]
    known = search.table_of_cases(study.of(search.KNOWN))
    lines += [table.markdown() for table in (*others, known) if table.rows]
    files.write(folder / "summary.md", "\n".join(lines))
