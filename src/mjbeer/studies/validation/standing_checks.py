"""Checks of the slosh in a standing can, which is held, shaken or thrown."""

import math
from collections.abc import Iterator
from functools import cache, partial

import mujoco
import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.checks.check import Check
from mjbeer.model.attach import attach
from mjbeer.model.build import build
from mjbeer.model.free import transverse_inertia
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import MujocoIntegrator
from mjbeer.theory.standing import SERIES, Reaction, Standing, standing

SHARES = (0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 2.0, 4.0)
"""Frequencies of shaking, over that of the first mode; the next ones have 1.7, 2.2, 2.5 and 2.9."""
_ANGLE = 1e-3
"""Tilt of the pendulums that are let go [rad]."""
_ROUNDED = 1.05
"""Factor on the errors that theory gives, as their bound: two digits of it are shown."""
_THROWN = 100
_GAIN = 0.1
"""Largest energy that a thrown can may gain over that which it had: a rigid can gains 0.05 at 5 ms."""


def checks() -> Iterator[Check]:
    """Yield the checks of standing cans."""
    check = partial(Check, "standing")
    by, reason = "half full, held, RK4, 1 ms", "RK4: (omega h)^4/120, 2.5e-9"
    name = f"frequency by stepping from {_ANGLE:g} rad, against a pendulum's 1 - angle^2/16"
    yield check(name, lambda: let_go(water(damping_ratio=0.0))[0], by, 5e-9, "relative", reason)
    reason = "breaking waves, which take the square of the angle: 4e-6; and the rates at crossings between samples"
    yield check("logarithmic decrement", lambda: let_go(water())[1], by, 1e-5, "relative", reason)
    for modes in (1, 2, 3, 5):
        can, by = water(modes), f"half full, {modes} mode{'s' * (modes > 1)}"
        for place, of in ((0, "force under shaking"), (2, "moment under pitching")):
            name = f"{of} at 8 frequencies, 0.2 to 4 of the first, against the infinite series"
            bound = float(_ROUNDED * np.abs(left_out(can)[place]).max())
            measure = lambda can=can, place=place: np.abs(reaction_errors(can)[place]).max()  # noqa: E731
            yield check(name, measure, by, bound, "relative", "the modes left out, whose share the bound is")
    for timestep in (2e-3, 5e-3):
        for modes in (1, 3):
            name = f"thrown cans, of {_THROWN}, that diverge or gain {_GAIN:g} of their energy"
            by = f"half full, {modes} mode{'s' * (modes > 1)}, implicitfast, {1e3 * timestep:g} ms"
            yield check(name, partial(thrown, water(modes), timestep), by, 0, "", "stable or not")


def water(modes: int = 1, fill: float = 0.5, damping_ratio: float | None = None) -> Standing:
    """Return a can of water."""
    return standing("water", fill, modes=modes, damping_ratio=damping_ratio)


@cache
def let_go(can: Standing) -> tuple[float, float]:
    """Return the relative errors of frequency and decrement of the first mode, let go in a can that is held."""
    model = build(can, free=False)
    data, samples, omega, ratio = mujoco.MjData(model), [], can.frequencies()[0], can.damping_ratios()[0]
    data.joint("slosh1").qpos = [math.cos(_ANGLE / 2), 0, math.sin(_ANGLE / 2), 0]
    while data.time * omega < 64:
        mujoco.mj_forward(model, data)
        samples.append((data.time, data.joint("slosh1").qpos[2], data.joint("slosh1").qvel[1]))
        mujoco.mj_step(model, data)
    times, sines, rates = np.array(samples).T
    angle = CubicHermiteSpline(times, 2 * np.arcsin(sines), rates)
    crossings = angle.roots(extrapolate=False)
    cycles = (len(crossings) - 1) / 2
    root = math.sqrt(1 - ratio**2)
    measured = 2 * math.pi * cycles / (crossings[-1] - crossings[0]) / (omega * root)
    speeds = np.abs(angle(crossings, 1))
    decrement = math.log(speeds[0] / speeds[-1]) / cycles
    expected = 2 * math.pi * ratio / root
    return measured / (1 - _ANGLE**2 / 16) - 1, decrement / expected - 1 if ratio > 0 else decrement


