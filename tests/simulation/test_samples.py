"""The samples of a run: at which times they are, and that no judgement of the run hangs on them."""

import math
import re
from typing import Any

import numpy as np
import pytest

from mjbeer import (
    Run,
    frozen,
    pendulum,
    simulate,
    sliding,
)
from mjbeer.exceptions import (
    ParameterError,
)
from tests.support.scenes import ANY_ROLLING_INTEGRATORS, ARRAYS


@pytest.mark.parametrize("integrator", ANY_ROLLING_INTEGRATORS)
def test_requested_times_are_those_of_the_whole_run(integrator: str) -> None:
    times = np.array([0.0, 0.007, 0.1, 0.25])

    whole = simulate(frozen(), 0.2499, 1.0, integrator=integrator, rolling="contact")
    some = simulate(frozen(), 0.25, 1.0, integrator=integrator, rolling="contact", times=times)
    times[1] = 7.0  # the run has a copy

    assert {getattr(whole, name).shape for name in ARRAYS} == {(251,)}
    assert np.array_equal(some.phi, whole.phi[[0, 7, 100, 250]])
    assert some.time[1] == 0.007


def test_times_need_no_duration() -> None:
    assert list(simulate(sliding(), phi0=0.3, times=[0, 5]).time) == [0, 5]
    assert simulate(sliding(), phi0=0.3).time[-1] == 2
    with pytest.raises(
        ParameterError, match=r"times must be between 0 and the duration 2.0 s, got 5.0 s"
    ):
        simulate(sliding(), 2, times=[0, 5])


@pytest.mark.parametrize("timestep", [1e-3, 1 / 3])
def test_rounding_does_not_take_a_time_from_its_step(timestep: float) -> None:
    """Times as people write them, and as clocks that add up timesteps count: all are the steps that
    were meant."""
    steps = np.arange(29_900, 30_000)
    scene = pendulum(gravity=0.0)
    clock = np.cumsum(np.full(30_000, timestep))[steps - 1]
    even = np.linspace(29_900 * timestep, 29_999 * timestep, 100)
    for times in (timestep * steps, even, clock):
        run = simulate(scene, 30_000 * timestep, 0.0, timestep=timestep, times=times)
        assert np.array_equal(run.time, timestep * steps)


@pytest.mark.parametrize(
    ("duration", "samples"),
    [(0.3, 4), (0.1 * 3, 4), (0.3 * (1 - 1e-15), 4), (0.31, 5), (1e-10, 2)],
)
def test_a_run_ends_with_the_step_that_reaches_its_duration(duration: float, samples: int) -> None:
    """A duration that rounding makes a little more or less than three steps has three."""
    run = simulate(pendulum(gravity=0.0), duration, 1.0, timestep=0.1)
    assert len(run.time) == samples


SETTINGS = [  # a contact that parts is not smooth enough for a tolerance
    {"rolling": "reduced", "integrator": "Euler"},
    {"rolling": "equality", "integrator": "Euler"},
    {"rolling": "contact", "integrator": "Euler"},
    {"rolling": "reduced", "integrator": "DOP853"},
    {"rolling": "equality", "integrator": "DOP853"},
    {"rolling": "contact", "integrator": "DOP853"},
    {"rolling": "reduced", "tolerance": 1e-6},
    {"rolling": "equality", "tolerance": 1e-6},
]


def without_numbers(run: Run) -> list[str]:
    """What a run warns of, with # for each number."""
    return [re.sub(r"[\d.e-]+", "#", warning) for warning in run.warnings]


@pytest.mark.parametrize(
    "setting", SETTINGS, ids=lambda setting: " ".join(map(str, setting.values()))
)
def test_what_a_run_says_of_itself_does_not_depend_on_its_samples(
    setting: dict[str, Any],
) -> None:
    """A frozen can from the top is pulled at, slips and parts before the end of a second."""
    names = ["slip", "lift", "largest_turn", "largest_distance"]
    allowed = 0.0
    if "tolerance" in setting:
        # Two runs may be compared at other samples, and one more be taken, with other steps.
        allowed = 1e-5
    else:
        names += ["largest_rate", "energy_drift"]

    all_samples = simulate(frozen(), 1.0, math.pi, friction=0.1, **setting)
    one = simulate(frozen(), 1.0, math.pi, friction=0.1, **setting, times=[1.0])

    assert len(one.time) == 1
    assert without_numbers(one) == without_numbers(all_samples)
    for name in names:
        expected = getattr(all_samples.record, name)
        assert getattr(one.record, name) == pytest.approx(expected, rel=allowed), name
    for friction in (0.3, math.inf):
        until = all_samples.rolls_until(friction)
        assert one.rolls_until(friction) == pytest.approx(until, rel=allowed)


@pytest.mark.parametrize(
    "setting",
    [
        {"tolerance": 1e-9},
        {"integrator": "DOP853", "timestep": 7e-3},
        {"integrator": "GaussJackson", "timestep": 2e-3},
    ],
)
def test_a_record_ends_with_the_run(setting: dict[str, Any]) -> None:
    """The can parts at 0.83389 s; the last steps of mjbeer's own integrators go beyond the last
    sample."""
    run = simulate(frozen(), 0.8335, math.pi, times=[0.0, 0.8335], **setting)
    assert run.rolls_until() == math.inf
    assert run.trusted
