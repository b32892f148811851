"""The MJCF templates: where they are, and reading one with every element there by name."""

import pathlib

import mujoco

from mjbeer.exceptions import TemplateError
from mjbeer.scene import Scene

_FOLDERS = (pathlib.Path(__file__).parent / "mjcf", pathlib.Path(__file__).parents[2] / "mjcf")
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
      TemplateError: if it cannot be read; the message has MuJoCo's reason.
    """
    path = folder() / f"{template}.xml"
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except ValueError as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error
    spec.compiler.degree = False  # the angles in the templates are those of the incline, which is always set anew
    for kind, names in (*_EVERYWHERE.items(), *_ALONE[template].items()):
        look = spec.find_default if kind == "default" else getattr(spec, kind)
        for each in names.split():
            if look(each) is None:
                raise TemplateError(f"{path} has no {kind} named {each!r}, which mjbeer uses; restore the template")
    return spec


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
