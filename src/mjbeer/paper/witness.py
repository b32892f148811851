"""MuJoCo as a witness: its forward dynamics along a motion, and the motions that claims share."""

import math
from functools import cache, partial
from typing import Any, NamedTuple

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.model.joints import joint_addresses, to_states
from mjbeer.model.setting import Integrator, Rolling, supported
from mjbeer.paper.claim import Bound, Observation, Witness
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can, Load
from mjbeer.theory.paper_scenes import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene


def simulated(scene: Scene, phi0: float, *more: Any, **settings: Any) -> Witness:
    """Return the witness of a motion; the arguments are those of `watch`.

    By default a constraint between two joints makes the can roll, since that model contains none of
    the paper's theory. It cannot have a massless can with a sliding load, for which the default is
    the reduced model.
    """
    settings.setdefault("rolling", "equality" if supported(scene, "equality") else "reduced")
    return Witness(f"MuJoCo, {settings['rolling']}", partial(watch, scene, phi0, *more, **settings))


@cache
def watch(
    scene: Scene,
    phi0: float,
    duration: float = 1.0,
    phi_dot0: float = 0.0,
    rolling: Rolling = "reduced",
    samples: int = 101,
    integrator: Integrator = "DOP853",
    timestep: float = 5e-4,
) -> Observation:
    """Simulate a motion, and return what MuJoCo computes at evenly spaced samples of it.

    Coordinates are those of Fig. 3. The load's centre of mass is at `s` along the incline; it is at
    the distance `across` from the axis, away from the incline, and at `height` above the place
    where the axis starts [m]. `theta` [rad] is the angle between gravity and the line from the axis
    to it. Accelerations are those of mj_forward, and `kinetic` and `potential` are energies of can
    and load [J]. `friction` is the force of the incline on the can, uphill [N]; it is 0 unless a
    constraint makes the can roll.
    """
    times = np.linspace(0, duration, samples)
    run = simulate(scene, duration, phi0, phi_dot0, rolling, integrator, timestep, times=times)
    model = build(scene, rolling, integrator="DOP853", timestep=timestep)
    computed = _forward_dynamics(model, scene, to_states(model, run))
    gravity = model.opt.gravity
    down = gravity / scene.gravity
    # A quarter turn from gravity.
    forward = np.array([-down[2], 0, down[0]])
    arm = computed.load[:, 0] - computed.axis[:, 0]
    # The height at which the axis starts, in the coordinates of the model.
    start = computed.axis[0, 0, 2]
    s, s_dot, s_ddot = computed.load[:, :, 0].T
    u, u_dot, u_ddot = computed.axis[:, :, 0].T
    across, across_dot, across_ddot = (computed.load - computed.axis)[:, :, 2].T
    return Observation.of(
        scene,
        time=run.time,
        s=s,
        s_dot=s_dot,
        s_ddot=s_ddot,
        u=u,
        u_dot=u_dot,
        u_ddot=u_ddot,
        across=across,
        across_dot=across_dot,
        across_ddot=across_ddot,
        phi=run.phi,
        phi_dot=computed.phi_dot,
        phi_ddot=computed.phi_ddot,
        theta=np.arctan2(-arm @ forward, arm @ down),
        height=-(computed.load[:, 0] - [0, 0, start]) @ down,
        kinetic=computed.kinetic,
        potential=computed.potential + scene.mass * gravity[2] * start,
        friction=computed.friction,
    )


class _ForwardDynamics(NamedTuple):
    """What MuJoCo computes from the states of a motion, in the coordinates of its model."""

    axis: np.ndarray
    """Position, velocity and acceleration of the can's axis, shape (samples, 3, 3)."""
    load: np.ndarray
    """Those of the load's centre of mass."""
    phi_dot: np.ndarray
    """[rad/s]."""
    phi_ddot: np.ndarray
    """[rad/s^2]."""
    potential: np.ndarray
    """[J]."""
    kinetic: np.ndarray
    """[J]."""
    friction: np.ndarray
    """Force of the incline on the can, uphill [N]."""


def _forward_dynamics(model: mujoco.MjModel, scene: Scene, states: np.ndarray) -> _ForwardDynamics:
    """Return what MuJoCo's forward dynamics computes at `states`, shape (samples, nq + nv)."""
    samples = len(states)
    computed = _ForwardDynamics(
        axis=np.empty((samples, 3, 3)),
        load=np.empty((samples, 3, 3)),
        phi_dot=np.zeros(samples),
        phi_ddot=np.zeros(samples),
        potential=np.zeros(samples),
        kinetic=np.zeros(samples),
        friction=np.zeros(samples),
    )
    data = mujoco.MjData(model)
    joints = joint_addresses(model)
    can = model.body("can").id
    # A frozen load belongs to the body of the can.
    carrier = model.body("load").id if "swing" in joints else can
    for sample, state in enumerate(states):
        data.qpos[:], data.qvel[:] = np.split(state, [model.nq])
        mujoco.mj_forward(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        upward = data.xmat[carrier].reshape(3, 3)[:, 2]
        centre = data.xpos[carrier] - scene.load.offset * upward
        computed.axis[sample] = _point_motion(model, data, data.xpos[can].copy(), can)
        computed.load[sample] = _point_motion(model, data, centre, carrier)
        rotation = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, None, rotation, data.xpos[carrier], carrier)
        computed.phi_dot[sample] = rotation[1] @ data.qvel
        computed.phi_ddot[sample] = rotation[1] @ data.qacc
        computed.potential[sample], computed.kinetic[sample] = data.energy
        if "slide" in joints:
            slide = model.joint("slide").dofadr[0]
            computed.friction[sample] = -data.qfrc_constraint[slide]
    return computed


