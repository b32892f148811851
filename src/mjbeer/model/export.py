"""Writes a scene as one stand-alone MJCF file, for MuJoCo 4 or for others too."""

import os
import re
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError, UnsupportedError
from mjbeer.model import mjcf_file
from mjbeer.model.build import START, add_start, can_spec
from mjbeer.model.check import check_drawn, check_file
from mjbeer.model.looks import simplify
from mjbeer.model.mujoco_library import library
from mjbeer.model.setting import (
    FRICTION,
    LOOKS,
    MUJOCO_INTEGRATORS,
    Integrator,
    Looks,
    MujocoIntegrator,
    Rolling,
    Setting,
)
from mjbeer.output import files
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

PORTABLE: tuple[MujocoIntegrator, ...] = ("Euler", "implicitfast", "RK4")
"""The integrators of a portable export. MJX and mujoco_warp have no "implicit", and MuJoCo 3.3 has
no "discrete"."""
DIGITS = 12
"""Digits of the numbers of an export, as many as in the files of mjcf/. They are within 5e-12 of
the model's, and the motion after a second is within 1e-10 rad of its motion: with RK4 that itself
is only within 1e-8 rad of the truth."""
_DRAWN_DIGITS = 6
"""Digits of what is only drawn, which MuJoCo keeps in single precision."""
_DRAWN_ATTRIBUTES = (
    *("rgba", "rgb1", "rgb2", "markrgb", "random", "ambient", "diffuse", "specular"),
    *("shininess", "emission", "texrepeat", "vertex", "texcoord"),
)
"""Attributes of MJCF that only say how something looks."""
_DIRECTIONS = ("quat", "vertex")
"""Attributes in which a number that ought to be 0 is up to some 1e-16 of the others."""
_NUMBER = re.compile(r"-?\d+(\.\d*)?(e[-+]?\d+)?")


def export(
    scene: Scene | Standing,
    path: str | os.PathLike[str],
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    rolling: Rolling = "reduced",
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    portable: bool = False,
    free: bool = True,
    mjcf: str | os.PathLike[str] | None = None,
    looks: Looks = "plain",
) -> None:
    """Write a scene as one MJCF file, with looks, sensors, and its start as the keyframe "start".

    The parameters are those of `simulate`, but the integrator must be one of MuJoCo's, and the
    file's name must end in .xml. A reduced model of a frozen load turns on the spot, because its
    one coordinate is phi.

    With `portable`, MuJoCo from 3.3.4 on, MJX, mujoco_warp and dm_control load the file. The
    integrator must then be one of `PORTABLE`. The scene must have no drag, and its damping must be
    in proportion to a rate. A contact is softer: docs/portability.md has the errors.

    By default the `looks` are "plain": the can is a cylinder that one can see through, and the file
    has 4 to 11 kB. A file is made to be read, edited and put into other worlds, and meshes would be
    more than nine tenths of it. With "full" it has the meshes that mjbeer draws, and 120 to 190 kB.
    Both have the same mechanics, in numbers of `DIGITS` digits. Meshes of your own, from a folder
    `mjcf`, are only in a file with full looks.

    A `standing` can is written with the floor that it stands on, or, with `free=False`, without it
    and held in place. Of the other parameters it has `integrator`, `timestep`, `mjcf`,
    `looks` and `portable`, with which it lacks the damping of breaking waves.

    Raises:
      ParameterError: if a parameter is invalid.
      UnsupportedError: if MuJoCo cannot represent such a model.
      TemplateError: if a file of MJCF is missing, lacks an element, or has other accelerations than
        theory.
      OutputError: if the file cannot be written.
    """
    target = require.path(path)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    if target.suffix != ".xml":  # MuJoCo takes a .urdf for URDF, and its MjSpec reads no .mjcf
        raise ParameterError(
            f"the name of the MJCF file must end in .xml, got {require.format_value(target.name)}"
        )
    portable = require.choice("portable", portable, (True, False))
    looks = require.choice("looks", looks, LOOKS)
    require.choice("integrator", integrator, PORTABLE if portable else MUJOCO_INTEGRATORS)
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    spec = can_spec(scene, setting, True, free, phi0, phi_dot0)
    if looks == "plain":
        simplify(spec, scene)
    if isinstance(scene, Standing):
        spec.add_key(name=START)
        spec.comment = f" Written by mjbeer: {scene!r}. "
        if portable:
            _remove_breaking_waves(spec)
    else:
        add_start(spec, scene, phi0, phi_dot0)
        fault = check_file(setting.folder, scene.attachment, setting.rolling)
        if fault is None:
            fault = check_drawn(mjcf_file.compile_spec(spec), scene, setting)
        if fault is not None:
            raise TemplateError(fault)
        if portable:
            _soften(spec, scene)
        spec.comment = (
            f" Written by mjbeer: rolling={rolling!r}, {scene!r}. "
            f"The start is the keyframe {START!r}. "
        )
    # MuJoCo 3.3 refuses a body without mass that has a drawn geom.
    spec.compiler.fusestatic = portable
    if portable:  # MJX 3.3 has no energy, and not all flags
        spec.option.disableflags &= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
        spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    model = spec.compile()
    root = _tree(spec)
    if portable:
        _restrict(root, model)
    _round(root)
    ET.indent(root)
    files.write(target, ET.tostring(root, encoding="unicode") + "\n")


