"""Checks of the slosh in a standing can, which is held, shaken or thrown."""

import math
from collections.abc import Iterator, Sequence
from functools import cache, partial
from typing import NamedTuple

import mujoco
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.checks.check import Check
from mjbeer.model.attach import attach
from mjbeer.model.build import build
from mjbeer.model.free_numbers import transverse_inertia
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import MujocoIntegrator
from mjbeer.theory.standing import SERIES, Reaction, Standing, standing

SHARES = (0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 2.0, 4.0)
"""Frequencies of shaking, divided by that of the first mode.

The next four modes have 1.7, 2.2, 2.5 and 2.9 times the frequency of the first.
"""
_ANGLE = 1e-3
"""Tilt of the pendulums that are let go [rad]."""
_ROUNDED = 1.05
"""Factor from an error that theory predicts to its bound, of which two digits are shown."""
_THROWN = 100
"""Number of cans that are thrown."""
FORCE = 0
MOMENT = 2
"""Indices of force and moment among the reactions."""
_GAIN = 0.1
"""Share of its energy that a thrown can may gain at most: a rigid can gains 0.05 at 5 ms."""


def checks() -> Iterator[Check]:
    """Yield the checks of standing cans."""
    by = "half full, held, RK4, 1 ms"
    yield Check(
        "standing",
        f"frequency by stepping from {_ANGLE:g} rad, against a pendulum's 1 - angle^2/16",
        _frequency_error,
        by,
        5e-9,
        "relative",
        "RK4: (omega h)^4/120, 2.5e-9",
    )
    yield Check(
        "standing",
        "logarithmic decrement",
        _decrement_error,
        by,
        1e-5,
        "relative",
        "breaking waves, which take the square of the angle: 4e-6; and the rates at crossings "
        "between samples",
    )
    for modes in (1, 2, 3, 5):
        yield from _reaction_checks(modes)
    for timestep in (2e-3, 5e-3):
        for modes in (1, 3):
            name = f"thrown cans, of {_THROWN}, that diverge or gain {_GAIN:g} of their energy"
            by = f"half full, {_in_words(modes)}, implicitfast, {1e3 * timestep:g} ms"
            measure = partial(thrown, water(modes), timestep)
            yield Check("standing", name, measure, by, 0, "", "stable or not")


def _in_words(modes: int) -> str:
    """Return a number of modes in words."""
    return "1 mode" if modes == 1 else f"{modes} modes"


def _reaction_checks(modes: int) -> Iterator[Check]:
    """Yield the checks of force and moment on the hand that shakes a can."""
    can = water(modes)
    for place, quantity in ((FORCE, "force under shaking"), (MOMENT, "moment under pitching")):
        yield Check(
            "standing",
            f"{quantity} at 8 frequencies, 0.2 to 4 of the first, against the infinite series",
            partial(_largest_reaction_error, can, place),
            f"half full, {_in_words(modes)}",
            float(_ROUNDED * np.abs(predicted_reaction_errors(can)[place]).max()),
            "relative",
            "the modes left out, whose share the bound is",
        )


def _largest_reaction_error(can: Standing, place: int) -> float:
    """Return the largest relative error of the force or the moment, by its index."""
    return float(np.abs(reaction_errors(can)[place]).max())


def _frequency_error() -> float:
    """Return the relative error of the frequency without damping."""
    return let_go(water(damping_ratio=0.0)).frequency


def _decrement_error() -> float:
    """Return the relative error of the decrement."""
    return let_go(water()).decrement


def water(modes: int = 1, fill: float = 0.5, damping_ratio: float | None = None) -> Standing:
    """Return a can of water."""
    return standing("water", fill, modes=modes, damping_ratio=damping_ratio)


class LetGo(NamedTuple):
    """Relative errors of the first mode of a can that is held while its liquid is let go."""

    frequency: float
    decrement: float
    """Without damping, the decrement itself."""


@cache
def let_go(can: Standing) -> LetGo:
    """Return the errors of frequency and decrement, measured at the zeros of the angle."""
    omega = can.frequencies()[0]
    ratio = can.damping_ratios()[0]
    angle = _first_mode(can, duration=64 / omega)
    crossings = angle.roots(extrapolate=False)
    cycles = (len(crossings) - 1) / 2
    root = math.sqrt(1 - ratio**2)
    damped_omega = 2 * math.pi * cycles / (crossings[-1] - crossings[0])
    measured = damped_omega / (omega * root)
    frequency = measured / (1 - _ANGLE**2 / 16) - 1
    speeds = np.abs(angle(crossings, 1))
    decrement = math.log(speeds[0] / speeds[-1]) / cycles
    expected = 2 * math.pi * ratio / root
    return LetGo(frequency, decrement / expected - 1 if ratio > 0 else decrement)


def _first_mode(can: Standing, duration: float) -> CubicHermiteSpline:
    """Return the angle [rad] of the first pendulum, let go in a held can, over a duration [s]."""
    model = build(can, free=False)
    data = mujoco.MjData(model)
    slosh = data.joint("slosh1")
    slosh.qpos = [math.cos(_ANGLE / 2), 0, math.sin(_ANGLE / 2), 0]
    times = []
    angles = []
    rates = []
    while data.time < duration:
        mujoco.mj_forward(model, data)
        times.append(data.time)
        angles.append(2 * np.arcsin(slosh.qpos[2]))
        rates.append(slosh.qvel[1])
        mujoco.mj_step(model, data)
    return CubicHermiteSpline(times, angles, rates)


