"""Write the results of a benchmark: the points as CSV, the diagram, and a summary with the tables."""

import pathlib
from collections.abc import Sequence

from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies.benchmark import overview, plots, predicted, tables
from mjbeer.studies.benchmark.points import Benchmark

_NOTES = """
The run time is that of one call that returns 65 samples of 2.048 s of motion, in one thread and with warm caches: the
least of the rounds. The time to build and compile a model is not part of it; points.csv has it in a column of its own.
Errors are against exact theory. `of the model` is the error of the same model integrated to 1e-13 a step, which is
itself accurate to about 1e-12, and `of the integrator` is the distance of the run from that more exact one.
"""


def write(study: Benchmark, folder: pathlib.Path, further: Sequence[Table] = ()) -> None:
    """Write points.csv, the diagrams work_precision and overview (.svg and .png) and, as the last, summary.md.

    `further` tables, of other studies, are the last ones of the summary.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "points.csv", study.csv())
    plots.draw(study, folder / "work_precision")
    overview.draw(study, folder / "overview")
    results = [*tables.tables(study), predicted.table(), *further]
    versions = ", ".join(f"{name} {number}" for name, number in study.machine["versions"].items())
    lines = [
        "# mjbeer: error against run time",
        "",
        f"{study.machine['processor']}, {study.machine['system']}, Python {study.machine['python']}; {versions}.",
        *_absent(study),
        _NOTES,
        "![Work-precision diagram](work_precision.svg)",
        "",
        *(table.markdown() for table in results),
    ]
    files.write(folder / "summary.md", "\n".join(lines))


def _absent(study: Benchmark) -> list[str]:
    """Return a paragraph on the tools that could not be imported, a line each, or nothing if all could."""
    reasons = study.settings.get("absent", {})  # studies of earlier versions had all tools
    return ["", *(f"{name} is absent: {reason}" for name, reason in reasons.items())] if reasons else []
