"""Compiled models that are stepped, and how the numbers of a scene are written into them.

To compile a model takes far longer than a run. Scenes whose models have the same elements therefore
share one compiled model, into which the numbers of each scene are written.
"""

import copy
import threading
from collections.abc import Callable
from typing import TypeAlias

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.model.build import make_rigid, rolling_spec
from mjbeer.model.check import check_file
from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.model_numbers import ModelNumbers, Structure
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import MUJOCO_INTEGRATORS

Views: TypeAlias = dict[tuple[str, str], list[np.ndarray]]
"""Parts of a compiled model's arrays, by the element and the attribute that they hold. An attribute
of several numbers may be in two arrays: the first numbers in the first one, the rest in the other.
"""
_INTEGRATORS: dict[str, mujoco.mjtIntegrator] = {
    name: mujoco.mjtIntegrator.__members__[f"mjINT_{name.upper()}"] for name in MUJOCO_INTEGRATORS
}
"""MuJoCo's constant for each integrator."""
_INERTIA_WARNING = int(mujoco.mjtWarning.mjWARN_INERTIA)
_compiled_models: dict[Structure, mujoco.MjModel] = {}
"""The compiled model of each structure, with the numbers of the scene that came first."""
_compiling = threading.Lock()


def compiled_model(numbers: ModelNumbers) -> mujoco.MjModel:
    """Return a new model to be stepped, into which `write_numbers` then writes its numbers.

    Each structure is compiled once a process. The content of the mechanics file is part of the
    structure, so that an edited file is compiled anew.

    Raises:
      TemplateError: if the mechanics file is missing, lacks an element, or has other accelerations
        than theory.
    """
    with _compiling:
        if numbers.structure not in _compiled_models:
            _compiled_models[numbers.structure] = _compile_structure(numbers)
        return copy.copy(_compiled_models[numbers.structure])


def _compile_structure(numbers: ModelNumbers) -> mujoco.MjModel:
    """Return the compiled model of a scene, to be stepped."""
    setting = numbers.setting
    fault = check_file(setting.folder, numbers.scene.attachment, setting.rolling)
    if fault is not None:
        raise TemplateError(fault)
    model = mjcf_file.compile_spec(rolling_spec(numbers.scene, setting))
    if setting.rolling == "equality":
        make_rigid(model)
    return model


def write_numbers(
    model: mujoco.MjModel, data: mujoco.MjData, numbers: ModelNumbers, views: Views
) -> None:
    """Write the numbers of a scene into a model of its structure, and reset the data.

    `views` are the model's `parameter_views`.

    Raises:
      UnsupportedError: if MuJoCo cannot represent such a model.
    """
    _write_parameters(model, numbers.parameters, views)
    data.warning.number[:] = 0  # It may be that of the scene before.
    with quiet():
        mujoco.mj_setConst(model, data)
    if numbers.setting.rolling == "equality":
        make_rigid(model)
    smallest = min(min(body.mass, body.inertia) for body in numbers.bodies.values())
    if smallest < mujoco.mjMINVAL:
        raise mjcf_file.refused("mass and inertia of moving bodies must be larger than mjMINVAL")
    if data.warning.number[_INERTIA_WARNING]:
        raise mjcf_file.refused(mjcf_file.TOO_UNEQUAL)
    mujoco.mj_resetData(model, data)


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
    joints = model.wrap_objid[first:].tolist()
    place = first + joints.index(model.joint(joint).id)
    return [model.wrap_prm[place : place + 1]]


def _joint_damping(model: mujoco.MjModel, name: str) -> list[np.ndarray]:
    """Return where the coefficient of the rate itself is, and those of its higher powers."""
    joint = model.joint(name)
    return [joint.damping, joint.dampingpoly[0]]


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


def parameter_views(model: mujoco.MjModel, values: Parameters) -> Views:
    """Return the parts of a model's arrays that hold these parameters.

    Options are not in arrays, and some parameters are the same in all models that are only stepped:
    they have no views.
    """
    views = {}
    for element, attribute in values:
        tag, _, name = element.partition(" ")
        view = _VIEWS.get((tag, attribute))
        if view is None:
            continue
        try:
            views[element, attribute] = view(model, name)
        except KeyError:
            # The model lacks the element, as it has no effect in any scene of this structure.
            continue
    return views


def _write_parameters(model: mujoco.MjModel, values: Parameters, views: Views) -> None:
    """Write parameters into the options and the arrays of a compiled model."""
    for (element, attribute), value in values.items():
        if isinstance(value, str):
            model.opt.integrator = _INTEGRATORS[value]
        elif element == "option":
            setattr(model.opt, attribute, value[0] if len(value) == 1 else value)
        elif (element, attribute) in views:
            _write_views(views[element, attribute], value)
    if ("geom can", "size") in views:
        # These follow from the size, as the compiler would have them.
        geom = model.geom("can")
        radius, half_length = values["geom can", "size"]
        geom.rbound = np.hypot(radius, half_length)
        model.geom_aabb[geom.id] = [0, 0, 0, radius, radius, half_length]


def _write_views(arrays: list[np.ndarray], numbers: tuple[float, ...]) -> None:
    """Write the numbers of a parameter into its one or two arrays."""
    if len(arrays) == 1:
        arrays[0][:] = numbers
        return
    first, rest = arrays
    first[:] = numbers[: len(first)]
    rest[:] = numbers[len(first) :]
