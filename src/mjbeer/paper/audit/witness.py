"""MuJoCo as a witness: the positions, velocities, accelerations and energies that it computes for a motion."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.model.build import build
from mjbeer.model.numbers import mass_unit
from mjbeer.model.setting import DOP853, ROLLINGS, Rolling
from mjbeer.model.state import places
from mjbeer.paper.letters import Quantities
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Witness:
    """What MuJoCo's forward dynamics computes at each sample of a motion."""

    scene: Scene
    time: np.ndarray
    quantities: Quantities
    """Coordinates, rates and accelerations: s is read from the load's centre of mass, accelerations from mj_forward."""
    across: np.ndarray
    """How far the load's centre of mass is from the axis, measured away from the incline [m]; its first and second
    derivatives follow in the second and third row."""
    height: np.ndarray
    """Height [m] of the load's centre of mass above where the axis starts, against gravity."""
    theta: np.ndarray
    """Angle [rad] between gravity and the line from the axis to the load's centre of mass."""
    kinetic: np.ndarray
    """MuJoCo's kinetic energy of the whole [J]."""
    potential: np.ndarray
    """MuJoCo's potential energy of the whole [J], zero where the axis starts."""
    friction: np.ndarray
    """Force [N] of the incline on the can, uphill, where a constraint makes the can roll; otherwise 0."""


def watch(
    scene: Scene, rolling: Rolling, duration: float, phi0: float, phi_dot0: float = 0.0, samples: int = 101
) -> Witness:
    """Simulate a motion and return what MuJoCo computes at evenly spaced samples of it.

    With `rolling` "equality" the can and the load are two bodies that a constraint couples: that model contains none
    of the paper's theory.
    """
    times = np.linspace(0, duration, samples)
    run = simulate(scene, duration, phi0, phi_dot0, rolling, DOP853, timestep=5e-4, times=times)
    return examine(run)


def examine(run: Trajectory) -> Witness:
    """Return what MuJoCo computes at each sample of a simulated motion."""
    scene, timestep = run.scene, run.timestep or 1e-3
    model = build(scene, require.choice("rolling", run.rolling, ROLLINGS), integrator=DOP853, timestep=timestep)
    data = mujoco.MjData(model)
    rows = [_evaluate(model, data, scene, run, i) for i in range(len(run.time))]
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    axis, load, unit = columns["axis"], columns["load"], mass_unit(scene)
    arm = load[:, 0] - axis[:, 0]
    down = model.opt.gravity / scene.gravity
    phi, (turn_rate, turn_acceleration) = run.phi, columns["turn"].T
    side = np.array([-down[2], 0, down[0]])  # a quarter turn from gravity, downhill
    quantities = Quantities.of(
        scene,
        s=load[:, 0, 0],
        s_dot=load[:, 1, 0],
        s_ddot=load[:, 2, 0],
        u=axis[:, 0, 0],
        u_dot=axis[:, 1, 0],
        u_ddot=axis[:, 2, 0],
        phi=phi,
        phi_dot=turn_rate,
        phi_ddot=turn_acceleration,
        sin_phi=np.sin(phi),
        cos_phi=np.cos(phi),
        sin_theta=np.sin(phi + scene.incline),
        cos_theta=np.cos(phi + scene.incline),
    )
    potential = (columns["energy"][:, 0] + unit * scene.mass * model.opt.gravity[2] * axis[0, 0, 2]) / unit
    return Witness(
        scene,
        run.time,
        quantities,
        across=np.stack([arm[:, 2], load[:, 1, 2] - axis[:, 1, 2], load[:, 2, 2] - axis[:, 2, 2]]),
        height=-(load[:, 0] - [0, 0, axis[0, 0, 2]]) @ down,
        theta=np.arctan2(-arm @ side, arm @ down),
        kinetic=columns["energy"][:, 1] / unit,
        potential=potential,
        friction=-columns["force"] / unit,
    )


def _evaluate(
    model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, run: Trajectory, i: int
) -> dict[str, np.ndarray]:
    """Return what MuJoCo computes at sample `i`: how the axis and the load's centre of mass move, the load's angular
    velocity and acceleration, the energies, and the constraint's force along the incline."""
    values = {
        "slide": (run.u[i], run.u_dot[i]),
        "lift": (run.lift[i], run.lift_dot[i]),
        "roll": (run.roll[i], run.roll_dot[i]),
        "swing": (run.phi[i] - run.roll[i], run.phi_dot[i] - run.roll_dot[i]),
        "phi": (run.phi[i], run.phi_dot[i]),
    }
    names = places(model)
    for name in names:
        data.joint(name).qpos[0], data.joint(name).qvel[0] = values[name]
    mujoco.mj_forward(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    can = model.body("can").id
    carrier = model.body("load").id if "swing" in names else can
    at = data.xpos[carrier] - data.xmat[carrier].reshape(3, 3)[:, 2] * scene.load.offset
    force = data.qfrc_constraint[model.joint("slide").dofadr[0]] if "slide" in names else 0.0
    turn = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, None, turn, data.xpos[carrier], carrier)
    return {
        "axis": _point_motion(model, data, data.xpos[can].copy(), can),
        "load": _point_motion(model, data, at, carrier),
        "turn": np.array([turn[1] @ data.qvel, turn[1] @ data.qacc]),
        "energy": data.energy.copy(),
        "force": np.array(force),
    }


def _point_motion(model: mujoco.MjModel, data: mujoco.MjData, point: np.ndarray, body: int) -> np.ndarray:
    """Return the position, velocity and acceleration of a point of a body, shape (3, 3), in SI units."""
    jacobian, change = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    mujoco.mj_jacDot(model, data, change, None, point, body)
    return np.stack([point, jacobian @ data.qvel, jacobian @ data.qacc + change @ data.qvel])