def response(can: Standing, omega: float) -> Reaction:
    """Return the liquid's reaction to shaking at a frequency [rad/s], in MuJoCo's model.

    It follows from the inertia M and the stiffness K of the model at rest: forces are
    (K - omega^2 M) times displacements. The pendulums are free of force, which gives their
    displacements for those of the rig.
    """
    model = _on_a_rig(can)
    data = mujoco.MjData(model)
    inertia = np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, inertia)
    moving = [0, 1]
    for mode in range(1, can.modes + 1):
        moving.append(model.joint(f"can-slosh{mode}").dofadr[0] + 1)
    stiffness = _stiffness(model, data, moving)
    # Rig and shell are rigid. The rig's mass and moment are 1; the shell's centre of mass lies
    # above the liquid's middle, about which moments are taken.
    shell = can.can
    above = (shell.length - can.height) / 2
    shell_inertia = transverse_inertia(shell) + shell.mass * above**2
    coupling = shell.mass * above
    inertia[:2, :2] -= [[1 + shell.mass, coupling], [coupling, 1 + shell_inertia]]
    stiffness[1, 1] += shell.mass * can.gravity * above
    # The first two coordinates are the rig's. Forces are divided by accelerations.
    apparent_mass = (stiffness - omega**2 * inertia)[np.ix_(moving, moving)] / -(omega**2)
    pendulums = np.linalg.solve(apparent_mass[2:, 2:], apparent_mass[2:, :2])
    reaction = apparent_mass[:2, :2] - apparent_mass[:2, 2:] @ pendulums
    return Reaction(reaction[0, 0], reaction[0, 1], reaction[1, 1])


def _on_a_rig(can: Standing) -> mujoco.MjModel:
    """Return a can on a rig that slides along x and pitches about the liquid's middle."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0, 0, -can.gravity]
    rig = spec.worldbody.add_body(name="rig", mass=1.0, inertia=[1.0] * 3, explicitinertial=True)
    rig.add_joint(name="x", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    rig.add_joint(name="theta", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0])
    attach(spec, can, pos=[0, 0, -can.height / 2], free=False, body="rig")
    return spec.compile()


def _stiffness(model: mujoco.MjModel, data: mujoco.MjData, moving: Sequence[int]) -> np.ndarray:
    """Return the stiffness matrix at rest, of which only the columns `moving` are computed."""
    angle = 1e-4
    stiffness = np.zeros((model.nv, model.nv))
    for place in moving:
        forces = []
        for side in (angle, -angle):
            mujoco.mj_resetData(model, data)
            mujoco.mj_integratePos(model, data.qpos, side * np.eye(model.nv)[place], 1.0)
            mujoco.mj_forward(model, data)
            forces.append(data.qfrc_bias.copy())
        stiffness[:, place] = (forces[0] - forces[1]) / (2 * math.sin(angle))
    return stiffness


@cache
def reaction_errors(can: Standing) -> np.ndarray:
    """Return the relative errors of force, coupling and moment, shape (3, shares)."""
    omegas = np.array(SHARES) * can.frequencies(1)[0]
    simulated = np.array([response(can, float(omega)) for omega in omegas]).T
    return simulated / np.array(can.reaction(omegas)) - 1


@cache
def predicted_reaction_errors(can: Standing) -> np.ndarray:
    """Return the `reaction_errors` that theory predicts, shape (3, shares).

    The model leaves modes out: their masses stay at their pivots instead of moving.
    """
    shaken = np.array(SHARES)[:, None] * can.frequencies(1)[0]
    omega = can.frequencies(SERIES)[can.modes :]
    mass = can.slosh_masses(SERIES)[can.modes :]
    pivot = can.pivots(SERIES)[can.modes :] - can.height / 2
    length = can.gravity / omega**2
    bob = pivot - length
    moving = mass * shaken**2 / (omega**2 - shaken**2)
    arm = bob + can.gravity / shaken**2
    force = moving
    coupling = moving * arm - mass * length
    moment = moving * arm**2 - mass * (pivot**2 - bob**2)
    moment = moment - mass * length * can.gravity / shaken**2
    missing = np.sum([force, coupling, moment], axis=-1)
    return -missing / np.array(can.reaction(shaken[:, 0]))


def thrown(
    can: Standing,
    timestep: float,
    integrator: MujocoIntegrator = "implicitfast",
    count: int = _THROWN,
) -> int:
    """Return how many of `count` cans diverge or gain energy in the second after they are thrown.

    They are thrown at a height of 0.3 m with about 1 m/s and 5 rad/s.
    """
    model = build(can, integrator=integrator, timestep=timestep)
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data = mujoco.MjData(model)
    random = np.random.default_rng(0)
    steps = round(1 / timestep)
    failed = 0
    for _ in range(count):
        mujoco.mj_resetData(model, data)
        turn = random.normal(size=4)
        data.joint("free").qpos = [0, 0, 0.3, *turn / np.linalg.norm(turn)]
        data.joint("free").qvel = random.normal(size=6) / math.sqrt(3) * [1, 1, 1, 5, 5, 5]
        with quiet():
            mujoco.mj_forward(model, data)
            start = float(data.energy.sum())
            lowest = start
            gain = 0.0
            for _ in range(steps):
                mujoco.mj_step(model, data)
                energy = float(data.energy.sum())
                lowest = min(lowest, energy)
                gain = max(gain, energy - lowest)
        diverged = any(warning.number for warning in data.warning)
        keeps_its_energy = gain <= _GAIN * start  # false if the gain is NaN
        if diverged or not keeps_its_energy:
            failed += 1
    return failed
