"""The search for runs that are wrong and do not say so: known cases and random ones, all before the same judge."""

import dataclasses
import math
import warnings
from collections import Counter, defaultdict
from collections.abc import Sequence
from functools import partial
from typing import Any

from mjbeer.model.setting import ROLLINGS
from mjbeer.output.terminal import Table
from mjbeer.studies.rows import Result, Row
from mjbeer.studies.stability.judge import ALARMS, FALSE, NEVER, REFUSED, VERDICTS, alarm, judge
from mjbeer.studies.stability.known_cases import Case, cases
from mjbeer.studies.stability.random_trials import REGIONS, random_trial

KNOWN, RANDOM = "cases", "search"
"""The groups of a study with known and with random cases."""
SIZE = 4 * len(REGIONS)
"""Number of random runs in a batch, which takes some seconds."""
RUNS = {"quick": 250, "usual": 3000, "long": 20000}
"""Least number of random runs, by the extent of the study."""
SMALL = 1e-4
"""Error [rad] below which there should be no false alarm at all: a hundredth of what is trusted."""
_SMALL_FALSE = f"{FALSE}, error below {SMALL:g}"
_ALONE = "judged by one theory alone"
"""Counted for runs that exact theory refuses to follow, or that are damped, which the reference cannot; they end in
other ways too."""
_ROUNDING = 1e-9
"""Errors below this [rad] do not count as overconfident: a second run at half the timestep cannot see rounding."""
_COLUMNS = {**VERDICTS, **ALARMS, _SMALL_FALSE: f"below {SMALL:g}", _ALONE: "one theory"}
"""What is counted, and the heading of its column. From the false alarms on, the runs are among the accurate ones."""


def rows(extent: str, number: int = 0) -> list[Row]:
    """Return all known cases and the random ones from a `number` on; but for a "long" study, cases have fewer tries."""
    found = []
    for each in cases():
        measured, reason = partial(try_case, each, extent != "long"), "each ends as theory allows"
        found.append(Row(KNOWN, f"{each.kind}: {each.name}", measured, bound=0, unit="runs", reason=reason))
    for first in range(number, number + RUNS[extent], SIZE):
        name, reason = f"random runs {first} to {first + SIZE - 1}", "none is wrong and silent, and theories agree"
        found.append(Row(RANDOM, name, partial(batch, first), bound=0, unit="runs", reason=reason))
    return found


def try_case(case: Case, quick: bool = False) -> dict[str, Any]:
    """Return how the tries of a known case ended, or those of a sample; "error" counts those that should not end so."""
    runs = []
    for each in case.tries:
        if each.sample or not quick:
            outcome = judge(each.trial.simulate)
            allowed = outcome.verdict in each.expected if each.expected else outcome.verdict not in NEVER
            allowed = allowed and (outcome.error is None or outcome.error <= each.within)
            about = {"setting": each.setting, "expected": list(each.expected), "as_expected": allowed}
            runs.append(about | dataclasses.asdict(outcome))
    return {"error": sum(not run["as_expected"] for run in runs), "why": case.why, "runs": runs}


def batch(first: int, size: int = SIZE) -> dict[str, Any]:
    """Return how the random runs from the number `first` on ended; "error" counts those that must not be.

    "regions" has the counts by region, "false alarms" and "refusals" those by message. "never" has all that is known of
    the runs that must not be, "overconfident" of trusted runs that are accurate, but less so than their own diagnostics
    say, and "needless" of those with a false alarm although their error is small.
    """
    regions = {region.name: Counter[str]() for region in REGIONS}
    alarms, refusals = Counter[str](), Counter[str]()
    kept: dict[str, list[dict[str, Any]]] = {"never": [], "overconfident": [], "needless": []}
    for number in range(first, first + size):
        trial, region = random_trial(number), REGIONS[number % len(REGIONS)].name
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # MuJoCo's and the run's own; all that counts is in its record
            outcome = judge(trial.simulate)
            kind, error = alarm(trial, outcome)
        small = kind == FALSE and error < SMALL
        alone = outcome.error is not None and outcome.apart is None
        counted = {outcome.verdict: True, kind: kind != "", _SMALL_FALSE: small, _ALONE: alone}
        regions[region].update(name for name, holds in counted.items() if holds)
        if kind == FALSE:
            alarms.update(outcome.alarms)
        if outcome.verdict == REFUSED:
            refusals.update(outcome.alarms)
        about = {"number": number, "region": region, **dataclasses.asdict(outcome), "call": f"{trial!r}.simulate()"}
        if outcome.verdict in NEVER:
            kept["never"].append(about)
        elif not outcome.says and (outcome.error or 0) > (outcome.admitted or 0) + _ROUNDING:
            kept["overconfident"].append(about)
        elif small:
            kept["needless"].append(about)
    by_region = {"regions": {name: dict(counts) for name, counts in regions.items()}}
    return {"error": len(kept["never"]), **by_region, "false alarms": dict(alarms), "refusals": dict(refusals), **kept}


