"""Two theories that share no code: they agree, rounding explains where they part, and an error in one is seen."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, pendulum, sliding
from mjbeer.exceptions import NoLibrationError
from mjbeer.studies.stability import truth
from mjbeer.studies.stability.reference import lagrangian
from mjbeer.studies.stability.truth import Truth

pytestmark = pytest.mark.slow

TIMES = np.linspace(0, 3, 301)


def true(scene: Scene, phi0: float, phi_dot0: float = 0.0, times: np.ndarray = TIMES) -> Truth:
    return truth.truth(scene, times, phi0, phi_dot0)


@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum(-1.0)])
def test_both_agree(scene: Scene) -> None:
    found = true(scene, 1.0, 2.0)
    assert len(found.motions) == 2
    assert found.apart is not None
    assert found.apart < 1e-12
    assert found.explained


def test_rounding_explains_where_they_part() -> None:
    """1e-12 rad from the top the spacing of doubles is a share of 4e-4; from the top it may fall either way."""
    scene = pendulum(0.0)
    beside = true(scene, math.pi - 1e-12)
    assert beside.apart is None or beside.apart > 1e-8
    assert beside.explained
    assert true(scene, math.pi).explained


def test_an_error_of_one_theory_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*arguments: object, **_: object) -> Trajectory:
        made = exact(*arguments)
        return replace(made, phi=made.phi + 2e-10 * (made.time > 1))

    monkeypatch.setattr(truth, "solution", wrong)
    found = true(frozen(), 1.0)
    assert found.apart is not None
    assert 1e-10 < found.apart <= 2e-10  # relative, as the load has turned by more than a radian
    assert not found.explained


def test_one_theory_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    def separatrix(*_: object, **__: object) -> Trajectory:
        raise NoLibrationError

    whole = true(frozen(), 1.0)
    monkeypatch.setattr(truth, "solution", separatrix)
    alone = true(frozen(), 1.0)
    assert (alone.apart, alone.explained) == (None, True)
    assert whole.off(alone.motions[0].phi, alone.motions[0].roll) < 1e-12
    monkeypatch.setattr(lagrangian, "MOST_STEPS", 3)
    none = true(frozen(), 1.0)
    assert (none.apart, none.explained) == (None, False)
    assert none.off(alone.motions[0].phi, alone.motions[0].roll) == math.inf
    monkeypatch.undo()
    monkeypatch.setattr(lagrangian, "MOST_STEPS", 3)
    again = true(frozen(), 1.0)
    assert (again.apart, again.explained) == (None, True)
    assert len(again.motions) == 1


def test_beside_a_separatrix_each_start_that_doubles_confuse_is_right(monkeypatch: pytest.MonkeyPatch) -> None:
    """On the top at rest the load may fall either way, if `solution` does not say that it stays."""

    def separatrix(*_: object, **__: object) -> Trajectory:
        raise NoLibrationError

    monkeypatch.setattr(truth, "solution", separatrix)
    found = true(pendulum(0.0), math.pi)
    ends = [motion.phi[-1] - math.pi for motion in found.motions]
    assert min(ends) < -1
    assert max(ends) > 1
    for motion in found.motions:
        assert found.off(motion.phi, motion.roll) == 0


def test_errors_are_relative_to_the_way_from_the_start() -> None:
    """A single late sample has turned as far as it is from the start, and not from itself."""
    scene = frozen()
    whole, late = true(scene, math.pi), true(scene, math.pi, times=TIMES[-1:])
    turned = abs(whole.motions[0].phi[-1] - math.pi)
    assert turned > 100
    for found in (whole, late):
        motion = found.motions[0]
        wrong = motion.phi.copy()
        wrong[-1] += 1
        assert found.off(wrong, motion.roll) == pytest.approx(1 / turned, rel=1e-6)


def test_a_motion_that_is_not_finite_is_off() -> None:
    found = true(frozen(), 1.0)
    motion = found.motions[0]
    nowhere = np.full_like(motion.phi, math.nan)
    assert not found.off(nowhere, motion.roll) <= 1
    assert not found.off(motion.phi, nowhere) <= 1
