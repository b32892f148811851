"""Builds the MuJoCo model of a scene, for each of three ways of rolling.

A model that is only stepped is a skeleton: joints, masses, forces and what touches. One that is seen has the template's
looks too. Both get their elements from `_add`, and their numbers from `numbers.write`.

- "reduced" has no constraint: its coordinates allow no other motion than rolling without slipping. The can's rotation
  follows from u, or from phi, and its inertia is added to theirs. There is no error but the integrator's.
- "equality" and "contact" leave it to MuJoCo's constraint solver to make the can roll. Its constraints are soft; here
  they are made as hard as is stable under the integrator.
"""

import copy
import inspect
import math
import threading
import warnings

import mujoco

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.model import check, looks, numbers, state
from mjbeer.model import free as free_cans
from mjbeer.model.engine import quiet
from mjbeer.model.numbers import Kind, Numbers
from mjbeer.model.setting import FRICTION, Integrator, Rolling, Setting
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

START = "start"
"""The name of the keyframe."""
_JOINTS = {
    "slide": ("can", mujoco.mjtJoint.mjJNT_SLIDE, (1, 0, 0)),  # u, positive downhill
    "lift": ("can", mujoco.mjtJoint.mjJNT_SLIDE, (0, 0, 1)),  # positive away from the incline
    "roll": ("can", mujoco.mjtJoint.mjJNT_HINGE, (0, 1, 0)),
    "swing": ("load", mujoco.mjtJoint.mjJNT_HINGE, (0, 1, 0)),  # the load's angle relative to the can
    "phi": ("can", mujoco.mjtJoint.mjJNT_HINGE, (0, 1, 0)),  # the load's angle, in a model of one body
}
"""Body, type and axis of each joint."""
_TURNED = [math.sqrt(0.5), 0, math.sqrt(0.5), 0]
"""Orientation of every inertial frame: a quarter turn about the axis, in which the inertia is the same. If the frame
were parallel to the body's, MuJoCo would move a centre of mass within 1e-6 m of the origin to the origin."""
_DISABLE, _ENABLE = mujoco.mjtDisableBit, mujoco.mjtEnableBit
_SINGULAR = "Inertia matrix is too close to singular"
"""What MuJoCo warns of, and goes on, when masses and inertias are too unequal for it to compute accelerations."""
_skeletons: dict[Kind, mujoco.MjModel] = {}
"""The skeleton of each kind, with the numbers of the scene that came first."""
_compiling = threading.RLock()
"""Warnings are caught by the whole process, and so by one thread at a time."""


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
) -> mujoco.MjModel:
    """Return a compiled MuJoCo model of a scene, whose keyframe "start" is at `phi0` [rad], `phi_dot0` [rad/s].

    `rolling` is "reduced" (no constraint: the coordinates allow no other motion), "equality" (a joint equality
    u = a roll) or "contact" (a cylinder on a plane, with a `friction` coefficient). Constraints are as hard as
    `integrator` and `timestep` [s] allow; a softer one is an edit of what `specify` returns.

    With `visuals` the incline is tilted and gravity is upright. Without them gravity is tilted instead: x is downhill
    and z away from the incline, and `model.opt.gravity` is g (sin alpha, 0, -cos alpha). That model has no geoms but
    those in contact, and the stages of a step that it does not need are disabled. Begin a loop of your own with
    `mjbeer.reset`: a new MjData is at zero coordinates, where a can in contact hardly touches.

    The joints are "slide" (u), "lift" (contact only), "roll" and, for a sliding load, "swing" relative to
    the can; a reduced model has "slide" and "phi", or "phi" alone for a frozen load. In a scene so light that
    MuJoCo's smallest mass would matter, all masses are multiplied by the same power of two, which does not
    change the motion; so they are in a reduced model with damping under "discrete", which would not see small forces.

    A `standing` can stands on a floor, on a free joint; without `free` it is held by the world. It has no other
    parameters than `visuals`, `integrator` and `timestep`, and a free joint only a standing can may have.

    Raises:
      ParameterError: if a name is unknown or a number is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model, as for a massless can around a sliding load.
      TemplateError: if a template is missing, lacks a part, or moves otherwise than the scene.
    """
    if isinstance(scene, Standing):
        refuse_others(rolling=rolling, friction=friction, phi0=phi0, phi_dot0=phi_dot0)
        return compile_spec(free_cans.compose(scene, visuals, free, integrator, timestep))
    refuse_held(scene, free)
    visuals, (phi0, phi_dot0) = require.boolean("visuals", visuals), require.start(phi0, phi_dot0)
    setting = Setting(rolling=rolling, integrator=integrator, timestep=timestep, friction=friction)
    spec = compose(scene, setting, visuals)
    add_start(spec, scene, phi0, phi_dot0)
    model = compile_spec(spec, rigid=setting.rigid)
    if visuals:
        check.require_theory(model, scene, setting)
    return model


