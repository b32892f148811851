"""simulate: samples, errors, repeatability, divergence, and the diagnostics a run carries."""

import math
import re
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, Trajectory, exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.exceptions import (
    AngleWarning,
    DivergenceError,
    MjbeerError,
    ParameterError,
    UnsupportedError,
    UntrustedWarning,
)
from mjbeer.model.build import Stepped
from mjbeer.model.numbers import Numbers
from mjbeer.model.setting import INTEGRATORS, ROLLINGS
from mjbeer.simulation.prepare import Prepared
from mjbeer.simulation.run import Run
from mjbeer.theory.exact import phi_error
from mjbeer.theory.measure import distance
from tests.support.scenes import SCENES

HUGE = Scene(Can(radius=1e20), Load(1.0, 1e20, 1.0), attachment="frozen")
WEIGHTLESS = pendulum(gravity=0.0)
ARRAYS = ("time", "u", "phi", "u_dot", "phi_dot", "roll", "roll_dot", "lift", "lift_dot", "energy")


@pytest.mark.parametrize("name", SCENES)
def test_a_run_starts_where_theory_starts(name: str) -> None:
    run = simulate(SCENES[name], 0.1, 0.8, 3.0)
    truth = exact(SCENES[name], np.array([0.0]), 0.8, 3.0)
    for each in ("u", "phi", "u_dot", "phi_dot", "roll", "roll_dot"):
        assert getattr(run, each)[0] == pytest.approx(getattr(truth, each)[0], rel=4e-16)


def test_every_array_has_a_row_a_sample() -> None:
    run = simulate(frozen(), 0.5, 1.0, rolling="contact")
    assert {getattr(run, each).shape for each in ARRAYS} == {(501,)}
    assert run.time[-1] == 0.5


def test_a_run_ends_on_the_first_step_at_or_after_its_duration() -> None:
    assert simulate(frozen(), 0.0104, 1.0).time[-1] == pytest.approx(0.011)


