"""The mechanics: MJCF files, into which the numbers of a scene are written before MuJoCo compiles them, or after."""

import copy
import functools
import pathlib
import xml.etree.ElementTree as ET
from collections.abc import Callable, Collection
from contextlib import suppress
from typing import TypeAlias

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError, UnsupportedError

Parameters: TypeAlias = dict[tuple[str, str], tuple[float, ...] | str]
"""Numbers by element and attribute, as `Mechanics.parameters`."""
Views: TypeAlias = dict[tuple[str, str], list[np.ndarray]]
"""Where a compiled model has such numbers."""


def read(path: pathlib.Path) -> ET.Element:
    """Return an MJCF file as a tree of its own, with what it includes in place."""
    root = copy.deepcopy(_parsed(path, _text(path)))
    _include(root, path.parent)
    return root


def content(path: pathlib.Path) -> tuple[bytes, ...]:
    """Return the bytes of an MJCF file and of all that it includes, by which to keep what is made of `read`'s tree.

    To read a file and compare it takes some 20 us. Its time and its size may be those that it had before an edit.
    """
    text = _text(path)
    found = [text]
    for name in _included(path, text):
        found.extend(content(path.parent / name))
    return tuple(found)


def _text(path: pathlib.Path) -> bytes:
    try:
        with open(path, "rb", buffering=0) as file:
            return file.read()
    except OSError as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error


@functools.lru_cache(maxsize=64)
def _parsed(path: pathlib.Path, text: bytes) -> ET.Element:
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error


@functools.lru_cache(maxsize=64)
def _included(path: pathlib.Path, text: bytes) -> tuple[str, ...]:
    """Return the names of the files that a file with this text includes itself."""
    return tuple(element.get("file", "") for element in _parsed(path, text).iter("include"))


def _include(root: ET.Element, folder: pathlib.Path) -> None:
    """Put what a tree includes from a folder in its place."""
    for parent in list(root.iter()):
        for place, child in reversed(list(enumerate(parent))):
            if child.tag == "include":
                parent[place : place + 1] = read(folder / child.get("file", ""))


def find(root: ET.Element, element: str) -> ET.Element | None:
    """Return an element by its tag and its name, as "joint slide".

    "inertial can" is in the body "can", and "fixed slip/roll" is the joint "roll" of the tendon "slip".
    """
    tag, _, name = element.partition(" ")
    name, _, joint = name.partition("/")
    if tag == "inertial":
        return root.find(f".//body[@name='{name}']/inertial")
    return root.find(f".//{tag}" + f"[@name='{name}']" * bool(name) + f"/joint[@joint='{joint}']" * bool(joint))


def write(root: ET.Element, values: Parameters, path: pathlib.Path, digits: int = 17) -> None:
    """Write numbers into the tree of the file at a `path`, with up to so many `digits`."""
    for (name, attribute), value in values.items():
        if (element := find(root, name)) is None:
            raise TemplateError(f"{path} has no {name!r}, into which mjbeer writes {attribute}; restore the file")
        element.set(attribute, value if isinstance(value, str) else " ".join(f"{each:.{digits}g}" for each in value))


def differences(root: ET.Element, values: Parameters) -> list[str]:
    """Return the parameters that have other values, in 12 digits, in a tree; all of them must be in it."""
    found = []
    for (name, attribute), value in values.items():
        element = find(root, name)
        words = [] if element is None else element.get(attribute, "").split()
        if isinstance(value, str):
            same = words == [value]
        else:
            same = len(words) == len(value) and np.allclose(np.array(words, float), value, rtol=1e-11, atol=0)
        if not same:
            found.append(f"{name} {attribute}")
    return found


def remove(root: ET.Element, *elements: str) -> None:
    """Take elements from a tree, wherever they are, by their paths."""
    for parent in list(root.iter()):
        for element in elements:
            for each in parent.findall(element):
                parent.remove(each)


def remove_unused(root: ET.Element, acting: Collection[str], damped: bool) -> None:
    """Take from a tree what only is seen or measured, and disable the stages of a step that it does not need.

    Of tendons and actuators those stay that are `acting`, by their names.
    """
    ET.SubElement(root, "compiler", fusestatic="true", discardvisual="true")
    remove(root, "sensor")
    for section in (*root.iterfind("tendon"), *root.iterfind("actuator")):
        section[:] = [each for each in section if each.get("name") in acting]
    stages = {"sensor": False, "spring": False, "damper": damped, "actuation": bool(root.findall("actuator/*"))}
    idle = {stage: "disable" for stage, needed in stages.items() if not needed}
    ET.SubElement(ET.SubElement(root, "option"), "flag", idle, energy="disable")


