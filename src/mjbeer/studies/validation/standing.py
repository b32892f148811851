"""Rows of cans that are free in space: the slosh in a standing one, and a lying one that rolls."""

import math
from collections.abc import Iterator
from functools import cache, partial

import mujoco
import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from mjbeer.model.build import build
from mjbeer.model.engine import quiet
from mjbeer.model.free import attach, transverse_inertia
from mjbeer.model.setting import MujocoIntegrator
from mjbeer.studies.rows import Row
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import SERIES, Reaction, Standing, standing

_METAL = Can.sheet_metal()
_FILLS = (0.1, 0.3, 0.5, 0.7, 0.9)
SHARES = (0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 2.0, 4.0)
"""Frequencies of shaking, over that of the first mode; the next ones have 1.7, 2.2, 2.5 and 2.9."""
_ANGLE = 1e-3
"""Tilt of the pendulums that are let go [rad]."""
_ROUNDED = 1.05
"""Factor on the errors that theory gives, as their bound: two digits of it are shown."""
_THROWN = 100
_GAIN = 0.1
"""Largest energy that a thrown can may gain over that which it had: a rigid can gains 0.05 at 5 ms."""


def rows() -> Iterator[Row]:
    """Yield the rows of standing and of lying cans."""
    for fill in _FILLS:
        yield Row(
            "standing",
            "frequencies of 3 modes, by the eigenvalues of M and K",
            partial(_eigenvalues, water(3, fill, damping_ratio=0.0)),
            f"{fill:.0%} full, held",
            1e-9,
            "relative",
            "rounding",
        )
    yield Row(
        "standing",
        f"frequency by stepping from {_ANGLE:g} rad, against a pendulum's 1 - angle^2/16",
        lambda: let_go(water(damping_ratio=0.0))[0],
        "half full, held, RK4, 1 ms",
        5e-9,
        "relative",
        "RK4: (omega h)^4/120, 2.5e-9",
    )
    yield Row(
        "standing",
        "logarithmic decrement",
        lambda: let_go(water())[1],
        "half full, held, RK4, 1 ms",
        1e-5,
        "relative",
        "breaking waves, which take the square of the angle: 4e-6; and the rates at crossings between samples",
    )
    for modes in (1, 2, 3, 5):
        can = water(modes)
        for place, name in ((0, "force under shaking"), (2, "moment under pitching")):
            yield Row(
                "standing",
                f"{name} at 8 frequencies, 0.2 to 4 of the first, against the infinite series",
                lambda can=can, place=place: np.abs(reaction_errors(can)[place]).max(),
                f"half full, {modes} mode{'s' * (modes > 1)}",
                float(_ROUNDED * np.abs(left_out(can)[place]).max()),
                "relative",
                "the modes left out, whose share the bound is",
            )
    for name, place in (("mass", 0), ("centre of mass", 1), ("inertia", 2)):
        yield Row(
            "standing",
            f"{name} of can and liquid",
            lambda place=place: _moments(water(3))[place],
            "half full, 3 modes",
            1e-13,
            "relative",
            "rounding",
        )
    yield Row(
        "standing",
        "moment of the liquid in a can tilted by 20 degrees, against rho g pi R^4/4 sin",
        lambda: tilted(math.radians(20)),
        "half full, 1 mode, held",
        1e-12,
        "relative",
        "rounding; a true surface has tan^2/2 more, 6.6 %",
    )
    yield Row(
        "standing",
        "tilt at which the can tips over, against a true surface",
        _tipping,
        "half full, 1 mode",
        2.0,
        "degrees",
        "a true surface has tan^2/2 more moment: 1.3 degrees",
    )
    for timestep in (2e-3, 5e-3):
        for modes in (1, 3):
            yield Row(
                "standing",
                f"thrown cans, of {_THROWN}, that diverge or gain {_GAIN:g} of their energy",
                partial(thrown, water(modes), timestep),
                f"half full, {modes} mode{'s' * (modes > 1)}, implicitfast, {1e3 * timestep:g} ms",
                0,
                "",
                "stable or not",
            )
    for name, scene, phi0 in (
        ("frozen", frozen(math.radians(8), can=_METAL), 2.0),
        ("sliding", sliding(math.radians(8), can=_METAL), 1.0),
    ):
        yield Row(
            "lying",
            "phi over 2 s",
            lambda scene=scene, phi0=phi0: np.abs(lying(scene, phi0)[0]).max(),
            f"{name}, metal can, free in space, RK4, 0.5 ms",
            1e-6,
            "rad",
            "softness of the contact",
        )
        yield Row(
            "lying",
            "turn about the vertical over 2 s of a can that starts askew on level ground",
            lambda scene=scene, phi0=phi0: lying(Scene(scene.can, scene.load, 0.0, scene.attachment), phi0, 0.5)[1],
            f"{name}, metal can, free in space, RK4, 0.5 ms",
            1e-9,
            "rad",
            "rounding",
        )


