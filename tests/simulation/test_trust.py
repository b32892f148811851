"""Which runs are trusted, and what a run warns of: wrong steps, slip, pull, angles and liquids."""

import math
import re
import warnings
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer import (
    Can,
    Load,
    Run,
    Scene,
    Trajectory,
    exact,
    frozen,
    hoop,
    liquid,
    simulate,
    sliding,
)
from mjbeer.exceptions import (
    AngleWarning,
    LiquidWarning,
    UntrustedWarning,
)
from mjbeer.theory.trajectory import largest_error
from tests.support.scenes import METAL, error


@pytest.mark.parametrize(
    ("run", "reason"),
    [
        (
            lambda: simulate(frozen(), 2, 1.0, integrator="Euler", timestep=4e-3),
            "energy or momentum drift",
        ),
        (lambda: simulate(frozen(), 1, 1.0, rolling="contact", friction=0.02), "the can slips by"),
        (
            lambda: simulate(hoop(), 0.5, 3.0, rolling="contact", timestep=1e-4, friction=1e3),
            "parts from the incline",
        ),
        (
            lambda: simulate(frozen(), 2, math.pi),
            r"from t = 0\.83.* s the incline would have to pull at the can",
        ),
        # It slides all the way, by less than a milliradian.
        (
            lambda: simulate(frozen(0.0), 0.3, 0.01, rolling="contact", friction=1e-5),
            r"needs a friction coefficient of 0\.00\d+, and the contact has 1e-05: it slides",
        ),
    ],
)
def test_a_run_that_is_not_to_be_relied_on_warns_when_it_is_made(
    run: Callable[[], Trajectory], reason: str
) -> None:
    message = f"this run is not to be relied on: .*{reason}"
    with pytest.warns(UntrustedWarning, match=message) as caught:
        trajectory = run()
    assert [warning.filename for warning in caught] == [__file__]
    assert not trajectory.trusted
    assert any(re.search(reason, warning) for warning in trajectory.warnings)


TURN_A_STEP = 2 * math.pi / 1e-3
"""[rad/s] at a timestep of 1 ms."""


WRONG: dict[str, Callable[[], Run]] = {
    "slips between samples": lambda: simulate(
        frozen(), 0.5, 1.0, rolling="contact", friction=0.05, times=[0.5]
    ),
    "hops between samples": lambda: simulate(
        hoop(), 1.0, 3.0, rolling="contact", timestep=1e-4, times=[1.0]
    ),
    "decays before the samples": lambda: simulate(
        frozen(), 3e3, 1.0, timestep=0.1, times=0.1 * np.arange(29900, 30000)
    ),
    "four turns in a step of RK4": lambda: simulate(frozen(0.0), 0.003, 0.0, 4 * TURN_A_STEP),
    "34 turns, whose parts are nearly whole turns too": lambda: simulate(
        frozen(0.0), 0.003, 0.0, 34 * TURN_A_STEP, integrator="Euler"
    ),
}


@pytest.mark.parametrize("make", WRONG.values(), ids=WRONG)
def test_a_wrong_run_is_never_trusted(make: Callable[[], Run]) -> None:
    """Each of these was once trusted, or might be. The least error among them is 0.45 rad."""
    run = make()
    assert error(run) > 0.4
    assert not run.trusted


def test_far_turns_in_a_step_of_dop853_are_no_alarm() -> None:
    """Its stages are at twelve phases of them: the error is 2e-5 rad, and so says the second
    run."""
    scene = Scene(Can(0.033, 0.12, 20.0, 0.02), Load(0.2, 0.01, 3e-5), 0.2, "sliding")

    run = simulate(scene, 1, 0.0, 150.0, integrator="DOP853", timestep=0.02)

    assert run.record.largest_rate * 0.02 > 2
    assert scene.oscillator.rate_variation(0.0, 150.0) > 1e-2
    assert error(run) < 1e-4
    assert run.trusted, run.warnings


def test_strong_damping_in_an_equality_is_no_alarm() -> None:
    """What it takes in a step was once known to fewer digits than the run has, and called a drift
    of 0.18 rad."""
    scene = sliding(can=METAL, damping=0.1)
    run = simulate(scene, 1, 1.0, rolling="equality", tolerance=7e-6, times=np.linspace(0, 1, 11))
    assert largest_error(run, exact(scene, run.time, 1.0), scene.can.radius) < 7e-6
    assert run.trusted, run.warnings


