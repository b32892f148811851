"""Reads MJCF files as trees, compares them with a scene's numbers, and writes these numbers."""

import copy
import functools
import pathlib
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Collection
from typing import TypeAlias

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError, UnsupportedError

Parameters: TypeAlias = dict[tuple[str, str], tuple[float, ...] | str]
"""Numbers by element and attribute, as in `ModelNumbers.parameters`."""
TOO_UNEQUAL = "masses and inertias are too unequal for it to compute accelerations"
"""Why MuJoCo cannot represent a scene whose inertia matrix is nearly singular."""


def read(path: pathlib.Path) -> ET.Element:
    """Return an MJCF file as a new tree, with the elements of the files that it includes."""
    root = copy.deepcopy(_parse(path, _read_bytes(path)))
    expand_includes(root, path.parent)
    return root


def content(path: pathlib.Path) -> tuple[bytes, ...]:
    """Return the bytes of an MJCF file and of all files that it includes.

    What is made from a file is kept with its content, to notice an edit. The time and the size of a
    file do not show every edit.
    """
    text = _read_bytes(path)
    contents = [text]
    for include in _parse(path, text).iter("include"):
        contents.extend(content(path.parent / include.get("file", "")))
    return tuple(contents)


def _read_bytes(path: pathlib.Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error


@functools.lru_cache(maxsize=64)
def _parse(path: pathlib.Path, text: bytes) -> ET.Element:
    """Return the tree of a file with this text, which nobody may change."""
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error


def expand_includes(root: ET.Element, folder: pathlib.Path) -> None:
    """Replace every include in a tree by the elements of the file in a folder that it names."""
    for parent in list(root.iter()):
        children = []
        for child in parent:
            if child.tag == "include":
                children.extend(read(folder / child.get("file", "")))
            else:
                children.append(child)
        parent[:] = children


def find(root: ET.Element, element: str) -> ET.Element | None:
    """Return an element by its tag and its name, as "joint slide".

    "inertial can" is in the body "can", and "fixed slip/roll" is the joint "roll" of the tendon
    "slip".
    """
    tag, _, name = element.partition(" ")
    name, _, joint = name.partition("/")
    if tag == "inertial":
        return root.find(f".//body[@name='{name}']/inertial")
    path = f".//{tag}"
    if name:
        path += f"[@name='{name}']"
    if joint:
        path += f"/joint[@joint='{joint}']"
    return root.find(path)


def write(root: ET.Element, values: Parameters, path: pathlib.Path, digits: int = 17) -> None:
    """Write numbers, with up to so many `digits`, into the tree of the file at a `path`."""
    for (name, attribute), value in values.items():
        element = find(root, name)
        if element is None:
            raise TemplateError(
                f"{path} has no {name!r}, into which mjbeer writes {attribute}; restore the file"
            )
        if isinstance(value, str):
            element.set(attribute, value)
        else:
            element.set(attribute, " ".join(f"{number:.{digits}g}" for number in value))


def differences(root: ET.Element, values: Parameters) -> list[str]:
    """Return the parameters that a tree lacks, or has with other values, compared in 12 digits."""
    return [
        f"{name} {attribute}"
        for (name, attribute), value in values.items()
        if not _has_value(find(root, name), attribute, value)
    ]


def _has_value(element: ET.Element | None, attribute: str, value: tuple[float, ...] | str) -> bool:
    words = [] if element is None else element.get(attribute, "").split()
    if isinstance(value, str):
        return words == [value]
    if len(words) != len(value):
        return False
    return np.allclose(np.array(words, float), value, rtol=1e-11, atol=0)


def remove(root: ET.Element, *paths: str) -> None:
    """Remove the elements with these paths from a tree, whatever their parents are."""
    for parent in list(root.iter()):
        for path in paths:
            for element in parent.findall(path):
                parent.remove(element)


def remove_unused(root: ET.Element, acting: Collection[str], damped: bool) -> None:
    """Remove what is only drawn or measured from a tree, and disable unneeded stages of a step.

    Only the tendons and the actuators stay whose names are in `acting`.
    """
    ET.SubElement(root, "compiler", fusestatic="true", discardvisual="true")
    remove(root, "sensor")
    for section in (*root.iterfind("tendon"), *root.iterfind("actuator")):
        section[:] = [element for element in section if element.get("name") in acting]
    flags = {"energy": "disable", "sensor": "disable", "spring": "disable"}
    if not damped:
        flags["damper"] = "disable"
    if not root.findall("actuator/*"):
        flags["actuation"] = "disable"
    ET.SubElement(ET.SubElement(root, "option"), "flag", flags)


def parse_spec(root: ET.Element, path: pathlib.Path) -> mujoco.MjSpec:
    """Return the specification of a tree, which is that of the mechanics file at a `path`."""
    expand_includes(root, path.parents[1])
    try:
        return mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    except ValueError as error:
        raise TemplateError(f"{path} is not readable MJCF: {one_line(error)}") from error


def compile_spec(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return the model that a specification compiles to.

    Raises:
      UnsupportedError: if MuJoCo cannot represent such a model.
    """
    with warnings.catch_warnings():
        # MuJoCo only warns, and would step such a model with wrong accelerations.
        warnings.filterwarnings("error", "Inertia matrix is too close to singular", UserWarning)
        try:
            return spec.compile()
        except UserWarning as warning:
            raise refused(TOO_UNEQUAL) from warning
        except ValueError as error:
            raise refused(one_line(error)) from error


def refused(reason: str) -> UnsupportedError:
    """Return the error that MuJoCo cannot represent a scene, with its reason."""
    return UnsupportedError(f"MuJoCo cannot represent this scene: {reason}")


def one_line(error: ValueError) -> str:
    """Return the message of an error of MuJoCo in one line."""
    return "; ".join(str(error).splitlines())
