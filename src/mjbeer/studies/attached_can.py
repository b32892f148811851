"""A lying can that `mjbeer.attach` puts into a world with a slope, rolling there in plain MuJoCo."""

import math

import mujoco
import numpy as np

from mjbeer.model.free import attach
from mjbeer.model.mujoco_library import quiet
from mjbeer.theory.scene import Scene


def roll(
    scene: Scene, phi0: float, duration: float, timestep: float = 5e-4, yaw: float = 0.0
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return times [s], phi [rad] at each, and the largest sine of the axis's turn out of its own direction.

    The can is let go at `phi0` [rad], lying along the slope or turned about its normal by `yaw` [rad].
    """
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
    turn = np.array([math.cos(tilt / 2), 0, math.sin(tilt / 2), 0])
    for axis, angle in (([0, 0, 1], yaw), ([0, 1, 0], u / radius)):
        step, both = np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(step, np.array(axis, float), angle)
        mujoco.mju_mulQuat(both, turn, step)
        turn = both
    joint, swing = data.joint("can-free"), scene.attachment == "sliding"
    joint.qpos = [*(radius * (1 - 1e-9) * normal + u * down), *turn]
    if swing:
        data.joint("can-swing").qpos = phi0 - u / radius
    mujoco.mj_forward(model, data)
    angles, drift, rolled, count = [], 0.0, u / radius, math.ceil(duration / timestep)
    ahead = math.cos(yaw) * down + math.sin(yaw) * np.cross(normal, down)
    with quiet():
        for _ in range(count):
            axes = data.body("can-can").xmat.reshape(3, 3)
            now = math.atan2(-axes[:, 0] @ normal, axes[:, 0] @ ahead)
            rolled = now + 2 * math.pi * round((rolled - now) / (2 * math.pi)) if math.isfinite(now) else math.inf
            drift = max(drift, abs(float(axes[:, 1] @ ahead)))
            angles.append(rolled + (data.joint("can-swing").qpos[0] if swing else 0.0))
            mujoco.mj_step(model, data)
    return timestep * np.arange(count), np.array(angles), drift
