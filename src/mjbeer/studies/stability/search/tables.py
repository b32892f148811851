"""The results of the search as tables: by region, by warning, and the runs that must not be."""

from collections import Counter
from typing import Any

from mjbeer.output.terminal import Table
from mjbeer.studies.stability.outcome import (
    ACCURATE,
    INACCURATE,
    MISSED,
    REFUSED,
    SILENT,
    THEORIES,
    UNKNOWN,
    UNSTABLE,
    VERDICTS,
)
from mjbeer.studies.stability.search.batches import ALONE, SMALL_FALSE
from mjbeer.studies.stability.search.check import FALSE, PARTS, SENSITIVE, SMALL, WAY

_COLUMNS = {
    REFUSED: "refused",
    UNSTABLE: "unstable",
    ACCURATE: "accurate",
    INACCURATE: "inaccurate",
    SILENT: "silent",
    MISSED: "missed",
    THEORIES: "theories",
    UNKNOWN: "beyond",
    FALSE: "false alarms",
    SMALL_FALSE: f"below {SMALL:g}",
    PARTS: "slip or lift",
    WAY: "way",
    SENSITIVE: "sensitive",
    ALONE: "one theory",
}
"""What is counted, and the heading of its column. From the false alarms on, the runs are among the accurate ones."""


def tables(batches: list[dict[str, Any]]) -> list[Table]:
    """Return the tables; but for the one by region, they are left out where there is nothing to show."""
    return [
        by_region(batches),
        *by_message("False alarms, by warning", "false alarms", batches),
        *by_message("Refusals, by message", "refusals", batches),
        *overconfident(batches),
        *never(batches),
    ]


def by_region(batches: list[dict[str, Any]]) -> Table:
    """Return a table of how the runs of each region ended."""
    regions: dict[str, Counter[str]] = {}
    for batch in batches:
        for name, counts in batch["regions"].items():
            regions.setdefault(name, Counter()).update(counts)
    if regions:
        regions["all"] = sum(regions.values(), Counter[str]())
    rows = [
        (name, str(sum(counts[verdict] for verdict in VERDICTS)), *(str(counts[key]) for key in _COLUMNS))
        for name, counts in regions.items()
    ]
    return Table("Random runs, by region", ("region", "runs", *_COLUMNS.values()), rows)


def by_message(title: str, kind: str, batches: list[dict[str, Any]]) -> list[Table]:
    """Return a table of how often a message of a kind came, if it did at all."""
    total = Counter[str]()
    for batch in batches:
        total.update(batch[kind])
    rows = [(message, str(count)) for message, count in total.most_common()]
    return [Table(title, ("message", "runs"), rows)] if rows else []


def overconfident(batches: list[dict[str, Any]]) -> list[Table]:
    """Return a table of how many trusted runs have a larger error than they admit, if there are any."""
    runs = [run for batch in batches for run in batch["overconfident"]]
    if not runs:
        return []
    worst = max(run["error"] for run in runs)
    rows = [
        ("trusted, accurate, but with a larger error than their diagnostics allow for", str(len(runs)), f"{worst:.0e}")
    ]
    return [Table("Overconfident runs", ("", "runs", "largest error [rad]"), rows)]


def never(batches: list[dict[str, Any]]) -> list[Table]:
    """Return a table of the runs that must not be, each with the call that repeats it, if there are any."""
    rows = [
        (run["verdict"], run["region"], str(run["number"]), f"{run['error'] or float('nan'):.1e}", run["call"])
        for batch in batches
        for run in batch["never"]
    ]
    columns = ("verdict", "region", "number", "error [rad]", "call")
    return [Table("Runs that must not be", columns, rows, left=(0, 1, 4))] if rows else []
