"""The compiled integrator: against SciPy's on the same equations, its continuous output, its
limits."""

import mujoco
import numpy as np
import pytest
from numba import njit
from scipy import integrate

from mjbeer import Can, Scene, exact, frozen, sliding
from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics, ForwardDynamics, write_derivative
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.theory.equations import accelerations
from tests.support.scenes import SCENES


def test_fixed_step_is_scipy_s_step() -> None:
    """One step of the same method from the same state on hand-derived equations: equal but for
    rounding."""
    scene = frozen()
    step = 2e-2

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[2:], accelerations(scene, y[1], y[3], y[2])])

    start = np.array([0.0, 1.0, 0.0, 0.5])
    reference = integrate.DOP853(
        slope, 0.0, start, 1.0, first_step=step, max_step=step, rtol=1e-2, atol=1e-2
    )
    reference.step()
    model = build(scene)
    method = DOP853(Dynamics(model), timestep=step)

    states = method.run(initial_state(model, scene, 1.0, 0.5), np.array([0.0, step / 3, step]))

    # Twelve slopes of size 50 and 5 times a step of 0.02, each with the rounding of its forward
    # dynamics.
    assert states[2] == pytest.approx(reference.y[1::2], rel=1e-13)
    assert states[1] == pytest.approx(reference.dense_output()(step / 3)[1::2], rel=1e-13)


def test_continuous_output_is_of_seventh_order() -> None:
    """Between steps: a tenth of a step in, the error falls at least as step^7 until rounding."""
    scene = frozen()
    model = build(scene)
    start = initial_state(model, scene, 0.3, 0.0)
    steps = 0.16 / 2.0 ** np.arange(4)
    errors = []
    for step in steps:
        times = step * (np.arange(int(2 / step)) + 0.1)
        states = DOP853(Dynamics(model), timestep=float(step)).run(start, times)
        phi = to_coordinates(model, scene, states, times).phi
        errors.append(np.abs(phi - exact(scene, times, 0.3).phi).max())
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # Of four errors: the steps' own error, of order 8, adds to that between them.
    assert order == pytest.approx(7.5, abs=0.8)


def test_a_run_of_too_many_evaluations_is_given_up() -> None:
    dynamics = Dynamics(build(frozen()))
    dynamics.most_evaluations = 1000
    method = DOP853(dynamics, timestep=1e-3)
    with pytest.raises(DivergenceError, match=r"given up at t = [\d.]+ s after \d+ evaluations"):
        method.run(np.array([1.0, 0.0]), np.array([0.0, 1e4]))


def test_a_motion_that_is_not_finite_is_a_divergence() -> None:
    method = DOP853(Dynamics(build(frozen())), local_tolerance=1e-6)
    with pytest.raises(DivergenceError, match="no longer finite"):
        method.run(np.array([1.0, 1e300]), np.array([0.0, 1.0]))


def test_evaluations_add_up_over_runs() -> None:
    dynamics = Dynamics(build(frozen()))
    method = DOP853(dynamics, timestep=1e-2)
    for _ in range(3):
        method.run(np.array([1.0, 0.0]), np.array([0.0, 1e-1]))
    assert dynamics.evaluations == 3 * (1 + 10 * 12)


@njit
def evaluate(dynamics: ForwardDynamics, state: np.ndarray, out: np.ndarray) -> None:
    write_derivative(dynamics, state, out)


@pytest.mark.parametrize("scene", [*SCENES.values(), sliding(can=Can.sheet_metal(), damping=1e-3)])
def test_what_is_left_out_of_an_evaluation_changes_no_bit(scene: Scene) -> None:
    """The functions called for a smooth model give mj_forward's acceleration, constant forces
    included."""
    model = build(scene)
    start = initial_state(model, scene, 0.7, 2.0)
    dynamics = Dynamics(model)
    assert len(dynamics.kernel_view.functions) > 1
    derivative = np.empty_like(start)

    evaluate(dynamics.kernel_view, start, derivative)

    data = mujoco.MjData(model)
    data.qpos[:] = start[: model.nq]
    data.qvel[:] = start[model.nq :]
    mujoco.mj_forward(model, data)
    # The actuator's force is added to the others in another order: one rounding of their sum.
    exactly = model.nu == 0
    assert derivative[model.nv :] == pytest.approx(data.qacc, rel=0 if exactly else 1e-15, abs=0)
