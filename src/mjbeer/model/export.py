"""Writes a scene as one stand-alone MJCF file, with all digits of every number and with mjbeer's meshes inside."""

import os
import pathlib

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.model import portable as portability
from mjbeer.model import same, setting
from mjbeer.model.engine import library
from mjbeer.model.present import present
from mjbeer.output import files
from mjbeer.theory.scene import Scene

_DIGITS = 17
"""Decimal digits from which a double can be read back exactly."""


def export(
    scene: Scene,
    path: str | os.PathLike[str],
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    rolling: setting.Rolling = "reduced",
    integrator: setting.Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = setting.FRICTION,
    portable: bool = False,
) -> None:
    """Write a scene as one MJCF file, with everything drawn, with sensors, and with its start as the keyframe "start".

    The parameters are those of `simulate`, but the integrator must be one of MuJoCo's, and the file's name must end in
    .xml. The text is read back before it is written, and must give the same model. A reduced model of a frozen load
    turns on the spot, because its one coordinate is phi.

    With `portable`, MuJoCo 3.3.1, MJX, mujoco_warp and dm_control load the file too. The integrator must then be one of
    `portable.INTEGRATORS`, the scene must have no drag and no damping but in proportion to a rate, and a contact is
    softer: docs/portability.md has the errors.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model, or cannot write all digits.
      OutputError: if the file cannot be written.
      MjbeerError: if the text does not give the same model.
    """
    require.instance("scene", scene, Scene)
    target, (phi0, phi_dot0) = require.path(path), require.start(phi0, phi_dot0)
    if target.suffix != ".xml":  # MuJoCo takes a .urdf for URDF, and its MjSpec reads no .mjcf
        raise ParameterError(f"MJCF is written: the file's name must end in .xml, got {require.shown(target.name)}")
    wanted = setting.Setting(rolling, integrator, timestep, friction=friction)
    if wanted.integrator in setting.OWN:
        raise UnsupportedError(
            f"{wanted.integrator} is mjbeer's integrator, not MuJoCo's; export with one of "
            f"{', '.join(setting.INTEGRATORS)}"
        )
    softness = setting.TUNED
    if require.boolean("portable", portable):
        portability.require_integrator(integrator)
        portability.require_linear(scene)
        softness = portability.softness(scene, rolling)
    made = setting.Setting(rolling, integrator, timestep, friction=friction, softness=softness)
    spec = present(scene, made, phi0=phi0, phi_dot0=phi_dot0)
    spec.comment = f" Written by mjbeer: rolling={rolling!r}, {scene!r} "  # replaces the template's
    folder = pathlib.Path(spec.modelfiledir).resolve()
    # A template with files of its own needs their folders; mjbeer's meshes are in the file.
    spec.meshdir = str(folder / spec.meshdir) if any(mesh.file for mesh in spec.meshes) else ""
    spec.texturedir = str(folder / spec.texturedir) if any(texture.file for texture in spec.textures) else ""
    built = spec.compile()
    text = _text(spec)
    reread = mujoco.MjModel.from_xml_string(text)
    same.require_same(built, reread)
    if portable:
        text = portability.rewrite(text)
        same.require_same_motion(reread, mujoco.MjModel.from_xml_string(text))
    files.write(target, text)


def _text(spec: mujoco.MjSpec) -> str:
    """Return the specification as XML with `_DIGITS` digits, where MuJoCo by default writes 6."""
    c = library()
    try:
        before, set_digits = c._mjPRIVATE__get_xml_precision(), c._mjPRIVATE__set_xml_precision
    except AttributeError:
        raise UnsupportedError(f"MuJoCo {mujoco.__version__} cannot write MJCF with all digits; 4.0 can") from None
    set_digits(_DIGITS)
    try:
        return spec.to_xml()
    finally:
        set_digits(before)
