"""Step a can of mjbeer in a MuJoCo loop of your own, with its joints by name.

python examples/own_scene.py
"""

import math

import mujoco
import numpy as np

import mjbeer

SCENE = mjbeer.sliding(incline=math.radians(5), fill=0.3, can=mjbeer.Can.sheet_metal())
PHI0, PHI_DOT0 = (
    1.0,
    0.0,
)  # the start: the angle of the beer's surface to the incline [rad], and its rate [rad/s]
DURATION = 2.0  # [s]


def run() -> tuple[np.ndarray, np.ndarray]:
    """Return the times [s] and the angle phi [rad] of every step."""
    model = mjbeer.build(SCENE, rolling="equality")
    data = mujoco.MjData(model)
    mjbeer.reset(model, data, SCENE, PHI0, PHI_DOT0)
    times, phi = [], []
    for _ in range(round(DURATION / model.opt.timestep)):
        times.append(data.time)
        phi.append(data.joint("roll").qpos[0] + data.joint("swing").qpos[0])
        # Here is the place for forces of your own, such as data.joint("slide").qfrc_applied[0] = 0.1.
        mujoco.mj_step(model, data)
    return np.array(times), np.array(phi)


def error(times: np.ndarray, phi: np.ndarray) -> float:
    """Return the largest distance of phi [rad] from exact theory."""
    return float(np.abs(phi - mjbeer.exact(SCENE, times, PHI0, PHI_DOT0).phi).max())


if __name__ == "__main__":
    print(f"after {DURATION:g} s phi is within {error(*run()):.1e} rad of exact theory")
