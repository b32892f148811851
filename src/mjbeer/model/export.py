"""A scene made ready for MuJoCo's viewer, and written as one stand-alone MJCF file, for MuJoCo 4 or for others too."""

import os
import xml.etree.ElementTree as ET

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError, UnsupportedError
from mjbeer.model.build import START, add_start, compile_spec, mechanics_fault, specification
from mjbeer.model.mujoco_library import library
from mjbeer.model.setting import FRICTION, INTEGRATORS, Integrator, MujocoIntegrator, Rolling, Setting
from mjbeer.output import files
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

PORTABLE: tuple[MujocoIntegrator, ...] = ("Euler", "implicitfast", "RK4")
"""The integrators that all have which load a portable export: MJX and mujoco_warp have no "implicit", and MuJoCo 3.3
has no "discrete"."""


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
) -> None:
    """Write a scene as one MJCF file, with everything drawn, with sensors, and with its start as the keyframe "start".

    The parameters are those of `simulate`, but the integrator must be one of MuJoCo's, and the file's name must end in
    .xml. A reduced model of a frozen load turns on the spot, because its one coordinate is phi.

    With `portable`, MuJoCo from 3.3.4 on, MJX, mujoco_warp and dm_control load the file. The integrator must then be
    one of `PORTABLE`, the scene must have no drag and no damping but in proportion to a rate, and a contact is softer:
    docs/portability.md has the errors.

    A `standing` can is written with the floor that it stands on, or without `free` as one that is held. It has no other
    parameters than `integrator`, `timestep`, `mjcf` and `portable`, with which it lacks the damping of breaking waves.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if a file of MJCF is missing, lacks an element, or moves otherwise than the scene.
      OutputError: if the file cannot be written.
    """
    target, (phi0, phi_dot0) = require.path(path), require.start(phi0, phi_dot0)
    if target.suffix != ".xml":  # MuJoCo takes a .urdf for URDF, and its MjSpec reads no .mjcf
        raise ParameterError(f"the name of the MJCF file must end in .xml, got {require.format_value(target.name)}")
    names = PORTABLE if require.choice("portable", portable, (True, False)) else INTEGRATORS
    require.choice("integrator", integrator, names)
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    spec = specification(scene, setting, True, free, phi0, phi_dot0)
    if isinstance(scene, Standing):
        spec.add_key(name=START)
        spec.comment = f" Written by mjbeer: {scene!r}. "
        for joint in spec.joints if portable else ():
            joint.damping = [joint.damping[0], 0, 0]
    else:
        add_start(spec, scene, phi0, phi_dot0)
        if fault := mechanics_fault(scene, setting, compile_spec(spec)):
            raise TemplateError(fault)
        if portable:
            _soften(spec, scene)
        spec.comment = f" Written by mjbeer: rolling={rolling!r}, {scene!r}. The start is the keyframe {START!r}. "
    spec.compiler.fusestatic = portable  # MuJoCo 3.3 refuses a body without mass that has a drawn geom
    if portable:  # MJX 3.3 has no energy, and not all flags
        spec.option.disableflags &= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
        spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    model = spec.compile()
    text = _text(spec)
    files.write(target, _portable(text, model) if portable else text)


def _text(spec: mujoco.MjSpec) -> str:
    """Return the specification as XML with 17 digits, which give all doubles back; MuJoCo's default is 6."""
    before, set_digits = library()._mjPRIVATE__get_xml_precision(), library()._mjPRIVATE__set_xml_precision
    set_digits(17)
    try:
        return spec.to_xml()
    finally:
        set_digits(before)


def _soften(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Make the rolling constraint of a portable export as hard as can be without `diagexact`.

    Without it an equality's row is softened by 1/m + 1/I, of slide and hinge, in metres and radians alike. A row about
    angles, roll - u/a, should have 1/(m a^2) + 1/I, and one about distances 1/m + a^2/I: of the two the one is taken
    that is not too soft.
    """
    if scene.drag > 0 or any(scene.damping_law.coefficients[1:]):
        raise UnsupportedError(
            "a portable export has no drag, and damping in proportion to the slip rate only: MuJoCo 3.3 knows no other"
        )
    spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    for pair in spec.pairs:
        # With 0.9999 and 100, as in models for MuJoCo 4, its error is a tenth in double precision, but in single
        # precision, as in mujoco_warp, the solver then ends with NaN.
        pair.solimp[:2], spec.option.impratio = 0.999, 10.0
    for equality in spec.equalities if scene.can.radius < 1.0 else ():
        equality.name1, equality.name2, equality.data[1] = equality.name2, equality.name1, 1 / scene.can.radius


def _portable(text: str, model: mujoco.MjModel) -> str:
    """Return MJCF as MuJoCo 4 writes it, without what MuJoCo 3.3 and dm_control do not know."""
    root = ET.fromstring(text, ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))
    for texture in root.iter("texture"):
        if texture.get("colorspace") == "auto":  # what a texture without it has
            del texture.attrib["colorspace"]
    for light in root.iter("light"):
        if light.get("type") == "directional":
            del light.attrib["type"]
            light.set("directional", "true")
    for parent in list(root.iter()):  # dm_control does not know frames, such as that of a fused body
        for place, frame in reversed(list(enumerate(parent))):
            if frame.tag == "frame":
                for element in frame:
                    there = getattr(model, element.tag)(element.get("name"))
                    for name in ("pos", "quat"):
                        element.set(name, " ".join(repr(float(each)) for each in getattr(there, name)))
                parent[place : place + 1] = frame
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"