@pytest.mark.slow
def test_rolls_until_is_where_theory_says() -> None:
    run = simulate(frozen(), 1, math.pi, tolerance=1e-9)
    truth = exact(frozen(), np.linspace(0, 1, 100_001), math.pi)
    # Both interpolate linearly between samples, here 1 ms apart: (1 ms)^2 times N's second
    # derivative.
    assert run.rolls_until() == pytest.approx(truth.rolls_until(), abs=1e-4)
    assert run.rolls_until(friction=0.3) < run.rolls_until()


@pytest.mark.parametrize("tolerance", [1.5e-5, 1e-9])
@pytest.mark.parametrize("friction", [math.inf, 0.3])
def test_a_start_that_would_have_to_be_pulled_is_seen(tolerance: float, friction: float) -> None:
    """The start itself was not looked at in a damped run to a tolerance: N < 0 was found too late,
    or not at all."""
    scene = sliding(-0.1617, 0.8492, damping=0.898)

    run = simulate(scene, 2, 1.256, 0.8636, tolerance=tolerance)

    assert run.forces.normal[0] < 0
    assert run.rolls_until(friction) == 0
    assert run.record.lowest_normal <= run.forces.normal[0]
    assert run.record.needed_friction == math.inf
    assert not run.trusted


@pytest.mark.parametrize(
    ("scene", "phi0", "phi_dot0", "tolerance"),
    [
        (sliding(-0.016, 0.867, METAL, damping=0.00273), 2.086, 0.351, 1.74e-4),
        (sliding(0.0748, 0.904, damping=0.00231), 2.845, -10.883, 1.38e-10),
        (sliding(-0.2508, 0.2304, METAL, damping=0.00324), -0.9035, -3.202, 4.24e-8),
        (sliding(0.1473, 0.6443, damping=0.000722), -2.270, -21.565, 5.71e-4),
    ],
)
def test_the_extreme_forces_between_steps_are_found(
    scene: Scene, phi0: float, phi_dot0: float, tolerance: float
) -> None:
    """N was up to 3 % of its range off, and the friction needed 9 % of itself; now it is looked at
    often enough that a thousandth is missed at most."""
    forces = exact(scene, np.linspace(0, 1, 20001), phi0, phi_dot0).forces
    allowed = 1e-3 + 10 * tolerance

    run = simulate(scene, 1.0, phi0, phi_dot0, tolerance=tolerance)

    assert run.record.lowest_normal == pytest.approx(
        forces.normal.min(), abs=allowed * float(np.ptp(forces.normal))
    )
    assert run.record.needed_friction == pytest.approx(
        forces.needed_friction.max(), rel=2 * allowed
    )


def test_degrees_in_place_of_radians_are_a_warning() -> None:
    with pytest.warns(
        AngleWarning, match=r"phi0 = 60 is taken as radians: .* math.radians\(60\)"
    ) as caught:
        simulate(sliding(), 0.1, 60)
    assert [warning.filename for warning in caught] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error", AngleWarning)
        simulate(sliding(), 0.1, -2 * math.pi)


def test_a_liquid_that_is_no_lump_any_more_is_a_warning() -> None:
    """Water passes the speed at which the wall throws it up, u_dot^2 = a g cos(alpha), after some
    10 cm."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LiquidWarning)
        scene = liquid("water")

    with pytest.warns(
        LiquidWarning,
        match=r"from t = 0\.\d+ s on the wall's centrifugal acceleration is more than",
    ) as told:
        run = simulate(scene, 1.0, 0.1)

    assert run.warnings == (str(told[0].message),)
    assert (run.trusted, run.solver_warnings, run.rolling_warnings) == (False, (), ())
    speed = float(np.interp(run.record.no_lump_at, run.time, np.abs(run.u_dot)))
    limit = math.sqrt(scene.can.radius * scene.gravity * math.cos(scene.incline))
    # To a timestep of 1 ms, in which it gains less than 2 mm/s.
    assert speed == pytest.approx(limit, abs=2e-3)
