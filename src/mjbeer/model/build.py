"""Builds the MuJoCo model of a scene, for each of three ways of rolling.

The numbers of the scene are written into an MJCF file. What is only stepped is a skeleton: joints, masses, forces and
what touches. What is seen has looks too.
"""

import copy
import os
import threading
import warnings

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError, UntrustedWarning
from mjbeer.model import check, looks, mjcf_file
from mjbeer.model.free import standing_spec
from mjbeer.model.joints import initial_joints
from mjbeer.model.mechanics import Mechanics, Structure
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import FRICTION, Integrator, Rolling, Setting
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

START = "start"
"""The name of the keyframe."""
_skeletons: dict[Structure, mujoco.MjModel] = {}
"""A compiled model of each structure, with the numbers of the scene that came first."""
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
    """Return a compiled MuJoCo model of a scene, whose keyframe "start" is at `phi0` [rad], `phi_dot0` [rad/s].

    `rolling` is "reduced" (no constraint: the coordinates allow no other motion), "equality" (a joint equality
    u = a roll) or "contact" (a cylinder on a plane, with a `friction` coefficient). Constraints are as hard as
    `integrator` and `timestep` [s] allow; a softer one is an edit of what `specify` returns.

    With `visuals` the incline is tilted and gravity is upright. Without them gravity is tilted instead: x is downhill
    and z away from the incline. That model has no geoms but those in contact, and the stages of a step that it does not
    need are disabled. Begin a loop of your own with `mjbeer.reset`: in a new MjData a can in contact hardly touches.

    The joints are "slide" (u), "lift" (contact only), "roll" and, for a sliding load, "swing" relative to the can; a
    reduced model has "slide" and "phi", or "phi" alone for a frozen load. With damping it has "implicitfast" instead of
    "discrete": their steps are the same here, but "discrete" takes small forces for none.

    A `standing` can stands on a floor, on a free joint; with `free=False`, which no other can has, the world holds it.
    It has no `rolling`, `friction`, `phi0` and `phi_dot0`.

    `mjcf` is a folder to be read instead of mjbeer's own; without it, that of the environment variable MJBEER_MJCF
    counts. All but the parameters that its README lists is in the model as it stands there. If it then moves otherwise
    than theory says, an `UntrustedWarning` has the file and the largest difference of accelerations.

    Raises:
      ParameterError: if a name is unknown or a number is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model, as for a massless can around a sliding load.
      TemplateError: if a file of MJCF is missing, or lacks an element into which a number is written.
    """
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    spec = specification(scene, setting, visuals, free, phi0, phi_dot0)
    if isinstance(scene, Standing):
        return compile_spec(spec)
    add_start(spec, scene, phi0, phi_dot0)
    model = compile_spec(spec, rigid=setting.rolling == "equality")
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
    """Return the specification of the model that `build` compiles, to be edited or attached to another one.

    The parameters and the errors are those of `build`. The can is the body "can", in the body "incline". A joint
    equality is as stiff as MJCF can express, which `build` makes rigid in the compiled model. Attached to another
    specification, bodies keep their joints, masses and geoms, and lose all options: the parent needs the same ones.
    """
    setting = Setting(rolling, integrator, timestep, friction=friction, mjcf=mjcf)
    spec = specification(scene, setting, visuals, free)
    if isinstance(scene, Scene):
        _warn_of_edits(compile_spec(spec.copy()) if visuals else None, scene, setting)
    return spec


def specification(
    scene: Scene | Standing, setting: Setting, visuals: bool, free: bool, phi0: float = 0.0, phi_dot0: float = 0.0
) -> mujoco.MjSpec:
    """Return the specification of a can in a setting, or refuse what has a meaning for the other kind of can only."""
    visuals, free = require.choice("visuals", visuals, (True, False)), require.choice("free", free, (True, False))
    if not isinstance(scene, Standing):
        require.instance("scene", scene, Scene)
        if not free:
            raise ParameterError("only a standing can is held by free=False: the can of a scene rolls")
        return rolling_spec(scene, setting, visuals)
    given = {"rolling": setting.rolling, "friction": setting.friction, "phi0": phi0, "phi_dot0": phi_dot0}
    if tuple(given.values()) != (Setting.rolling, FRICTION, 0.0, 0.0):
        raise ParameterError(f"a standing can does not roll: it has none of {', '.join(given)}, got {given}")
    return standing_spec(scene, setting, visuals, free)


