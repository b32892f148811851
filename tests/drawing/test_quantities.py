"""What a film shows of a motion: mean forces, and how far it is ahead of even acceleration."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, simulate, sliding
from mjbeer.drawing.quantities import QUANTITIES, mean_forces, mean_motion

SECOND = np.linspace(0, 1, 2001)


@pytest.mark.parametrize("make", [frozen, sliding])
def test_forces_of_a_rolling_can_are_those_that_rolling_needs(
    make: Callable[..., Scene],
) -> None:
    """The mean over a time w is off by N'' w^2/24.

    At 50 rad/s and a w of 20 ms, that is 0.04 of a weight.
    """
    motion = exact(make(can=Can.sheet_metal()), SECOND, 1.0)
    weight = motion.scene.mass * 9.81

    mean = mean_forces(motion)

    inside = slice(20, -20)  # at the ends the mean is over half the time
    assert mean.normal[inside] == pytest.approx(motion.forces.normal[inside] / weight, abs=0.04)
    assert mean.friction[inside] == pytest.approx(motion.forces.friction[inside] / weight, abs=0.04)


def test_a_can_in_the_air_has_no_forces() -> None:
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4)

    mean = mean_forces(run)

    flying = run.lift > 4e-3  # and not about to land
    assert flying.sum() > 20
    assert np.abs(mean.normal[flying]).max() < 1e-3
    assert np.abs(mean.friction[flying]).max() < 1e-3


def test_a_can_that_slips_has_mu_times_n() -> None:
    run = simulate(frozen(), 0.5, frozen().equilibrium(), rolling="contact", friction=0.1)

    mean = mean_forces(run)

    ratio = (mean.friction / mean.normal)[run.time < 0.3]
    assert ratio == pytest.approx(0.1, rel=1e-4)  # what a contact this stiff leaves out


def test_ahead_is_the_swing_of_eq_12() -> None:
    """u = s + b sin(phi), and s accelerates with g sin(alpha).

    What is left is b sin(phi), in a massless can.
    """
    motion = exact(sliding(), SECOND, 1.2, 3.0)
    expected = 1e3 * motion.scene.load.offset * np.sin(motion.phi)
    assert QUANTITIES["ahead"].values(motion) == pytest.approx(expected, abs=1e-9)


def test_turns_are_counted_on_from_the_start() -> None:
    """A load that loops has no jump in them."""
    motion = exact(sliding(), SECOND, 1.0, 40.0)

    turns = QUANTITIES["turns"].values(motion)

    assert turns[0] == 0
    assert math.tau * turns[-1] == pytest.approx(motion.phi[-1] - 1.0)
    assert turns[-1] > 4
    assert np.abs(np.diff(turns)).max() < 0.01


def test_a_damped_can_is_behind_the_one_that_accelerates_evenly() -> None:
    """The even one has no damping and starts alike, so the damped one falls behind it."""
    free = sliding(can=Can.sheet_metal())
    damped = sliding(can=Can.sheet_metal(), damping=1e-3, drag=1e-4)
    motion = exact(damped, SECOND, 1.2, 3.0)
    even = mean_motion(motion, SECOND)
    without = mean_motion(exact(free, SECOND, 1.2, 3.0), SECOND)
    assert even == pytest.approx(without, abs=1e-12)
    assert even[-1] - motion.u[-1] > 0.2
