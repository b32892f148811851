"""Every way in which a run can end is told apart, above all those that must not be; two theories judge each other."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, hoop, liquid, pendulum, simulate, sliding
from mjbeer.exceptions import NoLibrationError, TemplateError
from mjbeer.simulation.run import Run
from mjbeer.studies.stability import judge as judging
from mjbeer.studies.stability import reference
from mjbeer.studies.stability.judge import (
    ACCURATE,
    INACCURATE,
    REFUSED,
    SILENT,
    Outcome,
    Trial,
    Truth,
    alarm,
    judge,
    truth,
)

pytestmark = pytest.mark.slow

TIME = np.linspace(0, 1, 201)
LONG = np.linspace(0, 3, 301)


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
        (lambda: simulate(hoop(), 2, 1.0, rolling="contact", integrator="DOP853"), judging.UNSTABLE, "slips"),
        (lambda: simulate(frozen(), 500, 1.0, timestep=0.5), judging.UNSTABLE, "diverged at t ="),
        (lambda: simulate(sliding(), 1, 1.0, rolling="contact"), REFUSED, 'only in rolling="reduced"'),
        (lambda: simulate(sliding(), 1, math.nan), REFUSED, "phi0 must be a finite number"),
        (lambda: simulate(frozen(), 1, 1.0, tolerance=1e-16), REFUSED, "tolerance 1e-16 rad is not reached"),
        (lambda: lying(0.012), SILENT, ""),
        (lambda: lying(0.008), ACCURATE, ""),
        (lambda: lying(0.008, 0.007), judging.MISSED, ""),
        (lambda: lying(0.008, 0.009), ACCURATE, ""),
        (lambda: lying(0.012, 0.007), SILENT, ""),
    ],
)
def test_verdicts(run: Callable[[], Run], verdict: str, says: str) -> None:
    outcome = judge(run)
    assert (outcome.verdict, says in outcome.says, outcome.says == "") == (verdict, True, says == ""), outcome


def test_warnings_that_differ_in_numbers_alone_are_equal_and_a_pull_is_none() -> None:
    both = [judge(lambda f=f: simulate(frozen(), 1, 1.0, rolling="contact", friction=f)) for f in (0.02, 0.03)]
    assert both[0].says != both[1].says
    for outcome in both:
        assert "the can slips by … radii (trusted up to …)" in outcome.alarms
    pulled = judge(lambda: simulate(frozen(), 2, math.pi))
    assert pulled.says
    assert not pulled.alarms


def test_a_liquid_that_is_no_lump_hides_no_wrong_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is judged is whether the equations were solved; whether they are those of a liquid is another matter."""

    def water(**setting: Any) -> Run:
        return simulate(liquid("water", math.radians(7)), 1.0, 0.5, **setting)

    right = judge(lambda: water(tolerance=1e-9))
    assert (right.verdict, right.says, right.alarms) == (ACCURATE, "", ())
    assert judge(lambda: water(integrator="Euler", timestep=0.02)).verdict == judging.INACCURATE
    monkeypatch.setattr("mjbeer.theory.record.Record.implied_error", 0.0)
    monkeypatch.setattr("mjbeer.simulation.run.Run.error_estimate", 0.0)
    run = water(integrator="Euler", timestep=0.02)
    assert run.liquid_warnings
    assert judge(lambda: run).verdict == SILENT


@pytest.mark.parametrize("error", [TemplateError("gone"), ZeroDivisionError()])
def test_an_error_in_the_program_is_no_outcome(error: Exception) -> None:
    def fail() -> Run:
        raise error

    with pytest.raises(type(error)):
        judge(fail)


def off_by_a_bit(run: Trial) -> tuple[str, float]:
    """What the alarm of a run is that is right at its samples and has warned."""
    return alarm(run, Outcome(ACCURATE, 1e-5, 1.0, "it is off by 1 rad", 0.0, ("it is off by",)))


