"""The MJCF templates: where they are, and reading the looks of one; the mechanics are never a template's."""

import pathlib

import mujoco

from mjbeer.exceptions import TemplateError
from mjbeer.model import neutral
from mjbeer.theory.scene import Scene

_FOLDERS = (pathlib.Path(__file__).parents[1] / "mjcf", pathlib.Path(__file__).parents[3] / "mjcf")
"""In an installed wheel, and in a checkout."""
# What is addressed by name: kind by kind, in every template and in some alone.
_EVERYWHERE = {
    "body": ("incline", "can", "load"),
    "frame": ("level",),
    "camera": ("side", "quarter", "overview"),
    "geom": ("load", "board", "board_side"),
    "mesh": ("can",),
    "material": ("planks", "grid"),
    "default": ("collision",),
}
_WITH_BEER: dict[str, tuple[str, ...]] = {"mesh": ("load",)}
_FURTHER = {"sliding": _WITH_BEER, "frozen": _WITH_BEER}
_BODIES = {"incline": "world", "can": "incline", "load": "can"}
"""The bodies, and which one each is in."""
_MECHANISM = {
    "joints": ("slide", "lift", "roll", "swing"),
    "equalities": ("rolling",),
    "pairs": ("rolling",),
    "actuators": (), "excludes": (), "flexes": (), "plugins": (), "sensors": (), "tendons": (),
}  # fmt: skip
"""The names that elements which act on a motion may have: these are in the templates, and mjbeer makes its own."""
_SINGULAR = {"bodies": "body", "equalities": "equality", "flexes": "flex"}


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
    """Return the name of the template that shows a scene: a load without a fill is drawn as a point."""
    if scene.attachment == "sliding":
        return "pendulum" if scene.load.fill is None else "sliding"
    return "hoop" if scene.load.fill is None else "frozen"


def read(template: str) -> mujoco.MjSpec:
    """Return what a template shows, as an editable specification to which the mechanics are to be added.

    It has the bodies "incline", "can" and "load", and all that is drawn. It has no joints, no masses and no
    constraints, and its options, like the defaults of what is added to it, are MuJoCo's own: see `neutral`.

    Raises:
      TemplateError: if it cannot be read, lacks what mjbeer addresses by name, or has what could act on the motion
        and is unknown to mjbeer; the message names the file and the element.
    """
    path = folder() / f"{template}.xml"
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except (ValueError, OSError) as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error
    wrong = _missing(spec, _EVERYWHERE) or _missing(spec, _FURTHER.get(template, {})) or _unknown(spec)
    if wrong:
        raise TemplateError(f"{path} {wrong}")
    neutral.neutralize(spec)
    return spec


def _missing(spec: mujoco.MjSpec, wanted: dict[str, tuple[str, ...]]) -> str | None:
    """Return what to say of the first element that is missing, or None."""
    for kind, names in wanted.items():
        look = spec.find_default if kind == "default" else getattr(spec, kind)
        for element in names:
            if look(element) is None:
                return f"has no {kind} named {element!r}, which mjbeer uses; restore the template"
    return None


def _unknown(spec: mujoco.MjSpec) -> str | None:
    """Return what to say of the first element that could act on a motion and is none of mjbeer's, or None."""
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
