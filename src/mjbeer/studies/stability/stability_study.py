"""The stability study: maps with the borders of linear theory, and a search for silent runs.

The search runs known cases and random ones. The same judge decides how each run ended.
"""

import datetime
import json
import math
import pathlib
import secrets
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from decimal import ROUND_CEILING, Context
from functools import partial
from typing import NamedTuple

from rich.console import Console
from scipy.stats import binomtest

from mjbeer.checks.as_json import document
from mjbeer.checks.check import Check, Measured, Result
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import supported
from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies import study as studies
from mjbeer.studies.stability import map_plots, stability_maps
from mjbeer.studies.stability.endings import BatchEndings, KnownEndings, KnownRun, SilentRun
from mjbeer.studies.stability.judge import (
    JUDGES,
    REFUSED,
    RIGHT,
    UNDETECTED_ERROR,
    VERDICTS,
    WARNED,
    Outcome,
    judge,
)
from mjbeer.studies.stability.known_cases import KnownCase, cases
from mjbeer.studies.stability.regions import REGIONS, random_trial
from mjbeer.studies.study import Study
from mjbeer.theory.record import ERROR

COMMAND = "mjbeer stability"
UNFINISHED = "unfinished.jsonl"
"""Name of the file of a study that is being measured."""
FINISHED = "stability.jsonl"
"""Name of the file of a study that is complete."""
KNOWN = "cases"
"""The group of the known cases in a study."""
RANDOM = "search"
"""The group of the random runs in a study."""
OUTSIDE = "outside the domain"
"""The kind of the random trials that are refused before they have a model."""
SIZE = 4 * len(REGIONS)
"""Number of random runs in a batch, which takes some seconds."""
RUNS = 3000
"""Least number of random runs in a study."""
FEW_RUNS = 250
"""The same in a quick study."""
NEEDLESS = "doubted, yet right"
"""The name under which runs are counted that warn although their samples are right.

It is no fault to warn where the can slips, or where the incline would have to pull it.
"""
ABOVE = "above its estimate"
"""The name for trusted runs whose error exceeds their own estimate."""
TWICE = "above twice"
"""The name for trusted runs whose error exceeds twice their own estimate."""
CONFIDENCE = 0.95
"""Confidence of the bound on the share of silent runs."""
FIRST = "first random run"
"""The key, in the settings of a study, of the number of its first random run."""
_SEEDS = 10**9
"""A study draws the number of its first random run below this; development has seen few of them."""
_READ = """
A run is **right** if it is trusted, and phi and u/a stay within 0.01 rad of theory (relative beyond
1 rad), and within its tolerance if it has one. It is **refused** if it ends in an error that states
the reason, for instance because its scene is outside the domain. It is **doubted** if it carries a
warning, whether it is right or wrong. It is **silent** if it is trusted and wrong, which must never
happen. Two theories that share no code check a motion without damping; exact theory alone checks
damped motions, liquids and attached cans.
"""
"""Text of the summary on how to read the tables of the search."""


def plan(quick: bool, first: int) -> list[Check]:
    """Return all checks of a study, whose random runs have the numbers from `first` on.

    A `quick` study has coarser maps, and fewer random runs.
    """
    cells = stability_maps.FEW_CELLS if quick else stability_maps.CELLS
    runs = FEW_RUNS if quick else RUNS
    return [*stability_maps.checks(cells), *_known_checks(), *random_checks(runs, first)]


def _known_checks() -> list[Check]:
    """Return a check for each known case."""
    checks = []
    for case in cases():
        measure = partial(_measured_case, case)
        reason = "each ends as it must"
        checks.append(Check(KNOWN, case.name, measure, bound=0, unit="runs", reason=reason))
    return checks


def random_checks(runs: int, number: int) -> list[Check]:
    """Return the checks of at least `runs` random runs, whose numbers begin with `number`."""
    checks = []
    for first in range(number, number + runs, SIZE):
        name = f"random runs {first} to {first + SIZE - 1}"
        reason = "none is wrong and silent"
        checks.append(
            Check(RANDOM, name, partial(measured_batch, first), bound=0, unit="runs", reason=reason)
        )
    return checks


def _measured_case(case: KnownCase) -> Measured:
    """Return how many variants of a known case ended wrongly, and how each ended."""
    endings = try_case(case)
    return Measured(endings.wrong, endings.as_json())


