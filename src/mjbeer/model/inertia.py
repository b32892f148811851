"""The masses and inertias that the bodies of a model get, and the unit in which MuJoCo gets them."""

import math
from dataclasses import dataclass
from typing import Any

import mujoco

from mjbeer.theory.scene import Scene

_SMALLEST = 1e-9
"""Smallest mass [kg] and inertia [kg m^2] that is not scaled. It is a million times MuJoCo's smallest value (mjMINVAL,
1e-15), which is then too small to change any sum noticeably."""
_LARGEST = 1e3
"""Largest mass [kg] that is not scaled. MuJoCo's smallest softness of a constraint, 1e-15 /kg, is then 1e-12 of the
inverse mass."""
_NOTHING = 1e-30
"""Mass or inertia over the largest one below which it counts as none, as it adds nothing to any sum."""


def mass_unit(scene: Scene) -> float:
    """Return the power of two by which all masses of a scene are multiplied: 1 unless they are tiny or huge.

    Only ratios of masses enter the motion, and a power of two causes no rounding. In a scene with both tiny and huge
    masses the tiny ones decide: MuJoCo's smallest value would otherwise hide them.
    """
    can, base = scene.can, scene.oscillator.base
    if scene.attachment == "frozen":  # one body
        values = (scene.mass, frozen_inertia(scene), base)
    else:
        load = load_with_inertia(scene)
        values = (can.mass - load.moved, can.inertia, load.mass, load.inertia, base)
    smallest = min(value for value in values if value > _NOTHING * max(values))
    up = math.ceil(math.log2(_SMALLEST / smallest))
    down = math.floor(math.log2(_LARGEST / (scene.mass + can.inertia / can.radius**2)))
    return 2.0 ** max(up, min(0, down))


_TURNED = [math.sqrt(0.5), 0, math.sqrt(0.5), 0]
"""Orientation of every inertial frame: a quarter turn about the axis. If the frame were parallel to the body's, MuJoCo
would move a centre of mass within 1e-6 m of the origin to the origin, and lose the weight's torque. The inertia is the
same in both frames."""
_LITTLE = 1e-6
"""A load's own inertia over m b^2 below which it counts as none."""


@dataclass(frozen=True)
class LoadBody:
    """The body that stands for a load, to which some of the can's mass may have been moved."""

    moved: float
    """Mass that has been moved from the can to this body [kg]."""
    mass: float
    """Mass of the body, the moved mass included [kg]."""
    offset: float
    """Distance of its centre of mass from the axis [m]."""
    inertia: float
    """Moment of inertia about its centre of mass [kg m^2]."""


def load_with_inertia(scene: Scene) -> LoadBody:
    """Return a body for the load of a scene that has inertia about its centre of mass even if the load is a point.

    MuJoCo cannot move a body without inertia. Some of the can's mass, taken as a point on the axis, moves with the
    load exactly as with the can, and gives a point load an inertia.
    """
    load = scene.load
    is_point = load.inertia < _LITTLE * load.mass * load.offset**2
    return load_with_can_mass(scene, min(scene.can.mass / 2, load.mass) if is_point else 0.0)


def frozen_inertia(scene: Scene) -> float:
    """Return the moment of inertia of can and frozen load about their common centre of mass [kg m^2]."""
    can, load = scene.can, scene.load
    return load.inertia + can.inertia + load.mass * can.mass / scene.mass * load.offset**2


def load_with_can_mass(scene: Scene, moved: float) -> LoadBody:
    """Return a body for the load of a scene with the mass `moved` [kg] from the can to it, as a point on the axis."""
    load = scene.load
    mass = load.mass + moved
    inertia = load.inertia + load.mass * load.offset**2 * moved / mass
    return LoadBody(moved=moved, mass=mass, offset=load.mass * load.offset / mass, inertia=inertia)


def hold_inertial(body: mujoco.MjsBody) -> None:
    """Prepare a body of a specification for `set_inertial`: its masses are its own, not those of its geoms."""
    body.explicitinertial, body.iquat = True, _TURNED


def set_inertial(body: Any, mass: float, offset: float, inertia: float) -> None:
    """Give a body a `mass` [kg] at `offset` [m] below its axis, with an `inertia` about that point [kg m^2].

    The body is one of a compiled model, or one of a specification that is prepared by `hold_inertial`.
    """
    body.mass, body.ipos, body.inertia = mass, [0, 0, -offset], [inertia] * 3


def remove_mass(body: mujoco.MjsBody) -> None:
    """Remove mass and inertia from a body that is fixed to another one, which then has those of both."""
    hold_inertial(body)
    set_inertial(body, mass=0.0, offset=0.0, inertia=0.0)
