"""Builds the MuJoCo model of a scene, for each of three ways of rolling.

The numbers of the scene are written into an MJCF file. A model that is only stepped contains
joints, masses, forces and contact geoms. A model that is drawn has looks too.
"""

import copy
import os
import threading
import warnings

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError, UntrustedWarning
from mjbeer.model import check, looks, mjcf_file
from mjbeer.model.compiled_numbers import Views, write_compiled
from mjbeer.model.free import standing_spec
from mjbeer.model.joints import initial_joints
from mjbeer.model.model_numbers import ModelNumbers, Structure
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import FRICTION, Integrator, Rolling, Setting
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

START = "start"
"""The name of the keyframe."""
_INERTIA_WARNING = int(mujoco.mjtWarning.mjWARN_INERTIA)
_compiled_models: dict[Structure, mujoco.MjModel] = {}
"""The compiled model of each structure, with the numbers of the scene that came first."""
_compiling = threading.Lock()


def build(
    scene: Scene | Standing,
    rolling: Rolling = "reduced",
    visuals: bool = False,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    free: bool = True,
    mjcf: str | os.PathLike[str] | None = None,
) -> mujoco.MjModel:
    """Return a compiled MuJoCo model of a scene.

    Its keyframe "start" is at `phi0` [rad] with `phi_dot0` [rad/s].

    `rolling` is "reduced" (no constraint: the coordinates allow no other motion), "equality" (a
    joint equality roll = u/a) or "contact" (a cylinder on a plane, with a `friction` coefficient).
    Constraints are as hard as `integrator` and `timestep` [s] allow; for a softer one edit what
    `specify` returns.

    With `visuals` the incline is tilted and gravity is upright. Without them gravity is tilted
    instead: x is downhill and z away from the incline. That model has no geoms but those in
    contact, and the stages of a step that it does not need are disabled. Begin your own loop with
    `mjbeer.reset`: in a new MjData a can in contact hardly touches.

    The joints are "slide" (u), "lift" (contact only), "roll" and, for a sliding load, "swing"
    relative to the can; a reduced model has "slide" and "phi", or "phi" alone for a frozen load.
    With damping it has "implicitfast" instead of "discrete": their steps are the same here, but
    "discrete" treats small forces as zero.

    A `standing` can stands on a floor, on a free joint; with `free=False`, which no other can has,
    the world holds it. It has no `rolling`, `friction`, `phi0` and `phi_dot0`.

    `mjcf` is a folder that is read instead of mjbeer's own; without it, that of the environment
    variable MJBEER_MJCF counts. Everything except the parameters in its README is used unchanged.
    If the model's accelerations then differ from theory, an `UntrustedWarning` gives the file and
    the largest difference.

    Raises:
      ParameterError: if a name is unknown, or a number is invalid.
      UnsupportedError: if MuJoCo cannot represent such a model, as for a massless can around a sliding
        load.
      TemplateError: if a file of MJCF is missing, or lacks an element into which a number is
        written.
    """
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    spec = can_spec(scene, setting, visuals, free, phi0, phi_dot0)
    if isinstance(scene, Standing):
        return mjcf_file.compile_spec(spec)
    add_start(spec, scene, phi0, phi_dot0)
    model = mjcf_file.compile_spec(spec)
    if setting.rolling == "equality":
        _make_rigid(model)
    _warn_of_edits(model if visuals else None, scene, setting)
    return model


def specify(
    scene: Scene | Standing,
    rolling: Rolling = "reduced",
    visuals: bool = False,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    free: bool = True,
    mjcf: str | os.PathLike[str] | None = None,
) -> mujoco.MjSpec:
    """Return the specification of the model that `build` compiles, to edit it or to attach it.

    The parameters and the errors are those of `build`. The can is the body "can", in the body
    "incline". A joint equality is as stiff as MJCF can express, which `build` makes rigid in the
    compiled model. Attached to another specification, bodies keep their joints, masses and geoms,
    and lose all options: the parent needs the same ones.
    """
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    spec = can_spec(scene, setting, visuals, free)
    if isinstance(scene, Scene):
        _warn_of_edits(mjcf_file.compile_spec(spec.copy()) if visuals else None, scene, setting)
    return spec


def can_spec(
    can: Scene | Standing,
    setting: Setting,
    visuals: bool,
    free: bool,
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
) -> mujoco.MjSpec:
    """Return the specification of any can; refuse parameters that it does not have."""
    visuals = require.choice("visuals", visuals, (True, False))
    free = require.choice("free", free, (True, False))
    if isinstance(can, Standing):
        _refuse_rolling(setting, phi0, phi_dot0)
        return standing_spec(can, setting, visuals, free)
    require.instance("scene", can, Scene)
    if not free:
        raise ParameterError("only a standing can is held by free=False: the can of a scene rolls")
    return rolling_spec(can, setting, visuals)


