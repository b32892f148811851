"""Known cases end as they must, and runs anywhere in the space of scenes and settings are never
wrong and silent.

`make test` makes the same random runs every time, `make search` as many new ones as one wants;
`mjbeer stability` draws the number of its first one when it begins.
"""

import math
import os
import pathlib
import secrets
from collections.abc import Callable
from typing import NamedTuple

import pytest

import mjbeer
from mjbeer.checks.as_json import json_values
from mjbeer.checks.check import Check, Result
from mjbeer.exceptions import ParameterError
from mjbeer.studies.stability import stability_study
from mjbeer.studies.stability.endings import BatchEndings
from mjbeer.studies.stability.judge import (
    BOTH,
    REFUSED,
    RIGHT,
    THEORY,
    UNDETECTED_ERROR,
    WARNED,
    Outcome,
    Trial,
)
from mjbeer.studies.stability.known_cases import KnownCase, Variant, cases
from mjbeer.studies.stability.regions import REGIONS, random_trial
from mjbeer.studies.stability.stability_study import (
    RANDOM,
    SIZE,
    batch,
    random_checks,
    totals,
    try_case,
)
from mjbeer.studies.study import run_checks

pytestmark = pytest.mark.slow

EXAMPLES = os.environ.get("MJBEER_EXAMPLES")
"""How many new runs `make search` asks for."""
FIXED = 2 * len(REGIONS)
"""How many runs `make test` makes: two a region."""
CASES = cases()
SAMPLE = [case for case in CASES if "1 - 1e" not in case.name][::6]
SAMPLE += [case for case in CASES if len(case.variants) == 1 and case not in SAMPLE]
"""A nearly full can takes ten seconds to swing, and as many to simulate."""


def test_no_run_is_wrong_and_silent() -> None:
    if EXAMPLES is None:
        assert not batch(0, FIXED).silent
        return
    results = list(run_checks(random_checks(int(EXAMPLES), secrets.randbelow(10**9)), None))
    for table in stability_study.search_tables(totals(results), results):
        print(table.markdown())
    assert all(result.passed for result in results)


