"""Writes the stability study: its runs as CSV, its plots, and a summary with the tables."""

import datetime
import pathlib

from mjbeer.output import files
from mjbeer.studies.stability import damped_maps, damped_plots, plots, stored, tables
from mjbeer.studies.stability.run import Stability

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
_ENDURANCE = (
    "stability-endurance: energy drifts with the number of swings by laws that theory gives. It stays within bounds "
    "where semi-implicit Euler is symplectic. Where each step loses a share of it, even if only because coefficients "
    "are rounded, the drift grows in proportion to the number of swings."
)
"""Name and caption of the plot of endurance."""


def write(study: Stability, folder: pathlib.Path) -> None:
    """Write runs.csv, maps.json, the plots, and at the end summary.md into a folder.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "runs.csv", tables.runs(study))
    files.write(folder / "maps.json", stored.to_json(study, datetime.date.today()))
    pictures = plots.draw(study.of("limits"), study.of("maps"), folder)
    if study.of(damped_maps.GROUP):
        pictures.append(damped_plots.draw(study.of(damped_maps.GROUP), folder))
    if study.of("endurance"):
        plots.draw_endurance(study.of("endurance"), folder / "stability-endurance")
        pictures.append(_ENDURANCE)
    lines = ["# mjbeer: stability", "", f"{_verdict(study)}", _READ]
    first, *others = tables.tables(study)
    lines += [first.markdown()]
    for name, caption in (picture.split(": ", 1) for picture in pictures):
        lines += [f"![{name}]({name}.svg)", "", f"{caption[0].upper()}{caption[1:]}", ""]
    others += [table for table in (tables.catalogue(study), tables.reasons(study)) if table.rows]
    lines += [table.markdown() for table in others]
    files.write(folder / "summary.md", "\n".join(lines))


def _verdict(study: Stability) -> str:
    """Return a sentence on whether the results are what theory expects."""
    count = len(study.unexpected)
    return "All came out as theory expects." if not count else f"**{count} did not come out as theory expects.**"
