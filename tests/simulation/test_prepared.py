"""A simulator that is kept gives the bits of a new one, and no two threads have the same."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from mjbeer import frozen, pendulum, sliding
from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.model.setting import Setting
from mjbeer.simulation import simulator as simulators
from mjbeer.simulation.simulator import Simulator
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


def bits(simulator: Simulator) -> bytes:
    return simulator.solve(simulator.initial_state(0.7, 2.0), TIMES).states.tobytes()


@pytest.mark.parametrize("setting", SETTINGS, ids=repr)
def test_what_was_done_before_leaves_no_trace(setting: Setting) -> None:
    vars(simulators._kept).clear()
    for scene in (*SCENES * 2, *DAMPED * 2):  # with damping and drag, and then without
        for _ in range(2):  # the second time the model has the scene's numbers already
            assert bits(Simulator.kept(scene, setting)) == bits(Simulator(scene, setting))
    assert len(simulators._kept.simulators) < len(SCENES)


def test_each_thread_has_its_own() -> None:
    one = Simulator.kept(SCENES[0], SETTINGS[0])
    before = bits(one)
    with ThreadPoolExecutor(1) as thread:
        other = thread.submit(Simulator.kept, SCENES[1], SETTINGS[0]).result()
    assert other.model is not one.model
    assert bits(one) == before


def test_a_run_that_failed_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjbeer.simulation.tolerance._EVALUATIONS", 100_000)  # soon, and not after millions
    failed = Simulator.kept(SCENES[0], Setting(integrator="Euler", timestep=1.0))
    with pytest.raises(DivergenceError):
        failed.solve(np.array([0.0, 0.7, 0.0, 1e9]), np.array([0.0, 100.0]))
    simulator = Simulator.kept(SCENES[0], Setting(tolerance=1e-13))
    assert simulator is failed
    with pytest.raises(ToleranceError):
        simulator.solve(simulator.initial_state(0.7, 2.0), np.array([0.0, 1e5]))
    simulator = Simulator.kept(SCENES[1], SETTINGS[0])
    assert simulator is failed
    assert bits(simulator) == bits(Simulator(SCENES[1], SETTINGS[0]))
