"""Runs anywhere in the space of scenes, starts and settings: none is wrong and silent.

`make test` draws the same runs every time, `make search` 2,000 new ones; the search of `mjbeer stability` has its own.
"""

import os
from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability import search
from mjbeer.studies.stability.outcome import ACCURATE, SILENT, Outcome
from mjbeer.studies.stability.search import NUMBERS, RandomRun, random_run

pytestmark = pytest.mark.slow

EXAMPLES = os.environ.get("MJBEER_EXAMPLES")
"""How many new runs `make search` asks for."""


# MuJoCo says so when it compiles such a model; what counts here is what the run says.
@pytest.mark.filterwarnings("ignore:Inertia matrix is too close to singular:UserWarning")
@given(st.lists(st.floats(0, 1), min_size=NUMBERS, max_size=NUMBERS))
@example([0.5] * NUMBERS)
@settings(
    max_examples=int(EXAMPLES or 60),
    derandomize=EXAMPLES is None,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
def test_no_run_is_wrong_and_silent(numbers: list[float]) -> None:
    try:
        run = random_run(numbers)
    except ParameterError:
        assume(False)
    outcome = search.check(run)
    assert outcome.verdict != SILENT, (run, outcome)


def test_a_random_run_takes_all_its_numbers() -> None:
    """With one fewer it cannot be made; each but some that its own choices leave unused makes a difference."""
    generator = np.random.default_rng(3)
    numbers, changed = generator.random(NUMBERS).tolist(), set[int]()
    with pytest.raises(StopIteration):
        random_run(numbers[:-1])
    for _ in range(60):
        numbers = generator.random(NUMBERS).tolist()
        for place in range(NUMBERS):
            other = [*numbers[:place], (numbers[place] + 0.37) % 1, *numbers[place + 1 :]]
            if _made(numbers) != _made(other):
                changed.add(place)
    assert changed == set(range(NUMBERS))


def _made(numbers: Iterable[float]) -> RandomRun | None:
    try:
        return random_run(list(numbers))
    except ParameterError:
        return None


def test_random_runs_reach_the_extremes() -> None:
    generator = np.random.default_rng(0)
    runs = [each for _ in range(500) if (each := _made(generator.random(NUMBERS)))]
    scenes = [each.scene for each in runs]
    assert {each.rolling for each in runs} == {"reduced", "equality", "contact"}
    assert len({each.integrator for each in runs}) == 6
    assert any(each.tolerance for each in runs)
    assert any(each.gravity == 0 for each in scenes)
    assert any(each.load.offset == 0 for each in scenes)
    assert any(each.load.offset == each.can.radius for each in scenes)
    assert any(each.load.inertia == 0 for each in scenes)
    assert min(each.can.radius for each in scenes) < 1e-5
    assert max(each.can.radius for each in scenes) > 10
    assert max(abs(each.phi_dot0) for each in runs) > 1e4


def test_a_batch_counts_and_keeps_what_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = iter(
        [
            Outcome(ACCURATE, 1e-9, 1e-8, ""),
            Outcome(ACCURATE, 1e-3, 1e-4, ""),
            Outcome(ACCURATE, 1e-3, 1e-4, "N < 0"),
            Outcome(SILENT, 1.0, 1e-4, ""),
        ]
    )
    monkeypatch.setattr(search, "check", lambda _: next(ends))
    found = search.batch(5, 4)
    assert {name: count for name, count in found["verdicts"].items() if count} == {ACCURATE: 3, SILENT: 1}
    assert [each["number"] for each in found["silent"]] == [3]
    assert [each["number"] for each in found["overconfident"]] == [1]
    assert found["flagged"] == 1


def test_batches_repeat() -> None:
    assert search.batch(1, 3) == search.batch(1, 3)
