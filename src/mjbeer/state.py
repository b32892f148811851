"""Between a scene's coordinates (u, phi) and the joints of its model, addressed by name."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.joints import places
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
    state, joints = np.zeros(model.nq + model.nv), places(model)
    for name, (position, rate) in values.items():
        if name in joints:
            state[joints[name]], state[model.nq + joints[name]] = position, rate
    return state


def read(model: mujoco.MjModel, scene: Scene, states: np.ndarray) -> Motion:
    """Coordinates from states of shape (samples, nq + nv)."""
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
    return Motion(u, phi, u_dot, phi_dot, roll, roll_dot, lift, lift_dot)
