"""The compiled integrator: against SciPy's on the same equations, its continuous output, its limits."""

import math
import os
import pathlib
import subprocess
import sys

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjbeer import Can, Scene, exact, frozen, pendulum, sliding
from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import build
from mjbeer.model.state import read, start
from mjbeer.simulation import dop853_kernel
from mjbeer.simulation.dop853 import Integrator, integrate
from mjbeer.simulation.stepping import _COMPILING
from mjbeer.theory.equations import accelerations
from tests.support.scenes import SCENES


def test_fixed_step_is_scipy_s_step() -> None:
    """One step of the same method from the same state on hand-derived equations: equal but for rounding."""
    scene, step = frozen(), 2e-2
    from scipy.integrate import DOP853

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        return np.array([y[1], accelerations(scene, y[0], y[1], 0.0)[1]])

    reference = DOP853(slope, 0.0, np.array([1.0, 0.5]), 1.0, first_step=step, max_step=step, rtol=1e-2, atol=1e-2)
    reference.step()
    model = build(scene)
    ours = integrate(model, start(model, scene, 1.0, 0.5), np.array([0.0, step / 3, step]), timestep=step)
    # Twelve slopes of size 50 and 5 times a step of 0.02, each with the rounding of its forward dynamics.
    assert ours[2] == pytest.approx(reference.y, rel=1e-13)
    assert ours[1] == pytest.approx(reference.dense_output()(step / 3), rel=1e-13)


def test_adaptive_steps_agree_with_scipy_s() -> None:
    scene = sliding()
    model = build(scene)
    times = np.linspace(0, 2, 101)
    begin = start(model, scene, 1.0, 0.0)
    ours = read(model, scene, Integrator(model).run(begin, times, tolerance=1e-11), times).phi

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[2:], accelerations(scene, y[1], y[3], 0.0)])

    first = np.array([scene.load.offset * math.sin(1.0), 1.0, 0.0, 0.0])
    theirs = solve_ivp(slope, (0, 2), first, "DOP853", times, rtol=1e-11, atol=1e-11).y[1]
    truth = exact(scene, times, 1.0).phi
    # Step control is SciPy's, so both should be off by about as much; 3 allows for the different scales.
    assert np.abs(ours - truth).max() <= 3 * np.abs(theirs - truth).max() + 1e-13


def test_continuous_output_is_of_seventh_order() -> None:
    """Between steps: a tenth of a step in, the error falls at least as step^7 until rounding."""
    scene = frozen()
    model = build(scene)
    begin = start(model, scene, 0.3, 0.0)
    steps = 0.16 / 2.0 ** np.arange(4)
    errors = []
    for step in steps:
        times = step * (np.arange(int(2 / step)) + 0.1)
        found = read(model, scene, integrate(model, begin, times, timestep=float(step)), times).phi
        errors.append(np.abs(found - exact(scene, times, 0.3).phi).max())
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(7.5, abs=0.8)


def test_samples_do_not_change_the_steps() -> None:
    scene = sliding()
    model = build(scene)
    begin = start(model, scene, 1.0, 0.0)
    few, many = (Integrator(model).run(begin, np.linspace(0, 1, n), tolerance=1e-8) for n in (2, 1001))
    assert np.array_equal(few[-1], many[-1]) or np.abs(few[-1] - many[-1]).max() < 1e-7


def test_given_up_after_a_limit() -> None:
    model = build(frozen())
    with pytest.raises(DivergenceError, match=r"given up at t = [\d.]+ s after \d+ evaluations"):
        Integrator(model).run(np.array([1.0, 0.0]), np.array([0.0, 1e4]), timestep=1e-3, limit=1000)


def test_a_start_that_is_not_finite_is_a_divergence() -> None:
    model = build(frozen())
    with pytest.raises(DivergenceError, match="no longer finite"):
        Integrator(model).run(np.array([1.0, 1e300]), np.array([0.0, 1.0]), tolerance=1e-6)


def test_quaternions_are_refused() -> None:
    free = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    with pytest.raises(ValueError, match="only slide and hinge joints"):
        Integrator(free)


