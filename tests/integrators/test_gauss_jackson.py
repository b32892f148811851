"""The multistep integrator: its weights, its order, samples, start, and what it refuses."""

import math
import os
import pathlib
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

from mjbeer import exact, frozen, pendulum, simulate, sliding
from mjbeer.exceptions import DivergenceError, ParameterError, UnsupportedError
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.gauss_jackson import (
    GaussJackson,
    SundmanTime,
    first_timestep,
    sundman_time,
)
from mjbeer.integrators.gauss_jackson.method import BLOCK
from mjbeer.integrators.gauss_jackson.weights import COUNT, LAG, POSITION, VELOCITY, weights_at
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.simulation import methods
from mjbeer.simulation.methods import swing_law
from mjbeer.simulation.smooth_recorder import SmoothRecorder
from mjbeer.theory import trajectory
from mjbeer.theory.scene import Scene
from tests.support.scenes import METAL


@pytest.mark.parametrize("power", [VELOCITY, POSITION])
@pytest.mark.parametrize("back", [-1, 0, COUNT // 2])
@pytest.mark.parametrize("degree", range(COUNT))
def test_weights_are_exact_for_polynomials_of_twelfth_degree(
    power: int, back: int, degree: int
) -> None:
    """What the formulas give for a = t^n, less the same with a step more, is exact: the sums then
    drop out.

    The step is 1, v = t^(n+1)/(n+1), and q = t^(n+2)/((n+1)(n+2)).
    """
    chosen = weights_at(power, back)

    def formula(last: int) -> float:
        """The sum with weights if the last acceleration is at t = `last`."""
        return float(chosen @ np.arange(last - COUNT + 1.0, last + 1) ** degree)

    def velocity(last: int) -> Fraction:
        return Fraction(last - back) ** (degree + 1) / (degree + 1)

    def position(last: int) -> Fraction:
        return Fraction(last - back) ** (degree + 2) / ((degree + 1) * (degree + 2))

    if power == VELOCITY:  # a first difference leaves the newest acceleration, 1, of the first sum
        found = formula(1) - formula(0) + 1.0
        right = velocity(1) - velocity(0)
    else:  # a second difference leaves a_n of the second sum and (1 + back) (a_n - a_(n-1))
        found = formula(1) - 2 * formula(0) + formula(-1) + 1.0 - (1 + back) * (1.0 - 0.0**degree)
        right = position(1) - 2 * position(0) + position(-1)

    # Weights of either sign are summed with powers of numbers up to COUNT.
    rounding = 8 * np.finfo(float).eps * float(np.abs(chosen).sum()) * float(COUNT) ** degree
    assert found == pytest.approx(float(right), abs=rounding, rel=1e-14)


def pendulum_time(
    scene: Scene, phi0: float, precision: float = 1e-15, largest_turn: float = 4.0
) -> SundmanTime:
    """The Sundman time in which the scene's load is a pendulum, and which passes as fast as t at
    phi0."""
    law = swing_law(scene)
    return sundman_time(law, law.inertia(phi0), precision, largest_turn)


def largest_error(
    scene: Scene, phi0: float, timestep: float, times: np.ndarray, time: SundmanTime
) -> float:
    """The largest error of phi and u/a [rad] with a timestep [s] in a Sundman time."""
    model = build(scene)
    method = GaussJackson(Dynamics(model), timestep, time)
    states = method.run(initial_state(model, scene, phi0, 0.0), times)
    motion = to_coordinates(model, scene, states, times)
    return trajectory.largest_error(motion, exact(scene, times, phi0), scene.can.radius)


@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum()])
def test_the_error_falls_with_order_thirteen(scene: Scene) -> None:
    """From 1e-5 to 1e-12 rad. Terms of either sign meet in the error, so that rungs scatter: by 1.2
    in the order."""
    timesteps = 0.34 / scene.frequency() / 2.0 ** (np.arange(18) / 6)
    times = np.linspace(0, 2, 65)
    time = pendulum_time(scene, 1.0)
    errors = np.array([largest_error(scene, 1.0, float(h), times, time) for h in timesteps])
    fitted = (errors < 1e-5) & (errors > 1e-12)
    assert fitted.sum() >= 7
    assert errors.min() < 1e-12
    order = np.polyfit(np.log(timesteps[fitted]), np.log(errors[fitted]), 1)[0]
    assert order == pytest.approx(13, abs=1.3)


