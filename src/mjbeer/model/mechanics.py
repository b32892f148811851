"""What a scene decides of the mechanics of its model: joints, masses, and what acts on them.

Which joints and elements a model has is written into its specification. The numbers are written by the same function
into a specification, or into a model that is compiled already.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypedDict

import mujoco

from mjbeer.model.inertia import set_inertial
from mjbeer.theory.scene import Scene

_NO_DAMPING = (0.0, 0.0, 0.0)


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
    damping: tuple[float, float, float] = _NO_DAMPING
    """The coefficients of damping between can and load [N m s], [N m s^2] and [N m s^3], by the tendon "damper" or the
    joint "swing"."""
    drag: float = 0.0
    """Force against the joint "slide" over the square of its rate [kg/m]."""
    slide_in_damper: float = 0.0
    """Coefficient of the joint "slide" in the tendon "damper" [1/m]; that of the joint "phi" is 1."""

    @property
    def damps(self) -> bool:
        """Return whether there is damping between can and load."""
        return self.damping != _NO_DAMPING

    @property
    def dissipates(self) -> bool:
        """Return whether any of the forces takes energy from the motion."""
        return self.damps or self.drag > 0


class Dissipation(TypedDict):
    """The fields of a mechanics that take energy from the motion."""

    damping: tuple[float, float, float]
    drag: float
    slide_in_damper: float


def dissipation(scene: Scene, unit: float) -> Dissipation:
    """Return what a scene decides of the forces that take energy from its motion, in a `unit` of mass."""
    linear, quadratic, cubic = scene.damping_law.coefficients
    damping = unit * linear, unit * quadratic, unit * cubic
    return {"damping": damping, "drag": unit * scene.drag, "slide_in_damper": -1 / scene.can.radius}


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
    _fit_dissipation(made, mechanics)


def _fit_dissipation(made: mujoco.MjSpec | mujoco.MjModel, mechanics: Mechanics) -> None:
    """Write what takes energy from a motion: MuJoCo's polynomials of a rate v, d1 v + d2 v |v| + d3 v^3."""
    if mechanics.drag > 0:
        _damp_joint(made, "slide", (0.0, mechanics.drag, 0.0))
    if not mechanics.damps:
        return
    if "swing" in mechanics.joints:
        _damp_joint(made, "swing", mechanics.damping)
        return
    if isinstance(made, mujoco.MjSpec):
        made.tendon("damper").damping = mechanics.damping
    else:
        damper = made.tendon("damper").id
        made.tendon_damping[damper], made.tendon_dampingpoly[damper] = mechanics.damping[0], mechanics.damping[1:]
        made.wrap_prm[made.tendon_adr[damper] + 1] = mechanics.slide_in_damper


def _damp_joint(made: mujoco.MjSpec | mujoco.MjModel, name: str, damping: tuple[float, float, float]) -> None:
    joint = made.joint(name)
    if isinstance(made, mujoco.MjSpec):
        joint.damping = damping
    else:
        joint.damping, joint.dampingpoly = damping[0], damping[1:]
