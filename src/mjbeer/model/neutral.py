"""A template without its mechanics: what is drawn remains, and nothing that could enter a motion.

No list of harmful attributes is kept. What mjbeer makes anew is removed, and all attributes of what it keeps are set
to those of a new element of the same kind, but for a few that only matter for pictures.
"""

import functools
from typing import Any

import mujoco
import numpy as np

_MADE_ANEW = ("joints", "equalities", "pairs")
_COLLISION = ("surface", "can")
"""The geoms that touch where rolling is by contact, which are made anew as well."""
_ADDED = ("joint", "geom", "site", "equality", "pair", "tendon", "actuator")
"""Kinds of elements that mjbeer adds: they get the defaults of the class "main", wherever they are added."""
_SIZES = (
    "memory", "nconmax", "njmax", "nstack", "nkey", "nuserdata", "nuser_actuator", "nuser_body", "nuser_cam",
    "nuser_geom", "nuser_jnt", "nuser_sensor", "nuser_site", "nuser_tendon",
)  # fmt: skip
"""Memory and array sizes: with too little memory MuJoCo drops contacts."""
_LOOKS = ("meshdir", "texturedir", "degree", "eulerseq")
"""What the compiler has to know of files and orientations of what is drawn."""
_IDENTITY = ("name", "classname", "childclass", "info", "userdata", "plugin")
"""Attributes that say which element it is, and act on no motion without a plugin, which is refused."""


def neutralize(spec: mujoco.MjSpec) -> None:
    """Remove joints, constraints and the geoms that touch, and set what can enter a motion to MuJoCo's defaults.

    Elements that act on a motion and that mjbeer does not know must not be in the specification.
    """
    touching = [geom for geom in spec.geoms if geom.name in _COLLISION]
    for element in (*(element for kind in _MADE_ANEW for element in getattr(spec, kind)), *touching):
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
    # The mean inertia scales the solver's tolerance; centre and extent are the cameras'.
    spec.stat.meaninertia = spec.stat.meanmass = spec.stat.meansize = np.nan
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
        geom.mass = 0.0


def _reset(element: Any, fresh: Any, kept: tuple[str, ...] = ()) -> None:
    """Give an element all attributes of a fresh one of its kind, but for those that are kept."""
    for name in _attributes(type(fresh)):
        if name not in (*_IDENTITY, *kept):
            setattr(element, name, getattr(fresh, name))


@functools.cache
def _attributes(kind: type) -> tuple[str, ...]:
    """Return the names of all attributes of a kind of element that can be set."""
    return tuple(name for name in dir(kind) if getattr(getattr(kind, name), "fset", None) is not None)
