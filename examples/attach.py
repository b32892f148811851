"""Put two cans of mjbeer into a world of your own, where they roll freely on your own slope.

python examples/attach.py
"""

import math

import mujoco
import numpy as np

import mjbeer

INCLINE = math.radians(8)
METAL = mjbeer.Can.sheet_metal()
CANS = {"frozen": mjbeer.frozen(INCLINE, can=METAL), "sliding": mjbeer.sliding(INCLINE, can=METAL)}
PHI0 = {
    "frozen": 2.0,
    "sliding": 1.0,
}  # the starts: angles of the beer's surface to the slope [rad]
APART = 0.2  # the distance of the two cans, across the slope [m]
DURATION = 2.0  # [s]
DOWN, NORMAL = np.array(
    [[math.cos(INCLINE), 0, -math.sin(INCLINE)], [math.sin(INCLINE), 0, math.cos(INCLINE)]]
)


def turned(angle: float) -> list[float]:
    """Return the quaternion of a turn about y."""
    return [math.cos(angle / 2), 0, math.sin(angle / 2), 0]


def world() -> mujoco.MjModel:
    """Return a world with a slope and a light, and two cans at their starts."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 5e-4
    spec.option.disableflags |= int(
        mujoco.mjtDisableBit.mjDSBL_REFSAFE
    )  # contacts as hard as RK4 can have them
    spec.worldbody.add_light(name="sun", pos=[0, -1, 2], dir=[0, 0.5, -1])
    spec.worldbody.add_geom(
        name="slope", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.1], quat=turned(INCLINE)
    )
    for lane, (name, can) in enumerate(CANS.items()):
        u, _ = can.initial_axis(PHI0[name], 0.0)
        # A hair inside the slope, so that rounding does not leave it hanging in the air.
        pos = u * DOWN + (1 - 1e-9) * METAL.radius * NORMAL + [0, lane * APART, 0]
        mjbeer.attach(
            spec, can, pos=pos, quat=turned(INCLINE + u / METAL.radius), prefix=f"{name}-"
        )
    return spec.compile()


def errors() -> dict[str, float]:
    """Return the largest distance of phi [rad] from exact theory, for each can."""
    model = world()
    data = mujoco.MjData(model)
    swing = data.joint("sliding-swing")
    swing.qpos = (
        PHI0["sliding"] - CANS["sliding"].initial_axis(PHI0["sliding"], 0.0)[0] / METAL.radius
    )
    times, angles = [], {name: [] for name in CANS}
    while data.time < DURATION:
        mujoco.mj_forward(model, data)
        times.append(data.time)
        for name, found in angles.items():
            x = data.body(f"{name}-can").xmat.reshape(3, 3)[:, 0]
            found.append(
                math.atan2(-x @ NORMAL, x @ DOWN) + (swing.qpos[0] if name == "sliding" else 0.0)
            )
        mujoco.mj_step(model, data)
    return {
        name: float(
            np.abs(np.unwrap(found) - mjbeer.exact(CANS[name], times, PHI0[name]).phi).max()
        )
        for name, found in angles.items()
    }


if __name__ == "__main__":
    for can, error in errors().items():
        print(f"{can}: after {DURATION:g} s phi is within {error:.1e} rad of exact theory")
