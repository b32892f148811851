"""Attaches a can to another world, fills a can anew, and tells how high its liquid rises."""

import warnings
from collections.abc import Sequence

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError, UntrustedWarning
from mjbeer.model import looks, mjcf_file
from mjbeer.model.free import attached_spec
from mjbeer.model.model_numbers import shortest_time_constant
from mjbeer.model.setting import MUJOCO_INTEGRATORS
from mjbeer.model.spoiling import mass_reasons, option_reasons
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import MOST_MODES, Standing, mode_elevations

_SLOSHES = tuple(f"slosh{mode}" for mode in range(1, MOST_MODES + 1))
_PARTS = ("can", "load", "swing", "liquid", *_SLOSHES, "slide", "phi")
"""Bodies and joints by which cans differ; the last two are those of a scene that `build` made."""


def attach(
    parent: mujoco.MjSpec,
    can: Standing | Scene,
    pos: Sequence[float] = (0.0, 0.0, 0.0),
    quat: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
    prefix: str = "can-",
    free: bool = True,
    body: str = "world",
    friction: float | Sequence[float] | None = None,
) -> mujoco.MjsBody:
    """Attach a can to another world and return its body there.

    The names of all its elements begin with `prefix`.

    A `standing` can stands on its origin, the middle of the bottom; a scene with beer gives a lying
    can, whose origin is in the middle of its axis, which is y. The scene's incline is not built,
    and counts only in the damping that `mjbeer.liquid` has for it. A load of `Load.liquid` sloshes
    across the axis of the can like the slowest mode of a can that rolls, and along it stays at
    rest. In a sheet metal can that is held it swings up to 1 % more slowly than the liquid.

    `pos` [m] and `quat` are those of the origin in a `body` of the parent; a can that is not `free`
    is fixed to it.

    `friction` is one coefficient, or two or three: sliding, torsional, rolling. `None` is MuJoCo's
    default: 1, 0.005 and 0.0001. Where two geoms meet, MuJoCo takes the larger coefficient of the
    two: a can slides with 0.2 only if both the floor and the can have 0.2. It takes the larger
    condim, too; that of the can is 3.

    An option of the parent that is MuJoCo's default is taken as not chosen, and is changed for the
    whole world. Every can gets an elliptic cone, and a lying one impratio 100 and RK4 as well. An
    `UntrustedWarning` says what other options spoil.

    Raises:
      ParameterError: if a parameter is invalid, or there is no such body.
      UnsupportedError: if MuJoCo cannot move such a can freely.
      TemplateError: if a file of MJCF is missing or lacks an element.
    """
    require.instance("parent", parent, mujoco.MjSpec)
    require.instance("prefix", prefix, str)
    free = require.choice("free", free, (True, False))
    _require_place(pos, quat)
    if parent.body(f"{prefix}can") is not None:
        raise ParameterError(
            f"the parent has a can of this prefix already: give another one, got {prefix!r}"
        )
    require.choice("body", body, ["world"] if free else [there.name for there in parent.bodies])
    coefficients = _friction_coefficients(friction)

    child = attached_spec(can)
    if free:
        child.body("can").add_freejoint(name="free")
    mjcf_file.compile_spec(child.copy())
    _choose_options(parent.option, child.option, can)
    touching = child.geom("can")
    touching.friction[: len(coefficients)] = coefficients
    if isinstance(can, Scene):
        time_constant = shortest_time_constant(
            _integrator_name(parent.option), parent.option.timestep, contact=True
        )
        touching.solref = [time_constant, 1]
    reasons = option_reasons(parent.option, can) + mass_reasons(parent.compiler, child)

    # With options of its own MuJoCo would warn that the child's differ from the parent's.
    child.option = parent.option
    child.visual.map.zfar = parent.visual.map.zfar
    frame = parent.body(body).add_frame(pos=pos, quat=quat)
    attached = frame.attach_body(child.body("can"), prefix, "")
    if reasons:
        message = f"the parent's options spoil the can: {'; '.join(reasons)}"
        warnings.warn(message, UntrustedWarning, stacklevel=2)
    return attached