def _point_motion(
    model: mujoco.MjModel, data: mujoco.MjData, point: np.ndarray, body: int
) -> np.ndarray:
    """Return position, velocity and acceleration of a point of a body, shape (3, 3)."""
    jacobian = np.zeros((3, model.nv))
    jacobian_dot = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    mujoco.mj_jacDot(model, data, jacobian_dot, None, point, body)
    velocity = jacobian @ data.qvel
    acceleration = jacobian @ data.qacc + jacobian_dot @ data.qvel
    return np.stack([point, velocity, acceleration])


@cache
def oscillate(
    scene: Scene, phi0: float, duration: float = 4.0, rolling: Rolling = "reduced"
) -> Observation:
    """Simulate a swing in 4000 steps; return its `omega` [rad/s] and equilibrium `rest` [rad]."""
    run = simulate(
        scene, duration, phi0, rolling=rolling, integrator="DOP853", timestep=duration / 4000
    )
    return Observation.of(scene, omega=run.frequency(), rest=scene.equilibrium())


def footnote_scene(offset_factor: float = 1.0) -> Scene:
    """Return the scene of footnote 8, with b multiplied by a factor.

    It has a = 3 cm, b = 1 cm, alpha = 10 degrees, g = 980 cm/s^2 and I_axis = m a^2/2.
    """
    a = 0.03
    b = 0.01 * offset_factor
    load = Load(mass=1.0, offset=b, inertia=1.0 * (a**2 / 2 - b**2))
    return Scene(Can.massless(a), load, math.radians(10), "frozen", gravity=9.8)


def balanced(k: float) -> Scene:
    """Return a rolling cylinder of inertia k m a^2: a balanced load frozen to a massless can."""
    can = Can.massless()
    load = Load(mass=0.2, offset=0.0, inertia=k * 0.2 * can.radius**2)
    return Scene(can, load, attachment="frozen")


REDUCED = "MuJoCo, reduced"
EQUALITY = "MuJoCo, equality"
CONTACT = "MuJoCo, contact"
SMALL = 1e-3  # amplitude [rad] of a small swing
# At 2 rad every term of an equation matters; 1 rad is clearly not small.
SWING = simulated(sliding(), 2.0)
WIDE = simulated(sliding(), 1.0)
TENTH = simulated(sliding(), 0.1)
NARROW = simulated(sliding(), SMALL)
METAL = simulated(sliding(can=Can.sheet_metal()), 2.0)
WHEEL = simulated(pendulum(), 2.0)
ROLL_DOWN = simulated(frozen(), math.pi, 0.8)
FOOTNOTE_8 = simulated(footnote_scene(), math.pi, 0.8)
EXACT = Bound(1e-12, "rounding of MuJoCo's forward dynamics")
DRIFT = "what MuJoCo's joint equality takes back of its drift"
HELD = Bound(2e-8, DRIFT)

GRIP = 1e6  # friction coefficient so large that nothing slips
_SAMPLES = 256  # samples of one turn; ripples up to the 128th multiple of the rate can be measured


@cache
def loop(scene: Scene, phi_dot0: float) -> Observation:
    """Simulate one turn of a load that loops from phi = 0 with `phi_dot0` [rad/s].

    The mean rate is `Omega` [rad/s]. At index k, `ripple` has the amplitude [rad] of sin(k Omega t)
    in phi - Omega t, and `sway` that [m] in u less the distance due to the steady acceleration.
    """
    turn = 2 * math.pi / phi_dot0
    for _ in range(8):  # Newton's method for the time of a turn
        end = _one_turn(scene, turn, phi_dot0, np.array([0, turn]))
        turn += (2 * math.pi - end.phi[-1]) / end.phi_dot[-1]
    times = turn * np.arange(_SAMPLES) / _SAMPLES
    run = _one_turn(scene, turn, phi_dot0, times)
    rate = 2 * math.pi / turn
    ripple = sines(run.phi - rate * times)
    sway = sines(run.u - scene.acceleration() * times**2 / 2)
    return Observation.of(scene, Omega=rate, ripple=ripple, sway=sway)


def _one_turn(scene: Scene, turn: float, phi_dot0: float, times: np.ndarray) -> Run:
    """Return a motion of the duration `turn` [s] from phi = 0, at some times [s]."""
    return simulate(
        scene, turn, 0.0, phi_dot0, integrator="DOP853", timestep=turn / 64, times=times
    )


def sines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of sin(2 pi k x), at index k, in values at x from 0 to 1."""
    return -np.fft.rfft(values).imag * 2 / len(values)
