"""What an export does without, so that MuJoCo 3.3, MJX, mujoco_warp and dm_control load it.

MuJoCo 3.3 knows neither the flag "diagexact" nor the integrator "discrete" nor some attributes, and its first versions
refuse a body without mass. dm_control knows no `<frame>`.
"""

import copy
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import Softness
from mjbeer.theory.scene import Scene

INTEGRATORS = ("Euler", "implicitfast", "RK4")
"""The integrators that all of them have: MJX and mujoco_warp have no "implicit", and MuJoCo 3.3 has no "discrete"."""
_METRE = 1.0
"""Radius [m] from which on an equality is about distances instead of angles."""
_CONTACT = Softness(exact_diagonal=False, impedance=(0.999, 0.999), impratio=10.0)
"""The softness of a contact. With 0.9999 and 100, as in models for MuJoCo 4, its error is a tenth in double precision,
but in single precision, as in mujoco_warp, the solver then ends with NaN."""


def require_integrator(integrator: str) -> None:
    """Check that all that load a portable export have an integrator.

    Raises:
      UnsupportedError: if not.
    """
    if integrator not in INTEGRATORS:
        raise UnsupportedError(
            f"a portable export has one of the integrators {', '.join(INTEGRATORS)}, not {integrator}: MJX and "
            "mujoco_warp have no implicit, MuJoCo 3.3 has no discrete"
        )


def require_linear(scene: Scene) -> None:
    """Check that all that load a portable export have the damping and the drag of a scene.

    Raises:
      UnsupportedError: if the forces are not proportional to a rate.
    """
    if scene.drag > 0 or any(scene.damping_law.coefficients[1:]):
        raise UnsupportedError(
            "a portable export has no drag, and damping in proportion to the slip rate only: MuJoCo 3.3 knows no other"
        )


def softness(scene: Scene, rolling: str) -> Softness:
    """Return how soft the rolling constraint of a portable export is: as hard as can be without `diagexact`.

    Without it the softness of an equality's row is proportional to the sum of the inverse inertias 1/m and 1/I of slide
    and hinge, in metres and radians alike. In a row about angles, roll - u/a, the first should be 1/(m a^2), and is too
    small for a can of less than a metre; in a row about distances, u - a roll, the second should be a^2/I, and is too
    small for a can of more. So the sum is never much too large, and the row never much too soft.
    """
    if rolling == "contact":
        return _CONTACT
    return Softness(exact_diagonal=False, first="hinge" if scene.can.radius < _METRE else "slide")


def rewrite(text: str) -> str:
    """Return MJCF as MuJoCo 4 writes it, without what MuJoCo 3.3.0 does not know, frames, and bodies without mass."""
    root = ET.fromstring(text, ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))
    for texture in root.iter("texture"):
        if texture.get("colorspace") == "auto":  # what a texture without it has
            del texture.attrib["colorspace"]
    for light in root.iter("light"):
        if light.get("type") == "directional":
            del light.attrib["type"]
            light.set("directional", "true")
    world = root.find("worldbody")
    assert world is not None
    _dissolve(world)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _dissolve(parent: ET.Element) -> None:
    """Move to an element what is in its frames and in its bodies without a joint, and remove these, down the tree."""
    for child in list(parent):
        if child.tag not in ("frame", "body"):
            continue
        _dissolve(child)
        if child.find("joint") is not None:
            continue
        # MuJoCo numbers what is in a body after what is in its parent, but what is in a frame where the frame is.
        position = list(parent).index(child) if child.tag == "frame" else len(parent) - 1
        parent.remove(child)
        for element in reversed([each for each in child if each.tag != "inertial"]):
            parent.insert(position, _moved(element, child))


def _moved(element: ET.Element, frame: ET.Element) -> ET.Element:
    """Return a copy of an element in a frame, or in a body without a joint, as it is outside of it."""
    moved = copy.copy(element)
    place, turn = _numbers(frame, "pos", "0 0 0"), _numbers(frame, "quat", "1 0 0 0")
    position, quaternion, direction = np.zeros(3), np.zeros(4), np.zeros(3)
    mujoco.mju_rotVecQuat(position, _numbers(element, "pos", "0 0 0"), turn)
    moved.set("pos", _written(place + position))
    if element.tag == "light":
        mujoco.mju_rotVecQuat(direction, _numbers(element, "dir", "0 0 -1"), turn)
        moved.set("dir", _written(direction))
    else:
        mujoco.mju_mulQuat(quaternion, turn, _numbers(element, "quat", "1 0 0 0"))
        moved.set("quat", _written(quaternion))
    if "childclass" in frame.attrib:
        name = "childclass" if element.tag in ("body", "frame") else "class"
        moved.set(name, element.get(name, frame.attrib["childclass"]))
    return moved


def _numbers(element: ET.Element, name: str, default: str) -> np.ndarray:
    return np.array([float(word) for word in element.get(name, default).split()])


def _written(numbers: np.ndarray) -> str:
    return " ".join(repr(float(number)) for number in numbers)
