"""Converts between a scene's coordinates and the joints of its model, which are found by name."""

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
"""Depth in the incline at which a can in contact starts, in radii. At depth 0 rounding would decide
whether it touches; a can that does not touch falls freely for a step, 5 um at 1 ms, which is 1e5
times this depth."""


def reset(
    model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, phi0: float, phi_dot0: float = 0.0
) -> None:
    """Put the model of a scene at a start, at `phi0` [rad] with `phi_dot0` [rad/s], at time 0.

    Your own loop begins with it. Everything else in the `data` is reset, and accelerations and
    forces are computed (`mj_forward`). The model may come from `build`, from an export, or from a
    specification with further joints: the scene's are found by name.

    Raises:
      ParameterError: if the start is invalid, or the model has no joint for phi.
    """
    require.instance("model", model, mujoco.MjModel)
    require.instance("data", data, mujoco.MjData)
    require.instance("scene", scene, Scene)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    start = _start_values(scene, phi0, phi_dot0)
    joints = {model.joint(joint).name for joint in range(model.njnt)}
    if not joints & {"phi", "roll"}:
        raise ParameterError(
            f"the model must have the joints of a scene, got {require.format_value(sorted(joints))}"
        )
    mujoco.mj_resetData(model, data)
    for name in joints & start.keys():
        position, rate = start[name]
        data.joint(name).qpos[:] = position
        data.joint(name).qvel[:] = rate
    mujoco.mj_forward(model, data)


@functools.lru_cache(maxsize=32)
def joint_addresses(model: mujoco.MjModel) -> dict[str, int]:
    """Return the index of each joint's coordinate in qpos, and of its rate in qvel: the same."""
    joints = [model.joint(joint) for joint in range(model.njnt)]
    return {joint.name: int(joint.qposadr[0]) for joint in joints}


def initial_joints(joints: Iterable[str], scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """Return positions and rates of joints at a start, shape (2, joints); other joints are at 0."""
    values = _start_values(scene, phi0, phi_dot0)
    return np.array([values.get(name, (0.0, 0.0)) for name in joints]).T


def initial_state(model: mujoco.MjModel, scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """Return qpos and qvel at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
    return initial_joints(joint_addresses(model), scene, phi0, phi_dot0).ravel()


def to_states(model: mujoco.MjModel, motion: Coordinates) -> np.ndarray:
    """Return the states of shape (samples, nq + nv) whose coordinates are those of a motion."""
    values = _joint_values(motion)
    states = np.zeros((len(motion.time), model.nq + model.nv))
    for name, place in joint_addresses(model).items():
        position, rate = values[name]
        states[:, place] = position
        states[:, model.nq + place] = rate
    return states


def to_coordinates(
    model: mujoco.MjModel, scene: Scene, states: np.ndarray, times: np.ndarray
) -> Coordinates:
    """Return the coordinates of states, shape (samples, nq + nv), at `times` [s], shape
    (samples,)."""
    radius = scene.can.radius
    # Positions, then rates, shape (2, joints, samples); of each joint, shape (2, samples).
    values = states.T.copy().reshape(2, model.nq, len(states))
    joints = {name: values[:, place] for name, place in joint_addresses(model).items()}
    nothing = np.zeros((2, len(states)))
    swing = joints.get("swing", nothing)
    phi = joints["phi"] if "phi" in joints else joints["roll"] + swing
    u = joints["slide"] if "slide" in joints else radius * phi
    roll = joints["roll"] if "roll" in joints else u / radius
    lift = joints.get("lift", nothing)
    return Coordinates(
        time=times,
        u=u[0],
        u_dot=u[1],
        phi=phi[0],
        phi_dot=phi[1],
        roll=roll[0],
        roll_dot=roll[1],
        lift=lift[0],
        lift_dot=lift[1],
    )


def rolling_coordinates(radius: float, u: Any, u_dot: Any, phi: Any, phi_dot: Any) -> Coordinates:
    """Return the coordinates of a can that rolls without slipping; u is in [m], phi in [rad]."""
    nothing = 0 * phi
    return Coordinates(
        time=nothing,
        u=u,
        u_dot=u_dot,
        phi=phi,
        phi_dot=phi_dot,
        roll=u / radius,
        roll_dot=u_dot / radius,
        lift=nothing - START_DEPTH * radius,
        lift_dot=nothing,
    )


def _start_values(
    scene: Scene, phi0: float, phi_dot0: float
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return position and rate at a start of all joints that a model may have, by name."""
    u, u_dot = scene.initial_axis(phi0, phi_dot0)
    return _joint_values(rolling_coordinates(scene.can.radius, u, u_dot, phi0, phi_dot0))


def _joint_values(motion: Coordinates) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return positions and rates of all joints that a model may have, by name."""
    return {
        "slide": (motion.u, motion.u_dot),
        "lift": (motion.lift, motion.lift_dot),
        "roll": (motion.roll, motion.roll_dot),
        "swing": (motion.phi - motion.roll, motion.phi_dot - motion.roll_dot),
        "phi": (motion.phi, motion.phi_dot),
    }


def angle_sums(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the matrix M, shape (nq + nv, 2), with which `states @ M` is phi and u/a [rad]."""
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
    """Return the typical size of each component of a state, shape (nq + nv,).

    The error of a component is relative to it, or absolute where the component is smaller. Lengths
    have the radius, angles 1 rad, and their rates these times sqrt(g/a).
    """
    radius = scene.can.radius
    rate = math.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    sizes = np.array(
        [radius if name in ("slide", "lift") else 1.0 for name in joint_addresses(model)]
    )
    return np.append(sizes, rate * sizes)