def water(modes: int = 1, fill: float = 0.5, damping_ratio: float | None = None) -> Standing:
    """Return a can of water."""
    return standing("water", fill, modes=modes, damping_ratio=damping_ratio)


def _eigenvalues(can: Standing) -> float:
    """Return the largest relative error of omega^2 = K/M; K is the torque of weight at an angle over its sine."""
    model = build(can, free=False)
    data, inertia, angle, errors = mujoco.MjData(model), np.zeros((model.nv, model.nv)), 0.5, []
    for mode, omega in enumerate(can.frequencies(), 1):
        data.qpos[:] = model.qpos0
        data.joint(f"slosh{mode}").qpos = [math.cos(angle / 2), 0, math.sin(angle / 2), 0]
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, inertia)
        place = model.joint(f"slosh{mode}").dofadr[0] + 1
        stiffness = data.qfrc_bias[place] / math.sin(angle)
        errors.append(math.sqrt(stiffness / inertia[place, place]) / omega - 1)
    return max(errors, key=abs)


@cache
def let_go(can: Standing) -> tuple[float, float]:
    """Return the relative errors of frequency and decrement of the first mode, let go in a can that is held."""
    model = build(can, free=False)
    data, rows_, omega, ratio = mujoco.MjData(model), [], can.frequencies()[0], can.damping_ratios()[0]
    data.joint("slosh1").qpos = [math.cos(_ANGLE / 2), 0, math.sin(_ANGLE / 2), 0]
    while data.time * omega < 64:
        mujoco.mj_forward(model, data)
        rows_.append((data.time, data.joint("slosh1").qpos[2], data.joint("slosh1").qvel[1]))
        mujoco.mj_step(model, data)
    times, sines, rates = np.array(rows_).T
    way = CubicHermiteSpline(times, 2 * np.arcsin(sines), rates)
    crossings = way.roots(extrapolate=False)
    cycles = (len(crossings) - 1) / 2
    root = math.sqrt(1 - ratio**2)
    measured = 2 * math.pi * cycles / (crossings[-1] - crossings[0]) / (omega * root)
    speeds = np.abs(way(crossings, 1))
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
            way = np.zeros(model.nv)
            way[place] = side
            mujoco.mj_integratePos(model, data.qpos, way, 1.0)
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


def _moments(can: Standing) -> tuple[float, float, float]:
    """Return the relative errors of mass, centre of mass and second moment of the compiled model."""
    model, shell = build(can), can.can
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    masses, heights = model.body_mass[1:], data.xipos[1:, 2]
    found = masses.sum(), masses @ heights, masses @ heights**2 + model.body_inertia[1:, 0].sum()
    zeroth, first, second = can.fixed_moments()
    middle, half = can.height / 2, shell.length / 2
    expected = (
        zeroth + shell.mass,
        first + zeroth * middle + shell.mass * half,
        second + 2 * first * middle + zeroth * middle**2 + transverse_inertia(shell) + shell.mass * half**2,
    )
    mass, centre, inertia = (one / other - 1 for one, other in zip(found, expected, strict=True))
    return float(mass), float(centre - mass), float(inertia)


