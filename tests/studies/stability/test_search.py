"""Known cases end as theory allows, and runs anywhere in the space of scenes and settings are never wrong and silent.

`make test` makes the same random runs every time, `make search` as many new ones as one wants; the search of
`mjbeer stability` makes the ones with the first numbers.
"""

import functools
import json
import math
import os
import secrets

import pytest

import mjbeer
from mjbeer import exact, frozen
from mjbeer.model import setting
from mjbeer.studies import rows
from mjbeer.studies.study import Result
from mjbeer.studies.stability import search
from mjbeer.studies.stability.judge import (
    ACCURATE,
    FALSE,
    INACCURATE,
    MISSED,
    PARTS,
    REFUSED,
    SILENT,
    THEORIES,
    Outcome,
    Trial,
)
from mjbeer.studies.stability.known_cases import Case, Try, cases
from mjbeer.studies.stability.random_trials import REGIONS, random_trial
from mjbeer.studies.stability.reference import reference
from mjbeer.studies.stability.search import RANDOM, RUNS, SIZE, SMALL, batch, tables, try_case
from mjbeer.theory.load import Load

pytestmark = pytest.mark.slow

EXAMPLES = os.environ.get("MJBEER_EXAMPLES")
"""How many new runs `make search` asks for."""
FIXED = 36
"""How many runs `make test` makes: two a region."""
CASES = cases()
SAMPLE = [case for case in CASES if "1 - 1e" not in case.name][::6]
SAMPLE += [case for case in CASES if case.kind == "found" and case not in SAMPLE]
"""A nearly full can takes ten seconds to swing, and as many to simulate."""


def test_no_run_is_wrong_and_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor does one miss its tolerance, nor do two theories differ."""
    if EXAMPLES is None:
        assert not batch(0, FIXED)["never"]
        return
    monkeypatch.setitem(RUNS, "usual", int(EXAMPLES))
    todo = [row for row in search.rows("usual", secrets.randbelow(10**9)) if row.group == RANDOM]
    study = rows.run(todo, None, processes=os.cpu_count() or 1)
    for table in tables(study.results):
        print(table.markdown())
    assert not study.failed


@pytest.mark.parametrize("case", SAMPLE, ids=lambda case: f"{case.kind}: {case.name}")
def test_a_sample_of_the_known_cases_ends_as_expected(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion that no number of steps makes smooth is refused after fewer of them than usually."""
    monkeypatch.setattr("mjbeer.simulation.tolerance._EVALUATIONS", 500_000)
    found = try_case(case, quick=True)
    assert found["runs"]
    assert [run for run in found["runs"] if not run["as_expected"] or run["verdict"] == SILENT] == []
    assert found["error"] == 0


def test_expectations_are_what_is_compared() -> None:
    """An accurate run where none is expected, and a doubtful one where an accurate one is, both stand out."""
    good, bad = Trial(frozen(), 1.0, steps=300), Trial(frozen(), 1.0, integrator="Euler", timestep=8e-3, steps=250)
    tried = (Try("a", good, (INACCURATE,)), Try("b", good, (ACCURATE,)), Try("c", good),
             Try("d", good, (ACCURATE,), 1e-20), Try("e", bad, (ACCURATE,), sample=False))  # fmt: skip
    case = Case("stiff", "name", "why", tried)
    found = try_case(case)
    assert [run["as_expected"] for run in found["runs"]] == [False, True, True, False, False]
    assert found["error"] == 3
    quick = try_case(case, quick=True)
    assert [run["setting"] for run in quick["runs"]] == ["a", "b", "c", "d"]
    result = Result("cases", "stiff: name", values=quick)
    assert json.loads(result.line())["values"]["why"] == "why"
    assert search.table_of_cases([result]).rows[0][-1] == "why"


def test_known_cases_are_told_apart_and_friction_ones_stand_on_either_side_of_what_is_needed() -> None:
    names = [(case.kind, case.name) for case in CASES]
    assert len(set(names)) == len(names) == 119
    needed = float(exact(frozen(), [k / 1000 for k in range(1001)], 0.0).forces.needed.max())
    for case in CASES:
        settings = [each.setting for each in case.tries]
        assert len(set(settings)) == len(settings)
        assert any(each.sample for each in case.tries)
        if case.name.startswith("friction "):
            assert all((INACCURATE in each.expected) == (float(case.name[9:]) < needed) for each in case.tries)


def test_a_number_makes_the_same_run_every_time() -> None:
    assert random_trial(77) == trials()[77]
    assert batch(1, 3) == batch(1, 3)


def test_a_run_can_be_pasted() -> None:
    names = {"Trial": Trial, "Load": Load, **vars(mjbeer), **vars(setting)}
    for run in trials()[:100]:
        assert "\n" not in repr(run)
        assert eval(repr(run), names) == run


@functools.cache
def trials() -> list[Trial]:
    return [random_trial(number) for number in range(1800)]


def of(region: str) -> list[Trial]:
    return trials()[[each.name for each in REGIONS].index(region) :: len(REGIONS)]


