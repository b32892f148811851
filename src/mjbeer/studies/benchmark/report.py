"""What the benchmark writes: the points as CSV, the diagram, and a summary with the tables."""

import pathlib

from mjbeer.output import files
from mjbeer.studies.benchmark import overview, plots, predicted, tables
from mjbeer.studies.benchmark.points import Benchmark

_READ = """
Run time is that of one warm call that returns 65 samples of 2.048 s of motion, in one thread: the least of the
repeats. Building models and compiling is in a column of its own (points.csv). Errors are against exact theory; `of
the model` is the error of the same model integrated to 1e-13 a step, which by itself leaves 1e-12 or so, and `of the
integrator` the distance of the run from that.
"""


def write(study: Benchmark, folder: pathlib.Path) -> None:
    """Write points.csv, the diagrams work_precision and overview (.svg and .png), and last summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "points.csv", study.csv())
    plots.draw(study, folder / "work_precision")
    overview.draw(study, folder / "overview")
    results = [*tables.tables(study), predicted.table()]
    versions = ", ".join(f"{name} {number}" for name, number in study.machine["versions"].items())
    lines = [
        "# mjbeer: error against run time", "",
        f"{study.machine['processor']}, {study.machine['system']}, Python {study.machine['python']}; {versions}.",
        *_absent(study), _READ, "![Work-precision diagram](work_precision.svg)", "",
        *(table.markdown() for table in results),
    ]  # fmt: skip
    files.write(folder / "summary.md", "\n".join(lines))


def _absent(study: Benchmark) -> list[str]:
    """Return a paragraph on the tools that could not be imported, a line each, or nothing if all could."""
    reasons = study.settings.get("absent", {})  # studies of earlier versions had all tools
    return ["", *(f"{name} is absent: {reason}" for name, reason in reasons.items())] if reasons else []
