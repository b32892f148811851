"""The specifications of cans that are free in space: standing ones, and lying ones."""

import functools
import pathlib
import xml.etree.ElementTree as ET

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError
from mjbeer.model import looks, mjcf_file
from mjbeer.model.free_numbers import lying_parameters, standing_parameters
from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Setting
from mjbeer.theory.can import Can
from mjbeer.theory.paper_scenes import sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing, standing


def standing_spec(can: Standing, setting: Setting, visuals: bool, free: bool) -> mujoco.MjSpec:
    """Return the specification of a standing can, with a free joint and a floor if it is `free`."""
    integrator = require.choice("integrator", setting.integrator, MUJOCO_INTEGRATORS)
    root, path = _read_mechanics("standing", setting.folder)
    if not free:
        mjcf_file.remove(root, "freejoint", "geom[@name='surface']")
    _repeat_modes(root, can.moving_modes)
    options: Parameters = {
        ("option", "integrator"): integrator,
        ("option", "timestep"): (setting.timestep,),
    }
    mjcf_file.write(root, standing_parameters(can) | options, path)
    return looks.drawn_spec(root, path, can) if visuals else mjcf_file.parse_spec(root, path)


def attached_spec(can: Standing | Scene, visuals: bool = True) -> mujoco.MjSpec:
    """Return the specification of a can that is to be attached, without a free joint."""
    if isinstance(can, Standing):
        return standing_spec(can, Setting(), visuals, free=False)
    if not isinstance(can, Scene):
        got = require.format_value(can)
        raise ParameterError(f"can must be a Standing or a Scene, got {got}")
    root, path = _read_mechanics("lying", Setting().folder)
    mjcf_file.remove(root, "freejoint")
    if can.attachment == "frozen":
        mjcf_file.remove(root, "joint[@name='swing']", "jointpos", "jointvel")
    at_origin: Parameters = {
        ("body incline", "euler"): (0, 0, 0),
        ("body can", "euler"): (0, 0, 0),
        ("body can", "pos"): (0, 0, 0),
    }
    mjcf_file.write(root, lying_parameters(can) | at_origin, path)
    return looks.drawn_spec(root, path, can) if visuals else mjcf_file.parse_spec(root, path)


def _read_mechanics(name: str, folder: pathlib.Path) -> tuple[ET.Element, pathlib.Path]:
    """Return the tree of a mechanics file without its keyframes, and its path.

    Raises:
      TemplateError: if the file has other numbers than mjbeer's own.
    """
    path = folder / "mechanics" / f"{name}.xml"
    root = mjcf_file.read(path)
    edited = mjcf_file.differences(root, _paper_parameters(name))
    if edited:
        raise TemplateError(
            f"{path} has numbers of its own in {', '.join(edited)}, "
            "into which mjbeer writes a can's"
        )
    mjcf_file.remove(root, "keyframe")
    return root, path


def _repeat_modes(root: ET.Element, modes: int) -> None:
    """Replace the body and the sensor of "slosh1" by as many as there are modes."""
    for parent in (*root.iterfind(".//body[@name='can']"), *root.iterfind("sensor")):
        for first_mode in [child for child in parent if "slosh1" in child.get("name", "")]:
            parent.remove(first_mode)
            text = ET.tostring(first_mode, encoding="unicode")
            for mode in range(1, modes + 1):
                parent.append(ET.fromstring(text.replace("slosh1", f"slosh{mode}")))


@functools.cache
def _paper_parameters(name: str) -> Parameters:
    """Return the parameters that a mechanics file of mjbeer has as it stands."""
    if name == "lying":
        return lying_parameters(sliding(can=Can.sheet_metal()))
    return standing_parameters(standing())
