"""Slosh by MuJoCo: the load that stands for a liquid, and several pendulums that do so better."""

import math

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, simulate
from mjbeer.model.setting import ROLLINGS, Rolling
from mjbeer.simulation.run import Run
from mjbeer.theory import slosh
from tests.support import slosh_judge
from tests.support.scenes import METAL
from tests.support.slosh_judge import Judge

GRAVITY = 9.81
FILLS = (0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95)
AMPLITUDE = 1e-4
"""Amplitude of the swings [rad]: none of them is slower than a smaller one by more than 2e-8."""


def mode_frequency(can: Can, load: Load) -> float:
    """The frequency of the liquid's slowest mode in a can that rolls on level ground [rad/s]."""
    mass_ratio = (load.mass + can.effective_mass) / load.mass
    modes = slosh.rolling(load.fill, mass_ratio)
    return float(modes.frequencies(can.radius, GRAVITY)[0])


def measured_frequency(run: Run, near: float) -> float:
    """The frequency of a sine [rad/s], from samples about a quarter of a period apart.

    For a lag h, x(t - h) + x(t + h) = 2 cos(omega h) x(t).
    """
    step = run.time[1]
    lag = round(math.pi / 2 / (near * step))
    middle = run.phi[lag:-lag]
    around = run.phi[: -2 * lag] + run.phi[2 * lag :]
    cosine = middle @ around / (2 * middle @ middle)
    return math.acos(cosine) / (lag * step)


@pytest.mark.parametrize(
    ("can", "rolling"),
    [(Can(), "reduced"), *((METAL, rolling) for rolling in ROLLINGS)],
    ids=["massless, reduced", *(f"metal, {rolling}" for rolling in ROLLINGS)],
)
@pytest.mark.parametrize("fill", FILLS)
def test_a_small_swing_has_the_frequency_of_the_slowest_mode(
    can: Can,
    rolling: Rolling,
    fill: float,
) -> None:
    """In 1 s, which is 3 to 6 periods; MuJoCo rolls a can without inertia in "reduced" alone.

    RK4 slows a swing by (omega timestep)^4/120, which is 2e-8 at 40 rad/s. The softness of the
    contact changes the frequency by less than 2e-9.
    """
    load = Load.liquid(can, fill)
    scene = Scene(can, load, incline=0.0, gravity=GRAVITY)
    expected = mode_frequency(can, load)
    run = simulate(scene, 1.0, phi0=AMPLITUDE, rolling=rolling)
    assert measured_frequency(run, near=expected) == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("fill", slosh_judge.FILLS)
@pytest.mark.parametrize("can", slosh_judge.CANS)
def test_eight_pendulums_on_the_axis_swing_as_their_matrix_and_as_the_liquid(
    can: str,
    fill: float,
) -> None:
    """The differences of MuJoCo's torques err by 8e-12, and the modes left out count for 3e-5."""
    judge = Judge(slosh_judge.CANS[can], fill)
    lengths, _ = judge.matrix_modes()
    assert judge.mujoco_lengths() == pytest.approx(lengths, rel=1e-10)
    exact = slosh.rolling(fill, judge.ratio)
    assert lengths[0] == pytest.approx(exact.lengths[0], rel=1e-4)


@pytest.mark.parametrize("fill", slosh_judge.FILLS)
@pytest.mark.parametrize("can", slosh_judge.CANS)
def test_the_load_is_one_mode_and_the_liquid_a_sum_of_modes(can: str, fill: float) -> None:
    """A flat tilt is let go for two seconds: what the load leaves out is what the shares say.

    In a shallow liquid the finite amplitude still makes 6e-5 of a difference.
    """
    judge = Judge(slosh_judge.CANS[can], fill)
    time, tilt, axis = judge.let_go(slosh_judge.DURATION)
    lengths, shares = judge.matrix_modes()
    modes = np.cos(np.outer(time, np.sqrt(judge.gravity / lengths)))
    assert tilt / slosh_judge.AMPLITUDE == pytest.approx(modes @ shares, abs=1e-4)
    # Nothing pushes along the ground: can and liquid keep their centre of effective mass.
    arm = judge.moments.sum() / (judge.ratio * slosh_judge.MASS)
    assert axis == pytest.approx(arm * (tilt - tilt[0]), abs=1e-7 * slosh_judge.AMPLITUDE)
    slowest = mode_frequency(judge.can, Load.liquid(judge.can, fill))
    load = judge.lump(slosh_judge.DURATION)
    assert load.phi / slosh_judge.AMPLITUDE == pytest.approx(np.cos(slowest * time), abs=1e-5)