def _warn_of_edits(seen: mujoco.MjModel | None, scene: Scene, setting: Setting) -> None:
    """Give a warning to whoever calls if the mechanics file, or a model with looks, does not move as theory says."""
    if fault := mechanics_fault(scene, setting, seen):
        warnings.warn(f"{fault}; the model is as the file has it", UntrustedWarning, stacklevel=3)


def mechanics_fault(scene: Scene, setting: Setting, seen: mujoco.MjModel | None = None) -> str | None:
    """Return what is wrong with the mechanics file of a scene, or with a model of it with looks; None if nothing is."""
    if fault := check.file_fault(setting.folder, scene.attachment, setting.rolling):
        return fault
    if seen is not None and (fault := check.model_fault(seen, scene, setting)):
        return f"{setting.folder / 'looks'}, in {looks.name(scene)}, {fault}"
    return None


def rolling_spec(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """Return the specification of a scene in a setting, from its mechanics file and, with `visuals`, from the looks.

    What is only stepped lacks what is only seen or measured, and what exerts no force. A file that does not move as
    theory says is left whole.
    """
    mechanics = Mechanics(scene, setting, visuals)
    path, root = mechanics.path, mjcf_file.read(mechanics.path)
    mjcf_file.write(root, mechanics.parameters, path)
    mjcf_file.remove(root, "keyframe")  # of the file's own scene
    if not visuals and check.file_fault(setting.folder, scene.attachment, setting.rolling) is None:
        mjcf_file.remove_unused(root, mechanics.acting, scene.dissipates)
    return looks.to_spec(root, path, scene, visuals)


def add_start(spec: mujoco.MjSpec, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Add the keyframe "start" to a specification that has nothing but a scene's joints."""
    qpos, qvel = initial_joints([joint.name for joint in spec.joints], scene, phi0, phi_dot0)
    spec.add_key(name=START, qpos=qpos, qvel=qvel)


def compile_spec(spec: mujoco.MjSpec, rigid: bool = False) -> mujoco.MjModel:
    """Return the model that a specification compiles to, in which a joint equality is made `rigid` if asked for."""
    model = mjcf_file.compile_spec(spec)
    if rigid:
        _make_rigid(model)
    return model


def compiled_model(mechanics: Mechanics) -> mujoco.MjModel:
    """Return a model to be stepped, of one's own, into which `write_numbers` then writes those of a scene.

    Raises:
      TemplateError: if the mechanics file is missing, lacks an element, or moves otherwise than theory says.
    """
    with _compiling:
        if (skeleton := _skeletons.get(mechanics.structure)) is None:
            if fault := mechanics_fault(mechanics.scene, mechanics.setting):
                raise TemplateError(fault)
            spec = rolling_spec(mechanics.scene, mechanics.setting)
            skeleton = _skeletons[mechanics.structure] = compile_spec(spec, mechanics.setting.rolling == "equality")
    return copy.copy(skeleton)


def write_numbers(model: mujoco.MjModel, data: mujoco.MjData, mechanics: Mechanics, where: mjcf_file.Views) -> None:
    """Write the numbers of a scene into a model of its structure, at its `compiled_views`, and reset the data.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """
    mjcf_file.write_compiled(model, mechanics.parameters, where)
    data.warning.number[:] = 0  # of the scene before
    with quiet():
        mujoco.mj_setConst(model, data)
    if mechanics.setting.rolling != "reduced":
        model.stat.meaninertia = model.dof_M0.mean()  # scales the solver's tolerance
    if mechanics.setting.rolling == "equality":
        _make_rigid(model)
    if min(min(body.mass, body.inertia) for body in mechanics.bodies.values()) < mujoco.mjMINVAL:
        raise mjcf_file.refused("mass and inertia of moving bodies must be larger than mjMINVAL")
    if data.warning[mujoco.mjtWarning.mjWARN_INERTIA].number:
        raise mjcf_file.refused("masses and inertias are too unequal for it to compute accelerations")
    mujoco.mj_resetData(model, data)


def _make_rigid(model: mujoco.MjModel) -> None:
    """Change a compiled model so that MuJoCo solves its joint equality exactly, which MJCF cannot express.

    A row's softness is proportional to the inverse inertia that the compiled model stores for its joints, which is used
    for nothing else here, and so is set to 0. One sweep of PGS then solves the single row, where Newton would add a
    nearly infinite stiffness to the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations, model.opt.tolerance = 1, 0.0
