"""Between a scene's coordinates (u, phi) and the joints of its model, addressed by name."""

import mujoco
import numpy as np

from mjbeer.model.engine import quiet
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.scene import Scene

START_DEPTH = 1e-9
"""How deep a can starts in the incline, in radii. At depth 0 rounding decides whether it touches, and if it
does not it falls freely for a step: 5 um at 1 ms, 1e5 times this depth."""


def places(model: mujoco.MjModel) -> dict[str, int]:
    """Where each joint's coordinate is in qpos, and its rate in qvel."""
    return {model.joint(i).name: int(model.joint(i).qposadr[0]) for i in range(model.njnt)}


def start(model: mujoco.MjModel, scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """qpos and qvel of a scene's start, shape (nq + nv,)."""
    u, u_dot = scene.start(phi0, phi_dot0)
    roll, roll_dot = u / scene.can.radius, u_dot / scene.can.radius
    values = {
        "slide": (u, u_dot),
        "lift": (-START_DEPTH * scene.can.radius, 0.0),
        "roll": (roll, roll_dot),
        "swing": (phi0 - roll, phi_dot0 - roll_dot),
        "phi": (phi0, phi_dot0),
    }
    state, joints = np.zeros(model.nq + model.nv), places(model)
    for name, (position, rate) in values.items():
        if name in joints:
            state[joints[name]], state[model.nq + joints[name]] = position, rate
    return state


def read(model: mujoco.MjModel, scene: Scene, states: np.ndarray, times: np.ndarray) -> Coordinates:
    """The coordinates that states of shape (samples, nq + nv) stand for, at `times` [s] of as many samples."""
    joints = places(model)

    def column(name: str) -> tuple[np.ndarray, np.ndarray]:
        return states[:, joints[name]].copy(), states[:, model.nq + joints[name]].copy()

    nothing = np.zeros(len(states)), np.zeros(len(states))
    if "phi" in joints:
        phi, phi_dot = column("phi")
    else:
        (roll, roll_dot), (swing, swing_dot) = column("roll"), column("swing") if "swing" in joints else nothing
        phi, phi_dot = roll + swing, roll_dot + swing_dot
    radius = scene.can.radius
    u, u_dot = column("slide") if "slide" in joints else (radius * phi, radius * phi_dot)
    roll, roll_dot = column("roll") if "roll" in joints else (u / radius, u_dot / radius)
    lift, lift_dot = column("lift") if "lift" in joints else nothing
    return Coordinates(
        time=times,
        u=u,
        phi=phi,
        u_dot=u_dot,
        phi_dot=phi_dot,
        roll=roll,
        roll_dot=roll_dot,
        lift=lift,
        lift_dot=lift_dot,
    )


def settle(model: mujoco.MjModel, state: np.ndarray) -> np.ndarray:
    """A `state`, shape (nq + nv,), with the lift at which nothing accelerates it; as it is for a model without a lift.

    The force of a row is linear in its depth, so that two trials give the depth. A can that starts at another one
    falls or rises to it, which is a motion that the exact one does not have.
    """
    if "lift" not in (joints := places(model)):
        return state
    at = joints["lift"]
    data, settled = mujoco.MjData(model), state.copy()

    def acceleration(lift: float) -> float:
        data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
        data.qpos[at], data.qacc_warmstart[:] = lift, 0.0
        with quiet():
            mujoco.mj_forward(model, data)
        return float(data.qacc[at])

    trials = -1e-7, -2e-7
    first, second = (acceleration(lift) for lift in trials)
    settled[at] = trials[0] - first * (trials[1] - trials[0]) / (second - first)
    return settled
