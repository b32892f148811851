"""A unit of mass in which MuJoCo can represent a scene."""

import math

from mjbeer.inertial import frozen_inertia, point_share
from mjbeer.scene import Scene

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
