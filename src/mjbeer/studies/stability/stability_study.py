"""The stability study: maps with the borders of linear theory, and a search for runs that are wrong and silent.

The search makes known cases and random ones, and all come before the same judge.
"""

import datetime
import json
import math
import pathlib
import secrets
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from decimal import ROUND_CEILING, Context
from functools import partial
from typing import Any

from rich.console import Console

from mjbeer.checks.as_json import document
from mjbeer.checks.check import Check, Result
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import supported
from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies import study as studies
from mjbeer.studies.stability import stability_maps
from mjbeer.studies.stability.judge import DOUBTED, JUDGES, REFUSED, RIGHT, SILENT, VERDICTS, judge
from mjbeer.studies.stability.known_cases import KnownCase, cases
from mjbeer.studies.stability.regions import REGIONS, random_trial
from mjbeer.studies.study import Study
from mjbeer.theory.record import ERROR

COMMAND = "mjbeer stability"
UNFINISHED, FINISHED = "unfinished.jsonl", "stability.jsonl"
"""Files that have the study while it is measured, and when it is whole."""
KNOWN, RANDOM = "cases", "search"
"""The groups of a study with known and with random cases."""
OUTSIDE = "outside the domain"
"""The kind of random trials whose scene, start or timestep the domain refuses, so that there is no model of them."""
SIZE = 4 * len(REGIONS)
"""Number of random runs in a batch, which takes some seconds."""
RUNS, FEW_RUNS = 3000, 250
"""Least number of random runs in a study and in a quick one."""
NEEDLESS, ABOVE, TWICE = "doubted, yet right", "above its estimate", "above twice"
"""Counted besides: runs that warn although their samples are right, which is no fault where a can slips or would be
pulled; and trusted runs whose error is above what they admit, or above twice that."""
_RULE_OF_THREE = 3.0
"""-ln(0.05): where n runs had no fault, a share of faults above 3/n would have shown one with a probability of 95 %."""
FIRST = "first random run"
"""The setting of a study that has the number of its first random run."""
_SEEDS = 10**9
"""Number of random runs among which a study draws its first one: development has seen next to none of them."""
_READ = """
A run is **right** if it is trusted, and phi and u/a stay within 0.01 rad of theory (relative beyond 1 rad), and within
its tolerance if it has one. It is **refused** if it ends in an error that states the reason, also if its scene is
outside the domain, and **doubted** if it carries a warning, right or wrong. It is **silent** if it is trusted and
wrong: there must be none. Two theories that share no code judge a motion without damping; damped ones, liquids and
attached cans have exact theory alone.
"""
"""How to read the tables of the search."""


def plan(quick: bool, first: int) -> list[Check]:
    """Return all checks of a study with random runs from the number `first` on.

    A `quick` study has coarser maps, and fewer random runs.
    """
    known = [
        Check(KNOWN, each.name, partial(try_case, each), bound=0, unit="runs", reason="each ends as it must")
        for each in cases()
    ]
    cells, runs = (stability_maps.FEW_CELLS, FEW_RUNS) if quick else (stability_maps.CELLS, RUNS)
    return [*stability_maps.checks(cells), *known, *random_checks(runs, first)]


def random_checks(runs: int, number: int) -> list[Check]:
    """Return the checks of at least so many random runs, from a `number` on."""
    named = {first: f"random runs {first} to {first + SIZE - 1}" for first in range(number, number + runs, SIZE)}
    reason = "none is wrong and silent"
    return [Check(RANDOM, name, partial(batch, first), "", 0, "runs", reason) for first, name in named.items()]


def try_case(case: KnownCase) -> dict[str, Any]:
    """Return how the variants of a known case ended; "error" counts the wrong ends."""
    runs = []
    for each in case.variants:
        outcome = judge(each.trial)
        good = outcome.verdict != SILENT and outcome.error <= each.within
        if not supported(each.trial.scene, each.trial.rolling):
            good = outcome.verdict == REFUSED
        runs.append({"setting": each.setting, "as it must": good} | asdict(outcome))
    return {"error": sum(not run["as it must"] for run in runs), "why": case.why, "runs": runs}


def batch(first: int, size: int = SIZE) -> dict[str, Any]:
    """Return how the random runs from the number `first` on ended; "error" counts those that are wrong and silent.

    "kinds" has the counts by kind of model, with what judged the runs, and counts those `OUTSIDE` the domain as
    refused; "silent" has all that is known of those that must not be.
    """
    kinds: dict[str, Counter[str]] = {}
    silent = []
    for number in range(first, first + size):
        try:
            trial = random_trial(number)
        except ParameterError:
            kinds.setdefault(OUTSIDE, Counter())[REFUSED] += 1
            continue
        outcome = judge(trial)
        trusted = outcome.verdict == RIGHT
        counted = {
            outcome.verdict: True,
            outcome.judged_by: True,
            NEEDLESS: outcome.verdict == DOUBTED and outcome.error <= ERROR,
            ABOVE: trusted and outcome.error > outcome.admitted,
            TWICE: trusted and outcome.error > 2 * outcome.admitted,
        }
        kinds.setdefault(trial.kind, Counter()).update(name for name, holds in counted.items() if holds and name)
        if outcome.verdict == SILENT:
            region = REGIONS[number % len(REGIONS)].name
            silent.append({"number": number, "region": region, **asdict(outcome), "trial": repr(trial)})
    return {"error": len(silent), "kinds": {kind: dict(of) for kind, of in kinds.items()}, "silent": silent}


