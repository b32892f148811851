"""The stability study: maps with the borders of linear theory, and a search for runs that are wrong and silent."""

import datetime
import json
import pathlib

from rich.console import Console

from mjbeer.checks import Check
from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies import study as studies
from mjbeer.studies.stability import search, stability_maps
from mjbeer.studies.study import Study

COMMAND = "mjbeer stability"
EXTENTS = ("quick", "usual", "long", "maps")
"""How much a study measures: "long" everything, "maps" nothing but all maps; the other two differ in the number of
random runs."""
_READ = """
A run is **right** if it is trusted, and phi and u/a stay within 0.01 rad of theory (relative beyond 1 rad), and within
its tolerance if it has one. It is **refused** if it ends in an error that states the reason, and **doubted** if it
carries a warning, right or wrong. It is **silent** if it is trusted and wrong: there must be none. Two theories that
share no code judge a motion without damping; damped ones, liquids and attached cans have exact theory alone.
"""
"""How to read the tables of the search."""


def plan(extent: str) -> list[Check]:
    """Return all checks of a study of this extent, one of `EXTENTS`."""
    maps = stability_maps.checks(sample=extent in ("quick", "usual"))
    return maps if extent == "maps" else [*maps, *search.checks(extent)]


def conduct(folder: pathlib.Path, extent: str, console: Console) -> Study:
    """Measure what the study in `folder` lacks, on all cores, and return the study, kept as stability.jsonl.

    The summary of an earlier study is removed first.

    Raises:
      OutputError: if the folder cannot be written to.
      OSError: if the system ends one of the processes.
      ParameterError: if stability.jsonl is there but is not such a study.
    """
    (folder / "summary.md").unlink(missing_ok=True)
    return studies.run(plan(extent), console, folder / "stability.jsonl", COMMAND, {"extent": extent})


def tables(study: Study) -> list[Table]:
    """Return the tables for the terminal; that with a line a case appears only in the summary."""
    shown = [stability_maps.table(study.of(stability_maps.MAPS))]
    if study.of(search.RANDOM):
        shown += search.tables(search.totals(study.results), study.results)
    return shown


def to_json(study: Study) -> str:
    """Return the study as one JSON document: all results, and the totals of the search as numbers."""
    content = study.about | {"failed": [result.name for result in study.failed]}
    content |= {"totals": search.totals(study.results), "results": [result.as_json() for result in study.results]}
    return json.dumps(content) + "\n"


def write(study: Study, folder: pathlib.Path) -> None:
    """Write maps.json, totals.json, the plots of the maps, and at the end summary.md into a folder.

    Raises:
      OutputError: if a file cannot be written.
    """
    maps = stability_maps.to_json(study, datetime.date.today())
    files.write(folder / "maps.json", maps)
    totals = study.about | search.totals(study.results)
    files.write(folder / "totals.json", json.dumps(totals, indent=1) + "\n")
    count = len(study.failed)
    verdict = f"**{count} did not come out as they must.**" if count else "All came out as they must."
    lines = ["# mjbeer: stability", "", verdict, _READ]
    for name, draw in stability_maps.figures(json.loads(maps)).items():
        draw(folder / name)
        lines += [f"![{name}]({name}.svg)", "", stability_maps.FAMILIES[name.removeprefix("stability-")].caption, ""]
    known = [search.table_of_cases(study.of(search.KNOWN))] if study.of(search.KNOWN) else []
    lines += [table.markdown() for table in (*tables(study), *known)]
    files.write(folder / "summary.md", "\n".join(lines))
