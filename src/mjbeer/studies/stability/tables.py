"""The results of a stability study as tables, and its runs as CSV."""

import csv
import io
from collections import Counter
from typing import Any

from mjbeer.model.setting import ROLLINGS
from mjbeer.output.terminal import Table
from mjbeer.studies.stability import damped_maps, limits, maps
from mjbeer.studies.stability.outcome import ACCURATE, VERDICTS
from mjbeer.studies.stability.run import Stability
from mjbeer.studies.stability.search import tables as search

_RUN = ("kind", "case", "setting", "verdict", "error", "admitted", "says", "expected", "as_expected")
"""Columns of the CSV file."""


def tables(study: Stability) -> list[Table]:
    """Return the tables for the terminal that have a row; those with a line a case appear only in the summary."""
    shown = (
        verdicts(study),
        laws(study),
        limits.table(study.of("limits")),
        maps.table(study.of("maps")),
        damped_maps.table(study.of(damped_maps.GROUP)),
        *search.tables(study.of("search")),
        endurance(study),
    )
    return [table for table in shown if table.rows]


def verdicts(study: Stability) -> Table:
    """Return a table of how many runs ended in which way."""
    counts: dict[str, Counter[str]] = {}
    for case in study.of("catalogue"):
        counts.setdefault(case["kind"], Counter()).update(run["verdict"] for run in case["runs"])
    for batch in study.of("search"):
        for region in batch["regions"].values():
            counts.setdefault("random", Counter()).update(region)
    rows = [(kind, *(str(count[verdict]) for verdict in VERDICTS)) for kind, count in counts.items()]
    return Table("How runs ended", ("cases", *VERDICTS), rows)


def catalogue(study: Stability) -> Table:
    """Return a table with a line a case: how its runs ended, for result way of rolling."""
    rows = []
    for case in study.of("catalogue"):
        runs = {way: [run for run in case["runs"] if run["setting"].startswith(way)] for way in ROLLINGS}
        rows.append((f"{case['kind']}: {case['name']}", *(_summary(runs[way]) for way in ROLLINGS)))
    return Table("Stiff and extreme cases: runs, and the largest error [rad]", ("case", *ROLLINGS), rows)


def reasons(study: Stability) -> Table:
    """Return a table with a line a case: why it is stiff or extreme, and what theory expects."""
    rows = [(case["name"], case["why"], case["theory"]) for case in study.of("catalogue")]
    return Table("Why they are stiff or extreme", ("case", "why", "what theory expects"), rows)


def _summary(runs: list[dict[str, Any]]) -> str:
    """Return how many runs ended in which way, with their largest errors, and how many are unexpected."""
    parts = []
    for verdict in VERDICTS:
        matching = [run for run in runs if run["verdict"] == verdict]
        if matching:
            errors = [run["error"] for run in matching if run["error"] is not None]
            worst = f" ({max(errors):.0e})" if errors else ""
            parts.append(f"{len(matching)} {verdict if verdict != ACCURATE else 'accurate'}{worst}")
    unexpected = sum(not run["as_expected"] for run in runs)
    return ", ".join(parts) + (f"; {unexpected} UNEXPECTED" if unexpected else "")


def endurance(study: Stability) -> Table:
    """Return a table of how energy drifts over many swings."""
    rows = []
    for result in study.of("endurance"):
        exponent = "-" if result["exponent"] is None else f"{result['exponent']:.3f}"
        end = result["width"][-1] if result["law"] == "bounded" else abs(result["drift"][-1])
        share = "-"
        if "predicted_per_swing" in result and result["expected"] == "linear":
            share = f"{result['measured_per_swing']:.4e}, {result['predicted_per_swing']:.4e}"
        law = str(result["law"]) + ("" if result["as_expected"] else f" (expected: {result['expected']})")
        setting = f"{result['name']}, {result['integrator']}, T/{result['steps']}"
        rows.append((setting, f"{result['swings']:,}", f"{end:.1e}", exponent, law, share))
    heads = ("swing of 1 rad", "swings", "drift at the end", "exponent", "law", "share a swing: measured, theory")
    return Table("Drift of the swing's energy, as a share of it", heads, rows)


def laws(study: Stability) -> Table:
    """Return a table of the laws near the extremes, with their errors and bounds."""
    rows = [
        (law["quantity"], law["by"], f"{law['error']:.1e}", f"{law['bound']:.0e} {law['unit']}".strip())
        for law in study.of("laws")
    ]
    return Table("Laws towards the extremes", ("law", "by", "error", "at most"), rows)


def runs(study: Stability) -> str:
    """Return every run of the catalogue as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, _RUN, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    for case in study.of("catalogue"):
        for run in case["runs"]:
            about = {"kind": case["kind"], "case": case["name"], "expected": " or ".join(run["expected"])}
            writer.writerow({**run, **about})
    return text.getvalue()
