"""A lying can that `mjbeer.attach` puts into a world with a slope, rolling there in plain MuJoCo."""

import math

import mujoco
import numpy as np

from mjbeer.model.free import attach
from mjbeer.model.mujoco_library import quiet
from mjbeer.theory.scene import Scene


def roll(scene: Scene, phi0: float, duration: float, timestep: float = 5e-4) -> tuple[np.ndarray, np.ndarray]:
    """Return times [s], and phi [rad] at each, of the can that is let go at `phi0` [rad]."""
    spec, radius, tilt = mujoco.MjSpec(), scene.can.radius, scene.incline
    spec.option.timestep = timestep
    spec.option.integrator = int(mujoco.mjtIntegrator.mjINT_RK4)
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    slope = spec.worldbody.add_frame(quat=[math.cos(tilt / 2), 0, math.sin(tilt / 2), 0])
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1]).set_frame(slope)
    attach(spec, scene)
    model = spec.compile()
    data, (u, _) = mujoco.MjData(model), scene.start(phi0, 0.0)
    down, normal = np.array([math.cos(tilt), 0, -math.sin(tilt)]), np.array([math.sin(tilt), 0, math.cos(tilt)])
    rolled, swing, phi = u / radius, scene.attachment == "sliding", []
    half = (tilt + rolled) / 2
    data.joint("can-free").qpos = [*(radius * (1 - 1e-9) * normal + u * down), math.cos(half), 0, math.sin(half), 0]
    if swing:
        data.joint("can-swing").qpos = phi0 - rolled
    mujoco.mj_forward(model, data)
    with quiet():
        for _ in range(math.ceil(duration / timestep)):
            ahead = data.body("can-can").xmat.reshape(3, 3)[:, 0]
            now = math.atan2(-ahead @ normal, ahead @ down)
            rolled = now + 2 * math.pi * round((rolled - now) / (2 * math.pi)) if math.isfinite(now) else math.inf
            phi.append(rolled + (data.joint("can-swing").qpos[0] if swing else 0.0))
            mujoco.mj_step(model, data)
    return timestep * np.arange(len(phi)), np.array(phi)