def specify(
    scene: Scene | Standing,
    rolling: Rolling = "reduced",
    visuals: bool = False,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    free: bool = True,
) -> mujoco.MjSpec:
    """Return the specification of the model that `build` compiles, to be edited or attached to another one.

    The parameters and the errors are those of `build`. The can is the body "can", in the body "incline". A joint
    equality is as stiff as MJCF can express, which `build` makes rigid in the compiled model. Attached to another
    specification, bodies keep their joints, masses and geoms, and lose all options: `mjcf/README.md` lists those that
    the parent needs.
    """
    if isinstance(scene, Standing):
        refuse_others(rolling=rolling, friction=friction)
        return free_cans.compose(scene, visuals, free, integrator, timestep)
    refuse_held(scene, free)
    visuals = require.boolean("visuals", visuals)
    setting = Setting(rolling=rolling, integrator=integrator, timestep=timestep, friction=friction)
    spec = compose(scene, setting, visuals)
    if visuals:
        check.require_theory(compile_spec(spec), scene, setting)
    return spec


def refuse_others(**given: object) -> None:
    """Refuse what is said of a standing can that has a meaning for a can that rolls on an incline only.

    Raises:
      ParameterError: if something is not the default.
    """
    defaults = {name: each.default for name, each in inspect.signature(build).parameters.items()}
    for name, value in given.items():
        if value != defaults[name]:
            raise ParameterError(f"a standing can has no {name}, got {require.shown(value)}")


def refuse_held(scene: Scene, free: bool) -> None:
    """Check that what is no standing can is a scene, and that it is not to be held: its can always rolls.

    Raises:
      ParameterError: if not.
    """
    require.instance("scene", scene, Scene)
    if not require.boolean("free", free):
        raise ParameterError("only a standing can is held by free=False: the can of a scene rolls")