def measured_batch(first: int, size: int = SIZE) -> Measured:
    """Return how many random runs from the number `first` on are silent, and how all ended."""
    endings = batch(first, size)
    return Measured(len(endings.silent), endings.as_json())


def try_case(case: KnownCase) -> KnownEndings:
    """Return how the variants of a known case ended."""
    runs = []
    for variant in case.variants:
        outcome = judge(variant.trial)
        if supported(variant.trial.scene, variant.trial.rolling):
            as_it_must = outcome.verdict != UNDETECTED_ERROR and outcome.error <= variant.within
        else:
            as_it_must = outcome.verdict == REFUSED
        runs.append(KnownRun(variant.setting, as_it_must, outcome))
    return KnownEndings(case.why, runs)


def batch(first: int, size: int = SIZE) -> BatchEndings:
    """Return how the random runs from the number `first` on ended.

    Trials `OUTSIDE` the domain count as refused.
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
        kinds.setdefault(trial.kind, Counter()).update(_counted(outcome))
        if outcome.verdict == UNDETECTED_ERROR:
            region = REGIONS[number % len(REGIONS)].name
            silent.append(SilentRun(number, region, outcome, repr(trial)))
    counts = {kind: dict(counter) for kind, counter in kinds.items()}
    return BatchEndings(counts, silent)


def _counted(outcome: Outcome) -> list[str]:
    """Return all names under which an outcome is counted."""
    names = []
    if outcome.verdict:
        names.append(outcome.verdict)
    if outcome.judged_by:
        names.append(outcome.judged_by)
    if outcome.verdict == WARNED and outcome.error <= ERROR:
        names.append(NEEDLESS)
    if outcome.verdict == RIGHT and outcome.error > outcome.admitted:
        names.append(ABOVE)
    if outcome.verdict == RIGHT and outcome.error > 2 * outcome.admitted:
        names.append(TWICE)
    return names


class Totals(NamedTuple):
    """The counts of runs, by how they ended."""

    known: Mapping[str, int]
    """The counts of known cases, by verdict."""
    kinds: Mapping[str, Mapping[str, int]]
    """The counts of random runs by kind of model, also for "all", by the names of `_counted`."""


def totals(results: Iterable[Result]) -> Totals:
    """Return the counts of a study's runs."""
    known = Counter[str]()
    kinds: dict[str, Counter[str]] = {}
    for result in results:
        if result.group == KNOWN:
            case = KnownEndings.from_json(result.values)
            known.update(run.outcome.verdict for run in case.runs)
        elif result.group == RANDOM:
            for kind, counts in BatchEndings.from_json(result.values).kinds.items():
                kinds.setdefault(kind, Counter()).update(counts)
    ordered = {kind: dict(kinds[kind]) for kind in sorted(kinds)}
    every = sum(kinds.values(), Counter())
    return Totals(dict(known), ordered | {"all": dict(every)})


def bound(counts: Mapping[str, int]) -> float | None:
    """Return an upper bound on the share of trusted runs that are silent; None without such runs.

    It is C. Clopper and E. Pearson's exact bound at the confidence `CONFIDENCE`. If none of n
    trusted runs is silent, it is about 3/n.
    """
    silent = counts.get(UNDETECTED_ERROR, 0)
    trusted = silent + counts.get(RIGHT, 0)
    if trusted == 0:
        return None
    test = binomtest(silent, trusted, alternative="less")
    return float(test.proportion_ci(CONFIDENCE, method="exact").high)


def rounded_up(share: float) -> str:
    """Return an upper bound with two digits. Rounded down, it would claim too much."""
    return f"{Context(prec=2, rounding=ROUND_CEILING).create_decimal(share):f}"


def search_tables(found: Totals, results: Sequence[Result] = ()) -> list[Table]:
    """Return the tables of a search: known cases, random runs, and the silent runs of `results`."""
    known = [str(found.known.get(verdict, 0)) for verdict in VERDICTS]
    all_known = ("all", str(sum(found.known.values())), *known)
    tables = [
        Table("Known cases", ("cases", "runs", *VERDICTS), [all_known]),
        _table_of_kinds(found.kinds),
        _table_of_silent_runs(results),
    ]
    return [table for table in tables if table.rows]


