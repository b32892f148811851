"""The validation table passes row by row, and each kind of row fails on a wrong model or a misprint."""

import dataclasses
import json
import math

import numpy as np
import pytest

from mjbeer import Can, exact, hoop, simulate, sliding
from mjbeer.checks import Check, Result
from mjbeer.studies.validation import motion_checks as motions
from mjbeer.studies.validation.validate import Validation, checks
from mjbeer.theory import exact as theory
from mjbeer.theory import trajectory

CHECKS = {f"{check.name} - {check.by}": check for check in checks()}


@pytest.mark.slow
@pytest.mark.parametrize("check", CHECKS.values(), ids=CHECKS)
def test_check(check: Check) -> None:
    result = check.result()
    assert result.passed, f"{result.error} > {result.bound} {result.unit}"


def test_checks_are_told_apart() -> None:
    assert len(CHECKS) == len(checks())


def test_checks_can_be_written() -> None:
    """A bound that NumPy computed would make the verdict one of its own, which JSON does not have."""
    results = [Result(row.group, row.name, row.by, row.bound, row.unit, row.reason, 0.0) for row in CHECKS.values()]
    assert len(json.loads(Validation(results, []).json())["checks"]) == len(CHECKS)


def test_a_wrong_motion_is_found_out() -> None:
    """A gravity 1e-7 too strong shows in phi, in the period and in the acceleration."""
    run = simulate(sliding(gravity=9.81 * (1 + 1e-6)), 4, 1.0)
    wrong = dataclasses.replace(run, scene=sliding())
    assert theory.phi_error(wrong) > 1e-7
    assert abs(2 * math.pi / wrong.frequency() / sliding().period(1.0) - 1) > 1e-9
    steady = simulate(sliding(gravity=9.81 * (1 + 1e-6)), 2, 0.0)
    assert abs(trajectory.mean_acceleration(steady) / sliding().acceleration() - 1) > 1e-10


def test_takeoff_is_the_first_sample_in_the_air() -> None:
    fall = exact(hoop(), np.linspace(0, 0.3, 4), 3.0)
    lifted = dataclasses.replace(fall, lift=np.array([-1e-9, 0.0, 1e-6, 2e-6]))
    assert fall.takeoff() is None
    assert lifted.takeoff() == pytest.approx(math.pi - fall.phi[2])


@pytest.mark.slow
def test_a_wrong_prediction_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    right = motions.energy_per_swing
    monkeypatch.setattr(motions, "energy_per_swing", lambda *words: 1.01 * right(*words))
    assert not next(row for told, row in CHECKS.items() if told.startswith("energy that a swing")).result().passed


def test_energy_that_obeys_the_other_law_is_found_out() -> None:
    """It drifts in proportion to the number of swings in place of staying within bounds, and the reverse."""
    free = sliding(0.0, can=Can.hoop(mass=1e5))
    assert (motions._drift(free, "RK4", 10)[1] - 1).max() > 0.05
    assert abs(motions._drift_exponent(free, "Euler", 32)) > 0.02
