"""Every way in which a run can end is told apart, and above all the one that must not occur."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Trajectory, exact, frozen, hoop, simulate, sliding
from mjbeer.studies.stability.outcome import ACCURATE, INACCURATE, REFUSED, SILENT, UNSTABLE, judge

TIME = np.linspace(0, 1, 201)


def lying(error: float) -> Trajectory:
    """A motion that starts elsewhere than it says, and finds nothing wrong with itself."""
    made = exact(frozen(), TIME, 1.0)
    return replace(
        made, phi=made.phi + error * (TIME > 0), u=made.u + 0.033 * error * (TIME > 0), roll=made.roll + error
    )


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
def test_verdicts(run: Callable[[], Trajectory], verdict: str, says: str) -> None:
    outcome = judge(run)
    assert (outcome.verdict, says in outcome.says) == (verdict, True), outcome


@pytest.mark.parametrize(("error", "verdict"), [(0.012, SILENT), (0.008, ACCURATE)])
def test_a_run_that_is_wrong_without_a_word_is_caught(
    error: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its own diagnostics are made blind, as those of a run would be that misses something in them."""
    monkeypatch.setattr("mjbeer.theory.trajectory.doubts", lambda *_, **__: [])
    outcome = judge(lambda: lying(error))
    assert outcome.verdict == verdict
    assert outcome.error == pytest.approx(error, rel=1e-9)


def test_an_error_in_the_program_is_no_outcome() -> None:
    with pytest.raises(ZeroDivisionError):
        judge(lambda: 1 / 0)
