"""The compiled integrator: against SciPy's on the same equations, its continuous output, its limits."""

import mujoco
import numpy as np
import pytest
from numba import njit
from scipy import integrate

from mjbeer import Can, Scene, exact, frozen, sliding
from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics, derivative
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.theory.equations import accelerations
from tests.support.scenes import SCENES


def test_fixed_step_is_scipy_s_step() -> None:
    """One step of the same method from the same state on hand-derived equations: equal but for rounding."""
    scene, step, begin = frozen(), 2e-2, np.array([0.0, 1.0, 0.0, 0.5])

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[2:], accelerations(scene, y[1], y[3], y[2])])

    reference = integrate.DOP853(slope, 0.0, begin, 1.0, first_step=step, max_step=step, rtol=1e-2, atol=1e-2)
    reference.step()
    model = build(scene)
    ours = DOP853(model).run(initial_state(model, scene, 1.0, 0.5), np.array([0.0, step / 3, step]), step)
    # Twelve slopes of size 50 and 5 times a step of 0.02, each with the rounding of its forward dynamics.
    assert ours[2] == pytest.approx(reference.y[1::2], rel=1e-13)
    assert ours[1] == pytest.approx(reference.dense_output()(step / 3)[1::2], rel=1e-13)


def test_continuous_output_is_of_seventh_order() -> None:
    """Between steps: a tenth of a step in, the error falls at least as step^7 until rounding."""
    scene = frozen()
    model = build(scene)
    begin, steps, errors = initial_state(model, scene, 0.3, 0.0), 0.16 / 2.0 ** np.arange(4), []
    for step in steps:
        times = step * (np.arange(int(2 / step)) + 0.1)
        found = to_coordinates(model, scene, DOP853(model).run(begin, times, float(step)), times).phi
        errors.append(np.abs(found - exact(scene, times, 0.3).phi).max())
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(7.5, abs=0.8)


@pytest.mark.parametrize(
    ("rate", "end", "setting", "message"),
    [
        (0.0, 1e4, {"timestep": 1e-3, "limit": 1000}, r"given up at t = [\d.]+ s after \d+ evaluations"),
        (1e300, 1.0, {"tolerance": 1e-6}, "no longer finite"),
    ],
)
def test_a_run_without_an_end_is_a_divergence(rate: float, end: float, setting: dict, message: str) -> None:
    with pytest.raises(DivergenceError, match=message):
        DOP853(build(frozen())).run(np.array([1.0, rate]), np.array([0.0, end]), **setting)


@njit
def evaluate(pointers: tuple, views: tuple, state: np.ndarray, out: np.ndarray) -> None:
    derivative(pointers, views, state, out)


@pytest.mark.parametrize("scene", [*SCENES.values(), sliding(can=Can.sheet_metal(), damping=1e-3)])
def test_what_is_left_out_of_an_evaluation_changes_no_bit(scene: Scene) -> None:
    """The functions called for a smooth model give mj_forward's acceleration, constant forces included."""
    model = build(scene)
    begin = initial_state(model, scene, 0.7, 2.0)
    dynamics, rates = Dynamics(model), np.empty_like(begin)
    assert len(dynamics.kernel[0][0]) > 1
    evaluate(*dynamics.kernel, begin, rates)
    data = mujoco.MjData(model)
    data.qpos, data.qvel = np.split(begin, 2)
    mujoco.mj_forward(model, data)
    # The actuator's force is added to the others in another order: one rounding of their sum.
    exactly = model.nu == 0
    assert rates[model.nv :] == pytest.approx(data.qacc, rel=0 if exactly else 1e-15, abs=0)
