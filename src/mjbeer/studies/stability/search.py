"""The search for runs that are wrong and do not say so: known cases and random ones, all before the same judge."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

from mjbeer.checks import Check, Result
from mjbeer.model.setting import supported
from mjbeer.output.terminal import Table
from mjbeer.studies.stability.judge import DOUBTED, JUDGES, REFUSED, RIGHT, SILENT, VERDICTS, judge
from mjbeer.studies.stability.known_cases import KnownCase, cases
from mjbeer.studies.stability.regions import REGIONS, random_trial
from mjbeer.theory.record import ERROR

KNOWN, RANDOM = "cases", "search"
"""The groups of a study with known and with random cases."""
SIZE = 4 * len(REGIONS)
"""Number of random runs in a batch, which takes some seconds."""
RUNS = {"quick": 250, "usual": 3000, "long": 20000}
"""Least number of random runs, by the extent of the study."""
NEEDLESS, ABOVE, TWICE = "doubted, yet right", "above its estimate", "above twice"
"""Counted besides: runs that warn although their samples are right, which is no fault where a can slips or would be
pulled; and trusted runs whose error is above what they admit, or above twice that."""
_ROUNDING = 1e-9
"""Errors below this [rad] are not above an estimate: a second run cannot see rounding."""
_RULE_OF_THREE = 3.0
"""-ln(0.05): where n runs had no fault, a share of faults above 3/n would have shown one with a probability of 95 %."""


def checks(extent: str, number: int = 0) -> list[Check]:
    """Return all known cases and the random ones from a `number` on; but for "long", cases have fewer variants."""
    why = "each ends as it must"
    found = [
        Check(KNOWN, each.name, partial(try_case, each, extent != "long"), bound=0, unit="runs", reason=why)
        for each in cases()
    ]
    for first in range(number, number + RUNS[extent], SIZE):
        name, reason = f"random runs {first} to {first + SIZE - 1}", "none is wrong and silent"
        found.append(Check(RANDOM, name, partial(batch, first), bound=0, unit="runs", reason=reason))
    return found


def try_case(case: KnownCase, quick: bool = False) -> dict[str, Any]:
    """Return how the variants of a known case ended, or a sample of them; "error" counts the wrong ends."""
    runs = []
    for each in case.variants:
        if not quick or len(case.variants) == 1 or each.trial.integrator in (None, "RK4"):
            outcome = judge(each.trial)
            good = outcome.verdict != SILENT and outcome.error <= each.within
            if not supported(each.trial.scene, each.trial.rolling):
                good = outcome.verdict == REFUSED
            runs.append({"setting": each.setting, "as it must": good} | asdict(outcome))
    return {"error": sum(not run["as it must"] for run in runs), "why": case.why, "runs": runs}


def batch(first: int, size: int = SIZE) -> dict[str, Any]:
    """Return how the random runs from the number `first` on ended; "error" counts those that are wrong and silent.

    "regions" and "kinds" have the counts by region, and by kind of model with what judged the runs; "silent" has all
    that is known of those that must not be.
    """
    regions = {region.name: Counter[str]() for region in REGIONS}
    kinds: dict[str, Counter[str]] = {}
    silent = []
    for number in range(first, first + size):
        trial, region = random_trial(number), REGIONS[number % len(REGIONS)].name
        outcome = judge(trial)
        trusted = outcome.verdict == RIGHT
        counted = {
            outcome.verdict: True,
            outcome.judged_by: True,
            NEEDLESS: outcome.verdict == DOUBTED and outcome.error <= ERROR,
            ABOVE: trusted and outcome.error > outcome.admitted + _ROUNDING,
            TWICE: trusted and outcome.error > 2 * outcome.admitted + _ROUNDING,
        }
        names = [name for name, holds in counted.items() if holds and name]
        regions[region].update(names)
        kinds.setdefault(trial.kind, Counter()).update(names)
        if outcome.verdict == SILENT:
            silent.append({"number": number, "region": region, **asdict(outcome), "trial": repr(trial)})
    counts = {"regions": regions, "kinds": kinds}
    plain = {name: {key: dict(count) for key, count in of.items()} for name, of in counts.items()}
    return {"error": len(silent), **plain, "silent": silent}


def totals(results: Iterable[Result]) -> dict[str, Any]:
    """Return the counts of a study's runs, as numbers: of known cases, by region, and by kind of model with all."""
    known, counted = Counter[str](), {"regions": dict[str, Counter[str]](), "kinds": dict[str, Counter[str]]()}
    for result in results:
        if result.group == KNOWN:
            known.update(run["verdict"] for run in result.values["runs"])
        for name, table in counted.items() if result.group == RANDOM else ():
            for key, counts in result.values[name].items():
                table.setdefault(key, Counter()).update(counts)
    kinds = dict(sorted(counted["kinds"].items()))
    counted["kinds"] = kinds | {"all": sum(kinds.values(), Counter())}
    return {"known": dict(known)} | {
        name: {key: dict(of) for key, of in each.items()} for name, each in counted.items()
    }