@pytest.mark.parametrize(
    ("run", "kind"),
    [
        (Trial(frozen(), 1.0, integrator="RK4"), judging.FALSE),
        (Trial(frozen(), 0.0, 0.0, "contact", "RK4", 5e-4, None, 0.23, 400), judging.PARTS),
        (Trial(pendulum(0.0), math.pi - 1e-12, integrator="RK4", timestep=2e-3), judging.SENSITIVE),
        (Trial(frozen(), 1.0, integrator="Euler", timestep=8e-3, steps=200, moments=(1.0,)), judging.WAY),
        (
            Trial(frozen(), 1.0, integrator="RK4", timestep=0.5, moments=(1.0,)),
            judging.WAY,
        ),  # it explodes after its sample
    ],
)
def test_an_alarm_is_false_or_a_fact(run: Trial, kind: str) -> None:
    assert off_by_a_bit(run)[0] == kind
    assert alarm(run, Outcome(ACCURATE, 1e-5, 1.0, "N < 0")) == alarm(run, Outcome(INACCURATE)) == ("", 0.0)


def true(scene: Scene, phi0: float, phi_dot0: float = 0.0, times: np.ndarray = LONG) -> Truth:
    return truth(scene, times, phi0, phi_dot0)


@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum(-1.0)])
def test_both_theories_agree(scene: Scene) -> None:
    found = true(scene, 1.0, 2.0)
    assert len(found.motions) == 2
    assert found.explained
    assert found.apart is not None
    assert found.apart < 1e-12


def test_rounding_explains_where_they_part() -> None:
    """1e-12 rad from the top the spacing of doubles is a share of 4e-4; from the top it may fall either way."""
    beside = true(pendulum(0.0), math.pi - 1e-12)
    assert beside.apart is None or beside.apart > 1e-8
    assert beside.explained
    assert true(pendulum(0.0), math.pi).explained


def test_an_error_of_one_theory_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*arguments: object, **_: object) -> Trajectory:
        made = exact(*arguments)
        return replace(made, phi=made.phi + 2e-10 * (made.time > 1))

    monkeypatch.setattr(judging, "solution", wrong)
    found = true(frozen(), 1.0)
    assert found.apart is not None
    assert 1e-10 < found.apart <= 2e-10  # relative, as the load has turned by more than a radian
    assert not found.explained
    assert judge(lambda: simulate(frozen(), 3, 1.0)).verdict == judging.THEORIES


def nothing(*_: object, **__: object) -> Trajectory:
    raise NoLibrationError


def test_one_theory_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = true(frozen(), 1.0)
    monkeypatch.setattr(judging, "solution", nothing)
    alone = true(frozen(), 1.0)
    assert (alone.apart, alone.explained) == (None, True)
    assert whole.off(alone.motions[0].phi, alone.motions[0].roll) < 1e-12
    monkeypatch.setattr(reference, "MOST_STEPS", 3)
    none = true(frozen(), 1.0)
    assert (none.apart, none.explained) == (None, False)
    assert none.off(alone.motions[0].phi, alone.motions[0].roll) == math.inf
    assert judge(lambda: simulate(sliding(damping=1e-3), 1, 1.0)).verdict == judging.UNKNOWN
    monkeypatch.undo()
    monkeypatch.setattr(reference, "MOST_STEPS", 3)
    again = true(frozen(), 1.0)
    assert (again.apart, again.explained, len(again.motions)) == (None, True, 1)


def test_errors_are_relative_to_the_way_from_the_start() -> None:
    """A single late sample has turned as far as it is from the start, and not from itself."""
    whole, late = true(frozen(), math.pi), true(frozen(), math.pi, times=LONG[-1:])
    turned = abs(whole.motions[0].phi[-1] - math.pi)
    assert turned > 100
    for found in (whole, late):
        motion = found.motions[0]
        wrong = motion.phi.copy()
        wrong[-1] += 1
        assert found.off(wrong, motion.roll) == pytest.approx(1 / turned, rel=1e-6)
        nowhere = np.full_like(motion.phi, math.nan)
        assert not found.off(nowhere, motion.roll) <= 1
        assert not found.off(motion.phi, nowhere) <= 1


def test_what_passes_the_next_crest_by_rounding_is_no_quarrel_of_theories() -> None:
    """Its energy is below the crest by 1e-21 of the well, less than the rounding of its numbers."""
    motion = truth(frozen(0.0), np.array([6.0, 10.0]), math.pi + 2.7e-11, 0.0)
    ends = [seen.phi[-1] for seen in motion.motions]  # of both theories, and of those a rounding aside
    assert min(ends) < 3 * math.pi < max(ends)
    assert motion.explained
