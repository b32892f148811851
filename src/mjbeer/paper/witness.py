"""MuJoCo as a witness: what its forward dynamics computes along a motion; and the motions that several claims share."""

import math
from functools import cache, partial
from typing import Any

import mujoco
import numpy as np

from mjbeer.model.build import build
from mjbeer.model.joints import joint_addresses, to_states
from mjbeer.model.setting import Integrator, Rolling, supported
from mjbeer.paper.claim import Bound, Seen, Witness
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can, Load
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding


def simulated(scene: Scene, phi0: float, *more: Any, **settings: Any) -> Witness:
    """Return the witness of a motion; the arguments are those of `watch`.

    Unless told otherwise the can is rolled by a constraint between two joints: that model contains none of the paper's
    theory. A massless can around a sliding load is beyond it, and is reduced.
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
) -> Seen:
    """Simulate a motion and return what MuJoCo computes at evenly spaced samples of it, in the coordinates of Fig. 3.

    `s` is read from the position of the load's centre of mass, `across` is how far it is from the axis, away from the
    incline, and `height` how far above where the axis starts. `theta` [rad] is the angle between gravity and the line
    from the axis to it. Accelerations are those of mj_forward; `kinetic` and `potential` are energies of the whole [J],
    and `friction` is the force [N] of the incline on the can, uphill, where a constraint makes it roll, otherwise 0.
    """
    times = np.linspace(0, duration, samples)
    run = simulate(scene, duration, phi0, phi_dot0, rolling, integrator, timestep, times=times)
    model = build(scene, rolling, integrator="DOP853", timestep=timestep)
    data, names, can = mujoco.MjData(model), joint_addresses(model), model.body("can").id
    carrier = model.body("load").id if "swing" in names else can
    axis, load = np.empty((2, samples, 3, 3))
    phi_dot, phi_ddot, potential, kinetic, friction = np.zeros((5, samples))
    for k, state in enumerate(to_states(model, run)):
        data.qpos[:], data.qvel[:] = np.split(state, [model.nq])
        mujoco.mj_forward(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        centre = data.xpos[carrier] - data.xmat[carrier].reshape(3, 3)[:, 2] * scene.load.offset
        axis[k] = _point_motion(model, data, data.xpos[can].copy(), can)
        load[k] = _point_motion(model, data, centre, carrier)
        turn = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, None, turn, data.xpos[carrier], carrier)
        phi_dot[k], phi_ddot[k] = turn[1] @ data.qvel, turn[1] @ data.qacc
        potential[k], kinetic[k] = data.energy
        if "slide" in names:
            friction[k] = -data.qfrc_constraint[model.joint("slide").dofadr[0]]
    down, start = model.opt.gravity / scene.gravity, axis[0, 0, 2]
    arm, side = load[:, 0] - axis[:, 0], np.array([-down[2], 0, down[0]])  # a quarter turn from gravity, downhill
    coordinates = {"s": load[:, :, 0], "u": axis[:, :, 0], "across": load[:, :, 2] - axis[:, :, 2]}
    moved = {
        name + dots: column
        for name, columns in coordinates.items()
        for dots, column in zip(("", "_dot", "_ddot"), columns.T, strict=True)
    }
    moved |= {"phi": run.phi, "phi_dot": phi_dot, "phi_ddot": phi_ddot, "theta": np.arctan2(-arm @ side, arm @ down)}
    height, level = -(load[:, 0] - [0, 0, start]) @ down, scene.mass * model.opt.gravity[2] * start
    forces = {"kinetic": kinetic, "potential": potential + level, "friction": friction}
    return Seen.of(scene, time=run.time, height=height, **moved, **forces)


def _point_motion(model: mujoco.MjModel, data: mujoco.MjData, point: np.ndarray, body: int) -> np.ndarray:
    """Return the position, velocity and acceleration of a point of a body, shape (3, 3), in SI units."""
    jacobian, change = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    mujoco.mj_jacDot(model, data, change, None, point, body)
    return np.stack([point, jacobian @ data.qvel, jacobian @ data.qacc + change @ data.qvel])


@cache
def oscillate(scene: Scene, phi0: float, duration: float = 4.0, rolling: Rolling = "reduced") -> Seen:
    """Return the frequency `omega` [rad/s] of a swing that is simulated in 4000 steps, and its `rest` [rad]."""
    run = simulate(scene, duration, phi0, rolling=rolling, integrator="DOP853", timestep=duration / 4000)
    return Seen.of(scene, omega=run.frequency(), rest=scene.equilibrium())


def footnote_scene(part: float = 1.0) -> Scene:
    """Return the scene of footnote 8: a = 3 cm, b = 1 cm, alpha = 10 degrees, g = 980 cm/s^2, I_axis = m a^2/2.

    `part` scales b.
    """
    a, b, mass = 0.03, 0.01 * part, 1.0
    return Scene(Can.massless(a), Load(mass, b, mass * (a**2 / 2 - b**2)), math.radians(10), "frozen", 9.8)


def balanced(k: float) -> Scene:
    """Return a rolling cylinder of inertia k m a^2 about its axis: a balanced load frozen to a massless can."""
    can = Can.massless()
    return Scene(can, Load(0.2, 0.0, k * 0.2 * can.radius**2), attachment="frozen")


REDUCED, EQUALITY, CONTACT = "MuJoCo, reduced", "MuJoCo, equality", "MuJoCo, contact"
SMALL = 1e-3  # amplitude [rad] of a small swing
# At 2 rad every term of an equation matters; 1 rad is clearly not small.
SWING, WIDE, TENTH, NARROW = (simulated(sliding(), amplitude) for amplitude in (2.0, 1.0, 0.1, SMALL))
METAL, WHEEL = simulated(sliding(can=Can.sheet_metal()), 2.0), simulated(pendulum(), 2.0)
ROLL_DOWN, FOOTNOTE_8 = (simulated(scene, math.pi, 0.8) for scene in (frozen(), footnote_scene()))
EXACT = Bound(1e-12, "rounding of MuJoCo's forward dynamics")
DRIFT = "what MuJoCo's joint equality takes back of its drift"
HELD = Bound(2e-8, DRIFT)

GRIP = 1e6  # friction coefficient so large that nothing slips
_SAMPLES = 256  # samples of one turn; ripples up to the 128th multiple of the rate can be measured


@cache
def loop(scene: Scene, phi_dot0: float) -> Seen:
    """Simulate one turn of a load that loops from phi = 0, for which `phi_dot0` [rad/s] must be enough.

    Its mean rate is `Omega` [rad/s]. `ripple` has the amplitudes [rad] of sin(k Omega t) in phi - Omega t, at index k,
    and `sway` those [m] in u less its steady acceleration.
    """
    turn = 2 * math.pi / phi_dot0
    for _ in range(8):  # Newton's method for the time of a turn
        end = simulate(scene, turn, 0.0, phi_dot0, integrator="DOP853", timestep=turn / 64, times=np.array([0, turn]))
        turn += (2 * math.pi - end.phi[-1]) / end.phi_dot[-1]
    times, rate = turn * np.arange(_SAMPLES) / _SAMPLES, 2 * math.pi / turn
    run = simulate(scene, turn, 0.0, phi_dot0, integrator="DOP853", timestep=turn / 64, times=times)
    sway = sines(run.u - scene.acceleration() * times**2 / 2)
    return Seen.of(scene, Omega=rate, ripple=sines(run.phi - rate * times), sway=sway)


def sines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of sin(2 pi k x), at index k, in values that are evenly spaced over one period of x."""
    return -np.fft.rfft(values).imag * 2 / len(values)
