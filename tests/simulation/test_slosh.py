"""Slosh by MuJoCo: the load that stands for a liquid swings with the liquid's frequency."""

import math

import pytest

from mjbeer import Can, Load, Scene, simulate
from mjbeer.model.setting import ROLLINGS, Rolling
from mjbeer.simulation.run import Run
from mjbeer.theory import slosh
from tests.support.scenes import METAL

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
