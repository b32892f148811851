"""Converts between a scene's coordinates and the joints of its model, which are addressed by name."""

import functools
import math
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

START_DEPTH = 1e-9
"""Depth in the incline at which a can in contact starts, in radii. At depth 0 rounding would decide whether it touches;
a can that does not touch falls freely for a step, 5 um at 1 ms, which is 1e5 times this depth."""


def reset(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, phi0: float, phi_dot0: float = 0.0) -> None:
    """Put a model of a scene at its start at `phi0` [rad] with `phi_dot0` [rad/s], at time 0, for a loop of one's own.

    All else in the `data` is reset, and accelerations and forces are computed (`mj_forward`). The model may come from
    `build`, from an export, or from a specification with further joints: the scene's are found by name.

    Raises:
      ParameterError: if the start is not allowed, or the model has no joint for phi.
    """
    for name, given, kind in (("model", model, mujoco.MjModel), ("data", data, mujoco.MjData), ("scene", scene, Scene)):
        require.instance(name, given, kind)
    values = _start_values(scene, *require.start(phi0, phi_dot0))
    joints = {model.joint(joint).name for joint in range(model.njnt)}
    if not joints & {"phi", "roll"}:
        raise ParameterError(f"the model must have the joints of a scene, got {require.format_value(sorted(joints))}")
    mujoco.mj_resetData(model, data)
    for name in joints & values.keys():
        data.joint(name).qpos[:], data.joint(name).qvel[:] = values[name]
    mujoco.mj_forward(model, data)


@functools.lru_cache(maxsize=32)
def joint_addresses(model: mujoco.MjModel) -> dict[str, int]:
    """Return the index of each joint's coordinate in qpos, which is that of its rate in qvel too."""
    return {model.joint(joint).name: int(model.joint(joint).qposadr[0]) for joint in range(model.njnt)}


def initial_joints(joints: Iterable[str], scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """Return the positions and the rates of joints at a start, shape (2, joints); one that is not a scene's is at 0."""
    values = _start_values(scene, phi0, phi_dot0)
    return np.array([values.get(name, (0.0, 0.0)) for name in joints]).T


def initial_state(model: mujoco.MjModel, scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """Return qpos and qvel of a start at `phi0` [rad] with `phi_dot0` [rad/s], as one array of shape (nq + nv,)."""
    return initial_joints(joint_addresses(model), scene, phi0, phi_dot0).ravel()


def to_states(model: mujoco.MjModel, motion: Coordinates) -> np.ndarray:
    """Return the states of shape (samples, nq + nv) whose coordinates are those of a motion."""
    values, states = _values(motion), np.zeros((len(motion.time), model.nq + model.nv))
    for name, place in joint_addresses(model).items():
        states[:, place], states[:, model.nq + place] = values[name]
    return states


def rolling_coordinates(radius: float, u: Any, u_dot: Any, phi: Any, phi_dot: Any) -> Coordinates:
    """Return the coordinates of a can that rolls without slipping, in contact; u is in [m], phi in [rad]."""
    rates = {"u_dot": u_dot, "phi_dot": phi_dot, "roll_dot": u_dot / radius, "lift_dot": 0 * phi}
    return Coordinates(time=0 * phi, u=u, phi=phi, roll=u / radius, lift=0 * phi - START_DEPTH * radius, **rates)


def _start_values(scene: Scene, phi0: float, phi_dot0: float) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return the position and the rate at a start of all joints that a model may have, by name."""
    return _values(rolling_coordinates(scene.can.radius, *scene.initial_axis(phi0, phi_dot0), phi0, phi_dot0))


def _values(motion: Coordinates) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return the positions and rates of all joints that a model may have, by name."""
    return {
        "slide": (motion.u, motion.u_dot),
        "lift": (motion.lift, motion.lift_dot),
        "roll": (motion.roll, motion.roll_dot),
        "swing": (motion.phi - motion.roll, motion.phi_dot - motion.roll_dot),
        "phi": (motion.phi, motion.phi_dot),
    }


def to_coordinates(model: mujoco.MjModel, scene: Scene, states: np.ndarray, times: np.ndarray) -> Coordinates:
    """Return the coordinates for states of shape (samples, nq + nv) at `times` [s], shape (samples,)."""
    joints, radius = joint_addresses(model), scene.can.radius

    def both(name: str) -> np.ndarray:
        """Return a joint's positions and rates, shape (2, samples); zeros if there is none."""
        return states.T[joints[name] :: model.nq].copy() if name in joints else np.zeros((2, len(states)))

    phi = both("phi") if "phi" in joints else both("roll") + both("swing")
    u = both("slide") if "slide" in joints else radius * phi
    roll, lift = both("roll") if "roll" in joints else u / radius, both("lift")
    rates = {"u_dot": u[1], "phi_dot": phi[1], "roll_dot": roll[1], "lift_dot": lift[1]}
    return Coordinates(time=times, u=u[0], phi=phi[0], roll=roll[0], lift=lift[0], **rates)


def angle_sums(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the matrix whose product with a state of a scene's model is phi and u/a [rad], shape (nq + nv, 2)."""
    joints = joint_addresses(model)
    sums = np.zeros((model.nq + model.nv, 2))
    for name, place in joints.items():
        if name == "slide":
            sums[place, 1] = 1 / scene.can.radius
        elif name != "lift":
            sums[place, 0] = 1.0
            sums[place, 1] = 0.0 if "slide" in joints else 1.0
    return sums


def state_sizes(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the size of each component of a state, shape (nq + nv,): below it an error counts absolutely.

    Lengths have the radius, angles 1 rad, and their rates these times sqrt(g/a).
    """
    radius = scene.can.radius
    rate = math.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    sizes = np.array([radius if name in ("slide", "lift") else 1.0 for name in joint_addresses(model)])
    return np.append(sizes, rate * sizes)
