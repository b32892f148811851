"""Writes the MJCF that a viewer opens, and the SHA-256 of the mechanics files: `python
tools/templates.py mjcf`."""

import pathlib
import sys
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from mjbeer.model import looks_tree, mjcf_file
from mjbeer.model.check import SHIPPED, digest
from mjbeer.model.joints import initial_joints
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import Setting
from mjbeer.output import files
from mjbeer.theory.paper_scenes import hoop, pendulum
from mjbeer.theory.scene import Scene

_DIGITS = 12
"""Digits of the numbers in the files."""
_WIDTH = 120
"""Longest line of the files."""


class Start(NamedTuple):
    """A keyframe: phi [rad] and its rate [rad/s]."""

    phi: float
    phi_dot: float = 0.0


class Template(NamedTuple):
    """A file to be written: what it shows, and of which mechanics file; with a scene if the numbers
    are not its own."""

    about: str
    mechanics: str
    looks: str
    scene: Scene | None = None
    setting: Setting = Setting()
    keys: Mapping[str, Start] = MappingProxyType({})
    """Keyframes that replace those of the mechanics file."""


_PENDULUM = pendulum()
TEMPLATES = {
    "sliding": Template(
        "Beer that slides without friction in a can of sheet metal", "sliding_equality", "sliding"
    ),
    "frozen": Template("Beer frozen to a massless can", "frozen_equality", "frozen"),
    "pendulum": Template(
        "A pendulum on the axle of a wheel, appendix B of the paper",
        "sliding_equality",
        "pendulum",
        _PENDULUM,
        Setting("equality"),
        {
            "home": Start(0),
            "equilibrium": Start(_PENDULUM.equilibrium()),
            "level": Start(-_PENDULUM.incline),
            "swing": Start(1),
            "loop": Start(0, 50),
        },
    ),
    "hoop": Template(
        "A light hoop with a heavy bar on its rim, which hops, appendix A.4 of the paper",
        "frozen_contact",
        "hoop",
        hoop(),
        Setting("contact", timestep=2.5e-4, friction=10.0),
        {
            "home": Start(0),
            "equilibrium": Start(0),
            "swing": Start(1),
            "hop": Start(3),
            "push": Start(-3, 16),
        },
    ),
    "standing": Template(
        "A can of beer that stands on a floor, free in space", "standing", "standing"
    ),
    "lying": Template("A can of beer that lies on an incline, free in space", "lying", "sliding"),
}


def text(name: str, folder: pathlib.Path) -> str:
    """Return the file of a name in TEMPLATES, from the mechanics in a folder."""
    template = TEMPLATES[name]
    path = folder / "mechanics" / f"{template.mechanics}.xml"
    root = mjcf_file.read(path)
    if template.scene is not None:
        numbers = ModelNumbers(template.scene, template.setting, visuals=True)
        mjcf_file.write(root, numbers.parameters, path, _DIGITS)
        _replace_keyframes(root, template.scene, template.keys)
    looks_tree.add_looks(root, template.looks, folder)
    root.set("model", name)
    sources = (
        f"mechanics/{template.mechanics}.xml, which has the reasons, and looks/{template.looks}.xml"
    )
    root.insert(0, ET.Comment(f" Written by `make templates` from {sources}. Edit those. "))
    root.insert(0, ET.Comment(f" {template.about}. "))
    for element in root.iter():
        element.attrib.update(
            {key: " ".join(value.split()) for key, value in element.attrib.items()}
        )
    ET.indent(root)
    lines = ET.tostring(root, encoding="unicode").replace(" />", "/>").splitlines()
    return "".join(f"{_wrap(line)}\n" for line in lines)


def _replace_keyframes(root: ET.Element, scene: Scene, starts: Mapping[str, Start]) -> None:
    """Replace the keyframes of a mechanics file by those of a scene."""
    bodies = root.iter("body")
    joints = [joint.get("name", "") for body in bodies for joint in body.findall("joint")]
    keyframe = root.find("keyframe")
    assert keyframe is not None
    keyframe.clear()
    for name, start in starts.items():
        qpos, qvel = initial_joints(joints, scene, start.phi, start.phi_dot)
        key = ET.SubElement(keyframe, "key", name=name, qpos=_format(qpos))
        if start.phi_dot:
            key.set("qvel", _format(qvel))


def _format(numbers: np.ndarray) -> str:
    return " ".join(f"{number:.{_DIGITS}g}" for number in numbers)


def _wrap(line: str) -> str:
    """Return the line of an element in lines that are short enough; attributes go on below the
    first one."""
    if len(line) <= _WIDTH or "<!--" in line:
        return line
    indent = " " * (line.index(" ", line.index("<")) + 1)
    rows = []
    while len(line) > _WIDTH:
        end = line.rfind('" ', 0, _WIDTH) + 1
        if end == 0 or len(line) - end > _WIDTH - len(indent):
            # A list of numbers is longer than a line.
            end = line.rindex(" ", 0, _WIDTH)
        rows.append(line[:end])
        line = indent + line[end + 1 :]
    return "\n".join([*rows, line])


def digests(folder: pathlib.Path) -> str:
    """Return the SHA-256 of the mechanics files of scenes in a folder, one a line, with their
    names."""
    mechanics = sorted(
        [*folder.glob("mechanics/sliding_*.xml"), *folder.glob("mechanics/frozen_*.xml")]
    )
    return "".join(f"{digest(mjcf_file.content(path))}  {path.name}\n" for path in mechanics)


def main() -> None:
    """Write all files, from the mechanics and the looks in a folder."""
    folder = pathlib.Path(sys.argv[1])
    for name in TEMPLATES:
        files.write(folder / f"{name}.xml", text(name, folder))
    files.write(SHIPPED, digests(folder))


if __name__ == "__main__":
    main()