def compose(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """Return the specification of a scene in a setting, with the errors of `build`; its motion is not checked yet."""
    made = Numbers.of(scene, setting, visuals)
    if visuals:
        spec = looks.dressed(scene)
        for element, angle in ((spec.body("incline"), scene.incline), (spec.frame("level"), -scene.incline)):
            element.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
            element.quat = [math.cos(angle / 2), 0, math.sin(angle / 2), 0]
        if "slide" in made.joints and "roll" not in made.joints:  # nothing turns with the can, but these with the load
            for geom in filter(None, map(spec.geom, looks.TURNING)):
                spec.delete(geom)
    else:
        spec = mujoco.MjSpec()
        can = spec.worldbody.add_body(name="incline").add_body(name="can")
        if "load" in made.bodies:
            can.add_body(name="load")
        for stage in _unused(made):
            spec.option.disableflags |= int(_DISABLE.__members__[f"mjDSBL_{stage}"])
    # With the axis at the origin, an offset far smaller than the radius keeps its digits. Only a can that is seen, or
    # in contact, must lie on the incline.
    spec.compiler.fusestatic = not visuals
    spec.body("can").pos = [0, 0, scene.can.radius if visuals else 0.0]
    _add(spec, made)
    numbers.write(made, spec)
    return spec


def add_start(spec: mujoco.MjSpec, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Add the keyframe "start" to a specification that has nothing but a scene's joints."""
    qpos, qvel = state.at([joint.name for joint in spec.joints], scene, phi0, phi_dot0)
    spec.add_key(name=START, qpos=qpos, qvel=qvel)


def compile_spec(spec: mujoco.MjSpec, rigid: bool = False) -> mujoco.MjModel:
    """Return the model that a specification compiles to, in which a joint equality is made `rigid` if asked for.

    Raises:
      UnsupportedError: if MuJoCo refuses the scene's numbers or an element of the template.
    """
    with _compiling, warnings.catch_warnings():
        warnings.filterwarnings("error", _SINGULAR)
        try:
            model = spec.compile()
        except (ValueError, UserWarning) as error:
            raise _refused("; ".join(str(error).splitlines())) from error
    if rigid:
        _make_rigid(model)
    return model


class Stepped:
    """A model to be stepped, and its data, for one thread at a time; scenes of its kind are written into it in place.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """

    def __init__(self, made: Numbers) -> None:
        with _compiling:
            if (skeleton := _skeletons.get(made.kind)) is None:
                skeleton = compile_spec(compose(made.scene, made.setting), made.setting.rigid)
                _skeletons[made.kind] = skeleton
        self.model = copy.copy(skeleton)
        self.data = mujoco.MjData(self.model)
        self._made: Numbers | None = None
        self.write(made)

    def write(self, made: Numbers) -> None:
        """Write numbers of the same kind into the model, if they are new, and reset the data: with the same errors."""
        model, data = self.model, self.data
        if made == self._made:
            mujoco.mj_resetData(model, data)
            return
        self._made = None  # until all of it is written
        numbers.write(made, model)
        data.warning.number[:] = 0  # of the scene before
        with quiet():
            mujoco.mj_setConst(model, data)
        if made.setting.rolling != "reduced":
            model.stat.meaninertia = model.dof_M0.mean()  # scales the solver's tolerance
        if made.setting.rigid:
            _make_rigid(model)
        if min(min(body.mass, body.inertia) for body in made.bodies.values()) < mujoco.mjMINVAL:
            raise _refused("mass and inertia of moving bodies must be larger than mjMINVAL")
        if data.warning[mujoco.mjtWarning.mjWARN_INERTIA].number:
            raise _refused(_SINGULAR)
        mujoco.mj_resetData(model, data)
        self._made = made


def _make_rigid(model: mujoco.MjModel) -> None:
    """Change a compiled model so that MuJoCo solves its joint equality exactly, which MJCF cannot express.

    A row's softness is proportional to the inverse inertia that the compiled model stores for its joints, which is used
    for nothing else here, and so is set to 0. One sweep of PGS then solves the single row, where Newton would add a
    nearly infinite stiffness to the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(_ENABLE.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations, model.opt.tolerance = 1, 0.0


def _refused(reason: str) -> UnsupportedError:
    return UnsupportedError(f"MuJoCo cannot represent this scene: {reason}")


def _unused(made: Numbers) -> tuple[str, ...]:
    """Return the stages of a step that a kind of model does not need. Autoreset would hide a divergence."""
    never = ("AUTORESET", "CLAMPCTRL", "FRICTIONLOSS", "ISLAND", "LIMIT", "MIDPHASE", "SENSOR", "SPRING")
    constraint = {"reduced": ("CONSTRAINT", "CONTACT", "EQUALITY", "WARMSTART"), "equality": ("CONTACT",)}
    forces = (*(() if made.scene.dissipates else ("DAMPER",)), *(() if made.force else ("ACTUATION",)))
    return (*never, *forces, *constraint.get(made.setting.rolling, ()))


def _add(spec: mujoco.MjSpec, made: Numbers) -> None:
    """Add the elements of a kind to the bodies "incline", "can" and "load", without their numbers."""
    for body in filter(None, map(spec.body, ("can", "load"))):
        body.explicitinertial, body.iquat = True, _TURNED  # its masses are its own, not those of its geoms
        body.mass, body.inertia = 0.0, [0.0] * 3  # a load that is part of the can has none
    for name in made.joints:  # the order matters in one body: a slide that came after a hinge would turn with it
        body, type_, axis = _JOINTS[name]
        spec.body(body).add_joint(spec.default, name=name, type=type_, axis=axis)
    if made.force:
        joint, bias = mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtBias.mjBIAS_AFFINE
        weight = spec.add_actuator(name="weight", target=made.joints[0], trntype=joint, biastype=bias)
        weight.gainprm[0] = 0.0
    if made.chord:
        can = spec.body("can")
        top = [0, 0, float(can.pos[2]) + numbers.ARM]
        spec.body("incline").add_site(spec.default, name="chord_top", pos=top, group=4)
        can.add_site(spec.default, name="chord_end", pos=[0, 0, -numbers.ARM], group=4)
        chord = spec.add_tendon(name="chord", rgba=[0, 0, 0, 0])
        chord.wrap_site("chord_top")
        chord.wrap_site("chord_end")
    if made.scene.damping_law and made.setting.rolling == "reduced":
        # The length of this tendon, phi - u/a, is the angle by which the load is ahead of the can. Its damping is the
        # torque between them, though the can has no joint: the torque on the can, over its radius, acts on the slide.
        spec.add_tendon(name="damper").wrap_joint("phi", 1.0)  # the slide follows with its number
    if made.setting.rolling != "reduced":
        _add_constraint(spec, made.setting)


def _add_constraint(spec: mujoco.MjSpec, setting: Setting) -> None:
    """Add a joint equality, or two massless geoms that collide as a pair and with nothing else."""
    # MuJoCo's default diagonal adds the inverse inertias of slide and hinge without regard to metres and radians.
    spec.option.enableflags |= int(_ENABLE.mjENBL_DIAGEXACT)
    spec.option.disableflags |= int(_DISABLE.mjDSBL_REFSAFE)
    if setting.rolling == "equality":
        spec.add_equality(name="rolling", type=mujoco.mjtEq.mjEQ_JOINT, name1="slide", name2="roll")
        return
    plane, cylinder = mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_CYLINDER
    surface = spec.body("incline").add_geom(spec.default, name="surface", type=plane, size=[0, 0, 1])
    can = spec.body("can").add_geom(spec.default, name="can", type=cylinder, size=[1, 1, 0])
    can.quat = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    collision = spec.find_default("collision")
    for geom in (surface, can):
        geom.contype, geom.conaffinity, geom.mass = 0, 0, 0.0
        if collision is not None:
            geom.group, geom.rgba = collision.geom.group, collision.geom.rgba
    spec.add_pair(name="rolling", geomname1="surface", geomname2="can", condim=3)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