def bound(counts: dict[str, int]) -> float | None:
    """Return the largest share of silent runs that a count of 0 allows, at 95 %: 3/n; None if some were silent."""
    judged = sum(counts.get(verdict, 0) for verdict in (RIGHT, DOUBTED))
    return None if counts.get(SILENT) or not judged else _RULE_OF_THREE / judged


def tables(found: dict[str, Any], results: Sequence[Result] = ()) -> list[Table]:
    """Return the tables of a search from its totals: known cases, regions, kinds, and the silent runs of `results`."""
    by_region, by_kind = (*VERDICTS, NEEDLESS), (*VERDICTS, *JUDGES, ABOVE, TWICE)
    shares = ["-" if (share := bound(counts)) is None else f"{share:.1g}" for counts in found["kinds"].values()]
    kinds = [(*row, share) for row, share in zip(_rows(found["kinds"], by_kind), shares, strict=True)]
    last, silent = "share of silent runs below, at 95 %", [run for of in results for run in of.values.get("silent", ())]
    wrong = [(str(run["number"]), run["region"], f"{run['error']:.1e}", run["trial"]) for run in silent]
    made = [
        Table("Known cases", ("cases", "runs", *VERDICTS), _rows({"all": found["known"]}, VERDICTS)),
        Table("Random runs, by model and by what judged them", ("model", "runs", *by_kind, last), kinds),
        Table("Random runs, by region", ("region", "runs", *by_region), _rows(found["regions"], by_region)),
        Table("Silent runs, which must not be", ("number", "region", "error [rad]", "trial"), wrong, left=(0, 1, 3)),
    ]
    return [table for table in made if table.rows]


def _rows(counted: dict[str, dict[str, int]], columns: Sequence[str]) -> list[tuple[str, ...]]:
    """Return a row for each name: the number of its runs, and counts."""
    return [
        (name, str(sum(of.get(verdict, 0) for verdict in VERDICTS)), *(str(of.get(column, 0)) for column in columns))
        for name, of in counted.items()
    ]


def table_of_cases(results: Sequence[Result]) -> Table:
    """Return a table with a line a known case: how its runs ended, with the largest error of each way, and why."""
    rows = []
    for result in results:
        ended = []
        for verdict in VERDICTS:
            runs = [run for run in result.values["runs"] if run["verdict"] == verdict]
            errors = [run["error"] for run in runs if run["error"] not in (None, float("inf"))]
            ended.append(f"{len(runs)}" + (f" ({max(errors):.0e})" if errors else ""))
        rows.append((result.name, *ended, result.values["why"]))
    columns = ("case", *VERDICTS, "why it is one")
    return Table("Known cases: runs, and the largest error [rad]", columns, rows, left=(0, 5))