def _weight_moment(can: Standing, tilt: float, x: float, z: float) -> float:
    """Return the moment of weight [N m] about a level line at x and z of a can that is held at a tilt, at rest."""
    model = build(can, free=False)
    model.body("can").quat = [math.cos(tilt / 2), 0, math.sin(tilt / 2), 0]
    data = mujoco.MjData(model)
    for mode in range(1, can.modes + 1):  # they hang down
        data.joint(f"slosh{mode}").qpos = [math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0]
    mujoco.mj_kinematics(model, data)
    line = data.body("can").xmat.reshape(3, 3) @ [x, 0, z]
    return float(can.gravity * model.body_mass @ (data.xipos[:, 0] - line[0]))


def tilted(tilt: float) -> float:
    """Return the relative error of the liquid's moment about its middle, at a tilt [rad]."""
    can = water()
    middle, shell = can.height / 2, can.can
    lever = shell.mass * can.gravity * (shell.length / 2 - middle) * math.sin(tilt)
    found = _weight_moment(can, tilt, 0.0, middle) - lever
    return found / (can.density * can.gravity * math.pi * shell.radius**4 / 4 * math.sin(tilt)) - 1


def _tipping() -> float:
    """Return by how many degrees the model tips later than a can with a true surface, which stays plane."""
    can = water()
    radius, height, shell = can.can.radius, can.height, can.can

    def true_surface(tilt: float) -> float:
        rise = math.tan(tilt)
        x, z = radius**2 * rise / (4 * height), height / 2 + radius**2 * rise**2 / (8 * height)
        liquid = can.mass * ((x - radius) * math.cos(tilt) + z * math.sin(tilt))
        return liquid + shell.mass * (shell.length / 2 * math.sin(tilt) - radius * math.cos(tilt))

    model = brentq(lambda tilt: _weight_moment(can, tilt, radius, 0.0), 0.1, 1.2)
    return math.degrees(model - brentq(true_surface, 0.1, 1.2))


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


@cache
def lying(scene: Scene, phi0: float, yaw: float = 0.0) -> tuple[np.ndarray, float]:
    """Return the error of phi [rad] of a free can over 2 s, shape (steps,), and its largest turn about the normal."""
    spec, radius, tilt = mujoco.MjSpec(), scene.can.radius, scene.incline
    spec.option.timestep = 5e-4
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    slope = spec.worldbody.add_frame(quat=[math.cos(tilt / 2), 0, math.sin(tilt / 2), 0])
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1]).set_frame(slope)
    attach(spec, scene)
    model = spec.compile()
    data, (u, _) = mujoco.MjData(model), scene.start(phi0, 0.0)
    down, normal = np.array([math.cos(tilt), 0, -math.sin(tilt)]), np.array([math.sin(tilt), 0, math.cos(tilt)])
    turn = np.array([math.cos(tilt / 2), 0, math.sin(tilt / 2), 0])
    for axis, angle in (([0, 0, 1], yaw), ([0, 1, 0], u / radius)):
        step, both = np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(step, np.array(axis, float), angle)
        mujoco.mju_mulQuat(both, turn, step)
        turn = both
    joint, swing = data.joint("can-free"), scene.attachment == "sliding"
    joint.qpos = [*(radius * (1 - 1e-9) * normal + u * down), *turn]
    if swing:
        data.joint("can-swing").qpos = phi0 - u / radius
    mujoco.mj_forward(model, data)
    times, angles, drift, roll = [], [], 0.0, u / radius
    ahead = math.cos(yaw) * down + math.sin(yaw) * np.cross(normal, down)
    while data.time < 2.0:
        axes = data.body("can-can").xmat.reshape(3, 3)
        now = math.atan2(-axes[:, 0] @ normal, axes[:, 0] @ ahead)
        roll = now + 2 * math.pi * round((roll - now) / (2 * math.pi))
        drift = max(drift, abs(float(axes[:, 1] @ ahead)))
        times.append(data.time)
        angles.append(roll + (data.joint("can-swing").qpos[0] if swing else 0.0))
        mujoco.mj_step(model, data)
    return np.array(angles) - exact(scene, times, phi0).phi, drift
