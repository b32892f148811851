"""Put two cans of mjbeer into a world of your own, in which they roll on your own slope by contact and friction.

python examples/attach.py
"""

import math

import mujoco
import numpy as np

import mjbeer

INCLINE = math.radians(8)
METAL = mjbeer.Can.sheet_metal()
CANS = {"frozen": mjbeer.frozen(INCLINE, can=METAL), "sliding": mjbeer.sliding(INCLINE, can=METAL)}
PHI0 = {"frozen": 2.0, "sliding": 1.0}  # the starts: angles of the beer's surface to the slope [rad]
APART = 0.2  # the distance of the two cans, across the slope [m]
TIMESTEP = 5e-4  # [s]
DURATION = 2.0  # [s]
# Without these options of the parent, cans slip or bounce: mjcf/README.md says why.
OPTIONS = ("timestep", "integrator", "cone", "impratio", "tolerance", "enableflags", "disableflags")


def world() -> mujoco.MjSpec:
    """Return a world with a slope and a light, and no can yet."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_light(name="sun", pos=[0, -1, 2], dir=[0, 0.5, -1])
    slope = spec.worldbody.add_frame(name="slope", quat=[math.cos(INCLINE / 2), 0, math.sin(INCLINE / 2), 0])
    plane = spec.worldbody.add_geom(name="slope", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.1])
    plane.set_frame(slope)
    return spec


def attach(spec: mujoco.MjSpec, name: str, place: float) -> None:
    """Attach a can to the slope, `place` [m] across it; its joints and geoms get the prefix "name-"."""
    can = mjbeer.specify(CANS[name], rolling="contact", visuals=True, timestep=TIMESTEP)
    for option in OPTIONS:
        setattr(spec.option, option, getattr(can.option, option))
    spec.visual.map.zfar = can.visual.map.zfar  # what is left that differs, and that MuJoCo would warn of
    # The can is attached without its incline, and so without the contact with it: your slope gets the same contact.
    contact = can.pair("rolling")
    numbers = {key: getattr(contact, key) for key in ("condim", "friction", "solref", "solimp")}
    lane = spec.worldbody.add_frame(pos=[0, place, 0], quat=spec.frame("slope").quat)
    lane.attach_body(can.body("can"), f"{name}-", "")
    spec.add_pair(name=f"{name}-rolling", geomname1="slope", geomname2=f"{name}-can", **numbers)


def start(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> None:
    """Put a can at its start; its joints are found by their names."""
    u, u_dot = CANS[name].start(PHI0[name], 0.0)
    roll, roll_dot = u / METAL.radius, u_dot / METAL.radius
    data.joint(f"{name}-slide").qpos, data.joint(f"{name}-slide").qvel = u, u_dot
    data.joint(f"{name}-roll").qpos, data.joint(f"{name}-roll").qvel = roll, roll_dot
    data.joint(f"{name}-lift").qpos = -1e-9 * METAL.radius  # so that rounding does not leave it hanging in the air
    if name == "sliding":
        data.joint("sliding-swing").qpos = PHI0[name] - roll
        data.joint("sliding-swing").qvel = -roll_dot
    mujoco.mj_forward(model, data)


def phi(data: mujoco.MjData, name: str) -> float:
    """Return the angle of a can's load [rad]."""
    roll = data.joint(f"{name}-roll").qpos[0]
    return roll + data.joint("sliding-swing").qpos[0] if name == "sliding" else roll


def errors() -> dict[str, float]:
    """Return the largest distance of phi [rad] from exact theory, for each can."""
    spec = world()
    for lane, name in enumerate(CANS):
        attach(spec, name, place=lane * APART)
    model = spec.compile()
    data = mujoco.MjData(model)
    for name in CANS:
        start(model, data, name)
    times, angles = [], {name: [] for name in CANS}
    for _ in range(round(DURATION / model.opt.timestep)):
        times.append(data.time)
        for name, found in angles.items():
            found.append(phi(data, name))
        mujoco.mj_step(model, data)
    return {
        name: float(np.abs(found - mjbeer.exact(CANS[name], times, PHI0[name]).phi).max())
        for name, found in angles.items()
    }


if __name__ == "__main__":
    for can, error in errors().items():
        print(f"{can}: after {DURATION:g} s phi is within {error:.1e} rad of exact theory")
