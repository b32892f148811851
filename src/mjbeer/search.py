"""A seeded search for runs that are wrong and silent."""

import dataclasses
from collections import Counter
from functools import partial
from typing import Any

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.outcome import ACCURATE, SILENT, VERDICTS, Outcome, judge
from mjbeer.task import Task
from mjbeer.trial import NUMBERS, Trial, trial

_BATCH = 100
"""Trials of a task: some ten seconds."""
_BATCHES, _QUICK_BATCHES = 30, 2
_ROUNDING = 1e-9
"""Error that a run need not admit: rounding does not fall with the timestep [rad]."""
_IMPOSSIBLE = "no such scene"


def tasks(quick: bool) -> list[Task]:
    """The search, in batches; each has its own seed, so that it does not depend on those before."""
    count = _QUICK_BATCHES if quick else _BATCHES
    return [Task("search", f"{_BATCH} random runs, seed {seed}", partial(batch, seed)) for seed in range(count)]


def batch(seed: int, size: int = _BATCH) -> dict[str, Any]:
    """How many of a batch of trials ended in which way, and everything about those that were wrong and silent.

    `overconfident` has trusted runs whose error is greater than what the run admits: within what is trusted, but not
    what it said.
    """
    found, silent, overconfident, flagged = Counter(dict.fromkeys(VERDICTS, 0)), [], [], 0
    generator = np.random.default_rng(seed)
    for number in range(size):
        numbers = generator.random(NUMBERS).tolist()
        try:
            drawn = trial(numbers)
        except ParameterError:
            found[_IMPOSSIBLE] += 1
            continue
        outcome = attempt(drawn)
        found[outcome.verdict] += 1
        flagged += outcome.verdict == ACCURATE and bool(outcome.says)
        about = {"number": number, **dataclasses.asdict(outcome), "trial": repr(drawn)}
        if outcome.verdict == SILENT:
            silent.append(about)
        elif not outcome.says and (outcome.error or 0) > (outcome.admitted or 0) + _ROUNDING:
            overconfident.append(about)
    return {"seed": seed, "verdicts": dict(found), "flagged": flagged, "silent": silent, "overconfident": overconfident}


def attempt(drawn: Trial) -> Outcome:
    """Make and judge a trial; the one start that has no exact motion, the separatrix itself, is refused."""
    try:
        return judge(drawn.run)
    except NoLibrationError as error:
        return Outcome("refused", None, None, str(error))