@pytest.mark.parametrize("case", SAMPLE, ids=lambda case: case.name)
def test_a_sample_of_the_known_cases_ends_as_it_must(
    case: KnownCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A motion that no number of steps makes smooth is refused after fewer of them than usually."""
    monkeypatch.setattr("mjbeer.simulation.solve.EVALUATIONS", 500_000)
    found = try_case(case)
    assert found.runs
    assert [run for run in found.runs if not run.as_it_must] == []
    assert found.wrong == 0


def test_what_must_be_is_what_is_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wrong run where an accurate one is wanted, and one that is not refused where it must be,
    both stand out."""
    good = Trial(mjbeer.frozen(), 1.0, steps=300)
    bad = Trial(mjbeer.frozen(), 1.0, integrator="Euler", timestep=8e-3, steps=250)
    impossible = Trial(mjbeer.sliding(), 1.0, rolling="contact")
    tried = (
        Variant("a", impossible),
        Variant("b", good, 1e-2),
        Variant("c", bad),
        Variant("d", good, 1e-20),
    )
    found = try_case(KnownCase("name", "why", (*tried, Variant("e", bad, 1e-2))))
    assert [run.as_it_must for run in found.runs] == [True, True, True, False, False]
    assert (found.wrong, found.why) == (2, "why")
    monkeypatch.setattr(stability_study, "supported", lambda *_: False)
    assert try_case(KnownCase("name", "why", tried[1:2])).wrong == 1


class Span(NamedTuple):
    """What the trials of a region must reach: a value at or below `low`, and one at `high`."""

    region: str
    quantity: Callable[[Trial], float]
    low: float
    high: float


SPANS = (
    Span("fast rotation", lambda trial: abs(trial.phi_dot0) * trial.timestep, 0.1, 10),
    Span("contact friction", lambda trial: trial.friction, 0.02, 5),
    Span("mass ratios", lambda trial: trial.scene.can.mass / trial.scene.load.mass, 2e-3, 500),
    Span("steep", lambda trial: math.degrees(trial.scene.incline), -80, 80),
    Span("far angles", lambda trial: abs(trial.phi0), 200, 5e3),
    Span("weak or strong gravity", lambda trial: trial.scene.gravity, 1e-9, 5e2),
    Span("anything", lambda trial: trial.scene.can.radius, 3e-3, 10),
    Span("long", lambda trial: trial.duration, 20, 150),
)


class Drawn(NamedTuple):
    """The trials of each region, and the messages of those that the domain refused."""

    trials: dict[str, list[Trial]]
    refused: dict[str, list[str]]


@pytest.fixture(scope="module")
def drawn() -> Drawn:
    """Ninety trials of each region."""
    names = [region.name for region in REGIONS]
    trials: dict[str, list[Trial]] = {name: [] for name in names}
    refused: dict[str, list[str]] = {name: [] for name in names}
    for number in range(90 * len(names)):
        name = names[number % len(names)]
        try:
            trials[name].append(random_trial(number))
        except ParameterError as error:
            refused[name].append(str(error))
    return Drawn(trials, refused)


def test_a_number_makes_the_same_trial_every_time() -> None:
    assert random_trial(77) == random_trial(77)


@pytest.mark.parametrize("span", SPANS, ids=lambda span: span.region)
def test_a_region_reaches_its_extremes(span: Span, drawn: Drawn) -> None:
    values = [span.quantity(trial) for trial in drawn.trials[span.region]]

    assert min(values) <= span.low
    assert max(values) >= span.high


@pytest.mark.parametrize(
    ("region", "quantity"),
    [
        ("steep", "incline"),
        ("mass ratios", "mass of the can"),
        ("fast rotation", "mass of the can"),
        ("thin or full", "fill"),
    ],
)
def test_a_region_goes_beyond_the_domain(region: str, quantity: str, drawn: Drawn) -> None:
    messages = [message for message in drawn.refused[region] if f"{quantity} " in message]

    assert len(messages) > 9


def test_what_one_has_on_a_desk_is_in_the_domain(drawn: Drawn) -> None:
    assert drawn.refused["ordinary"] == []
    assert drawn.refused["attached"] == []


def test_late_samples_are_at_the_end(drawn: Drawn) -> None:
    for trial in drawn.trials["single late sample"]:
        assert len(trial.times) <= 2
        assert trial.times[-1] > 0.99 * trial.duration


def test_many_resonant_runs_turn_by_whole_quarters_in_a_step(drawn: Drawn) -> None:
    whole = 0
    for trial in drawn.trials["resonance"]:
        quarters = abs(trial.phi_dot0) * trial.timestep / (math.pi / 2)
        whole += abs(quarters - round(quarters)) < 1e-9

    assert whole > 30


def test_a_batch_counts_what_the_domain_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the error of a scene, and nothing simulates it."""
    monkeypatch.setattr(
        stability_study, "random_trial", lambda number: Trial(mjbeer.sliding(1.5 + number), 1.0)
    )
    monkeypatch.delattr(stability_study, "judge")
    assert batch(7, 3) == BatchEndings(kinds={"outside the domain": {REFUSED: 3}}, silent=[])


def test_a_batch_counts_and_keeps_what_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = [
        Outcome(RIGHT, BOTH, 1e-9, 1e-8),
        Outcome(RIGHT, BOTH, 1e-3, 6e-4),
        Outcome(RIGHT, THEORY, 1e-3, 1e-4),
        Outcome(WARNED, BOTH, 1e-3, 1e-4, "N < 0"),
        Outcome(WARNED, BOTH, 1.0, 1e-4, "off"),
        Outcome(UNDETECTED_ERROR, THEORY, 1.0, 1e-4),
        Outcome(REFUSED, says="tolerance 1 is not reached"),
        Outcome("", "nobody", math.inf, 1e-4),
    ]
    outcomes = iter(ends)
    monkeypatch.setattr(stability_study, "judge", lambda _: next(outcomes))
    monkeypatch.setattr(stability_study, "random_trial", lambda _: Trial(mjbeer.frozen(), 1.0))
    found = batch(SIZE, len(ends))
    assert [run.number - SIZE for run in found.silent] == [5]
    assert found.silent[0].trial.startswith("Trial(scene=")
    assert BatchEndings.from_json(json_values(found.as_json())) == found
    both = [Result(RANDOM, name, values=found.as_json()) for name in "ab"]
    all_of = totals(both).kinds["all"]
    assert all_of == {
        RIGHT: 6,
        WARNED: 4,
        UNDETECTED_ERROR: 2,
        REFUSED: 2,
        BOTH: 8,
        THEORY: 4,
        "nobody": 2,
        "doubted, yet right": 2,
        "above its estimate": 4,
        "above twice": 2,
    }


def test_the_bound_of_silent_runs_is_exact() -> None:
    """With a share at the bound, one of twenty studies has so few silent runs or fewer."""
    none = stability_study.bound({RIGHT: 200, WARNED: 100, REFUSED: 50})
    assert none is not None
    assert (1 - none) ** 200 == pytest.approx(0.05)

    two = stability_study.bound({RIGHT: 198, UNDETECTED_ERROR: 2, WARNED: 100})
    assert two is not None
    at_most_two = sum(math.comb(200, k) * two**k * (1 - two) ** (200 - k) for k in range(3))
    assert at_most_two == pytest.approx(0.05)


def test_without_trusted_runs_there_is_no_bound() -> None:
    assert stability_study.bound({WARNED: 100, REFUSED: 50}) is None


@pytest.mark.parametrize(
    ("share", "text"), [(0.00109, "0.0011"), (0.00191, "0.0020"), (0.0195, "0.020")]
)
def test_a_bound_is_rounded_up(share: float, text: str) -> None:
    assert stability_study.rounded_up(share) == text


def test_a_study_draws_new_runs_and_an_interrupted_one_goes_on_with_its_own(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers = iter(range(100, 200, 10))
    begun = []

    def plan(quick: bool, first: int) -> list[Check]:
        begun.append((quick, first))
        return []

    monkeypatch.setattr(secrets, "randbelow", lambda _: next(numbers))
    monkeypatch.setattr(stability_study, "plan", plan)

    for quick in (True, True, False, False):
        folder = tmp_path / str(quick)
        folder.mkdir(exist_ok=True)
        study = stability_study.run(folder, quick, None)
        assert study.settings == {"quick": quick, "first random run": begun[-1][1]}

    assert begun == [(True, 100), (True, 100), (False, 120), (False, 120)]


def test_random_runs_begin_with_the_first_one_of_the_study() -> None:
    named = [check.name for check in stability_study.plan(True, 12345) if check.group == RANDOM]
    assert named[0] == f"random runs 12345 to {12345 + SIZE - 1}"
    assert len(named) == 4