@pytest.mark.parametrize("integrator", [*INTEGRATORS, "DOP853"])
def test_requested_times_are_those_of_the_whole_run(integrator: str) -> None:
    times = np.array([0.0, 0.007, 0.1, 0.25])
    whole = simulate(frozen(), 0.25, 1.0, integrator=integrator)
    some = simulate(frozen(), 0.25, 1.0, integrator=integrator, times=times)
    assert np.array_equal(some.phi, whole.phi[[0, 7, 100, 250]])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"duration": 0}, r"duration must be greater than 0 \[s\], got 0"),
        ({"duration": math.inf}, "duration must be a finite number"),
        ({"duration": 1e6, "timestep": 1e-12}, "too many timesteps of 1e-12 s: at most 1e.08, or say with times="),
        ({"duration": 1e40, "timestep": 1e-40}, "too many timesteps"),
        ({"duration": 1e300}, r"duration must be between 1e-50 and 1e\+50 \[s\], got 1e\+300"),
        ({"duration": np.float64(-1.0)}, r"duration must be greater than 0 \[s\], got -1\.0$"),
        ({"phi0": math.nan}, r"phi0 must be a finite number \[rad\], got nan"),
        ({"phi0": "1"}, "phi0 must be a finite number"),
        ({"phi_dot0": math.inf}, "phi_dot0 must be a finite number"),
        ({"phi_dot0": 1e200}, r"phi_dot0 must be between -1e\+50 and 1e\+50 \[rad/s\], got 1e\+200"),
        (
            {"phi_dot0": -2e10},
            r"phi_dot0 of the start must be between -1e\+10 .* \[rad/s\], beyond .*mjMAXVAL.*, got -2",
        ),
        ({"phi0": 2e10}, r"phi0 must be between -1e\+10 and 1e\+10 \[rad\], got 20000000000\.0"),
        (
            {"scene": HUGE},
            r"u of the start must be between -1e\+10 and 1e\+10 \[m\], beyond which MuJoCo .*, got 1e\+20",
        ),
        ({"scene": HUGE, "phi0": 0.0, "phi_dot0": 1.0}, r"u_dot of the start .* \[m/s\], .*, got 1e\+20"),
        ({"scene": "frozen"}, "scene must be a Scene, got 'frozen'"),
        ({"softness": "hard"}, "softness must be a Softness, got 'hard'"),
        ({"tolerance": 0}, r"tolerance must be greater than 0 \[rad\], got 0"),
        ({"integrator": "rk4"}, r"integrator must be one of 'Euler'.*'GaussJackson'; got 'rk4': did you mean 'RK4'\?"),
        ({"times": [0.0, 0.5]}, r"between 0 and the duration 0\.1 s, got 0\.5 s"),
        ({"times": [0.01, 0.01]}, r"times must increase, but times\[1\] is 0\.01 s after 0\.01 s"),
        ({"times": []}, r"times must be a list or a one-dimensional array of one or more numbers \[s\], got \[\]"),
        ({"times": 0.05}, r"times must be a list .* \[s\], got 0\.05"),
        ({"times": "0.05"}, r"times must be a list .* \[s\], got '0\.05'"),
        ({"times": (each for each in (0.0, 0.1))}, r"times must be a list .* \[s\], got <generator object"),
        (
            {"times": np.zeros((2, 2))},
            r"times must be a list .*, got ndarray of shape \(2, 2\) and type float64: \[0\.0",
        ),
        ({"times": np.array([0.0, 0.1j])}, r"times must be a list .*, got ndarray of shape \(2,\) and type complex128"),
        ({"times": [0.0, 0.1j]}, r"times\[1\] must be a finite number \[s\], got 0\.1j"),
        ({"times": [[0.0], [0.0, 0.1]]}, r"times\[0\] must be a finite number \[s\], got \[0\.0\]"),
        ({"times": [0.0, None]}, r"times\[1\] must be a finite number \[s\], got None"),
        ({"times": [False, True]}, r"times\[0\] must be a finite number \[s\], got False"),
        ({"times": np.array([0.0, "x"], object)}, r"times\[1\] must be a finite number \[s\], got 'x'"),
        ({"times": np.ma.array([0.0, 0.1], mask=[0, 1])}, r"times\[1\] must be a finite number \[s\], got masked"),
        ({"times": [-0.01, 0.1]}, r"times\[0\] must be 0 or greater \[s\], got -0\.01"),
        ({"times": [0.0, 0.0105]}, 'multiples of the timestep 0.001 s only, not at 0.0105 s; integrator="DOP853"'),
        ({"times": [5e-10]}, "multiples of the timestep 0.001 s only, not at 5e-10 s"),
        (
            {"times": [0.01, 0.01 * (1 + 1e-12)]},
            r"times must be at least a timestep of 0\.001 s apart, got 0\.01 s and 0\.01",
        ),
        (
            {"duration": 1e15, "times": [1e15]},
            r"times must be within 1e\+12 timesteps of 0\.001 s, got 1000000000000000\.0 s",
        ),
        ({"duration": 1e15, "times": [1e15], "integrator": "DOP853"}, r"times must be within 1e\+12 timesteps"),
        *(
            ({"rolling": rolling, "tolerance": 1e-6, "timestep": bad}, f"timestep must be .*, got {bad}")
            for rolling in ("reduced", "equality")
            for bad in (0, -1e-3, math.nan, math.inf)
        ),
        ({"tolerance": 1e-6, "integrator": "foo"}, "integrator must be one of .*; got 'foo'"),
        ({"friction": 1e-6}, r"friction must be at least 1e-05, MuJoCo's smallest \(mjMINMU\), got 1e-06"),
    ],
)
def test_bad_input_says_what_is_allowed(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        simulate(**({"scene": frozen(), "duration": 0.1, "phi0": 1.0} | arguments))


def test_a_run_has_a_step_however_short_it_is() -> None:
    assert simulate(frozen(), 1e-10, 1.0).time.tolist() == [0.0, 1e-3]


@pytest.mark.parametrize("timestep", [0.1, 1e-3, 1 / 3])
def test_rounding_does_not_take_a_time_from_its_step(timestep: float) -> None:
    """Times as people write them, and as clocks that add up timesteps count: all are the steps that were meant."""
    steps = np.arange(29_900, 30_000)
    clock = np.cumsum(np.full(30_000, timestep))[steps - 1]
    for times in (timestep * steps, np.linspace(29_900 * timestep, 29_999 * timestep, 100), clock):
        run = simulate(WEIGHTLESS, 30_000 * timestep, 0.0, timestep=timestep, times=times)
        assert np.array_equal(run.time, timestep * steps)


def test_a_run_ends_on_its_duration_if_that_is_a_step_but_for_rounding() -> None:
    for duration in (0.3, 0.1 * 3, 0.3 * (1 - 1e-15), sum([0.1] * 3)):
        assert len(simulate(frozen(), duration, 1.0, timestep=0.1).time) == 4


def test_numbers_of_any_kind_become_doubles() -> None:
    run = simulate(frozen(), Decimal("0.01"), Fraction(1, 2), np.float32(0.5), timestep=np.float16(0.0009765625))
    assert all(type(each) is float for each in (run.phi0, run.phi_dot0, run.setting.timestep, run.setting.friction))
    assert (run.phi0, run.phi_dot0, run.timestep) == (0.5, 0.5, 2**-10)


def test_the_times_are_a_copy() -> None:
    times = np.array([0.0, 0.1])
    for motion in (exact(frozen(), times, 1.0), simulate(frozen(), 0.1, 1.0, integrator="DOP853", times=times)):
        times[1] = 7.0
        assert motion.time[1] == 0.1
        times[1] = 0.1


def test_a_massless_can_needs_reduced() -> None:
    with pytest.raises(UnsupportedError, match='only in rolling="reduced"'):
        simulate(sliding(), 1, 1.0, rolling="contact")


@pytest.mark.parametrize("integrator", [*INTEGRATORS, "DOP853"])
def test_divergence_is_an_error_with_time_and_cause(integrator: str, capfd: pytest.CaptureFixture[str]) -> None:
    """Steps of half a second on a swing of 0.1 s; MuJoCo's own log stays silent."""
    with pytest.raises(DivergenceError, match=r"diverged at t = [\d.e+]+ s: .+"):
        simulate(hoop(), 500, 1.0, integrator=integrator, timestep=0.5)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("rolling", ["reduced", "equality", "contact"])
@pytest.mark.parametrize("integrator", [*INTEGRATORS, "DOP853"])
def test_a_run_repeats_to_the_bit_alone_and_beside_another(rolling: str, integrator: str) -> None:
    def run(_: int) -> np.ndarray:
        found = simulate(SCENES["frozen, metal can"], 0.3, 1.0, rolling=rolling, integrator=integrator)
        return np.stack([getattr(found, each) for each in ARRAYS])

    first = run(0)
    with ThreadPoolExecutor(2) as pool:
        assert all(np.array_equal(first, each) for each in [run(0), *pool.map(run, range(2))])


@pytest.mark.parametrize("name", SCENES)
def test_a_good_run_is_trusted(name: str) -> None:
    run = simulate(SCENES[name], 1, 0.5)
    assert run.trusted, run.warnings
    assert run.warnings == ()


@pytest.mark.parametrize(
    ("run", "reason"),
    [
        (lambda: simulate(frozen(), 2, 1.0, integrator="Euler", timestep=4e-3), "energy or momentum drift"),
        (lambda: simulate(frozen(), 2, 1.0, integrator="Euler", timestep=4e-3), "as a run at other timesteps shows"),
        (lambda: simulate(frozen(), 1, 1.0, rolling="contact", friction=0.02), "the can slips by"),
        (lambda: simulate(hoop(), 0.5, 3.0, rolling="contact", timestep=1e-4, friction=1e3), "parts from the incline"),
        (lambda: simulate(frozen(), 2, math.pi), r"from t = 0\.83.* s the incline would have to pull"),
    ],
)
def test_a_run_that_is_not_to_be_relied_on_says_so(run: Callable[[], Trajectory], reason: str) -> None:
    trajectory = run()
    assert not trajectory.trusted
    assert any(re.search(reason, each) for each in trajectory.warnings), trajectory.warnings


HOLES = {
    "slips between samples": lambda: simulate(frozen(), 0.5, 1.0, rolling="contact", friction=0.05, times=[0.5]),
    "hops between samples": lambda: simulate(hoop(), 1.0, 3.0, rolling="contact", timestep=1e-4, times=[1.0]),
    "decays before the samples": lambda: simulate(
        frozen(), 3000.0, 1.0, timestep=0.1, times=0.1 * np.arange(29900, 30000)
    ),
    "two turns in a step of Euler": lambda: simulate(
        frozen(incline=0.0), 0.003, 0.0, 4 * math.pi / 1e-3, integrator="Euler"
    ),
    "four turns in a step of RK4": lambda: simulate(frozen(incline=0.0), 0.003, 0.0, 8 * math.pi / 1e-3),
    "34 turns in a step, whose parts are nearly whole turns too": lambda: simulate(
        frozen(incline=0.0), 0.003, 0.0, 68 * math.pi / 1e-3, integrator="Euler"
    ),
    "an arm lost in rounding": lambda: simulate(
        Scene(Can(0.033, 0.12, 1.0, 5e-4), Load(1e-16, 0.02, 1e-21), 0.0, "frozen"),
        1e7,
        1.0,
        rolling="equality",
        timestep=1e4,
    ),
}


@pytest.mark.parametrize("run", HOLES.values(), ids=HOLES.keys())
def test_a_wrong_run_is_never_trusted(run: Callable[[], Run]) -> None:
    """Each of these was once trusted. The least error among them is 0.45 rad."""
    made = run()
    truth, start = exact(made.scene, made.time, made.phi0, made.phi_dot0), made.scene.start(made.phi0, made.phi_dot0)
    assert distance(made, truth, made.scene.can.radius, start=(made.phi0, start[0])) > 0.4
    assert not made.trusted


@pytest.mark.parametrize(
    ("rolling", "integrator"),
    [  # a contact that parts is not smooth enough for a tolerance
        *[(rolling, integrator) for rolling in ROLLINGS for integrator in ("Euler", "DOP853")],
        ("reduced", "tolerance"),
        ("equality", "tolerance"),
    ],
)
def test_what_a_run_says_of_itself_does_not_depend_on_its_samples(rolling: str, integrator: str) -> None:
    """A frozen can from the top is pulled at, slips and parts before the end of a second."""
    setting: dict[str, Any] = {"tolerance": 1e-6} if integrator == "tolerance" else {"integrator": integrator}
    all_samples, one = (
        simulate(frozen(), 1.0, math.pi, rolling=rolling, friction=0.1, **setting, times=times)
        for times in (None, [1.0])
    )
    assert len(one.time) == 1
    # The samples of DOP853 make its last step end elsewhere, by rounding.
    assert [re.sub(r"[\d.e-]+", "#", text) for text in one.warnings] == [
        re.sub(r"[\d.e-]+", "#", text) for text in all_samples.warnings
    ]
    for name in ("slip", "lift", "turned", "rolled", "path", "fastest", "fails_at", "energy_drift"):
        assert getattr(one.record, name) == pytest.approx(getattr(all_samples.record, name), rel=1e-6, abs=1e-15)
    assert one.rolls_until(0.3) == pytest.approx(all_samples.rolls_until(0.3), rel=1e-6)


def test_slip_of_a_sliding_contact_is_coulomb_s() -> None:
    """Footnote 7: below mu = tan(alpha) the frozen can slides away from its equilibrium, above it stays."""
    scene = frozen()
    mu = math.tan(scene.incline)
    above = simulate(scene, 1, scene.equilibrium(), rolling="contact", friction=1.02 * mu)
    below = simulate(scene, 1, scene.equilibrium(), rolling="contact", friction=0.98 * mu)
    assert np.abs(above.slip).max() < 1e-6 * scene.can.radius
    assert np.abs(below.slip).max() > 1e-2 * scene.can.radius


@pytest.mark.slow
def test_rolls_until_is_where_theory_says() -> None:
    run = simulate(frozen(), 1, math.pi, tolerance=1e-9)
    truth = exact(frozen(), np.linspace(0, 1, 100_001), math.pi)
    # Both interpolate linearly between samples, here 1 ms apart: (1 ms)^2 times N's second derivative.
    assert run.rolls_until() == pytest.approx(truth.rolls_until(), abs=1e-4)
    assert run.rolls_until(friction=0.3) < run.rolls_until()


def test_frequency_needs_three_turning_points() -> None:
    with pytest.raises(MjbeerError, match="the motion turns 1 times"):
        simulate(frozen(), 0.5, math.pi).frequency()


def test_measured_frequency_is_that_of_the_exact_period() -> None:
    scene = frozen(can=Can.sheet_metal())
    amplitude = 0.4
    run = simulate(scene, 4, scene.equilibrium() + amplitude, tolerance=1e-12)
    # Turning points are interpolated to fourth order in the 1 ms between samples: (omega h)^4 = 2e-8 of h.
    assert run.frequency() * scene.period(amplitude) == pytest.approx(2 * math.pi, rel=1e-12)


@pytest.mark.parametrize("rolling", ["reduced", "equality", "contact"])
@pytest.mark.parametrize("integrator", ["Euler", "RK4", "DOP853"])
def test_the_error_that_a_second_run_estimates_is_the_one_that_theory_finds(rolling: str, integrator: str) -> None:
    """3.2 times the distance is 1.2 times the error where it is of first order in the softness of a contact, 1.5 times
    where it is of first order in the timestep, and up to 3.2 times for higher orders, once the order has settled."""
    scene, steps = SCENES["frozen, metal can"], {"Euler": 1e-4, "RK4": 4e-3, "DOP853": 3e-2}
    run = simulate(scene, 1.2, 1.0, rolling=rolling, integrator=integrator, timestep=steps[integrator])
    truth = exact(scene, run.time, 1.0)
    error = distance(run, truth, scene.can.radius, start=(1.0, scene.start(1.0, 0.0)[0]))
    assert run.error_estimate is not None
    assert 1.2 * error < run.error_estimate < 3.3 * error


def test_the_second_run_is_made_once_and_not_before_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    timesteps: list[float] = []

    def count(stepped: Stepped, numbers: Numbers) -> None:
        timesteps.append(numbers.timestep)
        write(stepped, numbers)

    write = Stepped.write
    monkeypatch.setattr(Stepped, "write", count)
    run = simulate(frozen(), 0.1, 1.0)
    assert timesteps == [1e-3]
    assert run.trusted
    assert run.error_estimate == run.error_estimate
    assert timesteps == pytest.approx([1e-3, (math.sqrt(5) - 1) / 2 * 1e-3], rel=1e-15)


def test_a_second_run_that_diverges_is_an_infinite_error(monkeypatch: pytest.MonkeyPatch) -> None:
    run, solve = simulate(frozen(), 0.1, 1.0), Prepared.solve

    def diverge(self: Prepared, start: np.ndarray, times: np.ndarray) -> None:
        solve(self, start, times)
        raise DivergenceError("its state is no longer finite")

    monkeypatch.setattr(Prepared, "solve", diverge)
    assert run.error_estimate == math.inf
    assert run.warnings == ("a run at other timesteps diverges: take a much smaller timestep or a better integrator",)


@pytest.mark.parametrize("gravity", [1e-5, 1e-3, 1.0, 1e6])
@pytest.mark.parametrize("scene", [frozen, pendulum])
def test_contact_holds_in_any_gravity(scene: Callable[..., Scene], gravity: float) -> None:
    """In units of sqrt(a/g) the motion is that on Earth; MuJoCo's solver has an acceleration in its tolerance.

    Its error is the contact's softness, 2e-7 rad; left at its default, the solver makes it 5e-2 rad at 1e-5 m/s^2.
    """
    slow = math.sqrt(9.81 / gravity)
    run = simulate(scene(gravity=gravity), 2 * slow, 1.0, rolling="contact", timestep=1e-3 * slow)
    assert phi_error(run, relative=True) < 5e-7
    assert np.abs(run.slip).max() < 1e-6 * run.scene.can.radius


@pytest.mark.parametrize("call", [lambda: simulate(sliding(), 0.1, 60), lambda: exact(sliding(), [0.1], 60)])
def test_degrees_in_place_of_radians_are_a_warning(call: Callable[[], Trajectory]) -> None:
    message = r"phi0 = 60 is taken as radians, 9.549 turns: .* math.radians\(60\)"
    with pytest.warns(AngleWarning, match=message) as caught:
        call()
    assert [each.filename for each in caught] == [__file__]


@pytest.mark.parametrize("phi0", [2 * math.pi, -2 * math.pi, 0.0])
def test_a_start_within_a_turn_is_no_warning(phi0: float) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", AngleWarning)
        simulate(sliding(), 0.1, phi0)


@pytest.mark.parametrize(
    ("run", "reason"),
    [
        (lambda: simulate(frozen(), 2, 1.0, integrator="Euler", timestep=4e-3), "energy or momentum drift"),
        (lambda: simulate(frozen(), 1, 1.0, rolling="contact", friction=0.02), "the can slips by"),
        (lambda: simulate(hoop(), 0.5, 3.0, rolling="contact", timestep=1e-4, friction=1e3), "parts from the incline"),
        (lambda: simulate(frozen(), 2, math.pi), "N < 0"),
    ],
)
def test_a_run_that_is_not_to_be_relied_on_warns_when_it_is_made(run: Callable[[], Trajectory], reason: str) -> None:
    with pytest.warns(UntrustedWarning, match=f"this run is not to be relied on: .*{reason}") as caught:
        run()
    assert [each.filename for each in caught] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error", UntrustedWarning)
        with pytest.raises(UntrustedWarning):
            run()
        warnings.simplefilter("ignore", UntrustedWarning)
        assert not run().trusted


def test_a_good_run_warns_of_nothing_and_is_run_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjbeer.simulation.run.Second.of", lambda _: pytest.fail("a second run"))
    with warnings.catch_warnings():
        warnings.simplefilter("error", UntrustedWarning)
        simulate(frozen(), 1.0, 1.0)


@pytest.mark.parametrize(("gravity", "trusted"), [(0.0, True), (9.81, False)])
def test_a_model_that_rounding_takes_all_inertia_from(gravity: float, trusted: bool) -> None:
    """A point on the rim of a can of next to no mass, where it touches the incline: nothing but the can has inertia."""
    scene = Scene(Can(1.0, 1.0, 1e-32, 0.0), Load(10**-14.8125, 1.0, 0.0), 0.0, "frozen", gravity)
    run = simulate(scene, 5.0, 0.0, rolling="contact", integrator="Euler", timestep=1.0)
    assert run.error_estimate is not None
    assert run.trusted == trusted
