"""The joints of the models, by name."""

import mujoco

_SLIDE, _HINGE = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
_JOINTS = {
    "slide": ("can", _SLIDE, (1, 0, 0)),  # u, positive downhill
    "lift": ("can", _SLIDE, (0, 0, 1)),  # positive away from the incline
    "roll": ("can", _HINGE, (0, 1, 0)),
    "swing": ("load", _HINGE, (0, 1, 0)),  # the load's angle relative to the can
    "phi": ("can", _HINGE, (0, 1, 0)),  # the load's angle, in a model whose can and load are one body
}
"""Body, type and axis of each joint."""


def add(spec: mujoco.MjSpec, *names: str) -> None:
    """Add the named joints. The order matters in one body: a slide that came after a hinge would turn with it."""
    for name in names:
        body, kind, axis = _JOINTS[name]
        spec.body(body).add_joint(spec.default, name=name, type=kind, axis=axis)
