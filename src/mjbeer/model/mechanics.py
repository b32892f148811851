"""What a scene decides of the mechanics of its model: joints, masses, and what acts on them.

Which joints and elements a model has is written into its specification. The numbers are written by the same function
into a specification, or into a model that is compiled already.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco

from mjbeer.model.inertia import set_inertial


@dataclass(frozen=True)
class Inertial:
    """The mass of a body."""

    mass: float
    """Mass [kg]."""
    offset: float
    """Distance of its centre of mass below the axis [m]."""
    inertia: float
    """Moment of inertia about the centre of mass [kg m^2]."""


@dataclass(frozen=True, kw_only=True)
class Mechanics:
    """The joints, masses and forces of a model; all masses are multiplied by the scene's unit of mass."""

    joints: tuple[str, ...]
    """Names of the joints."""
    bodies: Mapping[str, Inertial]
    """The bodies that have mass, by name."""
    armature: float = 0.0
    """Mass that only the joint "slide" moves [kg]."""
    force: float = 0.0
    """Constant force [N] or torque [N m] on the first joint, by the actuator "weight"."""
    chord: float = 0.0
    """Armature of the tendon "chord" [kg]."""


def fit(made: mujoco.MjSpec | mujoco.MjModel, mechanics: Mechanics) -> None:
    """Write the numbers of a mechanics into a specification, or a compiled model, that has its joints and elements."""
    for name, body in mechanics.bodies.items():
        set_inertial(made.body(name), mass=body.mass, offset=body.offset, inertia=body.inertia)
    if "slide" in mechanics.joints:
        made.joint("slide").armature = mechanics.armature
    if mechanics.force != 0:
        made.actuator("weight").biasprm[0] = mechanics.force
    if mechanics.chord > 0:
        if isinstance(made, mujoco.MjModel):
            made.tendon_armature[made.tendon("chord").id] = mechanics.chord
        else:
            made.tendon("chord").armature = mechanics.chord
