"""The joints of all models, by name."""

import mujoco

_SLIDE, _HINGE = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
_JOINTS = {
    "slide": ("can", _SLIDE, (1, 0, 0)),  # u, downhill
    "lift": ("can", _SLIDE, (0, 0, 1)),  # away from the incline
    "roll": ("can", _HINGE, (0, 1, 0)),
    "swing": ("load", _HINGE, (0, 1, 0)),  # of the load, relative to the can
    "phi": ("can", _HINGE, (0, 1, 0)),  # of the load, in a model whose can and load are one body
}
"""Body, type and axis of each joint."""


def add(spec: mujoco.MjSpec, *names: str) -> None:
    """Add joints by name. Those of one body act in this order: a slide after a hinge would turn with it."""
    for name in names:
        body, kind, axis = _JOINTS[name]
        spec.body(body).add_joint(spec.default, name=name, type=kind, axis=axis)
