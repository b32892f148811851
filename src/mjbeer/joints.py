"""Joints of a model by name. Each slide and hinge has one component of qpos, and the same one of qvel."""

import mujoco


def places(model: mujoco.MjModel) -> dict[str, int]:
    """Where each joint's coordinate is in qpos, and its rate in qvel."""
    return {model.joint(i).name: int(model.joint(i).qposadr[0]) for i in range(model.njnt)}
