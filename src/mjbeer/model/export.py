"""Stand-alone MJCF of a scene, for any MuJoCo: every number with all its digits, every mesh of mjbeer's inside."""

import os
import pathlib

import mujoco
import numpy as np

from mjbeer.exceptions import MjbeerError, UnsupportedError
from mjbeer.model import build, setting, state
from mjbeer.model.engine import library
from mjbeer.output import files
from mjbeer.theory.scene import Scene

_DIGITS = 17
"""Decimal digits that give a double back exactly."""
_EXACT = (
    "body_mass", "body_inertia", "body_ipos", "body_iquat", "body_pos", "body_quat", "jnt_axis", "dof_armature",
    "tendon_armature", "actuator_gainprm", "actuator_biasprm", "eq_data", "eq_solref", "eq_solimp", "pair_friction",
    "pair_solref", "pair_solimp", "key_qpos", "key_qvel",
)  # fmt: skip
_OPTIONS = ("timestep", "integrator", "gravity", "cone", "impratio", "enableflags", "disableflags")
_LEFT_OUT = float(np.finfo(float).eps)
"""MuJoCo does not write numbers that are this near to their default: forces of 1e-16 N. Those that it writes
are the same to the last bit, but for quaternions, which it normalizes once more."""


def export(
    scene: Scene,
    path: str | os.PathLike[str],
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    rolling: str = "reduced",
    integrator: str = "RK4",
    timestep: float = 1e-3,
    friction: float = setting.FRICTION,
) -> None:
    """Write a scene as one MJCF file, with its start as the keyframe "start".

    The parameters are those of `simulate`; the integrator is one of MuJoCo's. What was written is read back
    and must be the same model. A reduced model of a frozen load turns on the spot: its one coordinate is phi.

    Raises:
      ParameterError: on a parameter that is not allowed.
      UnsupportedError: if MuJoCo has no such model.
      OutputError: if the file cannot be written.
    """
    if integrator == setting.DOP853:
        raise UnsupportedError(
            f"DOP853 is mjbeer's integrator, not MuJoCo's; export with one of {', '.join(setting.INTEGRATORS)}"
        )
    spec = build.specify(scene, setting.Setting(rolling, integrator, timestep, friction=friction), visuals=True)
    spec.comment = f" Written by mjbeer: rolling={rolling!r}, {scene!r} "  # the template's is about another scene
    folder = pathlib.Path(spec.modelfiledir).resolve()
    # Only a template with further files of its own needs them: they are where they were.
    spec.meshdir = str(folder / spec.meshdir) if any(mesh.file for mesh in spec.meshes) else ""
    spec.texturedir = str(folder / spec.texturedir) if any(texture.file for texture in spec.textures) else ""
    built = build.compile_spec(spec)
    start = state.start(built, scene, phi0, phi_dot0)
    spec.add_key(name="start", qpos=start[: built.nq], qvel=start[built.nq :])
    built = spec.compile()
    text = _text(spec)
    _compare(built, mujoco.MjModel.from_xml_string(text))
    files.write(path, text)


def _text(spec: mujoco.MjSpec) -> str:
    """The specification as XML; MuJoCo writes 6 digits unless it is told."""
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
    numbers = [(name, getattr(built, name), getattr(reread, name)) for name in _EXACT]
    options = [(f"option {name}", getattr(built.opt, name), getattr(reread.opt, name)) for name in _OPTIONS]
    for name, one, other in [*numbers, *options]:
        if np.shape(one) != np.shape(other) or not np.allclose(one, other, rtol=0, atol=_LEFT_OUT):
            raise MjbeerError(f"the MJCF written is not the model: {name} is {other}, not {one}")