def test_regions_reach_their_extremes() -> None:
    late = of("single late sample")
    assert all(len(run.times) <= 2 and run.times[-1] == pytest.approx(run.timestep * run.steps) for run in late)
    assert all(len(run.times) <= 6 for run in of("sparse samples"))
    assert max(run.steps for run in of("few steps")) <= 5
    spans = {
        "fast rotation": ([abs(run.phi_dot0) * run.timestep for run in of("fast rotation")], 0.1, 10),
        "contact friction": ([run.friction for run in of("contact friction")], 0.02, 5),
        "mass ratios": ([run.scene.can.mass / run.scene.load.mass for run in of("mass ratios")], 1e-5, 1e5),
        "steep": ([math.degrees(run.scene.incline) for run in of("steep")], -89.99, 89.99),
        "far angles": ([abs(run.phi0) for run in of("far angles")], 200, 5e3),
        "weak or strong gravity": ([run.scene.gravity for run in of("weak or strong gravity")], 1e-9, 5e2),
        "anything": ([run.scene.can.radius for run in of("anything")], 1e-3, 10),
        "long": ([run.timestep * run.steps for run in of("long")], 20, 150),
    }  # fmt: skip
    assert [name for name, (reached, low, high) in spans.items() if min(reached) > low or max(reached) < high] == []
    turns = [abs(run.phi_dot0) * run.timestep / (math.pi / 2) for run in of("resonance")]
    assert sum(abs(turn - round(turn)) < 1e-9 for turn in turns) > 30
    assert min(1 - run.scene.load.fill for run in of("thin or full") if run.scene.load.fill) < 1e-7
    assert any(run.scene.load.offset == 0 for run in of("anything"))


def test_no_run_takes_theory_long() -> None:
    """It follows a run if that turns by some thousand radians, or swings some hundred times."""
    for run in trials():
        assert abs(run.phi_dot0) * run.timestep * run.steps <= 3001
        assert run.steps <= 15_000
    longest = max(of("long"), key=lambda run: run.scene.oscillator.depth * (run.timestep * run.steps) ** 2)
    reference(longest.scene, longest.times, longest.phi0, longest.phi_dot0)  # LongMotionError if it cannot


def test_a_batch_counts_and_keeps_what_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = [
        (Outcome(ACCURATE, 1e-9, 1e-8, "", 0.0), ("", 0.0)),
        (Outcome(ACCURATE, 1e-3, 1e-4, "", 0.0), ("", 0.0)),
        (Outcome(ACCURATE, 1e-3, 1e-4, "N < 0", 0.0), ("", 0.0)),
        (Outcome(SILENT, 1.0, 1e-4, "", 0.0), ("", 0.0)),
        (Outcome(MISSED, 1.0, 1e-4, "", 0.0), ("", 0.0)),
        (Outcome(THEORIES, 1.0, 1e-4, "", 0.0), ("", 0.0)),
        (Outcome(ACCURATE, 1e-3, 1.0, "off", 0.0, alarms=("off by",)), (FALSE, SMALL * 2)),
        (Outcome(ACCURATE, 1e-3, 1.0, "off", 0.0, alarms=("off by", "drifts by")), (FALSE, SMALL / 2)),
        (Outcome(REFUSED, says="tolerance 1 is not reached", alarms=("tolerance",)), ("", 0.0)),
        (Outcome(ACCURATE, 1e-3, 1.0, "slips", 0.0, alarms=("slips by",)), (PARTS, 0.0)),
    ]
    outcomes, alarms = (iter(each) for each in zip(*ends, strict=True))
    monkeypatch.setattr(search, "judge", lambda _: next(outcomes))
    monkeypatch.setattr(search, "alarm", lambda *_: next(alarms))
    found = batch(SIZE, 10)
    assert [run["number"] - SIZE for run in found["never"]] == [3, 4, 5]
    assert [run["number"] - SIZE for run in found["overconfident"]] == [1]
    assert [run["number"] - SIZE for run in found["needless"]] == [7]
    assert (found["false alarms"], found["refusals"]) == ({"off by": 2, "drifts by": 1}, {"tolerance": 1})
    assert found["never"][0]["call"].startswith("Trial(scene=")
    assert found["error"] == 3
    _, by_region, *others = tables([Result(RANDOM, name, values=found) for name in "ab"])
    everything = dict(zip(by_region.columns, by_region.rows[-1], strict=True))
    assert everything == {
        "region": "all", "runs": "20", "refused": "2", "unstable": "0", "accurate": "12", "inaccurate": "0",
        "silent": "2", "missed": "2", "theories": "2", "beyond": "0", "false alarms": "4", "below 0.0001": "2",
        "slip or lift": "2", "way": "0", "sensitive": "0", "one theory": "0",
    }  # fmt: skip
    assert [len(table.rows) for table in others] == [2, 1, 2, 6]


def test_the_search_is_cut_into_rows_without_gaps() -> None:
    for extent, least in RUNS.items():
        firsts = [int(row.name.split()[2]) for row in search.rows(extent) if row.group == RANDOM]
        assert firsts == list(range(0, SIZE * len(firsts), SIZE))
        assert 0 <= SIZE * len(firsts) - least < SIZE
