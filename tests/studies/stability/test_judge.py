"""Each way in which a run can end is told apart, above all a run that is wrong and silent."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Scene, frozen, hoop, liquid, pendulum, simulate, sliding
from mjbeer.exceptions import TemplateError
from mjbeer.simulation.run import Run
from mjbeer.studies.stability import judge as judging
from mjbeer.studies.stability.judge import (
    BOTH,
    REFUSED,
    RIGHT,
    SERIES,
    THEORY,
    UNDETECTED_ERROR,
    WARNED,
    Trial,
    judge,
    reference_motions,
)

pytestmark = pytest.mark.slow

LONG = np.linspace(0, 3, 301)
METAL = Can.sheet_metal()
SOFT = 1e-6
"""Error of an attached can over a second [rad]: its contact is soft."""


@pytest.mark.parametrize(
    ("trial", "verdict", "judged_by", "says"),
    [
        (Trial(frozen(), 1.0), RIGHT, BOTH, ""),
        (Trial(frozen(), 1.0, tolerance=1e-9), RIGHT, BOTH, ""),
        (Trial(frozen(), math.pi, steps=2000), WARNED, BOTH, "would have to pull"),
        (
            Trial(frozen(), 1.0, integrator="Euler", timestep=4e-3, steps=500),
            WARNED,
            BOTH,
            "other timesteps",
        ),
        (Trial(frozen(), 1.0, rolling="contact", friction=0.02), WARNED, BOTH, "slips"),
        (
            Trial(hoop(), 1.0, rolling="contact", integrator="DOP853", steps=2000),
            WARNED,
            BOTH,
            "slips",
        ),
        (Trial(frozen(), 1.0, timestep=0.5), REFUSED, "", "diverged at t ="),
        (Trial(sliding(), 1.0, rolling="contact"), REFUSED, "", 'only in rolling="reduced"'),
        (Trial(sliding(), math.nan), REFUSED, "", "phi0 must be a finite number"),
        (Trial(frozen(), 1.0, tolerance=1e-16), REFUSED, "", "tolerance 1e-16 rad is not reached"),
        (Trial(sliding(can=METAL, damping=1e-3), 1.0), RIGHT, THEORY, ""),
        (Trial(liquid("honey"), 1.0, tolerance=1e-6), RIGHT, THEORY, ""),
        (Trial(sliding(can=METAL), 1.0, rolling="contact", attached=True), RIGHT, THEORY, ""),
        (
            Trial(frozen(can=METAL), 1.0, rolling="contact", integrator="RK4", attached=True),
            RIGHT,
            THEORY,
            "",
        ),
    ],
    ids=str,
)
def test_verdicts(trial: Trial, verdict: str, judged_by: str, says: str) -> None:
    outcome = judge(trial)

    assert (outcome.verdict, outcome.judged_by) == (verdict, judged_by), outcome
    if says:
        assert says in outcome.says
    else:
        assert outcome.says == ""
    if trial.attached:
        assert outcome.error <= SOFT


@pytest.mark.parametrize(
    ("error", "tolerance", "verdict"),
    [
        (0.012, None, UNDETECTED_ERROR),
        (0.008, None, RIGHT),
        (0.008, 0.007, UNDETECTED_ERROR),
        (0.008, 0.009, RIGHT),
        (0.012, 0.1, UNDETECTED_ERROR),
    ],
)
def test_a_run_that_ends_elsewhere_than_its_steps_did_is_silent(
    error: float, tolerance: float | None, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lying(**given: Any) -> Run:
        run = simulate(**given)
        late = error * (run.time > 0.5)
        return replace(run, phi=run.phi + late, u=run.u + run.scene.can.radius * late)

    monkeypatch.setattr(judging, "simulate", lying)

    outcome = judge(Trial(frozen(), 0.5, tolerance=tolerance))

    assert outcome.verdict == verdict
    assert outcome.error == pytest.approx(error, rel=1e-3)


def test_an_attached_can_that_rolls_otherwise_is_silent_but_not_where_it_cannot_roll(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    trial = Trial(sliding(can=METAL), 1.0, rolling="contact", attached=True)
    right = judging.roll

    def wrong(scene: Scene, *rest: Any) -> Any:
        return right(replace(scene, incline=scene.incline + 0.1), *rest)

    monkeypatch.setattr(judging, "roll", wrong)

    assert judge(trial).verdict == UNDETECTED_ERROR
    assert judge(replace(trial, friction=1e-3)).verdict == RIGHT


@pytest.mark.parametrize("error", [TemplateError("gone"), ZeroDivisionError()])
def test_an_error_in_the_program_is_no_outcome(
    error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(**_: Any) -> Run:
        raise error

    monkeypatch.setattr(judging, "simulate", fail)
    with pytest.raises(type(error)):
        judge(Trial(frozen(), 1.0))


def test_theories_that_differ_by_what_rounding_explains_are_both_right() -> None:
    """They differ by a ten-billionth of a radian beside a separatrix."""
    _, top = pendulum(0.0).separatrix()

    beside = reference_motions(pendulum(0.0), LONG, top - 1e-12, 0.0)

    assert beside.judged_by in (BOTH, SERIES)
    assert math.isfinite(beside.distance)
    assert len(beside.motions) > 2


def test_theories_that_differ_more_are_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    assert reference_motions(frozen(), LONG, 1.0, 0.0).distance < 1e-11
    right = judging.exact_motion

    def wrong(scene: Scene, *rest: Any) -> Any:
        return right(replace(scene, gravity=9.8101), *rest)

    monkeypatch.setattr(judging, "exact_motion", wrong)

    assert reference_motions(frozen(), LONG, 1.0, 0.0).distance == math.inf
    assert judge(Trial(frozen(), 1.0)).verdict == UNDETECTED_ERROR