@pytest.mark.parametrize("changed", ["base", "uneven", "depth", "bottom"])
@pytest.mark.parametrize("scene", [sliding(0.2, can=METAL), frozen(0.1), pendulum()])
def test_a_wrong_law_changes_no_motion(scene: Scene, changed: str) -> None:
    """Only MuJoCo's accelerations count. At steps of 1/60 of a swing's radian rounding alone is
    left, some 1e-15 for each radian that is turned."""
    law = swing_law(scene)
    wrong = {
        "base": law._replace(base=1.05 * law.base),
        "uneven": law._replace(chord=0.9 * law.chord, coupling=0.9 * law.coupling),
        "depth": law._replace(depth=0.5 * law.depth),
        "bottom": law._replace(bottom=law.bottom + 0.5),
    }[changed]
    timestep = 1 / 60 / scene.oscillator.frequency()
    time = sundman_time(wrong, wrong.inertia(2.0))
    assert largest_error(scene, 2.0, timestep, np.linspace(0, 1, 65), time) < 2e-13


@pytest.mark.parametrize("precision", [1e-6, 1e-9, 1e-12])
def test_the_time_in_a_step_is_known_to_the_precision(precision: float) -> None:
    """Where next to no inertia is left at the lowest point. The steps themselves err by 1e-13 rad
    here; times that are off by a share of `precision` make the load, which turns by 60 rad/s there,
    err by as many times that."""
    scene = pendulum(0.1, wheel_mass=1e-3)
    time = pendulum_time(scene, 0.5, precision, largest_turn=0.2)
    error = largest_error(scene, 0.5, 1e-3, np.linspace(0, 1, 65), time)
    assert error < 60 * precision + 1e-12


@pytest.mark.parametrize("phi0", [0.1, 1.0, 3.0])
@pytest.mark.parametrize("scene", [sliding(), frozen(0.1), pendulum(0.1, wheel_mass=0.01)])
def test_the_first_timestep_suits_the_tolerance(scene: Scene, phi0: float) -> None:
    """The error is the tolerance, but for a timestep that is up to 2.5 times too short or 1.5 times
    too long."""
    tolerance = 1e-8
    law = swing_law(scene)
    first = first_timestep(law, phi0, 0.0, duration=2.0, tolerance=tolerance)
    time = pendulum_time(scene, phi0)
    error = largest_error(scene, phi0, first.timestep, np.linspace(0, 2, 65), time)
    assert tolerance / 2.5**13 < error < tolerance * 1.5**13


def test_a_load_at_rest_takes_eight_steps() -> None:
    law = swing_law(sliding(gravity=0.0))
    first = first_timestep(law, 1.0, 0.0, duration=1.0, tolerance=1e-9)
    assert first.timestep == 1 / 8
    assert first.largest_turn == 0.0


def test_the_forces_are_seen_within_long_steps() -> None:
    """The load turns by 0.2 rad between two looks where it is fastest, so that 0.1^2/2 of a force
    may be missed."""
    scene = pendulum(0.1, wheel_mass=0.02)
    end = 1.0
    model = build(scene)
    recorder = SmoothRecorder(model, scene)
    method = GaussJackson(Dynamics(model), 5e-3, pendulum_time(scene, 3.0))

    method.run(initial_state(model, scene, 3.0, 0.0), np.array([end]), recorder)

    truth = exact(scene, np.linspace(0, end, 200_001), 3.0).record
    assert recorder.record.lowest_normal == pytest.approx(truth.lowest_normal, rel=0.011)
    assert recorder.record.largest_rate == pytest.approx(truth.largest_rate, rel=0.011)
    assert recorder.record.rolling_ends_at == pytest.approx(truth.rolling_ends_at, abs=1e-4)


def test_samples_between_steps_err_no_more_than_those_at_steps() -> None:
    """The polynomial of the last accelerations is that of the method, so that it adds next to
    nothing."""
    scene = frozen()
    model = build(scene)
    start = initial_state(model, scene, 1.0, 0.0)
    method = GaussJackson(Dynamics(model), 0.015, pendulum_time(scene, 1.0))
    ends = []
    method.run(start, np.array([2.0]), lambda times, states: ends.append(times.copy()))

    def error_at(times: np.ndarray) -> float:
        motion = to_coordinates(model, scene, method.run(start, times), times)
        truth = exact(scene, times, 1.0)
        error = float(np.abs(motion.phi - truth.phi).max())
        # The rates err by the error of phi over the hundredth of a second in which an acceleration
        # makes most of it.
        assert np.abs(motion.phi_dot - truth.phi_dot).max() < error / 0.01
        return error

    at_steps = error_at(np.concatenate(ends))
    between = error_at(np.sort(np.random.default_rng(3).uniform(0, 2, 1000)))
    assert 1e-12 < at_steps < 1e-9
    assert between < 1.1 * at_steps


