"""A stability study as tables."""

import csv
import io
from collections import Counter
from typing import Any

from mjbeer.model.setting import ROLLINGS
from mjbeer.output.table import Table
from mjbeer.studies.stability import limits, maps
from mjbeer.studies.stability.outcome import ACCURATE, SILENT, VERDICTS
from mjbeer.studies.stability.run import Stability

_RUN = ("kind", "case", "setting", "verdict", "error", "admitted", "says", "expected", "as_expected")


def tables(found: Stability) -> list[Table]:
    """Return the tables for the terminal; those with a line for each case are only in the summary."""
    return [
        verdicts(found),
        laws(found),
        limits.table(found.of("limits")),
        maps.table(found.of("maps")),
        search(found),
        endurance(found),
    ]


def verdicts(found: Stability) -> Table:
    """Return how many runs ended in which way."""
    counts: dict[str, Counter[str]] = {}
    for case in found.of("catalogue"):
        counts.setdefault(case["kind"], Counter()).update(run["verdict"] for run in case["runs"])
    for batch in found.of("search"):
        counts.setdefault("random", Counter()).update(batch["verdicts"])
    rows = [(kind, *(str(count[verdict]) for verdict in VERDICTS)) for kind, count in counts.items()]
    return Table("How runs ended", ("cases", *VERDICTS), rows)


def catalogue(found: Stability) -> Table:
    """Return a line a case: what came of it in each way of rolling."""
    rows = []
    for case in found.of("catalogue"):
        runs = {way: [run for run in case["runs"] if run["setting"].startswith(way)] for way in ROLLINGS}
        rows.append((f"{case['kind']}: {case['name']}", *(_summary(runs[way]) for way in ROLLINGS)))
    return Table("Stiff and extreme cases: runs, and the largest error [rad]", ("case", *ROLLINGS), rows)


def reasons(found: Stability) -> Table:
    """Return a line a case: why it is one, and what theory expects."""
    rows = [(case["name"], case["why"], case["theory"]) for case in found.of("catalogue")]
    return Table("Why they are stiff or extreme", ("case", "why", "what theory expects"), rows)


def _summary(runs: list[dict[str, Any]]) -> str:
    parts = []
    for verdict in VERDICTS:
        those = [run for run in runs if run["verdict"] == verdict]
        if those:
            errors = [run["error"] for run in those if run["error"] is not None]
            worst = f" ({max(errors):.0e})" if errors else ""
            parts.append(f"{len(those)} {verdict if verdict != ACCURATE else 'accurate'}{worst}")
    odd = sum(not run["as_expected"] for run in runs)
    return ", ".join(parts) + (f"; {odd} UNEXPECTED" if odd else "")


def search(found: Stability) -> Table:
    """Return what the random search found."""
    batches = found.of("search")
    total = Counter[str]()
    for batch in batches:
        total.update(batch["verdicts"])
    over = [run for batch in batches for run in batch["overconfident"]]
    worst = max((run["error"] for run in over), default=0.0)
    rows = [
        ("runs", str(sum(total[verdict] for verdict in VERDICTS))),
        *((verdict, str(total[verdict])) for verdict in VERDICTS),
        ("accurate, but flagged by their own diagnostics", str(sum(batch["flagged"] for batch in batches))),
        ("trusted with more of an error than they admit", f"{len(over)} (largest error {worst:.0e} rad)"),
    ]
    rows += [(f"{SILENT}: seed {batch['seed']}", run["trial"]) for batch in batches for run in batch["silent"]]
    return Table("Random search", ("", "runs"), rows)


def endurance(found: Stability) -> Table:
    """Return how energy drifts over many swings."""
    rows = []
    for each in found.of("endurance"):
        exponent = "-" if each["exponent"] is None else f"{each['exponent']:.3f}"
        end = each["width"][-1] if each["law"] == "bounded" else abs(each["drift"][-1])
        share = "-"
        if "predicted_per_swing" in each and each["expected"] == "linear":
            share = f"{each['measured_per_swing']:.4e}, {each['predicted_per_swing']:.4e}"
        law = str(each["law"]) + ("" if each["as_expected"] else f" (expected: {each['expected']})")
        setting = f"{each['name']}, {each['integrator']}, T/{each['steps']}"
        rows.append((setting, f"{each['swings']:,}", f"{end:.1e}", exponent, law, share))
    heads = ("swing of 1 rad", "swings", "drift at the end", "exponent", "law", "share a swing: measured, theory")
    return Table("Drift of the swing's energy, as a share of it", heads, rows)


def laws(found: Stability) -> Table:
    """Return the laws towards the extremes, with their errors and bounds."""
    rows = [
        (law["quantity"], law["by"], f"{law['error']:.1e}", f"{law['bound']:.0e} {law['unit']}".strip())
        for law in found.of("laws")
    ]
    return Table("Laws towards the extremes", ("law", "by", "error", "at most"), rows)


def runs(found: Stability) -> str:
    """Return every run of the catalogue as CSV."""
    text = io.StringIO()
    writer = csv.DictWriter(text, _RUN, lineterminator="\n")
    writer.writeheader()
    for case in found.of("catalogue"):
        for run in case["runs"]:
            about = {"kind": case["kind"], "case": case["name"], "expected": " or ".join(run["expected"])}
            writer.writerow({**run, **about})
    return text.getvalue()