def _require_place(pos: Sequence[float], quat: Sequence[float]) -> None:
    """Refuse what is no position or no quaternion."""
    if len(require.samples("pos", pos, "m")) != 3:
        raise ParameterError(f"pos must have 3 numbers, got {require.format_value(pos)}")
    if len(require.samples("quat", quat)) != 4 or not np.any(quat):
        value = require.format_value(quat)
        raise ParameterError(f"quat must have 4 numbers, not all 0, got {value}")


def _friction_coefficients(friction: float | Sequence[float] | None) -> np.ndarray:
    """Return the coefficients of friction that are given, none to three."""
    if friction is None:
        return np.empty(0)
    coefficients = require.samples("friction", np.atleast_1d(friction))
    if len(coefficients) > 3 or np.any(coefficients < 0):
        value = require.format_value(friction)
        raise ParameterError(f"friction must be 1, 2 or 3 numbers of 0 or more, got {value}")
    return coefficients


def _choose_options(
    option: mujoco.MjOption, wanted: mujoco.MjOption, can: Standing | Scene
) -> None:
    """Change those options of a world that are MuJoCo's defaults to those that a can needs."""
    if option.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        option.cone = wanted.cone
    if isinstance(can, Standing):
        return
    if option.impratio == 1:
        option.impratio = wanted.impratio
    if option.integrator == mujoco.mjtIntegrator.mjINT_EULER:
        option.integrator = wanted.integrator


def _integrator_name(option: mujoco.MjOption) -> str:
    """Return the name of an integrator, as in MJCF."""
    member = mujoco.mjtIntegrator(option.integrator).name.removeprefix("mjINT_")
    return next(name for name in MUJOCO_INTEGRATORS if name.upper() == member)


def refill(model: mujoco.MjModel, can: Standing | Scene, prefix: str = "can-") -> None:
    """Give a can in a compiled model another fill or liquid, in place.

    The new can must be as large, with as many modes. The old one is the can that was attached under
    the `prefix`, or, with an empty one, that of a model of a standing can. Data keep their state,
    and have the new accelerations from the next `mj_step` or `mj_forward` on. A standing can is
    drawn with the new fill, a lying one still with the old. An `UntrustedWarning` says what the
    model's options spoil.

    Raises:
      ParameterError: if the model has no such can.
      UnsupportedError: if MuJoCo cannot move such a can freely.
    """
    require.instance("model", model, mujoco.MjModel)
    require.instance("prefix", prefix, str)
    spec = attached_spec(can, visuals=False)
    _require_same_can(model, can, prefix, spec)
    for joint in spec.joints:
        if joint.name != "swing" and min(spec.body(joint.name).inertia) < mujoco.mjMINVAL:
            least = f"{mujoco.mjMINVAL:g} kg m^2"
            raise UnsupportedError(f"MuJoCo moves no pendulum of less than {least}, as of {can}")
    for name in _PARTS:
        filled = spec.body(name)
        if filled is not None:
            body = model.body(f"{prefix}{name}")
            body.mass = filled.mass
            body.inertia = filled.inertia
            body.ipos = filled.ipos
            if name != "can":
                body.pos = filled.pos
    for damped in spec.joints:
        joint = model.joint(f"{prefix}{damped.name}")
        joint.damping[:] = damped.damping[0]
        joint.dampingpoly[:] = damped.damping[1:]
    if isinstance(can, Standing) and _has(model, mujoco.mjtObj.mjOBJ_GEOM, f"{prefix}beer"):
        for name, cylinder in looks.beer_column(can).items():
            geom = model.geom(f"{prefix}{name}")
            geom.pos[2] = (cylinder.low + cylinder.high) / 2
            geom.size[:2] = (cylinder.radius, (cylinder.high - cylinder.low) / 2)
    workspace = mujoco.MjData(model)
    mujoco.mj_setConst(model, workspace)
    reasons = option_reasons(model.opt, can)
    if reasons:
        warnings.warn(
            f"the model's options spoil the can: {'; '.join(reasons)}",
            UntrustedWarning,
            stacklevel=2,
        )


