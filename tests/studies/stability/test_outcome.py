"""Every way in which a run can end is told apart, and above all the one that must not occur."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, simulate, sliding
from mjbeer.exceptions import MjbeerError, OutputError, TemplateError
from mjbeer.simulation.run import Run
from mjbeer.studies.stability import truth
from mjbeer.studies.stability.outcome import (
    ACCURATE,
    INACCURATE,
    MISSED,
    REFUSED,
    SILENT,
    THEORIES,
    UNSTABLE,
    judge,
)
from mjbeer.theory.equations import Coordinates

TIME = np.linspace(0, 1, 201)


def lying(error: float, tolerance: float | None = None) -> Run:
    """A run that ends elsewhere than its steps did, of which it says nothing."""
    run = simulate(frozen(), 1, 0.5, tolerance=tolerance, times=TIME)
    late = error * (run.time > 0.5)
    return replace(run, phi=run.phi + late, u=run.u + run.scene.can.radius * late)


@pytest.mark.parametrize(
    ("run", "verdict", "says"),
    [
        (lambda: simulate(frozen(), 1, 1.0), ACCURATE, ""),
        (lambda: simulate(frozen(), 2, math.pi), ACCURATE, "would have to pull"),
        (lambda: simulate(frozen(), 2, 1.0, integrator="Euler", timestep=4e-3), INACCURATE, "other timesteps"),
        (lambda: simulate(frozen(), 1, 1.0, rolling="contact", friction=0.02), INACCURATE, "slips"),
        (lambda: simulate(hoop(), 2, 1.0, rolling="contact", integrator="DOP853"), UNSTABLE, "slips"),
        (lambda: simulate(frozen(), 500, 1.0, timestep=0.5), UNSTABLE, "diverged at t ="),
        (lambda: simulate(sliding(), 1, 1.0, rolling="contact"), REFUSED, 'only in rolling="reduced"'),
        (lambda: simulate(sliding(), 1, math.nan), REFUSED, "phi0 must be a finite number"),
        (lambda: simulate(frozen(), 1, 1.0, tolerance=1e-16), REFUSED, "tolerance 1e-16 rad is not reached"),
    ],
)
def test_verdicts(run: Callable[[], Run], verdict: str, says: str) -> None:
    outcome = judge(run)
    assert (outcome.verdict, says in outcome.says) == (verdict, True), outcome


@pytest.mark.parametrize(
    ("error", "tolerance", "verdict"),
    [
        (0.012, None, SILENT),
        (0.008, None, ACCURATE),
        (0.008, 0.007, MISSED),
        (0.008, 0.009, ACCURATE),
        (0.012, 0.007, SILENT),
    ],
)
def test_a_run_that_is_wrong_without_a_word_is_caught(error: float, tolerance: float | None, verdict: str) -> None:
    outcome = judge(lambda: lying(error, tolerance))
    assert outcome.verdict == verdict
    assert outcome.error == pytest.approx(error, rel=1e-3)


def test_a_late_sample_is_judged_by_the_start_of_the_motion() -> None:
    run = lying(0.012)
    late = {name: getattr(run, name)[-1:] for name in Coordinates.__dataclass_fields__}
    assert judge(lambda: replace(run, **late)).verdict == SILENT


def test_no_run_is_judged_where_theories_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    def other(*arguments: object, **_: object) -> object:
        made = exact(*arguments)
        return replace(made, phi=made.phi * 1.001)

    monkeypatch.setattr(truth, "solution", other)
    outcome = judge(lambda: simulate(frozen(), 1, 1.0))
    assert outcome.verdict == THEORIES
    assert outcome.apart == pytest.approx(1e-3, rel=0.1)


def test_warnings_that_differ_in_numbers_alone_are_equal() -> None:
    both = [judge(lambda f=f: simulate(frozen(), 1, 1.0, rolling="contact", friction=f)) for f in (0.02, 0.03)]
    assert both[0].says != both[1].says
    for outcome in both:
        assert "the can slips by … radii (trusted up to …)" in outcome.alarms


def test_refusals_have_their_reason_too() -> None:
    outcome = judge(lambda: simulate(frozen(), 1, 1.0, tolerance=1e-16))
    assert outcome.alarms[0].startswith("tolerance … rad is not reached: ")


@pytest.mark.parametrize("error", [TemplateError("gone"), OutputError("full")])
def test_a_run_that_cannot_be_tried_is_not_refused(error: MjbeerError) -> None:
    def fail() -> Run:
        raise error

    with pytest.raises(type(error)):
        judge(fail)


def test_an_error_in_the_program_is_no_outcome() -> None:
    with pytest.raises(ZeroDivisionError):
        judge(lambda: 1 / 0)