def test_evaluations_are_counted() -> None:
    """Twelve a step and the first; three more where samples fall into a step."""
    model = build(frozen())
    integrator = Integrator(model)
    begin = start(model, frozen(), 1.0, 0.0)
    for samples, expected in ((11, 1 + 10 * 12), (21, 1 + 10 * 15)):
        integrator.run(begin, np.linspace(0, 1, samples), timestep=0.1)
        assert integrator.evaluations == expected


@pytest.mark.parametrize("name", SCENES)
def test_what_is_left_out_of_an_evaluation_changes_no_bit(name: str) -> None:
    """The functions called for a smooth model give mj_forward's acceleration, constant forces included."""
    scene = SCENES[name]
    model = build(scene)
    begin = start(model, scene, 0.7, 2.0)
    integrator = Integrator(model)
    assert len(integrator.dynamics[0][0]) > 1
    slope = np.empty_like(begin)
    dop853_kernel.slope(*integrator.dynamics, begin, slope)
    data = mujoco.MjData(model)
    data.qpos, data.qvel = np.split(begin, 2)
    mujoco.mj_forward(model, data)
    # The actuator's force is added to the others in another order: one rounding of their sum.
    exactly = model.nu == 0
    assert slope[model.nv :] == pytest.approx(data.qacc, rel=0 if exactly else 1e-15, abs=0)


@pytest.mark.parametrize("scene", [sliding(), sliding(can=Can.sheet_metal()), pendulum()])
def test_an_evaluation_does_not_know_how_far_the_can_has_come(scene: Scene) -> None:
    """At a distance of 1e10 m, where MuJoCo itself would lose six digits."""
    model = build(scene)
    integrator, slopes = Integrator(model), []
    for place in (0.0, 1e10):
        begin = start(model, scene, 0.7, 2.0)
        begin[int(model.joint("slide").qposadr[0])] = place
        slopes.append(np.empty_like(begin))
        dop853_kernel.slope(*integrator.dynamics, begin, slopes[-1])
    assert (slopes[0] == slopes[1]).all()


def test_a_slide_that_is_tied_to_others_matters() -> None:
    model = build(pendulum(), "equality")
    assert Integrator(model).dynamics[1][-1].all()


def test_the_clock_is_put_back() -> None:
    model = build(frozen())
    seen = mujoco.MjData(model)
    integrate(model, np.array([1.0, 0.0]), np.array([0.0, 1.0]), 0.1)
    mujoco.mj_forward(model, seen)
    assert seen.timer[mujoco.mjtTimer.mjTIMER_FORWARD].duration > 0


def test_no_clock_is_read_while_stepping() -> None:
    model = build(frozen())
    integrator = Integrator(model)
    integrator.run(np.array([1.0, 0.0]), np.array([0.0, 1.0]), 0.1)
    timers = integrator._data.timer
    assert timers[mujoco.mjtTimer.mjTIMER_VELOCITY].number > 100
    assert timers[mujoco.mjtTimer.mjTIMER_VELOCITY].duration == 0


RUN = """
from mjbeer import frozen, simulate
simulate(frozen(), 0.1, 1.0)
simulate(frozen(), 0.1, 1.0, integrator="DOP853", timestep=0.01)
simulate(frozen(), 0.1, 1.0, tolerance=1e-6)
"""


@pytest.mark.slow
def test_it_is_said_once_on_a_terminal_that_loops_are_compiled(tmp_path: pathlib.Path) -> None:
    """And a loop that is in the cache is not compiled."""
    settings = {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "TERM": "xterm", "COLUMNS": "200"}
    for said in (f"{_COMPILING}\r\nend", "end"):
        reader, writer = os.openpty()
        subprocess.run([sys.executable, "-c", RUN], env=os.environ | settings, stderr=writer, check=True)
        os.write(writer, b"end")  # reading a terminal waits for something
        os.close(writer)
        text = b""
        with open(reader, "rb", buffering=0) as stream:
            while not text.endswith(b"end"):  # a terminal may hand over less than was written
                text += stream.read(10_000)
        assert text.decode() == said