def response(can: Standing, omega: float) -> Reaction:
    """Return the reaction of MuJoCo's model without its shell, by its inertia and its stiffness at rest."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0, 0, -can.gravity]
    rig = spec.worldbody.add_body(name="rig", mass=1.0, inertia=[1.0] * 3, explicitinertial=True)
    rig.add_joint(name="x", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    rig.add_joint(name="theta", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0])
    attach(spec, can, pos=[0, 0, -can.height / 2], free=False, body="rig")
    model = spec.compile()
    data, inertia = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, inertia)
    used = [0, 1, *(model.joint(f"can-slosh{mode}").dofadr[0] + 1 for mode in range(1, can.modes + 1))]
    stiffness, step = np.zeros((model.nv, model.nv)), 1e-4
    for place in used:
        forces = []
        for side in (step, -step):
            mujoco.mj_resetData(model, data)
            mujoco.mj_integratePos(model, data.qpos, side * np.eye(model.nv)[place], 1.0)
            mujoco.mj_forward(model, data)
            forces.append(data.qfrc_bias.copy())
        stiffness[:, place] = (forces[0] - forces[1]) / (2 * math.sin(step))
    # The rig and the shell are rigid: a mass, and a moment about the liquid's middle.
    shell, above = can.can, (can.can.length - can.height) / 2
    across = transverse_inertia(shell) + shell.mass * above**2
    inertia[:2, :2] -= [[1 + shell.mass, shell.mass * above], [shell.mass * above, 1 + across]]
    stiffness[1, 1] += shell.mass * can.gravity * above
    dynamic = (stiffness - omega**2 * inertia)[np.ix_(used, used)] / -(omega**2)
    found = dynamic[:2, :2] - dynamic[:2, 2:] @ np.linalg.solve(dynamic[2:, 2:], dynamic[2:, :2])
    return Reaction(found[0, 0], found[0, 1], found[1, 1])


@cache
def reaction_errors(can: Standing) -> np.ndarray:
    """Return the relative errors of force, coupling and moment at each of `SHARES`, shape (3, shares)."""
    omegas = np.array(SHARES) * can.frequencies(1)[0]
    found = np.array([response(can, float(omega)) for omega in omegas]).T
    return found / np.array(can.reaction(omegas)) - 1


@cache
def left_out(can: Standing) -> np.ndarray:
    """Return what theory says of those errors: modes left out that stay at their pivots instead of moving."""
    many, omegas = SERIES, np.array(SHARES)[:, None] * can.frequencies(1)[0]
    omega, mass = (each[can.modes :] for each in (can.frequencies(many), can.slosh_masses(many)))
    pivot = can.pivots(many)[can.modes :] - can.height / 2
    length = can.gravity / omega**2
    bob, moving = pivot - length, mass * omegas**2 / (omega**2 - omegas**2)
    arm = bob + can.gravity / omegas**2
    missing = [
        moving,
        moving * arm - mass * length,
        moving * arm**2 - mass * (pivot**2 - bob**2) - mass * length * can.gravity / omegas**2,
    ]
    return -np.sum(missing, axis=-1) / np.array(can.reaction(omegas[:, 0]))


def thrown(can: Standing, timestep: float, integrator: MujocoIntegrator = "implicitfast", count: int = _THROWN) -> int:
    """Return how many cans diverge or gain energy, thrown with some 1 m/s and 5 rad/s from 0.3 m for a second."""
    model = build(can, integrator=integrator, timestep=timestep)
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data, random, failed = mujoco.MjData(model), np.random.default_rng(0), 0
    for _ in range(count):
        mujoco.mj_resetData(model, data)
        turn = random.normal(size=4)
        data.joint("free").qpos = [0, 0, 0.3, *turn / np.linalg.norm(turn)]
        data.joint("free").qvel = random.normal(size=6) / math.sqrt(3) * [1, 1, 1, 5, 5, 5]
        with quiet():
            mujoco.mj_forward(model, data)
            start = lowest = float(data.energy.sum())
            gain = 0.0
            for _ in range(round(1 / timestep)):
                mujoco.mj_step(model, data)
                energy = float(data.energy.sum())
                lowest, gain = min(lowest, energy), max(gain, energy - lowest)
        failed += not gain <= _GAIN * start or any(warning.number for warning in data.warning)
    return failed
