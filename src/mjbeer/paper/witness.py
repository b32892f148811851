"""MuJoCo as a witness: what its forward dynamics computes along a motion; and the motions that several claims share."""

import math
from dataclasses import dataclass
from functools import cache, partial

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.model.build import build
from mjbeer.model.joints import joint_addresses, to_states
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.setting import DOP853, ROLLINGS, Rolling, Setting
from mjbeer.paper.claim import Bound, Motion, Witness
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.load import Load
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.scenes import frozen, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory


def simulate_motion(
    scene: Scene, rolling: Rolling, duration: float, phi0: float, phi_dot0: float = 0.0, samples: int = 101
) -> Motion:
    """Simulate a motion and return what MuJoCo computes at evenly spaced samples of it.

    With `rolling` "equality" the can and the load are two bodies that a constraint couples: that model contains none
    of the paper's theory.
    """
    times = np.linspace(0, duration, samples)
    return measure_motion(simulate(scene, duration, phi0, phi_dot0, rolling, DOP853, timestep=5e-4, times=times))


def measure_motion(run: Trajectory) -> Motion:
    """Return what MuJoCo computes at each sample of a simulated motion.

    s is read from the position of the load's centre of mass, and accelerations are those of mj_forward.
    """
    scene, timestep = run.scene, run.timestep or 1e-3
    setting = Setting(require.choice("rolling", run.rolling, ROLLINGS), DOP853, timestep)
    model, unit = build(scene, setting.rolling, integrator=DOP853, timestep=timestep), Mechanics.of(scene, setting).unit
    data = mujoco.MjData(model)
    samples = [_evaluate(model, data, scene, state) for state in to_states(model, run)]
    axis, load, turn, energy, force = (np.array(column) for column in zip(*samples, strict=True))
    energy, force = energy / unit, force / unit
    arm = load[:, 0] - axis[:, 0]
    across = load[:, :, 2] - axis[:, :, 2]
    down = model.opt.gravity / scene.gravity
    side = np.array([-down[2], 0, down[0]])  # a quarter turn from gravity, downhill
    return Motion.of(
        scene,
        **dict(zip(("s", "s_dot", "s_ddot"), load[:, :, 0].T, strict=True)),
        **dict(zip(("u", "u_dot", "u_ddot"), axis[:, :, 0].T, strict=True)),
        **dict(zip(("across", "across_dot", "across_ddot"), across.T, strict=True)),
        phi=run.phi,
        phi_dot=turn[:, 0],
        phi_ddot=turn[:, 1],
        sin_phi=np.sin(run.phi),
        cos_phi=np.cos(run.phi),
        sin_theta=np.sin(run.phi + scene.incline),
        cos_theta=np.cos(run.phi + scene.incline),
        theta=np.arctan2(-arm @ side, arm @ down),
        time=run.time,
        height=-(load[:, 0] - [0, 0, axis[0, 0, 2]]) @ down,
        kinetic=energy[:, 1],
        potential=energy[:, 0] + scene.mass * model.opt.gravity[2] * axis[0, 0, 2],
        friction=-force,
    )