def tables(results: Sequence[Result]) -> list[Table]:
    """Return the tables of a search: how runs ended, the random ones by region and message, and what must not be."""
    known, batches = ([of for of in results if of.group == group] for group in (KNOWN, RANDOM))
    kinds, regions = defaultdict[str, Counter[str]](Counter), defaultdict[str, Counter[str]](Counter)
    for case in known:
        kinds[case.name.partition(":")[0]].update(run["verdict"] for run in case.values["runs"])
    for name, counts in (pair for of in batches for pair in of.values["regions"].items()):
        regions[name].update(counts)
    if regions:
        kinds["random"] = regions["all"] = sum(regions.values(), Counter[str]())
    ended = [(kind, *(str(count[verdict]) for verdict in VERDICTS)) for kind, count in kinds.items()]
    by_region = [
        (name, str(sum(counts[verdict] for verdict in VERDICTS)), *(str(counts[key]) for key in _COLUMNS))
        for name, counts in regions.items()
    ]

    def messages(kind: str) -> list[tuple[str, ...]]:
        total = sum((Counter[str](of.values[kind]) for of in batches), Counter[str]())
        return [(message, str(count)) for message, count in total.most_common()]

    def listed(kind: str) -> list[tuple[str, ...]]:
        runs = [run | {"size": f"{run['error'] or math.nan:.1e}"} for of in batches for run in of.values[kind]]
        return [tuple(str(run[name]) for name in ("verdict", "region", "number", "size", "call")) for run in runs]

    never = ("verdict", "region", "number", "error [rad]", "call")
    found = [
        Table("How runs ended", ("cases", *VERDICTS), ended),
        Table("Random runs, by region", ("region", "runs", *_COLUMNS.values()), by_region),
        Table("False alarms, by warning", ("message", "runs"), messages("false alarms")),
        Table("Refusals, by message", ("message", "runs"), messages("refusals")),
        Table("Trusted, accurate, but with larger errors than they admit", never, listed("overconfident"), (0, 1, 4)),
        Table("Runs that must not be", never, listed("never"), left=(0, 1, 4)),
    ]
    return [table for table in found if table.rows]


def table_of_cases(results: Sequence[Result]) -> Table:
    """Return a table with a line a known case: how its runs ended, by way of rolling, and why it is a case."""
    rows = []
    for result in results:
        ways = ([run for run in result.values["runs"] if run["setting"].startswith(way)] for way in ROLLINGS)
        rows.append((result.name, *map(_summary, ways), result.values["why"]))
    title, columns = "Known cases: runs, and the largest error [rad]", ("case", *ROLLINGS, "why it is one")
    return Table(title, columns, rows, left=(0, 4))


def _summary(runs: list[dict[str, Any]]) -> str:
    """Return how many runs ended in which way, with their largest errors, and how many are unexpected."""
    parts = []
    for verdict in VERDICTS:
        matching = [run for run in runs if run["verdict"] == verdict]
        if matching:
            errors = [run["error"] for run in matching if run["error"] is not None]
            worst = f" ({max(errors):.0e})" if errors else ""
            parts.append(f"{len(matching)} {verdict.removeprefix('stable and ')}{worst}")
    unexpected = sum(not run["as_expected"] for run in runs)
    return ", ".join(parts) + (f"; {unexpected} UNEXPECTED" if unexpected else "")
