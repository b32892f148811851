"""Writes a scene as one stand-alone MJCF file, with all digits of every number and with mjbeer's meshes inside."""

import os
import pathlib

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, UnsupportedError
from mjbeer.model import setting
from mjbeer.model.engine import library
from mjbeer.model.present import present
from mjbeer.output import files
from mjbeer.theory.scene import Scene

_DIGITS = 17
"""Decimal digits from which a double can be read back exactly."""
_EXACT = (
    "body_mass", "body_inertia", "body_ipos", "body_iquat", "body_pos", "body_quat", "jnt_axis", "dof_armature",
    "tendon_armature", "actuator_gainprm", "actuator_biasprm", "eq_data", "eq_solref", "eq_solimp", "pair_friction",
    "pair_solref", "pair_solimp", "key_qpos", "key_qvel",
)  # fmt: skip
"""Arrays of the model that must be the same after reading the file back."""
_OPTIONS = ("timestep", "integrator", "gravity", "cone", "impratio", "enableflags", "disableflags")
"""Options of the model that must be the same after reading the file back."""
_LEFT_OUT = float(np.finfo(float).eps)
"""Largest difference that is allowed. MuJoCo does not write a number that is this near to its default, such as a force
of 1e-16 N. The numbers that it writes are read back to the last bit, except quaternions, which it normalizes again."""


def export(
    scene: Scene,
    path: str | os.PathLike[str],
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    rolling: setting.Rolling = "reduced",
    integrator: setting.Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = setting.FRICTION,
) -> None:
    """Write a scene as one MJCF file, with everything drawn, with sensors, and with its start as the keyframe "start".

    The parameters are those of `simulate`, but the integrator must be one of MuJoCo's. The text is read back before
    it is written, and must give the same model. A reduced model of a frozen load turns on the spot, because its one
    coordinate is phi.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model, or cannot write all digits.
      OutputError: if the file cannot be written.
      MjbeerError: if the text does not give the same model.
    """
    require.instance("scene", scene, Scene)
    target, (phi0, phi_dot0) = require.path(path), require.start(phi0, phi_dot0)
    wanted = setting.Setting(rolling, integrator, timestep, friction=friction)
    if wanted.integrator == setting.DOP853:
        raise UnsupportedError(
            f"DOP853 is mjbeer's integrator, not MuJoCo's; export with one of {', '.join(setting.INTEGRATORS)}"
        )
    spec = present(scene, wanted, phi0=phi0, phi_dot0=phi_dot0)
    spec.comment = f" Written by mjbeer: rolling={wanted.rolling!r}, {scene!r} "  # replaces the template's
    folder = pathlib.Path(spec.modelfiledir).resolve()
    # A template with files of its own needs their folders; mjbeer's meshes are in the file.
    spec.meshdir = str(folder / spec.meshdir) if any(mesh.file for mesh in spec.meshes) else ""
    spec.texturedir = str(folder / spec.texturedir) if any(texture.file for texture in spec.textures) else ""
    built = spec.compile()
    text = _text(spec)
    _compare(built, mujoco.MjModel.from_xml_string(text))
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


def _compare(built: mujoco.MjModel, reread: mujoco.MjModel) -> None:
    """Raise an MjbeerError if the model that was read back differs from the one that was built."""
    numbers = [(name, getattr(built, name), getattr(reread, name)) for name in _EXACT]
    options = [(f"option {name}", getattr(built.opt, name), getattr(reread.opt, name)) for name in _OPTIONS]
    for name, before, after in [*numbers, *options]:
        if np.shape(before) != np.shape(after) or not np.allclose(before, after, rtol=0, atol=_LEFT_OUT):
            raise MjbeerError(f"the MJCF written is not the model: {name} is {after}, not {before}")