def to_spec(root: ET.Element, path: pathlib.Path) -> mujoco.MjSpec:
    """Return the specification in the tree of the file at a `path`, with looks in place of what includes them."""
    _include(root, path.parents[1])
    try:
        return mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    except ValueError as error:
        raise TemplateError(f"{path} is not readable MJCF: {'; '.join(str(error).splitlines())}") from error


def compile_spec(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return the model that a specification compiles to.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise refused("; ".join(str(error).splitlines())) from error


def refused(reason: str) -> UnsupportedError:
    """Return the error of a scene that MuJoCo cannot have."""
    return UnsupportedError(f"MuJoCo cannot represent this scene: {reason}")


# Where a compiled model has what is written into it; what is not here is the same in all models that are only stepped.
_COMPILED: dict[tuple[str, str], Callable[[mujoco.MjModel, str], list[np.ndarray]]] = {
    ("body", "pos"): lambda model, name: [model.body(name).pos],
    ("inertial", "mass"): lambda model, name: [model.body(name).mass],
    ("inertial", "pos"): lambda model, name: [model.body(name).ipos],
    ("inertial", "diaginertia"): lambda model, name: [model.body(name).inertia],
    ("joint", "armature"): lambda model, name: [model.joint(name).armature],
    # in proportion to a rate, and with higher powers
    ("joint", "damping"): lambda model, name: [model.joint(name).damping, model.joint(name).dampingpoly[0]],
    ("fixed", "damping"): lambda model, name: [
        model.tendon_damping[model.tendon(name).id :][:1],
        model.tendon_dampingpoly[model.tendon(name).id],
    ],
    ("fixed", "coef"): lambda model, name: [_coefficient(model, *name.split("/"))],
    ("spatial", "armature"): lambda model, name: [model.tendon_armature[model.tendon(name).id :][:1]],
    ("general", "biasprm"): lambda model, name: [model.actuator(name).biasprm[:1]],
    ("joint", "polycoef"): lambda model, name: [model.equality(name).data[:5]],
    ("joint", "solref"): lambda model, name: [model.equality(name).solref],
    ("pair", "solref"): lambda model, name: [model.pair(name).solref],
    ("pair", "friction"): lambda model, name: [model.pair(name).friction],
    ("geom", "size"): lambda model, name: [model.geom(name).size[:2]],
}


def _coefficient(model: mujoco.MjModel, tendon: str, joint: str) -> np.ndarray:
    """Return the place of a joint's coefficient in a fixed tendon."""
    first, joint_id = int(model.tendon_adr[model.tendon(tendon).id]), model.joint(joint).id
    place = first + list(model.wrap_objid[first:]).index(joint_id)
    return model.wrap_prm[place : place + 1]


def compiled_views(model: mujoco.MjModel, values: Parameters) -> Views:
    """Return where a compiled model has those numbers that differ from scene to scene, except options."""
    found = {}
    for element, attribute in values:
        tag, _, name = element.partition(" ")
        with suppress(KeyError):  # of an option, and of what was left out, as it is 0 in all scenes of this kind
            found[element, attribute] = _COMPILED[tag, attribute](model, name)
    return found


def write_compiled(model: mujoco.MjModel, values: Parameters, where: Views) -> None:
    """Write numbers into a compiled model, at its `compiled_views`."""
    for key, value in values.items():
        if isinstance(value, str):
            model.opt.integrator = int(mujoco.mjtIntegrator.__members__[f"mjINT_{value.upper()}"])
        elif key[0] == "option":
            setattr(model.opt, key[1], value[0] if len(value) == 1 else value)
        elif key in where:
            first, *others = where[key]
            first[:] = value[: len(first)]
            for each in others:
                each[:] = value[len(first) :]
    if ("geom can", "size") in where:  # what the compiler derives from the size
        geom, (radius, half) = model.geom("can"), values["geom can", "size"]
        geom.rbound = np.hypot(radius, half)
        model.geom_aabb[geom.id] = [0, 0, 0, radius, radius, half]
