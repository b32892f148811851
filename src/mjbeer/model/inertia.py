"""Mass and inertia of a body, and the unit in which masses are given to MuJoCo."""

import math
from dataclasses import dataclass

import mujoco

from mjbeer.theory.scene import Scene

_SMALLEST = 1e-9
"""Smallest mass [kg] and inertia [kg m^2] that is left as it is: a million times MuJoCo's floor (mjMINVAL,
1e-15), so that the floor is far below what rounding leaves of the sums they enter."""
_LARGEST = 1e3
"""Greatest mass [kg] that is left as it is: MuJoCo's floor under the softness of a constraint, 1e-15 /kg as well, is
then a share of 1e-12 of its inverse inertia."""
_NOTHING = 1e-30
"""Share of the greatest mass or inertia under which one is as good as none: it adds nothing to any sum."""


def mass_unit(scene: Scene) -> float:
    """Power of two by which all masses of a scene are multiplied; 1 unless they are tiny, or huge.

    Only ratios of masses enter the motion, and a power of two rounds nothing. Where a scene has both, it is the tiny
    ones that must not drown.
    """
    can, form = scene.can, scene.oscillator
    if scene.attachment == "frozen":  # one body
        present = (scene.mass, frozen_inertia(scene), form.base)
    else:
        part = point_share(scene)
        present = (can.mass - part.moved, can.inertia, part.mass, part.inertia, form.base)
    smallest = min(each for each in present if each > _NOTHING * max(present))
    up = math.ceil(math.log2(_SMALLEST / smallest))
    down = math.floor(math.log2(_LARGEST / (scene.mass + can.inertia / can.radius**2)))
    return 2.0 ** max(up, min(0, down))


_TURNED = [math.sqrt(0.5), 0, math.sqrt(0.5), 0]
"""A quarter turn about the axis. MuJoCo takes a centre of mass within 1e-6 m of the body's frame to be in its
origin, and drops the weight's torque, if the two frames are parallel; the inertia is the same in either."""
_LITTLE = 1e-6
"""Share of m b^2 under which a load's own inertia counts as none."""


@dataclass(frozen=True)
class Share:
    """A load with some of its can's mass."""

    moved: float
    """Mass of the can that it has been given [kg]."""
    mass: float
    """Mass of both [kg]."""
    offset: float
    """Distance of their centre of mass from the axis [m]."""
    inertia: float
    """Their moment of inertia about it [kg m^2]."""


def point_share(scene: Scene) -> Share:
    """The load of a scene, with inertia about its centre of mass even if it is a point.

    MuJoCo moves no body without inertia. Some of the can's mass, taken as a point on the axis, moves with the
    load exactly as with the can, and gives a point load an inertia.
    """
    load = scene.load
    is_point = load.inertia < _LITTLE * load.mass * load.offset**2
    return share(scene, min(scene.can.mass / 2, load.mass) if is_point else 0.0)


def frozen_inertia(scene: Scene) -> float:
    """Moment of inertia of can and frozen load about their common centre of mass [kg m^2]."""
    can, load = scene.can, scene.load
    return load.inertia + can.inertia + load.mass * can.mass / scene.mass * load.offset**2


def share(scene: Scene, moved: float) -> Share:
    """The load of a scene with a mass [kg] `moved` to it from the can."""
    load = scene.load
    mass = load.mass + moved
    inertia = load.inertia + load.mass * load.offset**2 * moved / mass
    return Share(moved, mass, load.mass * load.offset / mass, inertia)


def set_inertial(body: mujoco.MjsBody, mass: float, offset: float, inertia: float) -> None:
    """Give a body a `mass` [kg] at `offset` [m] below its axis and an axial `inertia` about it [kg m^2]."""
    body.explicitinertial = True
    body.mass, body.ipos, body.inertia = mass, [0, 0, -offset], [inertia] * 3
    body.iquat = _TURNED


def weightless(body: mujoco.MjsBody) -> None:
    """Take mass and inertia from a body that is fixed to another, which then stands for both."""
    set_inertial(body, 0.0, 0.0, 0.0)
