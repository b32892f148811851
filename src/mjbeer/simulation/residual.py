"""How well a model's forces and inertias agree with theory: what rounding has taken from it before a run begins.

MuJoCo adds masses, and multiplies arms by forces, in double precision and in the coordinates of the world. If one mass
is far smaller than another, or an arm far shorter than the way that the can rolls, what moves the load may be lost in
these sums. All runs of such a model are wrong alike, so that no comparison of runs can show it.
"""

import copy
from dataclasses import replace

import mujoco
import numpy as np

from mjbeer.model.engine import quiet
from mjbeer.model.state import places, read, write
from mjbeer.theory.equations import Coordinates, accelerations, stiffness
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

STATES = 9
"""Number of states of a run, evenly spread, at which accelerations are compared."""
_SMALL_SWING = 0.1
"""Smallest acceleration with which a difference is compared, relative to the largest that gravity gives at rest: a
motion that hardly swings would otherwise divide rounding by nearly nothing."""

_OF_SLIP = 8 * float(np.finfo(float).eps)
"""Rounding of a slip rate, over the rates whose difference it is: each is rounded a few times."""


def residual(model: mujoco.MjModel, scene: Scene, states: np.ndarray, exact_constraint: bool) -> tuple[float, float]:
    """Return the largest difference of phi_ddot from theory's at `states` [rad/s^2], and relative to phi_ddot.

    `states` has shape (states, nq + nv). Softness is no loss, and shows as slip: the slip of the states is taken away,
    and a constraint that is not exact is replaced by that of rolling.
    """
    times, radius = np.zeros(len(states)), scene.can.radius
    motion = read(model, scene, states, times)
    motion = replace(motion, u=radius * motion.roll, u_dot=radius * motion.roll_dot)
    states = write(model, motion)
    slopes = np.concatenate([states[:, model.nq :], _accelerations(model, scene, states, exact_constraint)], axis=1)
    found = read(model, scene, slopes, times).phi_dot
    _, right = accelerations(scene, motion.phi, motion.phi_dot, motion.u_dot)
    oscillator = scene.oscillator
    small = float((_SMALL_SWING * oscillator.depth / oscillator.inertia(motion.phi)).min())
    differences = np.abs(found - right)
    if scene.dissipates:  # the rounding of a slip rate makes a torque that brings can and load together, and so is gone
        rates = np.abs(motion.phi_dot) + np.abs(motion.u_dot) / radius
        together = stiffness(scene, motion.phi, motion.phi_dot, motion.u_dot)
        differences = np.maximum(differences - _OF_SLIP * together * rates, 0.0)
    largest, difference = max(float(np.abs(right).max()), small), float(differences.max())
    return difference, difference / largest if largest > 0 else 0.0


def lost(model: mujoco.MjModel, scene: Scene, way: Coordinates, record: Record, exact_constraint: bool) -> float:
    """Return the error of phi [rad], relative beyond 1 rad, that a model's residual along the way of a run implies.

    Like a relative error of the energy it is a relative error of the rate, and so of the path of phi. It is no more
    than what the missing acceleration gives from rest, which is lost where a motion ought to begin, but does not.
    """
    chosen = np.linspace(0, len(way.time) - 1, min(STATES, len(way.time))).astype(int)
    some = Coordinates(**{name: array[chosen] for name, array in vars(way).items()})
    difference, relative = residual(model, scene, write(model, some), exact_constraint)
    missing = min(relative * max(record.path, 1.0), difference * float(way.time[-1]) ** 2 / 2)
    return missing / max(1.0, record.turned)


def _accelerations(model: mujoco.MjModel, scene: Scene, states: np.ndarray, exact_constraint: bool) -> np.ndarray:
    """Return the accelerations of the model's joints at `states`, shape (states, nv).

    Under MuJoCo's integrator "discrete" they would be changes over a whole step, over the step.
    """
    model = copy.copy(model)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data, accelerations = mujoco.MjData(model), np.empty((len(states), model.nv))
    inertia = np.empty((model.nv, model.nv))
    rolling = None if exact_constraint else _rolling(model, scene)
    with quiet():
        for place, state in enumerate(states):
            data.qpos[:], data.qvel[:], data.qacc_warmstart[:] = state[: model.nq], state[model.nq :], 0.0
            mujoco.mj_forward(model, data)
            if rolling is None:
                accelerations[place] = data.qacc
                continue
            mujoco.mj_fullM(model, data, inertia)
            reduced, force = rolling @ inertia @ rolling.T, rolling @ data.qfrc_smooth
            try:
                accelerations[place] = rolling.T @ np.linalg.solve(reduced, force)
            except np.linalg.LinAlgError:  # rounding took all inertia: nothing is known, and theory's motion is missing
                accelerations[place] = 0.0
    return accelerations


def _rolling(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the motions of the joints that roll without slipping, one a row: of the axis, and of phi alone."""
    joints, radius = places(model), scene.can.radius
    along, turning = np.zeros(model.nv), np.zeros(model.nv)
    along[joints["slide"]], along[joints["roll"]] = radius, 1.0
    if "swing" not in joints:
        return along[None]
    along[joints["swing"]], turning[joints["swing"]] = -1.0, 1.0
    return np.stack([along, turning])
