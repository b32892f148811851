"""Where a compiled model has the numbers of a scene, and how they are written there.

To compile a model takes far longer than a run. Scenes whose models have the same elements therefore
share one compiled model, into which the numbers of each scene are written.
"""

from collections.abc import Callable
from typing import TypeAlias

import mujoco
import numpy as np

from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.setting import MUJOCO_INTEGRATORS

Views: TypeAlias = dict[tuple[str, str], list[np.ndarray]]
"""The arrays of a compiled model that hold a parameter, by its element and attribute, in the order
of its numbers."""
_INTEGRATORS: dict[str, int] = {
    name: int(mujoco.mjtIntegrator.__members__[f"mjINT_{name.upper()}"]) for name in MUJOCO_INTEGRATORS
}
"""MuJoCo's number of each integrator."""


def _tendon_damping(model: mujoco.MjModel, name: str) -> list[np.ndarray]:
    tendon = model.tendon(name).id
    return [model.tendon_damping[tendon : tendon + 1], model.tendon_dampingpoly[tendon]]


def _tendon_armature(model: mujoco.MjModel, name: str) -> list[np.ndarray]:
    tendon = model.tendon(name).id
    return [model.tendon_armature[tendon : tendon + 1]]


def _coefficient(model: mujoco.MjModel, name: str) -> list[np.ndarray]:
    """Return where the coefficient of a joint in a tendon is, by a name such as "slip/roll"."""
    tendon, joint = name.split("/")
    first = int(model.tendon_adr[model.tendon(tendon).id])
    place = first + list(model.wrap_objid[first:]).index(model.joint(joint).id)
    return [model.wrap_prm[place : place + 1]]


def _joint_damping(model: mujoco.MjModel, name: str) -> list[np.ndarray]:
    """Return where the coefficient of the rate itself is, and those of its higher powers."""
    joint = model.joint(name)
    return [joint.damping, joint.dampingpoly[0]]


# A parameter that has no entry is an option, or is the same in all models that are only stepped.
_VIEWS: dict[tuple[str, str], Callable[[mujoco.MjModel, str], list[np.ndarray]]] = {
    ("body", "pos"): lambda model, name: [model.body(name).pos],
    ("inertial", "mass"): lambda model, name: [model.body(name).mass],
    ("inertial", "pos"): lambda model, name: [model.body(name).ipos],
    ("inertial", "diaginertia"): lambda model, name: [model.body(name).inertia],
    ("joint", "armature"): lambda model, name: [model.joint(name).armature],
    ("joint", "damping"): _joint_damping,
    ("fixed", "damping"): _tendon_damping,
    ("fixed", "coef"): _coefficient,
    ("spatial", "armature"): _tendon_armature,
    ("general", "biasprm"): lambda model, name: [model.actuator(name).biasprm[:1]],
    ("joint", "polycoef"): lambda model, name: [model.equality(name).data[:5]],
    ("joint", "solref"): lambda model, name: [model.equality(name).solref],
    ("pair", "solref"): lambda model, name: [model.pair(name).solref],
    ("pair", "friction"): lambda model, name: [model.pair(name).friction],
    ("geom", "size"): lambda model, name: [model.geom(name).size[:2]],
}


def compiled_views(model: mujoco.MjModel, values: Parameters) -> Views:
    """Return where a compiled model has the parameters that differ between scenes, except
    options."""
    views = {}
    for element, attribute in values:
        tag, _, name = element.partition(" ")
        view = _VIEWS.get((tag, attribute))
        if view is None:
            continue
        try:
            views[element, attribute] = view(model, name)
        except KeyError:
            # The element was removed, because it has no effect in any scene of this structure.
            continue
    return views


def write_compiled(model: mujoco.MjModel, values: Parameters, views: Views) -> None:
    """Write parameters into a compiled model, at its `compiled_views`."""
    for key, value in values.items():
        if isinstance(value, str):
            model.opt.integrator = _INTEGRATORS[value]
        elif key[0] == "option":
            setattr(model.opt, key[1], value[0] if len(value) == 1 else value)
        elif key in views:
            _write_views(views[key], value)
    if ("geom can", "size") in views:
        # The compiler derives these from the size.
        geom = model.geom("can")
        radius, half_length = values["geom can", "size"]
        geom.rbound = np.hypot(radius, half_length)
        model.geom_aabb[geom.id] = [0, 0, 0, radius, radius, half_length]


def _write_views(arrays: list[np.ndarray], numbers: tuple[float, ...]) -> None:
    """Write the numbers of a parameter into one array after the other."""
    if len(arrays) == 1:
        arrays[0][:] = numbers
        return
    first, rest = arrays
    first[:] = numbers[: len(first)]
    rest[:] = numbers[len(first) :]
