"""The catalogue of stiff and extreme cases: a third of it comes out as theory expects, as all does in the study."""

import json
import math
from collections import Counter
from functools import partial

import pytest

from mjbeer import Scene, exact, frozen, simulate, sliding
from mjbeer.studies.stability.catalogue import cases
from mjbeer.studies.stability.catalogue.case import Attempt, CatalogueCase, attempts, natural_period
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE, REFUSED, SILENT

pytestmark = pytest.mark.slow

CASES = cases.cases()
SAMPLE = [each for each in CASES if "1 - 1e" not in each.name][::3]
SAMPLE += [each for each in CASES if each.kind == "found" and each not in SAMPLE]
"""A nearly full can takes ten seconds to swing, and as many to simulate."""


@pytest.mark.parametrize("case", SAMPLE, ids=lambda case: f"{case.kind}: {case.name}")
def test_a_sample_comes_out_as_expected(case: CatalogueCase, monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion that no number of steps makes smooth is refused after fewer of them than usually."""
    monkeypatch.setattr("mjbeer.simulation.tolerance._EVALUATIONS", 500_000)
    found = case.measure(quick=True)
    assert found["runs"]
    for each in found["runs"]:
        assert each["as_expected"], each
        assert each["verdict"] != SILENT


def test_every_case_says_why() -> None:
    names = [(each.kind, each.name) for each in CASES]
    assert len(set(names)) == len(names)
    assert {each.kind for each in CASES} == {"stiff", "extreme", "found"}
    for each in CASES:
        assert each.why
        assert each.theory
        settings = [attempt.setting for attempt in each.attempts]
        assert len(set(settings)) == len(settings)
        assert any(attempt.sample for attempt in each.attempts)


def test_expectations_are_what_is_compared() -> None:
    """An accurate run where none is expected, and a doubtful one where an accurate one is, both stand out."""
    good = partial(simulate, frozen(), 0.3, 1.0)
    tries = (
        Attempt("a", good, (INACCURATE,)),
        Attempt("b", good, (ACCURATE,)),
        Attempt("c", good),
        Attempt("d", partial(simulate, frozen(), 2.0, 1.0, 0.0, "reduced", "Euler", 8e-3), (ACCURATE,), sample=False),
    )
    case = CatalogueCase("stiff", "name", "why", "theory", tries)
    assert [each["as_expected"] for each in case.measure(quick=False)["runs"]] == [False, True, True, False]
    assert [each["setting"] for each in case.measure(quick=True)["runs"]] == ["a", "b", "c"]
    assert json.loads(json.dumps(case.measure(quick=True), allow_nan=False))["why"] == "why"


def test_attempts_know_what_mujoco_has_no_model_of() -> None:
    expected = {each.setting: each.expected for each in attempts(sliding(), 1.0)}
    assert expected["reduced, RK4, T/300"] == (ACCURATE,)
    assert expected["equality, Euler, T/300"] == expected["contact, RK4, T/300"] == (REFUSED,)
    assert Counter(each.split(",")[0] for each in expected) == {"reduced": 8, "equality": 7, "contact": 6}


@pytest.mark.parametrize(
    ("scene", "phi_dot0", "period"),
    [
        (frozen(), 0.0, 2 * math.pi / frozen().frequency()),
        (frozen(), 1e4, 2e-4 * math.pi),
        (frozen(0.9), 0.0, 2 * math.pi * math.sqrt(0.033 / 9.81)),
        (frozen(gravity=0.0), 0.0, 1.0),
    ],
)
def test_natural_period(scene: Scene, phi_dot0: float, period: float) -> None:
    assert natural_period(scene, phi_dot0) == pytest.approx(period, rel=1e-14)


def test_friction_cases_stand_on_either_side_of_what_is_needed() -> None:
    needed = float(exact(frozen(), [k / 1000 for k in range(1001)], 0.0).forces.needed.max())
    for case in CASES:
        if case.name.startswith("friction "):
            value = float(case.name.split()[1])
            assert all((INACCURATE in each.expected) == (value < needed) for each in case.attempts)
