"""A unit of mass in which MuJoCo can represent a scene."""

import math

from mjbeer.scene import Scene

_SMALLEST = 1e-9
"""Smallest mass [kg] and inertia [kg m^2] that is left as it is: a million times MuJoCo's floor (mjMINVAL,
1e-15), so that the floor is far below what rounding leaves of the sums they enter."""
_NOTHING = 1e-30
"""Share of the greatest mass or inertia under which one is as good as none: it adds nothing to any sum."""


def mass_unit(scene: Scene) -> float:
    """Power of two by which all masses of a scene are multiplied; 1 unless they are tiny.

    Only ratios of masses enter the motion, and a power of two rounds nothing.
    """
    can, load = scene.can, scene.load
    present = (can.mass, can.inertia, load.mass, load.inertia, scene.oscillator.base)
    smallest = min(each for each in present if each > _NOTHING * max(present))
    return 2.0 ** max(0, math.ceil(math.log2(_SMALLEST / smallest)))
