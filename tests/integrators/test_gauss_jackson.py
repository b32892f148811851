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
from mjbeer.integrators.gauss_jackson import GaussJackson
from mjbeer.integrators.uneven_time import BLOCK, COUNT, LAG, OwnTime, own_time, weights
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.simulation import tolerance
from mjbeer.simulation.smooth_recorder import SmoothRecorder
from mjbeer.simulation.tolerance import pendulum_time
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import largest_error
from tests.support.scenes import METAL


@pytest.mark.parametrize("power", [1, 2])
@pytest.mark.parametrize("back", [-1, 0, COUNT // 2])
def test_weights_are_exact_for_polynomials_of_twelfth_degree(power: int, back: int) -> None:
    """What the formulas give for a = t^n, less the same with a step more, is exact: the sums then drop out.

    The last acceleration is at t = 0, the step is 1, and v = t^(n+1)/(n+1), q = t^(n+2)/((n+1)(n+2)).
    """
    chosen = weights(power, back)
    for degree in range(COUNT):

        def formula(end: int, degree: int = degree) -> float:
            return float(chosen @ np.arange(end - COUNT + 1.0, end + 1) ** degree)

        def truth(at: int, degree: int = degree) -> Fraction:
            moved = Fraction(at - back) ** (degree + power)
            return moved / (degree + 1) / (1 if power == 1 else degree + 2)

        if power == 1:  # a first difference leaves the newest acceleration of the first sum
            found, right = formula(1) - formula(0) + 1.0, truth(1) - truth(0)
        else:  # a second difference leaves a_n of the second sum, and (1 + back) (a_n - a_(n-1)) of the first
            found = formula(1) - 2 * formula(0) + formula(-1) + 1.0 - (1 + back) * (1.0 - 0.0**degree)
            right = truth(1) - 2 * truth(0) + truth(-1)
        rounding = 8 * np.finfo(float).eps * float(np.abs(chosen).sum()) * float(COUNT) ** degree
        assert found == pytest.approx(float(right), abs=rounding, rel=1e-14)


def errors(scene: Scene, phi0: float, steps: np.ndarray, times: np.ndarray, own: OwnTime | None = None) -> list[float]:
    """The largest errors of phi and u/a [rad] with some timesteps [s] in a scene's own time, or at another pace."""
    model, truth, right = build(scene), exact(scene, times, phi0), pendulum_time(scene, phi0)
    own = own._replace(share=right.share) if own else right
    begin, method = initial_state(model, scene, phi0, 0.0), GaussJackson(model)
    states = (method.run(begin, times, float(step), own) for step in steps)
    return [largest_error(to_coordinates(model, scene, each, times), truth, scene.can.radius) for each in states]


EVEN = own_time(1.0, 0.0, 1.0)
WRONG = {
    "even": EVEN,
    "another scene's": pendulum_time(pendulum(0.1, wheel_mass=0.01), 1.0)._replace(lawful=False),
    "no scene's": own_time(0.7, 0.8, 1.5),
}


@pytest.mark.parametrize(("own", "longest"), [(EVEN, 0.14), (None, 0.34), (WRONG["no scene's"], 0.12)])
@pytest.mark.parametrize("scene", [sliding(), frozen(), pendulum()])
def test_the_error_falls_with_order_thirteen(scene: Scene, own: OwnTime | None, longest: float) -> None:
    """From 1e-5 to 1e-12 rad. Terms of either sign meet in the error, so that rungs scatter: by 1.2 in the order."""
    steps = longest / scene.frequency() / 2.0 ** (np.arange(18) / 6)
    found = np.array(errors(scene, 1.0, steps, np.linspace(0, 2, 65), own))
    fitted = (found < 1e-5) & (found > 1e-12)
    assert fitted.sum() >= 7
    assert found.min() < 1e-12
    assert np.polyfit(np.log(steps[fitted]), np.log(found[fitted]), 1)[0] == pytest.approx(13, abs=1.3)


@pytest.mark.parametrize("own", WRONG.values(), ids=WRONG)
@pytest.mark.parametrize("scene", [sliding(0.2, can=METAL), frozen(0.1), pendulum()])
def test_a_wrong_pace_changes_no_motion(scene: Scene, own: OwnTime) -> None:
    """Only MuJoCo's accelerations count. At steps of 1/60 of a swing's radian rounding alone is left, some 1e-15 for
    each radian that is turned."""
    assert errors(scene, 2.0, np.array([1 / 60 / scene.oscillator.frequency()]), np.linspace(0, 1, 65), own)[0] < 2e-13


@pytest.mark.parametrize("precision", [1e-6, 1e-9, 1e-12])
def test_the_time_in_a_step_is_known_to_the_precision(precision: float) -> None:
    """Where next to no inertia is left at the lowest point. The steps themselves err by 1e-13 rad here; times that are
    off by a share of `precision` make the load, which turns by 60 rad/s there, err by as many times that."""
    scene = pendulum(0.1, wheel_mass=1e-3)
    own = pendulum_time(scene, 0.5, precision, 0.2)
    assert errors(scene, 0.5, np.array([1e-3]), np.linspace(0, 1, 65), own)[0] < 60 * precision + 1e-12


def test_the_forces_are_seen_within_long_steps() -> None:
    """The load turns by 0.2 rad between two looks where it is fastest, so that 0.1^2/2 of a force may be missed."""
    scene, end = pendulum(0.1, wheel_mass=0.02), 1.0
    model, recorder = build(scene), SmoothRecorder(build(scene), scene)
    own = pendulum_time(scene, 3.0)
    GaussJackson(model).run(initial_state(model, scene, 3.0, 0.0), np.array([end]), 5e-3, own, recorder)
    truth = exact(scene, np.linspace(0, end, 200_001), 3.0).record
    found = recorder.record
    assert found.lowest_normal == pytest.approx(truth.lowest_normal, rel=0.011)
    assert found.largest_rate == pytest.approx(truth.largest_rate, rel=0.011)
    assert found.rolling_ends_at == pytest.approx(truth.rolling_ends_at, abs=1e-4)


def test_samples_between_steps_err_no_more_than_those_at_steps() -> None:
    """The polynomial of the last accelerations is that of the method, so that it adds next to nothing."""
    scene, step = frozen(), 5e-3
    model = build(scene)
    begin, at = initial_state(model, scene, 1.0, 0.0), step * np.arange(401)
    between = np.sort(np.random.default_rng(3).uniform(0, 2, 1000))
    worst = []
    for times in (at, between):
        found = to_coordinates(model, scene, GaussJackson(model).run(begin, times, step, EVEN), times)
        truth = exact(scene, times, 1.0)
        worst.append(np.abs(found.phi - truth.phi).max())
        # The rates err by the frequency, 13/s, times the error of phi, or by that of an overtone: the fourth at most.
        assert np.abs(found.phi_dot - truth.phi_dot).max() < 4 * 13 * worst[-1]
    assert 1e-12 < worst[0] < 1e-10
    assert worst[1] < 1.1 * worst[0]


@pytest.mark.parametrize("last", [0, 3, 12, 13, 3 * BLOCK - 1])
def test_every_step_is_seen_once(last: int) -> None:
    """Also if a run is shorter than the steps that start it, or over blocks."""
    model, recorder = build(frozen()), SmoothRecorder(build(frozen()), frozen())
    times, integrator = 1e-3 * np.arange(last + 1), GaussJackson(model)
    found = integrator.run(initial_state(model, frozen(), 1.0, 0.0), times, 1e-3, EVEN, recorder)
    assert recorder.record.angle_covered == pytest.approx(np.abs(np.diff(found[:, 0])).sum(), rel=1e-13)
    assert recorder.record.largest_turn == pytest.approx(np.abs(found[:, 0] - 1.0).max(), rel=1e-13)
    assert np.abs(found[:, 0] - exact(frozen(), times, 1.0).phi).max() < 1e-11
    # Two a step without a law, and those of the first steps until they agree.
    assert (integrator.evaluations - 2 * max(0, last + LAG - COUNT // 2)) % COUNT == 0


def test_rounding_does_not_add_up() -> None:
    """Over 300,000 steps, in which u/a becomes 23,000 rad. Sums that forget their rounding err by 60 of this one's."""
    rounding = np.spacing(23e3)
    assert errors(sliding(), 1.0, np.array([1e-4]), np.linspace(0, 30, 31), EVEN)[0] < 4 * rounding


@pytest.mark.parametrize("timestep", [0.05, 0.1, 0.2])
def test_a_timestep_that_is_too_large_is_seen(timestep: float) -> None:
    """Rolling down turns faster and faster, and the method becomes unstable in the middle of the run."""
    with pytest.raises(DivergenceError, match="diverged at t = "):
        simulate(frozen(), 2.0, math.pi, integrator="GaussJackson", timestep=timestep)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_constraints_and_damping_are_refused(rolling: str) -> None:
    with pytest.raises(ParameterError, match=f"rolling must be 'reduced' with it, got '{rolling}'; DOP853 takes any"):
        simulate(frozen(), 1.0, 1.0, rolling=rolling, integrator="GaussJackson")
    with pytest.raises(UnsupportedError, match="smooth motions only, and this model has constraints"):
        GaussJackson(build(frozen(), rolling))
    for damped in (sliding(damping=1e-3, can=METAL), sliding(drag=0.1)):
        with pytest.raises(UnsupportedError, match="undamped motions only, and this model has damping"):
            GaussJackson(build(damped))


def test_a_tolerance_falls_back_on_dop853(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where runs stay too far apart."""
    monkeypatch.setattr(tolerance, "_TRIES", 0)
    run = simulate(frozen(), 2.0, 1.0, tolerance=1e-8)
    assert run.integrator == "DOP853"
    assert np.abs(run.phi - exact(run.scene, run.time, 1.0).phi).max() < 1e-8


@pytest.mark.costly
def test_what_is_compiled_and_what_is_read_from_the_cache_give_the_same_bits(tmp_path: pathlib.Path) -> None:
    """A sum whose order a compiler may choose has one where it compiles, and another where it reads its cache."""
    script = (
        "from mjbeer import *; run = simulate(sliding(), 1, 1, tolerance=1e-9); print(run.phi[-1], run.error_estimate)"
    )
    told = [
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for _ in range(2)
    ]
    assert told[0] == told[1] != ""
