"""Runs of damped scenes: their accuracy, what they say of it, the method for stiff ones, and what is refused."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mjbeer.theory.losses import stiffest
from mjbeer.theory.trust import ERROR

from mjbeer import Can, Load, Scene, build, pendulum, simulate, sliding
from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.simulation import tolerance as tolerances
from mjbeer.simulation.dop853 import Integrator
from mjbeer.theory.equations import rolling_forces
from mjbeer.theory.liquid import Damping
from mjbeer.theory.trajectory import distance
from tests.support import damped
from tests.support.scenes import METAL, scenes

MIXED = sliding(0.3, can=METAL, damping=Damping(1e-4, 1e-6, 1e-7), drag=0.05)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(scenes(), st.floats(-9, 2), st.floats(-6, 0), st.floats(-3, 3), st.floats(-3, 3), st.sampled_from([1e-4, 1e-9]))
def test_true_error_is_below_the_tolerance(
    scene: Scene, damping: float, drag: float, phi0: float, swing: float, tolerance: float
) -> None:
    """Damping over eleven decades, in units of what stops the load within a radian."""
    assume(scene.attachment == "sliding")
    unit = math.sqrt(scene.gravity / scene.can.radius)
    scene = replace(
        scene, damping=scene.oscillator.base * unit * 10**damping, drag=scene.mass / scene.can.radius * 10**drag
    )
    times = np.linspace(0, 8 / unit, 41)
    assume(stiffest(scene) * times[-1] < 2e3)  # the reference is explicit
    run = simulate(scene, times[-1], phi0, swing * unit, tolerance=tolerance, times=times)
    truth = damped.motion(scene, times, phi0, swing * unit)
    start = phi0, scene.start(phi0, 0.0)[0]
    error = distance(run, truth, scene.can.radius, start)
    assert run.error_estimate is not None
    assert error <= tolerance
    assert run.error_estimate <= tolerance
    assert run.integrator == "DOP853"


@pytest.mark.parametrize("damping", [1e-12, 1e-3, 0.1])
@pytest.mark.parametrize("integrator", ["RK4", "DOP853"])
def test_an_accurate_run_is_trusted(integrator: str, damping: float) -> None:
    scene = sliding(damping=damping)
    run = simulate(scene, 2, 1.0, integrator=integrator, times=np.linspace(0, 2, 21))
    error = distance(run, damped.motion(scene, run.time, 1.0), scene.can.radius)
    assert error < 1e-7
    assert run.trusted
    # RK4's steps resolve, at 1e-3 s, the 1e-3 s in which can and load come together, to 1e-4.
    assert run.record.implied_error < (1e-3 if integrator == "RK4" else 1e-8)
    assert run.energy_drift < (1e-4 if integrator == "RK4" else 1e-9)


@pytest.mark.parametrize("damping", [1e-12, 1e-6, 1e-3])
def test_a_wrong_run_is_not(damping: float) -> None:
    """Large steps lose energy that damping does not take."""
    scene = sliding(damping=damping)
    with pytest.warns(UserWarning, match="energy or momentum drift"):
        run = simulate(scene, 4, 2.0, integrator="Euler", timestep=5e-3, times=np.linspace(0, 4, 21))
    assert distance(run, damped.motion(scene, run.time, 2.0), scene.can.radius) > ERROR
    assert not run.trusted


@pytest.mark.parametrize("integrator", ["implicit", "implicitfast"])
def test_an_implicit_method_with_a_constraint_is_wrong_and_says_so(integrator: str) -> None:
    """MuJoCo solves the constraint without the damping that it then integrates with, and the can slips."""
    scene = sliding(can=METAL, damping=0.1)
    with pytest.warns(UserWarning, match="slips"):
        run = simulate(scene, 1, 1.0, rolling="equality", integrator=integrator, times=[0.0, 0.5, 1.0])
    assert distance(run, damped.motion(scene, run.time, 1.0), scene.can.radius) > 1
    assert not run.trusted


def test_an_explicit_method_with_strong_damping_diverges() -> None:
    for integrator in ("Euler", "RK4", "DOP853"):
        with pytest.raises(DivergenceError):
            simulate(sliding(damping=1.0), 1, 1.0, integrator=integrator)


@pytest.mark.parametrize("scene", [
    MIXED, sliding(damping=2.0), replace(pendulum(1.0, wheel_mass=1e3), damping=0.1), sliding(drag=0.1),
])  # fmt: skip
def test_the_functions_that_stand_for_mj_forward_know_dampers(scene: Scene) -> None:
    model = build(scene)
    integrator, data = Integrator(model), mujoco.MjData(model)
    assert len(integrator._pointers[0]) > 1
    for place in range(10):
        state = np.array([0.0, 1.0, -2.0, 20.0]) * np.cos(place + np.arange(4))
        data.qpos[:], data.qvel[:] = np.split(state, 2)
        mujoco.mj_forward(model, data)
        assert data.qfrc_passive.any()
        assert np.array_equal(integrator.slope(state)[2:], data.qacc)


@pytest.mark.parametrize("scene", [sliding(damping=1e-3), sliding(damping=Damping(cubic=1e-9)), sliding(drag=0.1)])
def test_gauss_jackson_refuses_what_is_damped(scene: Scene) -> None:
    with pytest.raises(UnsupportedError, match="undamped motions only"):
        simulate(scene, 1, 1.0, integrator="GaussJackson")


def test_no_damping_is_the_motion_without_it() -> None:
    for setting in ({}, {"integrator": "Euler", "rolling": "equality"}, {"tolerance": 1e-9}):
        plain, none = sliding(can=METAL), sliding(can=METAL, damping=Damping(), drag=0.0)
        one, other = (simulate(scene, 0.5, 1.0, **setting) for scene in (plain, none))
        assert np.array_equal(one.phi, other.phi)
        assert np.array_equal(one.u, other.u)
        assert one.energy_drift == other.energy_drift


def test_the_forces_of_all_steps_are_those_of_the_motion() -> None:
    """Within the long steps of DOP853 too, where speed and slip are those of polynomials."""
    run = simulate(MIXED, 1, 1.0, 5.0, tolerance=1e-9)
    truth = damped.motion(MIXED, np.linspace(0, 1, 1001), 1.0, 5.0)
    forces = rolling_forces(MIXED, truth.phi, truth.phi_dot, truth.u_dot)
    # An eighth of a step of 1/30 s does not meet the extremes, flat as they are, by (25/s / 240/s)^2 / 2.
    assert run.record.lowest_normal == pytest.approx(forces.normal.min(), rel=5e-3)
    assert run.record.needed == pytest.approx(forces.needed.max(), rel=5e-3)
    without = rolling_forces(MIXED, truth.phi, truth.phi_dot, 0.0)
    assert abs(without.needed.max() / forces.needed.max() - 1) > 0.05


def test_a_turn_in_a_timestep_is_untrusted_though_the_load_starts_fast() -> None:
    """At 1e3 rad/s weight and inertia hardly matter; at 100 rad/s they do, and the load still turns far in a step."""
    scene = Scene(Can(0.033, 0.12, 20.0, 0.02), Load(0.2, 0.01, 3e-5), 0.2, "sliding")
    timestep = 0.02
    assert scene.oscillator.unevenness(0.0, 1e3) < ERROR < scene.oscillator.unevenness(0.0, 2 / timestep)
    for damping, said in ((0.0, False), (2e-4, True)):
        run = simulate(replace(scene, damping=damping), 1, 0.0, 1e3, integrator="DOP853", timestep=timestep)
        assert any("in a timestep" in reason for reason in run.warnings) == said


@pytest.mark.parametrize("rolling", ["reduced", "equality"])
@pytest.mark.parametrize("integrator", ["discrete", "implicit"])
def test_a_second_run_estimates_the_error_of_implicit_methods(integrator: str, rolling: str) -> None:
    """Where MuJoCo's accelerations are those of a whole step, they must not be taken for a loss of the model's."""
    scene = sliding(can=METAL, damping=1e-3)
    run = simulate(scene, 1, 1.0, rolling=rolling, integrator=integrator, times=np.linspace(0, 1, 11))
    error = distance(run, damped.motion(scene, run.time, 1.0), scene.can.radius)
    assert run.error_estimate is not None
    assert error < run.error_estimate < 5 * error


@pytest.mark.parametrize("rolling", ["reduced", "equality"])
@pytest.mark.parametrize("damping", [1e3, 1e6])
def test_a_stiff_motion_keeps_its_tolerance(damping: float, rolling: str) -> None:
    scene = sliding(can=METAL, damping=damping)
    times = np.linspace(0, 0.2, 5)
    run = simulate(scene, 0.2, 1.0, rolling=rolling, times=times, tolerance=1e-9)
    assert run.integrator == "Radau"
    assert run.timestep is None
    assert run.error_estimate is not None
    assert run.error_estimate <= 1e-9
    truth = damped.motion(scene, times, 1.0, method="Radau", fine=1e-12)
    assert distance(run, truth, scene.can.radius) < 1e-9
    assert run.trusted
    assert run.energy_drift < 1e-4  # long steps, between which losses are trapezoids


def test_both_methods_agree_where_both_can(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, runs = sliding(damping=1.0), []
    for limit in (0.0, math.inf):
        monkeypatch.setattr(tolerances, "_STIFF", limit)
        runs.append(simulate(scene, 0.5, 1.0, times=np.linspace(0, 0.5, 11), tolerance=1e-9))
    assert [run.integrator for run in runs] == ["Radau", "DOP853"]
    assert distance(*runs, scene.can.radius) < 2e-9


def test_a_tolerance_that_the_stiff_method_has_not_is_refused() -> None:
    with pytest.raises(ToleranceError, match="the Radau run would need a local tolerance below"):
        simulate(sliding(damping=1e6), 0.05, 1.0, tolerance=1e-12)


def test_damping_whose_torque_is_lost_in_rounding_is_refused() -> None:
    with pytest.raises(ToleranceError, match="rounding of the slip rate hides its torque"):
        simulate(sliding(damping=1e12), 1, 1.0, tolerance=1e-6)


def test_a_run_that_explodes_without_end_is_not_trusted() -> None:
    """In one step of 3 s the drag throws it 1e50 m away, and rounding loses more than any start may be aside."""
    step, can = 2.9541119699441847, Can(0.0602372833438853, 0.18, 143.05675886384725, 0.5190857848226949)
    load = Load(0.1, 0.04475897687907349, 3.628530304651521e-05)
    scene = Scene(can, load, -0.20165489394302266, drag=84.92118769933582)
    times = step * np.array([0.05721241519926756, 0.6780277908869407, 0.9798938151808825])
    run = simulate(scene, step, 3.2434202840633297, 0.0, "equality", "DOP853", timestep=step, times=times)
    assert not run.trusted