def _refuse_rolling(setting: Setting, phi0: float, phi_dot0: float) -> None:
    """Refuse the parameters that a standing can does not have."""
    given = {
        "rolling": setting.rolling,
        "friction": setting.friction,
        "phi0": phi0,
        "phi_dot0": phi_dot0,
    }
    defaults = {"rolling": Setting.rolling, "friction": FRICTION, "phi0": 0.0, "phi_dot0": 0.0}
    if given != defaults:
        raise ParameterError(f"a standing can does not roll: it has none of {', '.join(given)}, got {given}")


def _warn_of_edits(drawn: mujoco.MjModel | None, scene: Scene, setting: Setting) -> None:
    """Warn the caller of `build` or `specify` if a file or a drawn model differs from theory."""
    fault = check_both(scene, setting, drawn)
    if fault is not None:
        warnings.warn(f"{fault}; the model is as the file has it", UntrustedWarning, stacklevel=3)


def check_both(scene: Scene, setting: Setting, drawn: mujoco.MjModel | None = None) -> str | None:
    """Return what is wrong with a scene's mechanics file or drawn model, None if nothing is."""
    fault = check.check_file(setting.folder, scene.attachment, setting.rolling)
    if fault is not None or drawn is None:
        return fault
    fault = check.check_model(drawn, scene, setting)
    if fault is not None:
        return f"{setting.folder / 'looks'}, in {looks.name(scene)}, {fault}"
    return None


def rolling_spec(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """Return the specification of a scene in a setting, with looks if `visuals` is True.

    Without looks it lacks everything that is only drawn or measured, or exerts no force. A file
    whose accelerations differ from theory is left whole.
    """
    numbers = ModelNumbers(scene, setting, visuals)
    root = mjcf_file.read(numbers.path)
    mjcf_file.write(root, numbers.parameters, numbers.path)
    mjcf_file.remove(root, "keyframe")  # It is that of the file's own scene.
    if visuals:
        return looks.drawn_spec(root, numbers.path, scene)
    if check.check_file(setting.folder, scene.attachment, setting.rolling) is None:
        mjcf_file.remove_unused(root, numbers.acting, scene.dissipates)
    return mjcf_file.parse_spec(root, numbers.path)


def add_start(spec: mujoco.MjSpec, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Add the keyframe "start" to a specification that has no joints but a scene's."""
    names = [joint.name for joint in spec.joints]
    qpos, qvel = initial_joints(names, scene, phi0, phi_dot0)
    spec.add_key(name=START, qpos=qpos, qvel=qvel)


def compiled_model(numbers: ModelNumbers) -> mujoco.MjModel:
    """Return a new model to be stepped, into which `write_numbers` then writes its numbers.

    Each structure is compiled once a process. The content of the mechanics file is part of the
    structure, so that an edited file is compiled anew.

    Raises:
      TemplateError: if the mechanics file is missing, lacks an element, or has other accelerations
        than theory.
    """
    with _compiling:
        if numbers.structure not in _compiled_models:
            _compiled_models[numbers.structure] = _compile_structure(numbers)
        return copy.copy(_compiled_models[numbers.structure])


def _compile_structure(numbers: ModelNumbers) -> mujoco.MjModel:
    """Return the compiled model of a scene, to be stepped."""
    fault = check_both(numbers.scene, numbers.setting)
    if fault is not None:
        raise TemplateError(fault)
    model = mjcf_file.compile_spec(rolling_spec(numbers.scene, numbers.setting))
    if numbers.setting.rolling == "equality":
        _make_rigid(model)
    return model


def write_numbers(model: mujoco.MjModel, data: mujoco.MjData, numbers: ModelNumbers, views: Views) -> None:
    """Write the numbers of a scene into a model of its structure, and reset the data.

    `views` are the model's `compiled_views`.

    Raises:
      UnsupportedError: if MuJoCo cannot represent such a model.
    """
    write_compiled(model, numbers.parameters, views)
    data.warning.number[:] = 0  # It may be that of the scene before.
    with quiet():
        mujoco.mj_setConst(model, data)
    if numbers.setting.rolling != "reduced":
        model.stat.meaninertia = model.dof_M0.mean()  # It scales the solver's tolerance.
    if numbers.setting.rolling == "equality":
        _make_rigid(model)
    if any(min(body.mass, body.inertia) < mujoco.mjMINVAL for body in numbers.bodies.values()):
        raise mjcf_file.refused("mass and inertia of moving bodies must be larger than mjMINVAL")
    if data.warning.number[_INERTIA_WARNING]:
        raise mjcf_file.refused("masses and inertias are too unequal for it to compute accelerations")
    mujoco.mj_resetData(model, data)


def _make_rigid(model: mujoco.MjModel) -> None:
    """Make MuJoCo solve the joint equality of a compiled model exactly, which MJCF cannot express.

    A row's softness is proportional to the inverse inertia that the compiled model stores for its
    joints, which is used for nothing else here, and so is set to 0. One sweep of PGS then solves
    the single row, where Newton would add a nearly infinite stiffness to the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations = 1
    model.opt.tolerance = 0.0
