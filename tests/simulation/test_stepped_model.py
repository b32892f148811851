"""A model that is kept gives the bits of a new one, and no two threads have the same."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.model.setting import Setting
from mjbeer.simulation.methods import model_numbers
from mjbeer.simulation.solve import solve
from mjbeer.simulation.stepped_model import SteppedModel, kept_model
from mjbeer.simulation.tolerance import Problem
from tests.support.scenes import METAL

SETTINGS = [
    Setting(tolerance=1e-7),
    Setting("equality", tolerance=1e-6),
    Setting(integrator="DOP853", timestep=1e-2),
    Setting("equality", "DOP853", timestep=1e-2),
    Setting("equality", "implicit", timestep=2e-3),
    Setting("contact", timestep=2e-3),
]
SCENES = [
    sliding(can=METAL),
    sliding(0.3, 0.2, can=METAL),
    frozen(0.2),
    frozen(0.3, 0.8, can=METAL),
    pendulum(),
]
DAMPED = [
    sliding(can=METAL, damping=1e-4, drag=0.1),
    sliding(0.3, can=METAL, damping=1e-3),
    sliding(can=METAL, drag=0.2),
]
TIMES = np.linspace(0, 0.4, 5)


def kept(scene: Scene, setting: Setting) -> SteppedModel:
    return kept_model(model_numbers(scene, setting))


def new(scene: Scene, setting: Setting) -> SteppedModel:
    return SteppedModel(model_numbers(scene, setting))


def bits(stepped: SteppedModel, setting: Setting) -> bytes:
    return solve(stepped, setting, stepped.initial_state(0.7, 2.0), TIMES).states.tobytes()


@pytest.mark.parametrize("setting", SETTINGS, ids=repr)
def test_what_was_done_before_leaves_no_trace(setting: Setting) -> None:
    models = set()

    def assert_same_bits() -> None:
        for scene in (*SCENES * 2, *DAMPED * 2):  # with damping and drag, and then without
            expected = bits(new(scene, setting), setting)
            for _ in range(2):  # the second time the model has the scene's numbers already
                stepped = kept(scene, setting)
                models.add(id(stepped.model))
                assert bits(stepped, setting) == expected

    with ThreadPoolExecutor(1) as thread:  # which has no models of other tests
        thread.submit(assert_same_bits).result()
    assert len(models) < len(SCENES)


def test_each_thread_has_its_own() -> None:
    setting = SETTINGS[0]
    one = kept(SCENES[0], setting)
    before = bits(one, setting)
    with ThreadPoolExecutor(1) as thread:
        other = thread.submit(kept, SCENES[1], setting).result()
    assert other.model is not one.model
    assert bits(one, setting) == before


def test_a_run_that_failed_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    # It is given up soon, and not after millions.
    monkeypatch.setattr("mjbeer.simulation.solve.EVALUATIONS", 100_000)
    coarse = Setting(integrator="Euler", timestep=1.0)
    failed = kept(SCENES[0], coarse)
    with pytest.raises(DivergenceError):
        solve(failed, coarse, np.array([0.0, 0.7, 0.0, 1e9]), np.array([0.0, 100.0]))
    tight = Setting(tolerance=1e-12)
    stepped = kept(SCENES[0], tight)
    assert stepped is failed
    with pytest.raises(ToleranceError):
        solve(stepped, tight, stepped.initial_state(0.7, 2.0), np.array([0.0, 1e5]))
    stepped = kept(SCENES[1], SETTINGS[0])
    assert stepped is failed
    assert bits(stepped, SETTINGS[0]) == bits(new(SCENES[1], SETTINGS[0]), SETTINGS[0])


@pytest.mark.parametrize("scene", [sliding(), frozen()])
def test_a_nudge_changes_the_energy_in_one_direction(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Position and rate could change it in opposite ways, and hide what rounding does beside a
    separatrix."""
    problems: list[Problem] = []

    def note(_: object, problem: Problem, __: object) -> None:
        problems.append(problem)

    monkeypatch.setattr("mjbeer.simulation.solve.solve_to_tolerance", note)
    stepped = new(scene, SETTINGS[0])
    place = stepped.model.nq - 1
    for phi0, phi_dot0 in ((1.0, 3.0), (-2.0, 3.0), (1.0, -3.0), (2.5, -0.1)):
        start = stepped.initial_state(phi0, phi_dot0)
        solve(stepped, SETTINGS[0], start, TIMES)
        nudge = np.sign(problems[-1].nudged_start - start)
        assert nudge[-1] * phi_dot0 > 0
        if phi_dot0 == -0.1:  # nearly at rest the torque is all of the acceleration
            assert scene.oscillator.drop(phi0 + 1e-6 * nudge[place], phi0) < 0