def _tree(spec: mujoco.MjSpec) -> ET.Element:
    """Return a specification as a tree with all 17 digits of doubles; MuJoCo's default is 6."""
    before = library()._mjPRIVATE__get_xml_precision()
    library()._mjPRIVATE__set_xml_precision(17)
    try:
        text = spec.to_xml()
    finally:
        library()._mjPRIVATE__set_xml_precision(before)
    return ET.fromstring(text, ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))


def _round(root: ET.Element) -> None:
    """Round the numbers of a tree to the digits that mean something."""
    for element in root.iter():
        for name, value in element.items():
            digits = _DRAWN_DIGITS if name in _DRAWN_ATTRIBUTES else DIGITS
            words = value.split(" ")
            least = 0.0
            if name in _DIRECTIONS:
                least = 1e-15 * max(abs(float(word)) for word in words)
            element.set(name, " ".join(_rounded(word, digits, least) for word in words))


def _rounded(word: str, digits: int, least: float) -> str:
    """Return a word with so many digits if it is a number, and 0 for one below the `least`."""
    if not _NUMBER.fullmatch(word):
        return word
    number = float(word)
    if abs(number) <= least:
        return "0"
    return f"{number:.{digits}g}"


def _remove_breaking_waves(spec: mujoco.MjSpec) -> None:
    """Leave only the damping in proportion to the rate: MuJoCo 3.3 knows no other."""
    for joint in spec.joints:
        joint.damping = [joint.damping[0], 0, 0]


def _soften(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Make the rolling constraint of a portable export as hard as can be without `diagexact`.

    Without `diagexact` MuJoCo softens the row of an equality by 1/m + 1/I, for the mass m of the
    slide and the inertia I of the hinge. That is right for neither of the two ways to write the
    row: in angles, roll - u/a, it should be 1/(m a^2) + 1/I, and in distances, u - a roll, it
    should be 1/m + a^2/I. So the row is in angles if the radius is at most 1 m, and in distances if
    it is larger: in both cases MuJoCo's sum is then too small, and the row harder than exact. But a
    frozen load couples the joints, which changes the exact sum as the load turns. With the load at
    the bottom the row of half a can of beer is 1.5 times as soft as exact, and the hoop's 11 times.
    """
    if scene.drag > 0 or any(scene.damping_law.coefficients[1:]):
        raise UnsupportedError(
            "a portable export has no drag, and damping in proportion to the slip rate only: "
            "MuJoCo 3.3 knows no other"
        )
    spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    for pair in spec.pairs:
        # With 0.9999 and 100, as in models for MuJoCo 4, its error is a tenth in double precision,
        # but in single precision, as in mujoco_warp, the solver then ends with NaN.
        pair.solimp[:2] = 0.999
        spec.option.impratio = 10.0
    if scene.can.radius > 1.0:
        for equality in spec.equalities:
            equality.name1 = "slide"
            equality.name2 = "roll"
            equality.data[1] = scene.can.radius


def _restrict(root: ET.Element, model: mujoco.MjModel) -> None:
    """Remove what MuJoCo 3.3 and dm_control do not know from MJCF as MuJoCo 4 writes it."""
    for texture in root.iter("texture"):
        if texture.get("colorspace") == "auto":  # It is the default.
            del texture.attrib["colorspace"]
    for light in root.iter("light"):
        if light.get("type") == "directional":
            del light.attrib["type"]
            light.set("directional", "true")
    _dissolve_frames(root, model)


def _dissolve_frames(root: ET.Element, model: mujoco.MjModel) -> None:
    """Replace each frame by its elements: dm_control does not know frames."""
    for parent in list(root.iter()):
        for place, frame in reversed(list(enumerate(parent))):
            if frame.tag == "frame":
                for element in frame:
                    there = getattr(model, element.tag)(element.get("name"))
                    element.set("pos", _exact(there.pos))
                    element.set("quat", _exact(there.quat))
                parent[place : place + 1] = frame


def _exact(numbers: np.ndarray) -> str:
    """Return numbers with all their digits."""
    return " ".join(repr(float(number)) for number in numbers)