@pytest.mark.parametrize("end", [0.0, 3e-3, 12e-3, 13e-3, 3.0])
def test_every_step_is_seen_once(end: float) -> None:
    """Also if a run is shorter than the steps that start it, or over blocks; and a step is one
    evaluation."""
    scene = frozen()
    model = build(scene)
    dynamics = Dynamics(model)
    pieces = []
    method = GaussJackson(dynamics, 1e-3, pendulum_time(scene, 1.0))

    method.run(
        initial_state(model, scene, 1.0, 0.0),
        np.array([end]),
        lambda times, states: pieces.append((times.copy(), states.copy())),
    )

    times = np.concatenate([piece_times for piece_times, _ in pieces])
    states = np.concatenate([piece_states for _, piece_states in pieces])
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(end, rel=1e-14)  # a sum of up to 3,000 steps
    # dt/ds is 1 at the start, and between 1/2 and 2 in this swing.
    assert np.diff(times[:-1]).min(initial=1e-3) > 0.5e-3
    assert np.diff(times).max(initial=0.0) < 2e-3
    # Rounding of 3,000 steps. Measured: 7e-15.
    assert np.abs(states[:, 0] - exact(scene, times, 1.0).phi).max() < 1e-13
    steps = len(times) - 1
    assert (len(pieces) > 1) == (steps > BLOCK)
    # Thirteen for each iteration of the first steps, which reach six steps after the start.
    beyond_first = max(0, steps + LAG - COUNT // 2)
    assert (dynamics.evaluations - beyond_first) % COUNT == 0


def test_rounding_does_not_add_up() -> None:
    """Over 300,000 steps, in which u/a becomes 23,000 rad. Sums that forget their rounding err by
    60 of this one's."""
    rounding = np.spacing(23e3)
    time = pendulum_time(sliding(), 1.0)
    assert largest_error(sliding(), 1.0, 1e-4, np.linspace(0, 30, 31), time) < 4 * rounding


@pytest.mark.parametrize("timestep", [0.05, 0.1, 0.2])
@pytest.mark.parametrize("phi_dot0", [5.0, 200.0])
def test_a_timestep_that_is_too_long_is_said_to_be(phi_dot0: float, timestep: float) -> None:
    """The first steps are not found, or the load, which rolls down faster and faster, turns too far
    in a later one."""
    with pytest.raises(DivergenceError, match=r"failed at t = [\d.]+ s: take a shorter timestep"):
        simulate(frozen(), 2.0, math.pi, phi_dot0, integrator="GaussJackson", timestep=timestep)


def test_an_angle_that_mujoco_does_not_allow_is_said_to_be_no_longer_finite() -> None:
    """At 5 rad/s and faster the load has a fifth of a second at most to its largest number,
    1e10."""
    method = GaussJackson(Dynamics(build(frozen())), 1e-3, pendulum_time(frozen(), 1.0))
    with pytest.raises(
        DivergenceError, match=r"diverged at t = 0\.\d+ s: its state is no longer finite"
    ):
        method.run(np.array([1e10 - 1, 5.0]), np.array([0.2]))


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_constraints_are_refused(rolling: str) -> None:
    message = f"rolling must be 'reduced' with it, got '{rolling}'; DOP853 takes any"
    with pytest.raises(ParameterError, match=message):
        simulate(frozen(), 1.0, 1.0, rolling=rolling, integrator="GaussJackson")
    dynamics = Dynamics(build(frozen(), rolling))
    with pytest.raises(
        UnsupportedError, match="smooth motions only, and this model has constraints"
    ):
        GaussJackson(dynamics, 1e-3, pendulum_time(frozen(), 1.0))


@pytest.mark.parametrize("scene", [sliding(damping=1e-3, can=METAL), sliding(drag=0.1)])
def test_damping_is_refused(scene: Scene) -> None:
    dynamics = Dynamics(build(scene))
    with pytest.raises(UnsupportedError, match="undamped motions only, and this model has damping"):
        GaussJackson(dynamics, 1e-3, pendulum_time(scene, 1.0))


def test_a_tolerance_falls_back_on_dop853(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where runs stay too far apart, here because each is coarser than the one before."""
    monkeypatch.setattr(methods, "_FINER", 0.7)
    run = simulate(frozen(), 2.0, 1.0, tolerance=1e-8)
    assert run.integrator == "DOP853"
    assert np.abs(run.phi - exact(run.scene, run.time, 1.0).phi).max() < 1e-8


@pytest.mark.costly
def test_what_is_compiled_and_what_is_read_from_the_cache_give_the_same_bits(
    tmp_path: pathlib.Path,
) -> None:
    """A sum whose order a compiler may choose has one where it compiles, and another where it reads
    its cache."""
    script = """
from mjbeer import simulate, sliding
run = simulate(sliding(), 1, 1, tolerance=1e-9)
print(run.phi[-1], run.error_estimate)
"""

    def printed_by_a_new_process() -> str:
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        command = [sys.executable, "-c", script]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout

    compiled = printed_by_a_new_process()
    assert compiled != ""
    assert printed_by_a_new_process() == compiled
