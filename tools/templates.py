"""Writes the files that a viewer opens, from mechanics and looks: `python tools/templates.py mjcf`."""

import pathlib
import sys
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from mjbeer.model import looks, mjcf_file
from mjbeer.model.joints import initial_joints
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.setting import Setting
from mjbeer.output import files
from mjbeer.theory.scene import Scene, hoop, pendulum

_DIGITS = 12
"""Digits of the numbers in the files."""


class Template(NamedTuple):
    """A file to be written: what it shows, and of which mechanics file; with a scene if the numbers are not its own."""

    about: str
    mechanics: str
    looks: str
    scene: Scene | None = None
    setting: Setting = Setting()
    keys: Mapping[str, tuple[float, float]] = MappingProxyType({})
    """phi [rad] and its rate [rad/s] of keyframes that replace those of the mechanics file."""


_WHEEL, _HOOP = pendulum(), hoop()
TEMPLATES = {
    "sliding": Template("Beer that slides without friction in a can of sheet metal", "sliding_equality", "sliding"),
    "frozen": Template("Beer frozen to a massless can", "frozen_equality", "frozen"),
    "pendulum": Template(
        "A pendulum on the axle of a wheel, appendix B of the paper",
        "sliding_equality",
        "pendulum",
        _WHEEL,
        Setting("equality"),
        {"equilibrium": (_WHEEL.equilibrium(), 0), "level": (-_WHEEL.incline, 0), "swing": (1, 0), "loop": (0, 50)},
    ),
    "hoop": Template(
        "A light hoop with a heavy bar on its rim, which hops, appendix A.4 of the paper",
        "frozen_contact",
        "hoop",
        _HOOP,
        Setting("contact", timestep=2.5e-4, friction=10.0),
        {"equilibrium": (0, 0), "rocking": (1, 0), "hop": (3, 0), "push": (-3, 16)},
    ),
    "standing": Template("A can of beer that stands on a floor, free in space", "standing", "standing"),
    "lying": Template("A can of beer that lies on an incline, free in space", "lying", "sliding"),
}


def text(name: str, folder: pathlib.Path) -> str:
    """Return the file of a name in TEMPLATES, from the mechanics in a folder."""
    template = TEMPLATES[name]
    path = folder / "mechanics" / f"{template.mechanics}.xml"
    root = mjcf_file.read(path)
    if template.scene:
        mjcf_file.write(root, Mechanics(template.scene, template.setting, visuals=True).parameters, path, _DIGITS)
        joints = [each.get("name", "") for body in root.iter("body") for each in body.findall("joint")]
        keyframe = root.find("keyframe")
        assert keyframe is not None
        keyframe[:] = [_key(key, joints, template.scene, *start) for key, start in template.keys.items()]
    looks.include_looks(root, template.looks)
    root.set("model", name)
    written = f"from mechanics/{template.mechanics}.xml, which has the reasons, and looks/. Edit those"
    root.insert(0, ET.Comment(f" {template.about}. Written by `make templates` {written}. "))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode").replace(" />", "/>") + "\n"


def _key(name: str, joints: list[str], scene: Scene, phi0: float, phi_dot0: float) -> ET.Element:
    """Return a keyframe."""
    qpos, qvel = (
        " ".join(f"{each:.{_DIGITS}g}" for each in row) for row in initial_joints(joints, scene, phi0, phi_dot0)
    )
    return ET.Element("key", {"name": name, "qpos": qpos} | ({"qvel": qvel} if phi_dot0 else {}))


def main() -> None:
    """Write all files into a folder, whose mechanics and looks they are made from."""
    folder = pathlib.Path(sys.argv[1])
    for name in TEMPLATES:
        files.write(folder / f"{name}.xml", text(name, folder))


if __name__ == "__main__":
    main()