def _evaluate(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, state: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return what MuJoCo computes in a state: how the axis and the load's centre of mass move, the load's angular
    velocity and acceleration, the energies, and the constraint's force along the incline."""
    data.qpos[:], data.qvel[:] = np.split(state, [model.nq])
    names = joint_addresses(model)
    mujoco.mj_forward(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    can = model.body("can").id
    carrier = model.body("load").id if "swing" in names else can
    at = data.xpos[carrier] - data.xmat[carrier].reshape(3, 3)[:, 2] * scene.load.offset
    force = data.qfrc_constraint[model.joint("slide").dofadr[0]] if "slide" in names else 0.0
    turn = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, None, turn, data.xpos[carrier], carrier)
    return (
        _point_motion(model, data, data.xpos[can].copy(), can),
        _point_motion(model, data, at, carrier),
        np.array([turn[1] @ data.qvel, turn[1] @ data.qacc]),
        data.energy.copy(),
        np.array(force),
    )


def _point_motion(model: mujoco.MjModel, data: mujoco.MjData, point: np.ndarray, body: int) -> np.ndarray:
    """Return the position, velocity and acceleration of a point of a body, shape (3, 3), in SI units."""
    jacobian, change = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    mujoco.mj_jacDot(model, data, change, None, point, body)
    return np.stack([point, jacobian @ data.qvel, jacobian @ data.qacc + change @ data.qvel])


@cache
def swing(amplitude: float = 2.0, incline: float = INCLINE) -> Motion:
    """Return a second of beer that slides in a massless can, let go at an amplitude on an incline [rad].

    At 2 rad every term of an equation matters; 1 rad is clearly not small, and 1e-3 rad is.
    """
    return simulate_motion(sliding(incline), "reduced", 1.0, amplitude)


@cache
def metal() -> Motion:
    """Return a second of beer that slides in the 12-oz can of sheet metal, let go at 2 rad."""
    return simulate_motion(sliding(can=Can.sheet_metal()), "equality", 1.0, 2.0)


@cache
def wheel() -> Motion:
    """Return a second of a pendulum in a wheel, let go at 2 rad."""
    return simulate_motion(pendulum(), "equality", 1.0, 2.0)


@cache
def rolling_down(scene: Scene | None = None) -> Motion:
    """Return the first 0.8 s of a can with frozen beer that rolls down, let go with the beer on top."""
    return simulate_motion(scene or frozen(), "equality", 0.8, math.pi)


@cache
def resting(scene: Scene, rolling: Rolling = "equality") -> Motion:
    """Return a second that starts at the equilibrium; a balanced load starts at phi = 0."""
    return simulate_motion(scene, rolling, 1.0, scene.equilibrium() if scene.load.offset else 0.0)


@cache
def frequency(scene: Scene, phi0: float, duration: float = 4.0, rolling: Rolling = "reduced") -> float:
    """Return the frequency omega [rad/s] of a swing that is simulated in 4000 steps."""
    run = simulate(scene, duration, phi0, rolling=rolling, integrator=DOP853, timestep=duration / 4000)
    return run.frequency()


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
SWING = Witness(REDUCED, swing)
WIDE, NARROW = (Witness(REDUCED, partial(swing, amplitude)) for amplitude in (1.0, SMALL))
METAL, WHEEL = Witness(EQUALITY, metal), Witness(EQUALITY, wheel)
ROLL_DOWN = Witness(EQUALITY, rolling_down)
FOOTNOTE_8 = Witness(EQUALITY, partial(rolling_down, footnote_scene()))
EXACT = Bound(1e-12, "rounding of MuJoCo's forward dynamics")
DRIFT = "what MuJoCo's joint equality takes back of its drift"
HELD = Bound(2e-8, DRIFT)

TOP = math.pi - 0.05
"""Angle phi [rad] from which a hoop falls: a little beside pi, the top, where it would stay in balance."""
GRIP = 1e6  # friction coefficient so large that nothing slips


def fall_from_top(scene: Scene, timestep: float, friction: float) -> Trajectory:
    """Return the fall of a hoop in contact, let go at `TOP`, until just after it lifts off or passes the bottom."""
    times = np.linspace(0, 3, 3001)
    fall = exact(scene, times, TOP)
    parts = fall.rolls_until()
    duration = parts * 1.02 if math.isfinite(parts) else float(times[np.argmax(fall.phi < 0)])
    return simulate(scene, duration, TOP, rolling="contact", timestep=timestep, friction=friction)


DECADE = (50.0, 100.0, 200.0, 400.0)
"""Rates phi_dot [rad/s] at phi = 0 of loads that loop; their mean rates span a decade, 35 to 354 rad/s."""
_SAMPLES = 256  # samples of one turn; ripples up to the 128th multiple of the rate can be measured


@dataclass(frozen=True)
class Looping:
    """The ripples of a load that loops, over one turn."""

    rate: float  # mean rate Omega of phi [rad/s]
    phi: np.ndarray  # amplitudes [rad] of sin(k Omega t) in phi - Omega t, at index k
    sway: np.ndarray  # amplitudes [m] of sin(k Omega t) in u less its steady acceleration, at index k


def loop(scene: Scene, phi_dot0: float) -> Looping:
    """Simulate one turn from phi = 0 and return its ripples; `phi_dot0` [rad/s] must be enough for a turn."""
    turn = 2 * math.pi / require.positive("phi_dot0", phi_dot0, "rad/s")
    for _ in range(8):  # Newton's method for the time of a turn
        end = simulate(scene, turn, 0.0, phi_dot0, integrator=DOP853, timestep=turn / 64, times=np.array([0, turn]))
        turn += (2 * math.pi - end.phi[-1]) / end.phi_dot[-1]
    times = turn * np.arange(_SAMPLES) / _SAMPLES
    run = simulate(scene, turn, 0.0, phi_dot0, integrator=DOP853, timestep=turn / 64, times=times)
    rate = 2 * math.pi / turn
    return Looping(rate, sines(run.phi - rate * times), sines(run.u - scene.acceleration() * times**2 / 2))


def sines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of sin(2 pi k x), at index k, in values that are evenly spaced over one period of x."""
    return -np.fft.rfft(values).imag * 2 / len(values)


def cosines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of cos(2 pi k x), as `sines` does; the one at k = 0 is twice the mean."""
    return np.fft.rfft(values).real * 2 / len(values)
