"""The MJCF templates: where they are, and reading one that is as it came with mjbeer."""

import hashlib
import pathlib

import mujoco

from mjbeer.exceptions import TemplateError
from mjbeer.theory.scene import Scene

_FOLDERS = (pathlib.Path(__file__).parents[1] / "mjcf", pathlib.Path(__file__).parents[3] / "mjcf")
"""In an installed wheel, and in a checkout."""


def folder() -> pathlib.Path:
    """The folder of the templates.

    Raises:
      TemplateError: if there is none.
    """
    for each in _FOLDERS:
        if (each / "shared.xml").is_file():
            return each
    raise TemplateError(f"no MJCF templates: neither {_FOLDERS[0]} nor {_FOLDERS[1]} holds them; reinstall mjbeer")


def name(scene: Scene) -> str:
    """Name of the template that shows a scene: a load without a fill is drawn as a point."""
    if scene.attachment == "sliding":
        return "pendulum" if scene.load.fill is None else "sliding"
    return "hoop" if scene.load.fill is None else "frozen"


def read(template: str) -> mujoco.MjSpec:
    """A template as an editable specification. What is added to it has its angles in radians.

    Raises:
      TemplateError: if it cannot be read, or is not as it came with mjbeer; the message says what is wrong.
    """
    path = folder() / f"{template}.xml"
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        changed = [each for each in (path, *map(path.with_stem, _SHARED)) if digest(each) != _DIGESTS[each.stem]]
    except (ValueError, OSError) as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error
    if changed:
        raise TemplateError(_missing(path, spec, _EVERYWHERE, _ALONE[template]) or _other(changed[0]))
    spec.compiler.degree = False  # the angles in the templates are those of the incline, which is always set anew
    return spec


def digest(path: pathlib.Path) -> str:
    """What a file is recognized by, whatever its line ends."""
    return hashlib.sha256(path.read_bytes().replace(b"\r\n", b"\n")).hexdigest()[:16]


def _missing(path: pathlib.Path, spec: mujoco.MjSpec, *wanted: dict[str, str]) -> str | None:
    """What to say of the first element that is missing, if one is."""
    for kind, names in (item for each in wanted for item in each.items()):
        look = spec.find_default if kind == "default" else getattr(spec, kind)
        for name in names.split():
            if look(name) is None:
                return f"{path} has no {kind} named {name!r}, which mjbeer uses; restore the template"
    return None


def _other(path: pathlib.Path) -> str:
    return (
        f"{path} is not as it came with mjbeer, whose models it would make wrong without a word; restore the template "
        "(reinstall mjbeer, or in a checkout `git checkout mjcf`), and make changes in a copy of the folder"
    )


_SHARED = ("shared", "incline")
"""What every template includes."""
_DIGESTS = {
    "frozen": "1c70544c14d6c99b",
    "hoop": "2458f1126cd8aa04",
    "pendulum": "a81f2feb83c9b761",
    "sliding": "6132c33443c017ca",
    "shared": "1a8d6eefa6f266da",
    "incline": "2442c767fc9f6d69",
}
# What model and appearance address by name: kind by kind, in every template and in each alone.
_EVERYWHERE = {
    "body": "incline can load",
    "joint": "slide roll",
    "frame": "level",
    "camera": "side quarter overview",
    "geom": "load board board_side",
    "mesh": "can",
    "material": "planks grid wood metal end beer mark",
    "texture": "planks grid",
    "default": "visual collision",
}
_ALONE = {
    "sliding": {"joint": "swing", "mesh": "load", "equality": "rolling"},
    "frozen": {"mesh": "load", "equality": "rolling"},
    "pendulum": {"joint": "swing", "equality": "rolling"},
    "hoop": {"joint": "lift", "geom": "surface can", "pair": "rolling"},
}
