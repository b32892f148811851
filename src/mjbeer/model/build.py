"""MuJoCo models of a scene, in three ways of rolling, made from the MJCF templates."""

import math

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import appearance, constrained, reduced, templates
from mjbeer.model.inertia import mass_unit
from mjbeer.model.setting import DOP853, FRICTION, TUNED, Setting, Softness
from mjbeer.theory.scene import Scene

_INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    DOP853: mujoco.mjtIntegrator.mjINT_RK4,  # it evaluates the model's forward dynamics, and steps by itself
}
_DISABLE = mujoco.mjtDisableBit
# What no scene needs. Autoreset must go: it would hide a divergence by starting again.
_UNUSED = (
    _DISABLE.mjDSBL_AUTORESET | _DISABLE.mjDSBL_CLAMPCTRL | _DISABLE.mjDSBL_DAMPER | _DISABLE.mjDSBL_FRICTIONLOSS
    | _DISABLE.mjDSBL_ISLAND | _DISABLE.mjDSBL_LIMIT | _DISABLE.mjDSBL_MIDPHASE | _DISABLE.mjDSBL_SENSOR
    | _DISABLE.mjDSBL_SPRING
)  # fmt: skip
_UNCONSTRAINED = (
    _DISABLE.mjDSBL_CONSTRAINT | _DISABLE.mjDSBL_CONTACT | _DISABLE.mjDSBL_EQUALITY | _DISABLE.mjDSBL_WARMSTART
)


def build(
    scene: Scene,
    rolling: str = "reduced",
    visuals: bool = False,
    integrator: str = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    softness: Softness = TUNED,
) -> mujoco.MjModel:
    """A compiled MuJoCo model of a scene.

    `rolling` is "reduced" (no constraint: the can's rotation is folded into the coordinates), "equality"
    (a joint equality u = a roll) or "contact" (a cylinder on a plane, with a `friction` coefficient).
    The constraints of the last two are tuned to `integrator` and `timestep` [s], but for what `softness` gives.
    Without `visuals` the model has no geoms but those of a contact, and the stages that it does not need are disabled.

    The joints are "slide" (u), "lift" (contact only), "roll" and, for a sliding load, "swing" relative to
    the can; a reduced model has "slide" and "phi", or "phi" alone for a frozen load. Where the scene is so
    light that MuJoCo's smallest mass would matter, all masses are multiplied by the same power of two,
    which changes no motion.

    Raises:
      ParameterError: on a name that does not exist or a number that is not allowed.
      UnsupportedError: if MuJoCo has no such model, as for a massless can around a sliding load.
      TemplateError: if a template is missing, lacks a part, or has one that is not allowed.
    """
    setting = Setting(rolling, integrator, timestep, friction=friction, softness=softness)
    return compile_model(scene, setting, visuals)


def compile_model(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjModel:
    """The model of a scene that is rolled and stepped in a setting; errors as in `build`."""
    model = compile_spec(specify(scene, setting, visuals))
    if setting.rolling == "equality" and setting.softness == TUNED:
        constrained.make_rigid(model)
    return model


def compile_spec(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Compile a specification.

    Raises:
      UnsupportedError: if MuJoCo refuses it: for the scene's numbers, or for what a template shows.
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise UnsupportedError(f"MuJoCo cannot represent this scene: {error}") from error


def specify(scene: Scene, setting: Setting, visuals: bool = False) -> mujoco.MjSpec:
    """The editable specification that `compile_model` compiles, with the same errors.

    Compiled by itself, its joint equality is as stiff as MJCF can say; `compile_model` makes it rigid.
    """
    rolling = setting.rolling
    spec = templates.read(templates.name(scene))
    if visuals:
        appearance.dress(spec, scene)
    else:
        appearance.strip(spec)
    _tilt(spec, scene, visuals)
    # Without an incline to lie on, the axis is the origin: an offset far smaller than the radius keeps its digits.
    spec.body("can").pos = [0, 0, scene.can.radius if visuals or rolling == "contact" else 0.0]
    spec.option.timestep = setting.timestep
    spec.option.integrator = int(_INTEGRATORS[setting.integrator])
    unit = mass_unit(scene)
    if rolling == "reduced":
        reduced.reduce(spec, scene, unit)
    elif rolling == "equality":
        constrained.roll_by_equality(spec, scene, unit, setting)
    else:
        constrained.roll_by_contact(spec, scene, unit, setting)
    if not visuals:
        _disable_unused(spec, rolling)
    return spec


def _tilt(spec: mujoco.MjSpec, scene: Scene, visuals: bool) -> None:
    """Tilt the incline if one is to see it, or else gravity: that is exact, and saves the body."""
    gravity, tilt = scene.gravity, scene.incline if visuals else 0.0
    for element, angle in ((spec.body("incline"), tilt), (spec.frame("level"), -tilt)):
        element.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
        element.quat = [math.cos(angle / 2), 0, math.sin(angle / 2), 0]
    if visuals:
        spec.option.gravity = [0, 0, -gravity]
    else:
        spec.option.gravity = [gravity * math.sin(scene.incline), 0, -gravity * math.cos(scene.incline)]
        spec.compiler.fusestatic = True


def _disable_unused(spec: mujoco.MjSpec, rolling: str) -> None:
    spec.option.disableflags |= int(_UNUSED)
    if rolling == "reduced":
        spec.option.disableflags |= int(_UNCONSTRAINED)
    if rolling == "equality":
        spec.option.disableflags |= int(_DISABLE.mjDSBL_CONTACT)
    if not spec.actuators:
        spec.option.disableflags |= int(_DISABLE.mjDSBL_ACTUATION)
