"""Slosh by MuJoCo: the load that stands for a liquid, and several pendulums that do so better."""

import math

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Load, Scene, attach, liquid, simulate
from mjbeer.model.setting import ROLLINGS, Rolling
from mjbeer.theory import slosh
from mjbeer.theory.liquid_properties import LIQUIDS
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


def measured_frequency(values: np.ndarray, step: float, near: float) -> float:
    """The frequency of a sine [rad/s], from samples about a quarter of a period apart.

    For a lag h, x(t - h) + x(t + h) = 2 cos(omega h) x(t).
    """
    lag = round(math.pi / 2 / (near * step))
    middle = values[lag:-lag]
    around = values[: -2 * lag] + values[2 * lag :]
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
    measured = measured_frequency(run.phi, run.time[1], near=expected)
    assert measured == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("fill", FILLS)
def test_a_free_lying_can_sloshes_as_one_that_rolls(fill: float) -> None:
    """On a level floor of another world, by contact; the rate of the joint is a sine.

    A swing of 3 mrad is slower than a smaller one by up to 6e-6. In smaller ones the settling of
    the contact shows, most of all in a full can, whose load has next to no moment.
    """
    load = Load.liquid(METAL, fill)
    expected = mode_frequency(METAL, load)
    world = mujoco.MjSpec()
    world.option.timestep = 1e-3
    world.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    attach(world, Scene(METAL, load, incline=0.0, gravity=GRAVITY), [0, 0, METAL.radius])
    model = world.compile()
    data = mujoco.MjData(model)
    data.joint("can-swing").qpos = 3e-3
    rate = data.joint("can-swing").qvel
    rates = []
    for _ in range(1000):
        mujoco.mj_step(model, data)
        rates.append(rate[0])
    measured = measured_frequency(np.array(rates), 1e-3, near=expected)
    assert measured == pytest.approx(expected, rel=1e-5)
    # It stays in its plane.
    assert abs(data.body("can-can").xpos[1]) < 1e-9


def test_a_free_lying_can_keeps_its_mass_and_has_admissible_moments() -> None:
    """The mode has less inertia than ice about the axis of the can, and other moments follow."""
    scene = Scene(METAL, Load.liquid(METAL))
    world = mujoco.MjSpec()
    attach(world, scene)
    body = world.compile().body("can-load")
    assert body.mass == pytest.approx(scene.load.mass)
    assert body.ipos == pytest.approx([0, 0, -scene.load.offset])
    x, y, z = body.inertia
    assert y == pytest.approx(scene.load.inertia)
    assert x == pytest.approx(z)
    assert x == pytest.approx(scene.load.mass * METAL.length**2 / 12 + y / 2)


def measured_rate(values: np.ndarray, step: float, near: float) -> complex:
    """The complex rate of a swing that decays [1/s], beside one of an axis that slows down.

    Three exponentials obey a recurrence with three coefficients (Prony, 1795), whose polynomial has
    the factors of the exponentials over a lag as its roots.
    """
    lag = round(math.pi / 2 / (near * step))
    before = np.stack([values[: -3 * lag], values[lag : -2 * lag], values[2 * lag : -lag]], axis=1)
    coefficients = np.linalg.lstsq(before, values[3 * lag :])[0]
    factors = np.roots([1, *-coefficients[::-1]])
    rates = np.log(factors.astype(complex)) / (lag * step)
    return max(rates, key=lambda rate: rate.imag)


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("fill", [0.25, 0.5, 0.75, 0.95])
@pytest.mark.parametrize("name", ["water", "olive oil"])
def test_a_small_swing_decays_as_the_slowest_mode(name: str, fill: float, rolling: Rolling) -> None:
    """The load is as fast as the mode, and decays as it does, but for terms in zeta squared."""
    scene = liquid(name, 0.0, fill, METAL, gravity=GRAVITY)
    modes = slosh.rolling(fill, scene.effective_mass / scene.load.mass)
    viscosity = LIQUIDS[name].viscosity
    ratios = modes.damping_ratios(METAL.radius, METAL.length, GRAVITY, viscosity)
    zeta = ratios.layers + ratios.bulk
    omega = float(modes.frequencies(METAL.radius, GRAVITY)[0])
    run = simulate(scene, 1.0, phi0=AMPLITUDE, rolling=rolling)
    rate = measured_rate(run.phi, run.time[1], near=omega)
    assert -rate.real == pytest.approx(zeta * omega, rel=5 * zeta**2 + 1e-6)
    assert abs(rate) == pytest.approx(omega, rel=5 * zeta**2 + 1e-6)


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
    assert np.abs(tilt / slosh_judge.AMPLITUDE - modes @ shares).max() < 1e-4
    # Nothing pushes along the ground: can and liquid keep their centre of effective mass.
    arm = judge.moments.sum() / (judge.ratio * slosh_judge.MASS)
    assert np.abs(axis - arm * (tilt - tilt[0])).max() < 1e-7 * slosh_judge.AMPLITUDE
    slowest = mode_frequency(judge.can, Load.liquid(judge.can, fill))
    load = judge.lump(slosh_judge.DURATION)
    assert np.abs(load.phi / slosh_judge.AMPLITUDE - np.cos(slowest * time)).max() < 1e-5
