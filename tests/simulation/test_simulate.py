"""simulate: how a run starts, what is refused, that it repeats, and how it diverges."""

import dataclasses
import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from mjbeer import (
    Run,
    Scene,
    exact,
    frozen,
    hoop,
    simulate,
    sliding,
)
from mjbeer.cli.app import parse
from mjbeer.cli.motions import run_of
from mjbeer.exceptions import (
    DivergenceError,
    ParameterError,
)
from mjbeer.model.setting import ROLLINGS
from tests.support.scenes import ANY_ROLLING_INTEGRATORS, ARRAYS, SCENES


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_run_starts_where_theory_starts_and_is_trusted(scene: Scene) -> None:
    run = simulate(scene, 0.1, 0.8, 3.0)
    truth = exact(scene, np.array([0.0]), 0.8, 3.0)
    for name in ("u", "phi", "u_dot", "phi_dot", "roll", "roll_dot"):
        expected = getattr(truth, name)[0]
        assert getattr(run, name)[0] == pytest.approx(expected, rel=4e-16)  # two roundings
    assert simulate(scene, 1, 0.5).trusted


def test_the_command_line_has_the_same_defaults() -> None:
    ours = simulate(sliding())
    theirs = run_of(parse(["simulate", "sliding"]))
    assert (ours.time[-1], ours.phi0) == (2.0, math.radians(60))
    # Degrees and back are a rounding of the start.
    assert theirs.phi == pytest.approx(ours.phi, abs=1e-14)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"duration": math.inf}, "duration must be a finite number"),
        (
            {"duration": 1e6, "timestep": 1e-6},
            "too many timesteps of 1e-06 s: at most 1e.08, or say with times=",
        ),
        ({"phi0": math.nan}, r"phi0 must be a finite number \[rad\], got nan"),
        ({"scene": "frozen"}, "scene must be a Scene, got 'frozen'"),
        ({"integrator": "rk4"}, r"integrator must be one of 'Euler'.*'GaussJackson'; got 'rk4'$"),
        (
            {"integrator": "DOP853", "tolerance": 1e-6},
            "with a tolerance mjbeer chooses the integrator: .* got 'DOP853'",
        ),
        ({"times": [0.0, 0.5]}, r"between 0 and the duration 0\.1 s, got 0\.5 s"),
        ({"times": [0.01, 0.01]}, r"times must increase, but times\[1\] is 0\.01 s after 0\.01 s"),
        (
            {"times": [0.0, 0.0105]},
            'multiples of the timestep 0.001 s only, not at 0.0105 s; integrator="DOP853"',
        ),
        (
            {"times": [0.01, 0.01 * (1 + 1e-12)]},
            r"different multiples of .* only, not at 0\.0100000000000\d+ s",
        ),
        ({"friction": 1e-6}, "friction must be between 1e-05 and inf, got 1e-06"),
    ],
)
def test_bad_input_says_what_is_allowed(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        simulate(**({"scene": frozen(), "duration": 0.1, "phi0": 1.0} | arguments))


@pytest.mark.parametrize("integrator", ANY_ROLLING_INTEGRATORS)
def test_divergence_is_an_error_with_time_and_cause(
    integrator: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """Steps of half a second on a swing of 0.1 s; MuJoCo's own log stays silent."""
    with pytest.raises(DivergenceError, match=r"diverged at t = [\d.e+]+ s: .+"):
        simulate(hoop(), 500, 1.0, integrator=integrator, timestep=0.5)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("integrator", ANY_ROLLING_INTEGRATORS)
def test_a_run_repeats_to_the_bit_alone_and_beside_another(rolling: str, integrator: str) -> None:
    scene = SCENES["frozen, metal can"]

    def run(_: int) -> np.ndarray:
        found = simulate(scene, 0.3, 1.0, rolling=rolling, integrator=integrator)
        return np.stack([getattr(found, name) for name in ARRAYS])

    first = run(0)
    alone = run(1)
    with ThreadPoolExecutor(2) as pool:
        beside_another = list(pool.map(run, range(2)))
    for again in (alone, *beside_another):
        assert np.array_equal(first, again)


@pytest.mark.parametrize("name", ["record", "diagnosis"])
def test_a_run_is_not_made_without_what_it_says_of_itself(name: str) -> None:
    """`Trajectory` has properties of these names, which must not become the defaults of the
    fields."""
    run = simulate(sliding(), 0.1, 1.0)
    values = {field.name: getattr(run, field.name) for field in dataclasses.fields(run)}
    assert Run(**values).record is run.record
    del values[name]
    with pytest.raises(TypeError, match=f"'{name}'"):
        Run(**values)
