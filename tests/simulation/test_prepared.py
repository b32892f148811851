"""A set-up that is lent again gives the bits of a new one, and nobody gets one that is in use."""

import numpy as np
import pytest

from mjbeer import frozen, pendulum, sliding
from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.model.setting import Setting
from mjbeer.simulation import run
from mjbeer.simulation.run import Simulator
from tests.support.scenes import METAL

SETTINGS = [
    Setting(tolerance=1e-7),
    Setting("equality", tolerance=1e-6),
    Setting(integrator="DOP853", timestep=1e-2),
    Setting("equality", "DOP853", timestep=1e-2),
    Setting("equality", "implicit", timestep=2e-3),
    Setting("contact", timestep=2e-3),
]
SCENES = [sliding(can=METAL), sliding(0.3, 0.2, can=METAL), frozen(0.2), frozen(0.3, 0.8, can=METAL), pendulum()]
DAMPED = [
    sliding(can=METAL, damping=1e-4, drag=0.1), sliding(0.3, can=METAL, damping=1e-3), sliding(can=METAL, drag=0.2)
]  # fmt: skip
TIMES = np.linspace(0, 0.4, 5)


@pytest.fixture(autouse=True)
def none_idle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "_pool", {})


def bits(simulator: Simulator) -> bytes:
    return simulator.solve(simulator.initial_state(0.7, 2.0), TIMES).states.tobytes()


@pytest.mark.parametrize("setting", SETTINGS, ids=repr)
def test_what_was_done_before_leaves_no_trace(setting: Setting) -> None:
    for scene in (*SCENES * 2, *DAMPED * 2):  # with damping and drag, and then without
        for _ in range(2):  # the second time the model has the scene's numbers already
            with Simulator.from_pool(scene, setting) as simulator:
                assert bits(simulator) == bits(Simulator(scene, setting))
    assert len(run._pool) < len(SCENES)


def test_a_set_up_in_use_is_not_lent() -> None:
    with Simulator.from_pool(SCENES[0], SETTINGS[0]) as one:
        before = bits(one)
        with Simulator.from_pool(SCENES[1], SETTINGS[0]) as other:
            assert other.model is not one.model
        assert bits(one) == before


def test_a_set_up_comes_back_from_a_run_that_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjbeer.simulation.tolerance._EVALUATIONS", 100_000)  # soon, and not after millions
    with (
        pytest.raises(DivergenceError),
        Simulator.from_pool(SCENES[0], Setting(integrator="Euler", timestep=1.0)) as failed,
    ):
        failed.solve(np.array([0.0, 0.7, 0.0, 1e9]), np.array([0.0, 100.0]))
    with Simulator.from_pool(SCENES[0], Setting(tolerance=1e-13)) as simulator:
        assert simulator.model is failed.model
        with pytest.raises(ToleranceError):
            simulator.solve(simulator.initial_state(0.7, 2.0), np.array([0.0, 1e5]))
    with Simulator.from_pool(SCENES[1], SETTINGS[0]) as simulator:
        assert simulator.model is failed.model
        assert bits(simulator) == bits(Simulator(SCENES[1], SETTINGS[0]))