def wall_rise(model: mujoco.MjModel, data: mujoco.MjData, prefix: str = "can-") -> float:
    """Return how high the liquid of a standing can rises at the wall now, divided by R.

    It is the largest rise around the wall, by all modes that move; a solid liquid has 0. The can is
    the one that was attached under the `prefix`, or, with an empty one, that of a model of a
    standing can. The value is that of `data.qpos`, also right after `mj_step`, and takes tens of
    microseconds: ask in every step. Linear theory is quantitative up to 0.1, and gives a picture up
    to 0.3. What rises beyond is no liquid any more, and nothing else says so.

    Raises:
      ParameterError: if the model has no such can, or the data are those of another model.
    """
    require.instance("model", model, mujoco.MjModel)
    require.instance("data", data, mujoco.MjData)
    require.instance("prefix", prefix, str)
    if not _has(model, mujoco.mjtObj.mjOBJ_BODY, f"{prefix}liquid"):
        raise ParameterError(
            f"the model has no standing can under the prefix {require.format_value(prefix)}"
        )
    if len(data.qpos) != model.nq:
        coordinates = f"{len(data.qpos)} coordinates"
        raise ParameterError(
            f"the data must be those of the model, of {model.nq}, got {coordinates}"
        )
    return float(np.hypot(*surface_slope(model, data, prefix)))


def surface_slope(model: mujoco.MjModel, data: mujoco.MjData, prefix: str) -> np.ndarray:
    """Return how high the liquid of a standing can rises at the walls towards +x and +y, in radii.

    Every mode varies with the cosine of the angle around the axis, and so does their sum: the two
    numbers are the vector -sum(2/(xi^2 - 1) (x, y)) with the sines (x, y) of the pendulums' tilts
    in the frame of the can, and its length is the largest rise.
    """
    joint = mujoco.mjtObj.mjOBJ_JOINT
    names = [f"{prefix}{slosh}" for slosh in _SLOSHES]
    addresses = [
        model.jnt_qposadr[mujoco.mj_name2id(model, joint, name)]
        for name in names
        if _has(model, joint, name)
    ]
    slope = np.zeros(2)
    for elevation, first in zip(mode_elevations(len(addresses)), addresses, strict=True):
        turn = data.qpos[first : first + 4].copy()
        mujoco.mju_normalize4(turn)
        w, x, y, z = turn
        upper_end = np.array([2 * (x * z + w * y), 2 * (y * z - w * x)])
        slope -= elevation * upper_end
    return slope


def _require_same_can(
    model: mujoco.MjModel, can: Standing | Scene, prefix: str, spec: mujoco.MjSpec
) -> None:
    """Refuse a model whose can differs in size or parts from the specification of a can."""
    needed = [
        name for name in _PARTS if spec.body(name) is not None or spec.joint(name) is not None
    ]
    kinds = (mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_JOINT)
    there = [name for name in _PARTS if any(_has(model, kind, f"{prefix}{name}") for kind in kinds)]
    size = [can.can.radius, can.can.length / 2]  # written to MJCF with 6 digits or more
    has_parts = there == needed
    if not has_parts or not np.allclose(
        model.geom(f"{prefix}can").size[:2], size, rtol=1e-6, atol=0
    ):
        raise ParameterError(
            f"the model must have a can under the prefix {require.format_value(prefix)} "
            "with radius "
            f"and half length {size} m and with {', '.join(needed)}; "
            f"it has {', '.join(there) or 'none'}, "
            f"got {require.format_value(can)}"
        )


def _has(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str) -> bool:
    """Return whether a model has an element of this kind and name."""
    return mujoco.mj_name2id(model, kind, name) >= 0
