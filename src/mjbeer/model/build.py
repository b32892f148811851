"""Builds the MuJoCo model of a scene, for each of three ways of rolling, from an MJCF template."""

import math
import threading
import warnings

import mujoco

from mjbeer import require
from mjbeer.exceptions import UnsupportedError
from mjbeer.model import appearance, constrained, mechanics, reduced, templates
from mjbeer.model.inertia import mass_unit
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.setting import DOP853, FRICTION, GAUSS_JACKSON, TUNED, Integrator, Rolling, Setting, Softness
from mjbeer.theory.scene import Scene

_INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    DOP853: mujoco.mjtIntegrator.mjINT_RK4,  # not used: mjbeer's own integrators step by themselves
    GAUSS_JACKSON: mujoco.mjtIntegrator.mjINT_RK4,
}
_DISABLE = mujoco.mjtDisableBit
# No scene needs these stages. Autoreset must go: it would hide a divergence by starting again.
_UNUSED = (
    _DISABLE.mjDSBL_AUTORESET
    | _DISABLE.mjDSBL_CLAMPCTRL
    | _DISABLE.mjDSBL_FRICTIONLOSS
    | _DISABLE.mjDSBL_ISLAND
    | _DISABLE.mjDSBL_LIMIT
    | _DISABLE.mjDSBL_MIDPHASE
    | _DISABLE.mjDSBL_SENSOR
    | _DISABLE.mjDSBL_SPRING
)
_HEAVY = 2.0**60
"""Factor of all masses where "discrete" meets the damping of a tendon. It then iterates for the acceleration, and takes
forces below 3e-8 [N, N m] for none: at its true mass, a load that is let go 1e-6 rad beside the top would stay there
for ever."""
_SINGULAR = "Inertia matrix is too close to singular"
"""What MuJoCo warns of, and goes on, when masses and inertias are too unequal for it to compute accelerations."""
_compiling = threading.Lock()
"""Warnings are caught by the whole process, and so by one thread at a time."""
_UNCONSTRAINED = (
    _DISABLE.mjDSBL_CONSTRAINT | _DISABLE.mjDSBL_CONTACT | _DISABLE.mjDSBL_EQUALITY | _DISABLE.mjDSBL_WARMSTART
)


def build(
    scene: Scene,
    rolling: Rolling = "reduced",
    visuals: bool = False,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    softness: Softness = TUNED,
) -> mujoco.MjModel:
    """Return a compiled MuJoCo model of a scene.

    `rolling` is "reduced" (no constraint: the coordinates allow no other motion), "equality" (a joint equality
    u = a roll) or "contact" (a cylinder on a plane, with a `friction` coefficient). Constraints are as hard as
    `integrator` and `timestep` [s] allow, except where `softness` says otherwise. Without `visuals` the model has no
    geoms but those in contact, and the stages of a step that it does not need are disabled.

    The joints are "slide" (u), "lift" (contact only), "roll" and, for a sliding load, "swing" relative to
    the can; a reduced model has "slide" and "phi", or "phi" alone for a frozen load. In a scene so light that
    MuJoCo's smallest mass would matter, all masses are multiplied by the same power of two, which does not
    change the motion; so they are in a reduced model with damping under "discrete", which would not see small forces.

    Raises:
      ParameterError: if a name is unknown or a number is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model, as for a massless can around a sliding load.
      TemplateError: if a template is missing, lacks a part, or has a part that is not allowed.
    """
    require.instance("scene", scene, Scene)
    visuals = require.boolean("visuals", visuals)
    setting = Setting(rolling=rolling, integrator=integrator, timestep=timestep, friction=friction, softness=softness)
    return compile_model(scene, setting, visuals)


