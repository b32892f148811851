"""Builds the MuJoCo model of a can, for you: `build` and `specify`.

The numbers of a scene are written into the MJCF file of its attachment and its way of rolling. A
model that is only stepped contains joints, masses, forces and contact geoms. A model that is drawn
has looks too.
"""

import os
import warnings

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, UntrustedWarning
from mjbeer.model import looks, mjcf_file
from mjbeer.model.check import check_drawn, check_file
from mjbeer.model.free import standing_spec
from mjbeer.model.joints import initial_joints
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import FRICTION, Integrator, Rolling, Setting
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

START = "start"
"""The name of the keyframe that a model of a scene has."""


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
    the largest difference. Your folder is read at every call, and mjbeer's own mechanics once.

    Raises:
      ParameterError: if a name is unknown, or a number is invalid.
      UnsupportedError: if MuJoCo cannot represent such a model, as for a massless can around a
        sliding load.
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
        make_rigid(model)
    _warn_of_edits(scene, setting, model if visuals else None)
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
        model = mjcf_file.compile_spec(spec.copy()) if visuals else None
        _warn_of_edits(scene, setting, model)
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
        names = ", ".join(given)
        raise ParameterError(f"a standing can does not roll: it has none of {names}, got {given}")


def _warn_of_edits(scene: Scene, setting: Setting, drawn: mujoco.MjModel | None) -> None:
    """Warn the caller of `build` or `specify` if a file, or a model that is drawn, is wrong."""
    fault = check_file(setting.folder, scene.attachment, setting.rolling)
    if fault is None and drawn is not None:
        fault = check_drawn(drawn, scene, setting)
    if fault is not None:
        warnings.warn(f"{fault}; the model is as the file has it", UntrustedWarning, stacklevel=3)


def rolling_spec(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """Return the specification of a scene in a setting, with looks if `visuals` is True.

    Without looks it lacks everything that is only drawn or measured, or exerts no force. But a file
    that is wrong keeps all it has, as any of it may be what makes the file wrong.
    """
    numbers = ModelNumbers(scene, setting, visuals)
    root = mjcf_file.read(numbers.path)
    mjcf_file.write(root, numbers.parameters, numbers.path)
    mjcf_file.remove(root, "keyframe")  # It is that of the file's own scene.
    if visuals:
        return looks.drawn_spec(root, numbers.path, scene)
    if check_file(setting.folder, scene.attachment, setting.rolling) is None:
        mjcf_file.remove_unused(root, numbers.acting, scene.dissipates)
    return mjcf_file.parse_spec(root, numbers.path)


def add_start(spec: mujoco.MjSpec, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Add the keyframe "start" to a specification that has no joints but a scene's."""
    names = [joint.name for joint in spec.joints]
    qpos, qvel = initial_joints(names, scene, phi0, phi_dot0)
    spec.add_key(name=START, qpos=qpos, qvel=qvel)


def make_rigid(model: mujoco.MjModel) -> None:
    """Make the joint equality of a compiled model rigid, which MJCF cannot express.

    A row's softness is proportional to the inverse inertia that the model stores for its joints.
    Nothing else uses that here, so it is set to 0. One sweep of the solver PGS then solves the
    single row exactly. The solver Newton would add a nearly infinite stiffness to the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations = 1
    model.opt.tolerance = 0.0
