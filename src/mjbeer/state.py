"""Between a scene's coordinates (u, phi) and the joints of its model, addressed by name."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.scene import Scene

START_DEPTH = 1e-9
"""How deep a can starts in the incline, in radii. At depth 0 rounding decides whether it touches, and if it
does not it falls freely for a step: 5 um at 1 ms, 1e5 times this depth."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Sampled coordinates and their rates; the fields are those of a Trajectory."""

    u: np.ndarray
    phi: np.ndarray
    u_dot: np.ndarray
    phi_dot: np.ndarray
    roll: np.ndarray
    roll_dot: np.ndarray
    lift: np.ndarray
    lift_dot: np.ndarray


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
    state = np.zeros(model.nq + model.nv)
    for name, (position, rate) in values.items():
        if name in _joints(model):
            at, rate_at = _columns(model, name)
            state[at], state[rate_at] = position, rate
    return state


def read(model: mujoco.MjModel, scene: Scene, states: np.ndarray) -> Motion:
    """Coordinates from states of shape (samples, nq + nv)."""
    joints = _joints(model)

    def column(name: str) -> tuple[np.ndarray, np.ndarray]:
        at, rate_at = _columns(model, name)
        return states[:, at].copy(), states[:, rate_at].copy()

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
    return Motion(u, phi, u_dot, phi_dot, roll, roll_dot, lift, lift_dot)


def _joints(model: mujoco.MjModel) -> set[str]:
    return {model.joint(i).name for i in range(model.njnt)}


def _columns(model: mujoco.MjModel, name: str) -> tuple[int, int]:
    joint = model.joint(name)
    return int(joint.qposadr[0]), model.nq + int(joint.dofadr[0])