def _table_of_kinds(kinds: Mapping[str, Mapping[str, int]]) -> Table:
    """Return a table with a row for each kind of model: how runs ended, and who judged them."""
    counted = (*VERDICTS, *JUDGES, NEEDLESS, ABOVE, TWICE)
    last = "silent of trusted runs, at most (95 % confidence)"
    rows = []
    for kind, counts in kinds.items():
        runs = sum(counts.get(verdict, 0) for verdict in VERDICTS)
        cells = [str(counts.get(name, 0)) for name in counted]
        share = bound(counts)
        rows.append((kind, str(runs), *cells, "-" if share is None else rounded_up(share)))
    title = "Random runs, by model and by what judged them"
    return Table(title, ("model", "runs", *counted, last), rows)


def _table_of_silent_runs(results: Sequence[Result]) -> Table:
    """Return a table with a row for each silent run."""
    rows = []
    for result in results:
        if result.group != RANDOM:
            continue
        for run in BatchEndings.from_json(result.values).silent:
            rows.append((str(run.number), run.region, f"{run.outcome.error:.1e}", run.trial))
    columns = ("number", "region", "error [rad]", "trial")
    return Table("Silent runs, which must not be", columns, rows, left=(0, 1, 3))


def _table_of_cases(results: Sequence[Result]) -> Table:
    """Return a table with a row for each known case: how its runs ended, and their errors."""
    rows = []
    for result in results:
        case = KnownEndings.from_json(result.values)
        cells = [_ended(case.runs, verdict) for verdict in VERDICTS]
        rows.append((result.name, *cells, case.why))
    title = "Known cases: runs, and the largest error [rad]"
    return Table(title, ("case", *VERDICTS, "why it is one"), rows, left=(0, 5))


def _ended(runs: Sequence[KnownRun], verdict: str) -> str:
    """Return how many runs ended with a verdict, and the largest of their finite errors."""
    ended = [run.outcome.error for run in runs if run.outcome.verdict == verdict]
    errors = [error for error in ended if error != math.inf]
    return f"{len(ended)} ({max(errors):.0e})" if errors else f"{len(ended)}"


def run(folder: pathlib.Path, quick: bool, console: Console) -> Study:
    """Measure on all cores what the study in `folder` lacks, and return the study.

    Meanwhile it is in the file `UNFINISHED`. Its random runs are fresh: the number of the first one
    is drawn when the study begins, and is one of its settings.

    Raises:
      OutputError: if the folder cannot be written to.
      OSError: if the system ends one of the processes.
      ParameterError: if a file of that name exists but has no such study.
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
    unfinished = folder / UNFINISHED
    return studies.run(checks, console, unfinished, COMMAND, settings, folder / FINISHED)


def tables(study: Study) -> list[Table]:
    """Return the tables for the terminal. The table of known cases is in the summary alone."""
    maps = stability_maps.table(study.of(stability_maps.MAPS))
    return [maps, *search_tables(totals(study.results), study.results)]


def write(study: Study, folder: pathlib.Path) -> None:
    """Write the study, its maps and totals, the plots of the maps, and summary.md into a folder.

    Raises:
      OutputError: if a file cannot be written.
    """
    study.save(folder / FINISHED)
    maps = [stability_maps.from_result(result) for result in study.of(stability_maps.MAPS)]
    about = {**study.about, "date": datetime.date.today().isoformat()}
    maps_json = document(about, stability_maps.MAPS, [asdict(one_map) for one_map in maps])
    files.write(folder / "maps.json", maps_json)
    content = {**study.about, **totals(study.results)._asdict()}
    files.write(folder / "totals.json", json.dumps(content, indent=1) + "\n")
    verdict = "All came out as they must."
    if study.failed:
        verdict = f"**{len(study.failed)} did not come out as they must.**"
    lines = ["# mjbeer: stability", "", verdict, _READ]
    stored = stability_maps.load(folder / "maps.json")
    for name, draw in map_plots.figures(stored).items():
        draw(folder / name)
        family = stability_maps.FAMILIES[name.removeprefix("stability-")]
        lines += [f"![{name}]({name}.svg)", "", family.caption, ""]
    for table in (*tables(study), _table_of_cases(study.of(KNOWN))):
        lines.append(table.markdown())
    files.write(folder / "summary.md", "\n".join(lines))
