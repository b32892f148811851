"""Finds and reads the MJCF templates, of which a model takes only the looks, never the mechanics."""

import os
import pathlib
import re
import time
from typing import NamedTuple

import mujoco

from mjbeer.exceptions import TemplateError
from mjbeer.model import neutral, sensors
from mjbeer.theory.scene import Scene

_FOLDERS = (pathlib.Path(__file__).parents[1] / "mjcf", pathlib.Path(__file__).parents[3] / "mjcf")
"""Where the templates are in an installed wheel, and in a checkout."""
_EVERYWHERE = {
    "body": ("incline", "can", "load"),
    "frame": ("level",),
    "camera": ("side", "quarter", "overview"),
    "geom": ("load", "board"),
    "mesh": ("can",),
    "material": ("planks", "grid"),
    "default": ("collision",),
}
"""The elements that mjbeer addresses by name in every template, by kind."""
_WITH_BEER: dict[str, tuple[str, ...]] = {"mesh": ("load",)}
_FURTHER = {"sliding": _WITH_BEER, "frozen": _WITH_BEER}
"""The elements that mjbeer addresses by name in some templates only."""
_INCLUDE = re.compile(rb"""<include\s+file\s*=\s*["']([^"']*)["']""")
"""What names another file in a template."""
_SETTLED = 2_000_000_000
"""Age of a file's last change [ns] from which on another one gives it another time: some file systems count time in
steps of 2 s, and a change within the step would not show."""
_BODIES = {"incline": "world", "can": "incline", "load": "can"}
"""The bodies, with the parent of each."""
_MECHANISM = {
    "joints": ("slide", "lift", "roll", "swing"),
    "equalities": ("rolling",),
    "pairs": ("rolling",),
    "actuators": (),
    "excludes": (),
    "flexes": (),
    "plugins": (),
    "sensors": sensors.NAMES,
    "tendons": sensors.NAMES,
}
"""The names that elements which act on the motion may have, by kind. mjbeer replaces such elements by its own, or
leaves them out: sensors are only in models that are shown."""
_SINGULAR = {"bodies": "body", "equalities": "equality", "flexes": "flex"}
"""Names of kinds whose plural does not just add an s."""

_files: "dict[str, _File]" = {}
"""The files that were read, by their paths."""


def folder() -> pathlib.Path:
    """Return the folder of the templates.

    Raises:
      TemplateError: if there is none.
    """
    for candidate in _FOLDERS:
        if (candidate / "shared.xml").is_file():
            return candidate
    raise TemplateError(f"no MJCF templates: neither {_FOLDERS[0]} nor {_FOLDERS[1]} holds them; reinstall mjbeer")


def name(scene: Scene) -> str:
    """Return the name of the template for a scene; a load without a fill is drawn as a ball."""
    if scene.attachment == "sliding":
        return "pendulum" if scene.load.fill is None else "sliding"
    return "hoop" if scene.load.fill is None else "frozen"


def contents(template: str) -> tuple[bytes, ...]:
    """Return the bytes of a template and of the files that it includes; those that cannot be read are left out.

    As long as these are the same, so is what `read` returns.
    """
    place = str(folder())
    waiting, found = [os.path.join(place, f"{template}.xml")], dict[str, bytes]()
    while waiting:
        path = waiting.pop()
        if path not in found and (file := _file(path)) is not None:
            found[path] = file.text
            for name in file.included:
                waiting += {os.path.join(place, name), os.path.join(os.path.dirname(path), name)}
    return (place.encode(), *found.values())


class _File(NamedTuple):
    """A file of a template, as it was read."""

    state: tuple[int, int, int]
    settled: bool
    """Whether a later change of the file will show in its state."""
    text: bytes
    included: tuple[str, ...]


def _file(path: str) -> _File | None:
    """Return a file, read again if it may have changed since it was last read; None if it cannot be read."""
    try:
        status, known = os.stat(path), _files.get(path)
        state = status.st_mtime_ns, status.st_size, status.st_ino
        if known is not None and known.settled and known.state == state:
            return known
        settled = time.time_ns() - status.st_mtime_ns > _SETTLED
        with open(path, "rb", buffering=0) as stream:
            text = stream.read()
    except (OSError, ValueError):
        return None
    included = tuple(os.fsdecode(name) for name in _INCLUDE.findall(text))
    _files[path] = _File(state, settled, text, included)
    return _files[path]


def read(template: str) -> mujoco.MjSpec:
    """Return a template without its mechanics, as an editable specification to which those of a model can be added.

    It has the bodies "incline", "can" and "load", and everything that is drawn. It has no joints, no masses, no
    constraints and no sensors; its options, and the defaults of elements that are added, are MuJoCo's own, as
    `neutral` explains.

    Raises:
      TemplateError: if it cannot be read, lacks an element that mjbeer addresses by name, or has an unknown element
        that could act on the motion; the message names the file and the element.
    """
    path = folder() / f"{template}.xml"
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except (ValueError, OSError) as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error
    missing = _missing(spec, _EVERYWHERE) or _missing(spec, _FURTHER.get(template, {}))
    if fault := missing or _unknown(spec):
        raise TemplateError(f"{path} {fault}")
    neutral.neutralize(spec)
    return spec


def _missing(spec: mujoco.MjSpec, wanted: dict[str, tuple[str, ...]]) -> str | None:
    """Return the end of an error message about the first element that is missing, or None if all exist."""
    for kind, names in wanted.items():
        find = spec.find_default if kind == "default" else getattr(spec, kind)
        for element in names:
            if find(element) is None:
                return f"has no {kind} named {element!r}, which mjbeer uses; restore the template"
    return None


def _unknown(spec: mujoco.MjSpec) -> str | None:
    """Return the end of an error message about the first unknown element that could act on the motion, or None."""
    for kind, names in {"bodies": ("world", *_BODIES), **_MECHANISM}.items():
        for element in getattr(spec, kind):
            if element.name not in names:
                singular = _SINGULAR.get(kind, kind.removesuffix("s"))
                return (
                    f"has a further {singular}, named {element.name!r}, which could act on the motion and is not "
                    "allowed; remove it (what is only drawn can be a geom or a site of the world or of a body)"
                )
    if spec.hasImplicitPluginElem:
        return "has a plugin, which could act on the motion and is not allowed; remove it"
    for body in spec.bodies[1:]:
        if body.parent.name != _BODIES[body.name] or body.frame is not None:
            return f"has the body {body.name!r} elsewhere than directly in {_BODIES[body.name]!r}; put it there"
    return None
