"""Adds the looks of a can, a file of MJCF, to the tree of its mechanics file."""

import copy
import pathlib
import xml.etree.ElementTree as ET

from mjbeer.model import mjcf_file

SHARED_FILES = ("assets.xml", "scene.xml")
"""The files that all cans include: meshes and materials, and what stands around a can."""


def add_looks(root: ET.Element, kind: str, folder: pathlib.Path) -> None:
    """Add the looks of a kind of can, from a folder of MJCF, to the tree of a mechanics file.

    What the looks have in a body is added to the body of this name, if there is one; a load without
    a body of its own is in the can. A geom replaces the one of its name, which shows where the load
    is in a mechanics file that is opened by itself.
    """
    looks = mjcf_file.read(folder / "looks" / f"{kind}.xml")
    bodies = {body.get("name"): body for body in root.iter("body")}
    bodies.setdefault("load", bodies["can"])
    for drawn in looks.iter("geom"):
        mjcf_file.remove(root, f"geom[@name='{drawn.get('name')}']")
    world = root.find("worldbody")
    for parent in (*looks.iter("worldbody"), *looks.iter("body")):
        target = world if parent.tag == "worldbody" else bodies.get(parent.get("name"))
        if target is not None:  # A can without modes has no body "slosh1".
            _add_elements(target, [child for child in parent if child.tag != "body"])
    _level(root)
    for file in reversed(SHARED_FILES):
        root.insert(0, ET.Element("include", file=file))


def _add_elements(body: ET.Element, elements: list[ET.Element]) -> None:
    """Add elements to a body, before the bodies in it."""
    tags = [child.tag for child in body]
    place = tags.index("body") if "body" in tags else len(tags)
    body[place:place] = copy.deepcopy(elements)


def _level(root: ET.Element) -> None:
    """Turn the frame of the cameras back by the incline, if there is one."""
    frame = mjcf_file.find(root, "frame level")
    incline = mjcf_file.find(root, "body incline")
    if frame is not None and incline is not None:
        angle = float(incline.get("euler", "0 0 0").split()[1])
        frame.set("euler", f"0 {0 - angle:.17g} 0")
