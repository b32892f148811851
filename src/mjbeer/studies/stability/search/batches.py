"""The search as tasks: each makes a batch of runs, and counts by region how they ended."""

import dataclasses
import warnings
from collections import Counter
from functools import partial
from typing import Any

from mjbeer.studies.stability.outcome import NEVER, REFUSED
from mjbeer.studies.stability.search.check import FALSE, PULL, SMALL, Finding, check
from mjbeer.studies.stability.search.random_run import RandomRun
from mjbeer.studies.stability.search.regions import REGIONS, random_run
from mjbeer.studies.study import Task

GROUP = "search"
"""Name of the group of these tasks."""
SMALL_FALSE = f"{FALSE}, error below {SMALL:g}"
"""Counted for false alarms of runs with such an error, which count as false alarms too."""
ALONE = "judged by one theory alone"
"""Counted for runs that exact theory refuses to follow, or that are damped, which the reference cannot; they end in
other ways too."""
_TURNS = 4
"""How often a batch goes through all regions; a batch takes some seconds."""
SIZE = _TURNS * len(REGIONS)
"""Number of runs in a batch."""
RUNS = {"quick": 250, "usual": 3000, "long": 20000}
"""Least number of runs, by the extent of the study."""
_ROUNDING = 1e-9
"""Errors below this [rad] do not count as overconfident: a second run at half the timestep cannot see rounding."""


def tasks(extent: str, number: int = 0) -> list[Task]:
    """Return the search from a run's `number` on as tasks; a run depends on its number alone."""
    firsts = range(number, number + RUNS[extent], SIZE)
    return [Task(GROUP, f"random runs {first} to {first + SIZE - 1}", partial(batch, first)) for first in firsts]


def batch(first: int, size: int = SIZE) -> dict[str, Any]:
    """Return how the runs from the number `first` on ended, and everything about those that must not end so.

    "regions" has the counts by region, "false alarms" and "refusals" those by message. "never" has the runs that must
    not be, "overconfident" trusted runs that are accurate, but less so than their own diagnostics say, and "needless"
    those with a false alarm although their error is small.
    """
    regions = {region.name: Counter[str]() for region in REGIONS}
    alarms, refusals = Counter[str](), Counter[str]()
    never, overconfident, needless = [], [], []
    for number in range(first, first + size):
        run = random_run(number)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # MuJoCo's and the run's own; all that counts is in its report
            finding = check(run)
        regions[run.region].update(_counted(finding))
        if finding.alarm == FALSE:
            alarms.update(alarm for alarm in finding.outcome.alarms if not alarm.startswith(PULL))
        outcome = finding.outcome
        if outcome.verdict == REFUSED:
            refusals.update(outcome.alarms)
        if outcome.verdict in NEVER:
            never.append(_about(number, run, finding))
        elif not outcome.says and (outcome.error or 0) > (outcome.admitted or 0) + _ROUNDING:
            overconfident.append(_about(number, run, finding))
        elif SMALL_FALSE in _counted(finding):
            needless.append(_about(number, run, finding))
    return {
        "regions": {name: dict(counts) for name, counts in regions.items()},
        "false alarms": dict(alarms),
        "refusals": dict(refusals),
        "never": never,
        "overconfident": overconfident,
        "needless": needless,
    }


def _counted(finding: Finding) -> list[str]:
    """Return the names under which a run is counted."""
    outcome = finding.outcome
    names = [outcome.verdict, *([finding.alarm] if finding.alarm else [])]
    names += [ALONE] if outcome.error is not None and outcome.apart is None else []
    return [*names, SMALL_FALSE] if finding.alarm == FALSE and finding.error < SMALL else names


def _about(number: int, run: RandomRun, finding: Finding) -> dict[str, Any]:
    """Return all that is known of a run in a form for JSON."""
    return {"number": number, "region": run.region, **dataclasses.asdict(finding.outcome), "call": str(run)}