def compile_model(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjModel:
    """Return the compiled model of a scene in a setting, with the same errors as `build`."""
    return finish(compose(scene, setting, visuals), setting)


def finish(spec: mujoco.MjSpec, setting: Setting) -> mujoco.MjModel:
    """Return the model that a specification in a setting compiles to, with its joint equality made rigid."""
    model = compile_spec(spec)
    if constrained.is_rigid(setting):
        constrained.make_rigid(model)
    return model


def compile_spec(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return the model that a specification compiles to.

    Raises:
      UnsupportedError: if MuJoCo refuses the scene's numbers or an element of the template.
    """
    with _compiling, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            model = spec.compile()
        except ValueError as error:
            reason = "; ".join(str(error).splitlines())
            raise UnsupportedError(f"MuJoCo cannot represent this scene: {reason}") from error
    for warning in caught:
        if _SINGULAR in str(warning.message):
            raise UnsupportedError(f"MuJoCo cannot represent this scene: {warning.message}")
        warnings.warn(warning.message, stacklevel=2)
    return model


def specify(
    scene: Scene,
    rolling: Rolling = "reduced",
    visuals: bool = False,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    softness: Softness = TUNED,
) -> mujoco.MjSpec:
    """Return the specification of the model that `build` compiles, to be edited or attached to another one.

    The parameters and the errors are those of `build`. The can is the body "can", in the body "incline". A joint
    equality is as stiff as MJCF can express, which `build` makes rigid in the compiled model. Attached to another
    specification, bodies keep their joints, masses and geoms, and lose all options: `mjcf/README.md` lists those that
    the parent needs.
    """
    require.instance("scene", scene, Scene)
    visuals = require.boolean("visuals", visuals)
    setting = Setting(rolling=rolling, integrator=integrator, timestep=timestep, friction=friction, softness=softness)
    return compose(scene, setting, visuals)


def compose(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """Return the specification that `compile_model` compiles, with the same errors as `build`."""
    spec, moving = templates.read(templates.name(scene)), mechanics_of(scene, setting, visuals)
    if visuals:
        appearance.dress(spec, scene)
    else:
        appearance.strip(spec)
    _tilt(spec, scene, visuals)
    # With the axis at the origin, an offset far smaller than the radius keeps its digits. Only a can that is seen, or
    # in contact, must lie on the incline.
    spec.body("can").pos = [0, 0, scene.can.radius if visuals else 0.0]
    if setting.rolling == "reduced":
        reduced.add(spec, moving)
    elif setting.rolling == "equality":
        constrained.add_equality(spec, moving, setting)
    else:
        constrained.add_contact(spec, moving, setting)
    fit(spec, scene, setting, moving)
    if visuals:
        spec.option.gravity = [0, 0, -scene.gravity]
    else:
        _disable_unused(spec, setting.rolling, moving)
    return spec


def mechanics_of(scene: Scene, setting: Setting, visuals: bool = False) -> Mechanics:
    """Return the joints, masses and forces of the model of a scene in a setting; one with visuals keeps its masses.

    Raises:
      UnsupportedError: if MuJoCo cannot move one of its bodies.
    """
    unit = mass_unit(scene)
    if setting.rolling == "reduced":
        if setting.integrator == "discrete" and scene.damping_law and not visuals:
            unit *= _HEAVY
        return reduced.mechanics(scene, unit)
    return constrained.mechanics(scene, unit, setting.rolling)


def fit(made: mujoco.MjSpec | mujoco.MjModel, scene: Scene, setting: Setting, moving: Mechanics) -> None:
    """Write all numbers of a scene in a setting into a specification without visuals, or the model compiled from it."""
    option = made.opt if isinstance(made, mujoco.MjModel) else made.option
    option.timestep, option.integrator = setting.timestep, int(_INTEGRATORS[setting.integrator])
    gravity, incline = scene.gravity, scene.incline
    option.gravity = [gravity * math.sin(incline), 0, -gravity * math.cos(incline)]
    mechanics.fit(made, moving)
    if setting.rolling == "equality":
        constrained.fit_equality(made, scene, setting)
    elif setting.rolling == "contact":
        constrained.fit_contact(made, scene, setting)


def _tilt(spec: mujoco.MjSpec, scene: Scene, visuals: bool) -> None:
    """Tilt the incline if it is to be seen; otherwise gravity is tilted, which is exact and needs no body."""
    tilt = scene.incline if visuals else 0.0
    for element, angle in ((spec.body("incline"), tilt), (spec.frame("level"), -tilt)):
        element.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
        element.quat = [math.cos(angle / 2), 0, math.sin(angle / 2), 0]
    spec.compiler.fusestatic = not visuals


def _disable_unused(spec: mujoco.MjSpec, rolling: str, moving: Mechanics) -> None:
    spec.option.disableflags |= int(_UNUSED)
    if not moving.dissipates:  # dampers stay where there is damping or drag
        spec.option.disableflags |= int(_DISABLE.mjDSBL_DAMPER)
    if rolling == "reduced":
        spec.option.disableflags |= int(_UNCONSTRAINED)
    if rolling == "equality":
        spec.option.disableflags |= int(_DISABLE.mjDSBL_CONTACT)
    if not spec.actuators:
        spec.option.disableflags |= int(_DISABLE.mjDSBL_ACTUATION)
