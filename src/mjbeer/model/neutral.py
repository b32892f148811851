"""Removes the mechanics from a template, so that what is left is drawn and cannot act on the motion.

There is no list of harmful attributes. Elements that mjbeer makes anew are removed. In elements that it keeps, all
attributes are set to those of a new element of the same kind, except a few that only matter for pictures.
"""

import functools
from typing import Any

import mujoco
import numpy as np

_MADE_ANEW = ("sensors", "tendons", "joints", "equalities", "pairs")
"""Kinds of elements that mjbeer makes anew; what refers to others comes before them."""
_COLLISION = ("surface", "can")
"""The geoms that collide where rolling is by contact. They are made anew as well."""
_ADDED = ("joint", "geom", "site", "equality", "pair", "tendon", "actuator")
"""Kinds of elements that mjbeer adds. They get the defaults of the class "main", wherever they are added."""
_USER_SIZES = ("actuator", "body", "cam", "geom", "jnt", "sensor", "site", "tendon")
_SIZES = ("memory", "nconmax", "njmax", "nstack", "nkey", "nuserdata", *(f"nuser_{kind}" for kind in _USER_SIZES))
"""Memory and array sizes. They matter, for with too little memory MuJoCo drops contacts."""
_LOOKS = ("meshdir", "texturedir", "degree", "eulerseq")
"""Options of the compiler that say where files are and how orientations are written: drawn elements need them."""
_IDENTITY = ("name", "classname", "childclass", "info", "userdata", "plugin")
"""Attributes that identify an element. They act on the motion only through a plugin, which is refused."""


def neutralize(spec: mujoco.MjSpec) -> None:
    """Remove joints, constraints, sensors and colliding geoms, and set what can act on the motion to MuJoCo's defaults.

    The specification must not contain elements that act on the motion and that mjbeer does not know.
    """
    colliding = [geom for geom in spec.geoms if geom.name in _COLLISION]
    for element in (*(element for kind in _MADE_ANEW for element in getattr(spec, kind)), *colliding):
        spec.delete(element)
    fresh = mujoco.MjSpec()
    body = fresh.worldbody.add_body()
    for element in spec.bodies[1:]:
        _reset(element, body)
    for kind in _ADDED:
        _reset(getattr(spec.default, kind), getattr(fresh.default, kind))
    _reset(spec.option, fresh.option)
    _reset(spec.compiler, fresh.compiler, _LOOKS)
    for size in _SIZES:
        setattr(spec, size, getattr(fresh, size))
    # The mean inertia scales the solver's tolerance. Centre and extent stay: only the cameras use them.
    spec.stat.meaninertia = spec.stat.meanmass = spec.stat.meansize = np.nan
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
        geom.mass = 0.0


def _reset(element: Any, fresh: Any, kept: tuple[str, ...] = ()) -> None:
    """Give an element the attributes of a fresh one of its kind, except those that are kept."""
    for name in _attributes(type(fresh)):
        if name not in (*_IDENTITY, *kept):
            setattr(element, name, getattr(fresh, name))


@functools.cache
def _attributes(kind: type) -> tuple[str, ...]:
    """Return the names of all attributes that can be set in a kind of element."""
    return tuple(name for name in dir(kind) if getattr(getattr(kind, name), "fset", None) is not None)