def totals(results: Iterable[Result]) -> dict[str, Any]:
    """Return the counts of a study's runs, as numbers: of known cases, and of random ones by kind of model and all."""
    known, kinds = Counter[str](), dict[str, Counter[str]]()
    for result in results:
        if result.group == KNOWN:
            known.update(run["verdict"] for run in result.values["runs"])
        elif result.group == RANDOM:
            for kind, counts in result.values["kinds"].items():
                kinds.setdefault(kind, Counter()).update(counts)
    ordered = dict(sorted(kinds.items())) | {"all": sum(kinds.values(), Counter())}
    return {"known": dict(known), "kinds": {kind: dict(of) for kind, of in ordered.items()}}


def bound(counts: dict[str, int]) -> float | None:
    """Return an upper bound, at 95 % confidence, of the share of trusted runs that are silent: 3/n of n trusted runs.

    None if some run was silent, or none was trusted.
    """
    trusted = counts.get(RIGHT, 0)
    if counts.get(SILENT) or not trusted:
        return None
    return _RULE_OF_THREE / trusted


def rounded_up(share: float) -> str:
    """Return an upper bound of a share with two digits, rounded up: rounded down, it would claim too much."""
    return f"{Context(prec=2, rounding=ROUND_CEILING).create_decimal(share):f}"


def search_tables(found: dict[str, Any], results: Sequence[Result] = ()) -> list[Table]:
    """Return the tables of a search from its totals: known cases, random ones, and the silent runs of `results`."""
    columns, last = (*VERDICTS, *JUDGES, NEEDLESS, ABOVE, TWICE), "silent share of trusted runs at most, at 95 %"
    kinds = []
    for name, counts in found["kinds"].items():
        runs, share = sum(counts.get(verdict, 0) for verdict in VERDICTS), bound(counts)
        cells = (str(counts.get(column, 0)) for column in columns)
        kinds.append((name, str(runs), *cells, "-" if share is None else rounded_up(share)))
    silent = [run for of in results for run in of.values.get("silent", ())]
    wrong = [(str(run["number"]), run["region"], f"{run['error']:.1e}", run["trial"]) for run in silent]
    known = ("all", str(sum(found["known"].values())), *(str(found["known"].get(verdict, 0)) for verdict in VERDICTS))
    made = [
        Table("Known cases", ("cases", "runs", *VERDICTS), [known]),
        Table("Random runs, by model and by what judged them", ("model", "runs", *columns, last), kinds),
        Table("Silent runs, which must not be", ("number", "region", "error [rad]", "trial"), wrong, left=(0, 1, 3)),
    ]
    return [table for table in made if table.rows]


def _table_of_cases(results: Sequence[Result]) -> Table:
    """Return a table with a line a known case: how its runs ended, with the largest error of each way, and why."""
    rows = []
    for result in results:
        ended = []
        for verdict in VERDICTS:
            runs = [run for run in result.values["runs"] if run["verdict"] == verdict]
            errors = [run["error"] for run in runs if run["error"] not in (None, math.inf)]
            ended.append(f"{len(runs)}" + (f" ({max(errors):.0e})" if errors else ""))
        rows.append((result.name, *ended, result.values["why"]))
    columns = ("case", *VERDICTS, "why it is one")
    return Table("Known cases: runs, and the largest error [rad]", columns, rows, left=(0, 5))


def conduct(folder: pathlib.Path, quick: bool, console: Console) -> Study:
    """Measure what the study in `folder` lacks, on all cores, and return the study, kept as unfinished.jsonl.

    Its random runs are fresh: the number of the first one is drawn when the study begins, and kept in its settings.

    Raises:
      OutputError: if the folder cannot be written to.
      OSError: if the system ends one of the processes.
      ParameterError: if unfinished.jsonl or stability.jsonl is there but is not such a study.
    """
    settings = {"quick": quick, FIRST: secrets.randbelow(_SEEDS)}
    for name in (UNFINISHED, FINISHED):
        path = folder / name
        if path.exists():
            begun = Study.load(path, COMMAND).settings
            if begun.get("quick") == quick:
                settings |= begun
            break
    checks = plan(quick, settings[FIRST])
    return studies.run(checks, console, folder / UNFINISHED, COMMAND, settings, finished=folder / FINISHED)


def tables(study: Study) -> list[Table]:
    """Return the tables for the terminal; that with a line a case appears only in the summary."""
    maps = stability_maps.table(study.of(stability_maps.MAPS))
    return [maps, *search_tables(totals(study.results), study.results)]


def to_json(study: Study) -> str:
    """Return the study as one JSON document: all results, and the totals of the search as numbers."""
    content = study.about | {"failed": [result.name for result in study.failed]}
    content |= {"totals": totals(study.results), "results": [result.as_json() for result in study.results]}
    return json.dumps(content) + "\n"


def write(study: Study, folder: pathlib.Path) -> None:
    """Write stability.jsonl, maps.json, totals.json, the plots of the maps, and summary.md into a folder.

    Raises:
      OutputError: if a file cannot be written.
    """
    study.save(folder / FINISHED)
    maps = ({"name": of.name, "worst": of.error, **of.values} for of in study.of(stability_maps.MAPS))
    dated = study.about | {"date": datetime.date.today().isoformat()}
    files.write(folder / "maps.json", document(dated, stability_maps.MAPS, maps))
    files.write(folder / "totals.json", json.dumps(study.about | totals(study.results), indent=1) + "\n")
    count = len(study.failed)
    verdict = f"**{count} did not come out as they must.**" if count else "All came out as they must."
    lines = ["# mjbeer: stability", "", verdict, _READ]
    for name, draw in stability_maps.figures(stability_maps.load(folder / "maps.json")).items():
        draw(folder / name)
        lines += [f"![{name}]({name}.svg)", "", stability_maps.FAMILIES[name.removeprefix("stability-")].caption, ""]
    lines += [table.markdown() for table in (*tables(study), _table_of_cases(study.of(KNOWN)))]
    files.write(folder / "summary.md", "\n".join(lines))
