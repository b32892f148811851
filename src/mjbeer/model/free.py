"""Cans that are free in space, as bodies of a MuJoCo specification, and how one is attached to another world.

A standing can has pendulums on ball joints for the modes of its slosh, and a body for what does not slosh: two hinges
diverge in a can that tumbles, and two slides do not follow gravity. A lying can has the paper's lump on a hinge about
its axis, or frozen. Each is the body "can", with the full inertia of a body in space, and touches everything with one
cylinder.
"""

import math
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError, UntrustedWarning
from mjbeer.model import looks, numbers
from mjbeer.model.setting import INTEGRATORS, Integrator
from mjbeer.theory.can import Can
from mjbeer.theory.load import segment
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import MOST_MODES, Standing

_BOB = 1e-3, 0.1
"""Share of a pendulum's inertia that its bob has about itself, at least and over the damping ratio. MuJoCo moves
nothing without inertia, and with too little of it the damping of a spin is too stiff for RK4. The bob is heavier by as
much, and nearer to the pivot, so that the motion is exactly the pendulum's."""
_SPIN = 1e-9
"""Inertia of the liquid about the can's axis over that about a level one: it has none, as nothing drags it along."""
_BREAKING = 0.02
"""Damping ratio that a mode has more at the rate omega, growing with the square of the rate: waves break. It is chosen,
not computed: with it thrown cans are stable at 5 ms. At an elevation of 0.1 R it adds 2e-4."""
_HARD = 1e9
"""solmix of a lying can: of a contact's solref and solimp all but 1e-9 is its own."""
_COARSE = 0.5
"""Largest angle [rad] of a mode's oscillation in a timestep: semi-implicit integrators then have it 1 % too fast."""
_ALONG_Y = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
"""Turns a cylinder's own axis, z, to that of a lying can."""
_SITES = {"group": 5, "size": [1e-4] * 3, "rgba": [0, 0, 0, 0]}
"""How sites look that only sensors need."""
_RK4 = 2.785
"""Largest product of a timestep and a rate of decay with which RK4 is stable."""
_SPOILING = {
    "CONTACT": "touches nothing",
    "CONSTRAINT": "touches nothing",
    "GRAVITY": "does not slosh",
    "DAMPER": "has no damping",
}
"""What a can does under a flag that disables a stage of MuJoCo's."""
_PARTS = ("can", "load", "swing", "liquid", *(f"slosh{mode}" for mode in range(1, MOST_MODES + 1)), "slide", "phi")
"""Bodies and joints by which cans differ; the last two are those of a scene that `build` made."""
_WRITTEN = 1e-6
"""Relative difference of sizes that were written to MJCF, with 6 digits or more."""
_FLAGS, _CONES, _KINDS = mujoco.mjtDisableBit, mujoco.mjtCone, mujoco.mjtIntegrator


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
    """Attach a can to another world and return its body there: the name of all that is in it begins with `prefix`.

    A `standing` can stands on its origin, the middle of the bottom; a scene with beer gives a lying can, whose origin
    is in the middle of its axis, which is y. It rolls on what it meets: the scene's incline is not built, and counts
    only in the damping that `mjbeer.liquid` has for it. `pos` [m] and `quat` are those of the origin in a `body` of the
    parent; a can that is not `free` is fixed to it.

    `friction` is one coefficient, or two or three: sliding, torsional, rolling. `None` is MuJoCo's default: 1, 0.005
    and 0.0001. In a contact MuJoCo takes the larger coefficient and the larger condim of the two geoms; the can has
    condim 3. A can therefore slides with 0.2 only if the floor *and* the can have it.

    Options of the parent that are MuJoCo's defaults are taken as not chosen, and changed for the whole world where that
    makes contact and rolling exact: an elliptic cone; for a lying can impratio 100, and RK4 instead of Euler. An
    `UntrustedWarning` says what other options of the parent spoil.

    Raises:
      ParameterError: if a parameter is not allowed, or there is no such body.
      UnsupportedError: if MuJoCo cannot move such a can freely.
      TemplateError: if a template is missing or lacks a part.
    """
    require.instance("parent", parent, mujoco.MjSpec)
    free = require.boolean("free", free)
    place = require.samples("pos", pos, "m"), require.samples("quat", quat)
    for name, value, array, count in (("pos", pos, place[0], 3), ("quat", quat, place[1], 4)):
        if len(array) != count or (name == "quat" and not array.any()):
            zero = ", not all 0" if name == "quat" else ""
            raise ParameterError(f"{name} must have {count} numbers{zero}, got {require.shown(value)}")
    if not (isinstance(prefix, str) and prefix and prefix.isprintable()):  # MuJoCo's names end at the first "\0"
        raise ParameterError(f"prefix must be a text that can be printed and is not empty, got {require.shown(prefix)}")
    if parent.body(f"{prefix}can") is not None:
        raise ParameterError(f"the parent has a can of this prefix already: give another one, got {prefix!r}")
    require.choice("body", body, ["world"] if free else [each.name for each in parent.bodies])
    several = isinstance(friction, (list, tuple)) or (isinstance(friction, np.ndarray) and friction.ndim > 0)
    listed = friction if several else [friction]
    coefficients = [] if friction is None else [require.non_negative("friction", each) for each in listed]
    if friction is not None and not 1 <= len(coefficients) <= 3:
        raise ParameterError(f"friction must have 1, 2 or 3 numbers, got {require.shown(friction)}")
    child = _lying(can) if isinstance(can, Scene) else dressed(require.instance("can", can, Standing), visuals=True)
    _settle(parent.option, can)
    reasons = [*_spoilt(parent.option, can), *_bounded(parent.compiler, child)]
    touching = child.geom("can")
    touching.friction = [*coefficients, *touching.friction[len(coefficients) :]]
    if isinstance(can, Scene):
        kind = _KINDS(parent.option.integrator).name.removeprefix("mjINT_")
        integrator = next(each for each in INTEGRATORS if each.upper() == kind)
        touching.solref = [numbers.stiffest(integrator, parent.option.timestep, contact=True), 1]
    child.option, child.visual.map.zfar = parent.option, parent.visual.map.zfar  # MuJoCo warns of what differs
    root = child.body("can")
    root.pos, root.quat = [0, 0, 0], [1, 0, 0, 0]
    if free:
        root.add_freejoint(name="free")
    attached = parent.body(body).add_frame(pos=place[0], quat=place[1]).attach_body(root, prefix, "")
    if reasons:
        warnings.warn(f"the parent's options spoil the can: {'; '.join(reasons)}", UntrustedWarning, stacklevel=2)
    return attached


def refill(model: mujoco.MjModel, can: Standing | Scene, prefix: str = "can-") -> None:
    """Give a can in a compiled model another fill or liquid, in place; it must be as large, with as many modes.

    It is the can that was attached under the `prefix`, or, with an empty one, that of a model of a standing can. Data
    keep their state, and have the new accelerations from the next `mj_step` or `mj_forward` on. A standing can is drawn
    with the new fill, a lying one still with the old. An `UntrustedWarning` says what the model's options spoil.

    Raises:
      ParameterError: if the model has no such can.
      UnsupportedError: if MuJoCo cannot move such a can freely.
    """
    require.instance("model", model, mujoco.MjModel)
    if not (isinstance(prefix, str) and prefix.isprintable()):
        raise ParameterError(f"prefix must be a text that can be printed, got {require.shown(prefix)}")
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="can")
    if isinstance(can, Scene):
        drawn = {}
        lie(body, body.add_body(name="load"), can)
    else:
        stand(spec, require.instance("can", can, Standing))
        drawn = looks.column(can)
    _require_parts(model, prefix, spec, can)
    if any(min(spec.body(each.name).inertia) < mujoco.mjMINVAL for each in spec.joints if each.name != "swing"):
        raise UnsupportedError(
            f"MuJoCo moves no pendulum with an inertia below {mujoco.mjMINVAL:g} kg m^2, as of {can}"
        )
    for each in spec.bodies[1:]:
        part = model.body(f"{prefix}{each.name}")
        part.mass, part.inertia, part.ipos = each.mass, each.inertia, each.ipos
        if each.name != "can":
            part.pos = each.pos
    for each in spec.joints:
        joint = model.joint(f"{prefix}{each.name}")
        joint.damping[:], joint.dampingpoly[:] = each.damping[0], each.damping[1:]
    for each in spec.sites:
        model.site(f"{prefix}{each.name}").pos = each.pos
    for name, (low, high) in drawn.items():
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, f"{prefix}{name}") >= 0:
            geom = model.geom(f"{prefix}{name}")
            geom.pos[2], geom.size[1] = (low + high) / 2, (high - low) / 2
    mujoco.mj_setConst(model, mujoco.MjData(model))  # which it takes as its workspace
    if reasons := _spoilt(model.opt, can):
        warnings.warn(f"the model's options spoil the can: {'; '.join(reasons)}", UntrustedWarning, stacklevel=2)


def _require_parts(model: mujoco.MjModel, prefix: str, spec: mujoco.MjSpec, can: Standing | Scene) -> None:
    """Check that the can of a model has the parts of a specification, and the size."""
    find, shell = mujoco.mj_name2id, can.can
    kinds = mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_JOINT
    there = [each for each in _PARTS if any(find(model, kind, f"{prefix}{each}") >= 0 for kind in kinds)]
    needed = [each for each in _PARTS if spec.body(each) is not None or spec.joint(each) is not None]
    size = [shell.radius, shell.length / 2]
    if there != needed or not np.allclose(model.geom(f"{prefix}can").size[:2], size, rtol=_WRITTEN, atol=0):
        raise ParameterError(
            f"the model must have a can under the prefix {require.shown(prefix)} with radius and half length {size} m "
            f"and with {', '.join(needed)}; it has {', '.join(there) or 'none'}, got {require.shown(can)}"
        )


def _settle(option: mujoco.MjOption, can: Standing | Scene) -> None:
    """Change a parent's options that nobody chose."""
    if option.cone == _CONES.mjCONE_PYRAMIDAL:
        option.cone = _CONES.mjCONE_ELLIPTIC
    if isinstance(can, Scene):
        if option.impratio == 1:
            option.impratio = numbers.FRICTION_HARDNESS
        if option.integrator == _KINDS.mjINT_EULER:
            option.integrator = _KINDS.mjINT_RK4


def _spoilt(option: mujoco.MjOption, can: Standing | Scene) -> list[str]:
    """Return what a world's options spoil."""
    reasons, size = [], float(np.linalg.norm(option.gravity))
    explicit, decay = option.integrator == _KINDS.mjINT_RK4, _decay(can)
    if isinstance(can, Scene):
        if not explicit:
            reasons.append("with another integrator than RK4 the error of rolling is of the order of the timestep")
    elif can.modes > 0 and (turned := option.timestep * float(can.frequencies()[-1])) > _COARSE:
        reasons.append(
            f"the timestep of {option.timestep:g} s is coarse: the fastest mode turns by "
            f"{require.above(turned, _COARSE)} rad in it, not {_COARSE:g} or less"
        )
    if explicit and option.timestep * decay > _RK4:
        remedy = "" if isinstance(can, Scene) else ", or another integrator"
        reasons.append(
            f"with RK4 its damping may diverge at a timestep of {option.timestep:g} s: give {_RK4 / decay:.2g} s or "
            f"less{remedy}"
        )
    if not math.isclose(size, can.gravity, rel_tol=1e-6):
        reasons.append(f"gravity is {size:.6g} m/s^2, and the can is made for {can.gravity:.6g}")
    for flag, told in _SPOILING.items():
        if option.disableflags & int(_FLAGS.__members__[f"mjDSBL_{flag}"]) and (flag != "DAMPER" or decay > 0):
            reasons.append(f"with the flag {flag.lower()} disabled it {told}")
    return reasons


def _bounded(compiler: mujoco.MjsCompiler, child: mujoco.MjSpec) -> list[str]:
    """Return what a parent's compiler does to the masses of a can."""
    reasons, moving = [], [body for body in child.bodies if body.mass > 0]
    if compiler.settotalmass > 0:
        reasons.append("settotalmass scales its masses")
    for name, least in (
        ("boundmass", min(body.mass for body in moving)),
        ("boundinertia", min(min(body.inertia) for body in moving)),
    ):
        if getattr(compiler, name) > least:
            reasons.append(f"{name} raises what is less, from {least:.2g} on, once the world is saved and read again")
    return reasons


def _decay(can: Standing | Scene) -> float:
    """Return the largest rate [1/s] at which damping slows a spin, of a bob or of a can that turns around its load.

    Where damping grows with the rate, it is that at the frequency of the first mode, or at sqrt(g/a): thrown at 1 m/s,
    0 of 1,976 cans diverge under RK4 up to its limit, and 510 of 1,112 beyond. What is in proportion has a sharp limit.
    """
    if isinstance(can, Scene):
        if not can.damping_law:
            return 0.0
        load, slope = can.load, can.damping_law.slope(math.sqrt(can.gravity / can.can.radius))
        return float(slope * (1 / can.can.inertia + 1 / (load.inertia + load.moment * load.offset)))
    if can.modes == 0:
        return 0.0
    ratios, omega = can.damping_ratios(), can.frequencies()
    return float(np.max(2 * (ratios * omega + _BREAKING * omega[0] ** 2 / omega) / _shares(can)))


def _shares(can: Standing) -> np.ndarray:
    """Return the share of each pendulum's inertia that its bob has about itself."""
    return np.maximum(_BOB[0], _BOB[1] * can.damping_ratios())


def compose(can: Standing, visuals: bool, free: bool, integrator: Integrator, timestep: float) -> mujoco.MjSpec:
    """Return the specification of a standing can: on the floor if it is `free`, or else held by the world.

    Raises:
      ParameterError: if the integrator is not one of MuJoCo's, or the timestep is not allowed.
      TemplateError: if the template is missing or lacks a part.
    """
    spec = dressed(can, require.boolean("visuals", visuals))
    option = spec.option
    option.integrator = int(
        _KINDS.__members__[f"mjINT_{require.choice('integrator', integrator, INTEGRATORS).upper()}"]
    )
    option.timestep = require.within("timestep", timestep, *require.TIMESTEP, "s")
    option.cone, option.gravity = _CONES.mjCONE_ELLIPTIC, [0, 0, -can.gravity]
    if require.boolean("free", free):
        spec.body("can").add_freejoint(name="free")
        plane = mujoco.mjtGeom.mjGEOM_PLANE
        spec.worldbody.add_geom(spec.default, name="surface", type=plane, size=[0, 0, 1], group=3)
    return spec


def dressed(can: Standing, visuals: bool) -> mujoco.MjSpec:
    """Return a specification with a standing can, which has no joint yet, and with its looks if they are wanted."""
    if visuals:
        spec = looks.upright(can)
    else:
        spec = mujoco.MjSpec()
        spec.worldbody.add_body(name="can")
    stand(spec, can)
    touch(spec.body("can"), can.can)
    return spec


def _lying(scene: Scene) -> mujoco.MjSpec:
    """Return a specification with a lying can in it, which has no joint yet."""
    spec = looks.dressed(scene)
    lie(spec.body("can"), spec.body("load"), scene)
    touch(spec.body("can"), scene.can, lying=True)
    return spec


def stand(spec: mujoco.MjSpec, can: Standing) -> None:
    """Give the body "can", whose origin is the middle of the inside of the bottom, the masses of a standing can.

    What does not slosh is the body "liquid". Each mode is a body "slosh1", "slosh2" ... on a ball joint of its name.
    The masses, first and second moments of all of them together are those of theory, bobs as they are included.
    """
    body, shell, half = spec.body("can"), can.can, can.can.length / 2
    across = transverse_inertia(shell)
    _inertial(body, shell.mass, half, [across, across, shell.inertia])
    middle = can.height / 2
    moments = can.fixed_moments()
    lengths = can.gravity / can.frequencies() ** 2
    critical = 2 * can.frequencies() * can.slosh_masses() * lengths**2
    dampers = can.damping_ratios() * critical, _BREAKING / can.frequencies() ** 2 * critical
    parts = can.slosh_masses(), lengths, can.pivots(), *dampers, can.elevations(), _shares(can)
    for number, each in enumerate(zip(*map(np.ndarray.tolist, parts), strict=True), 1):
        mass, length, pivot, damper, cubic, rise, share = each
        name, own = f"slosh{number}", share * mass * length**2
        bob, arm = mass / (1 - share), length * (1 - share)
        place = pivot - middle - arm
        moments = moments - bob * place ** np.arange(3) - [0, 0, own]
        slosh = spec.body(name) or body.add_body(name=name)
        slosh.pos = [0, 0, pivot]
        slosh.add_joint(spec.default, name=name, type=mujoco.mjtJoint.mjJNT_BALL, damping=[damper, 0, cubic])
        _inertial(slosh, bob, -arm, [own] * 3)
        _add_sensors(spec, body, slosh, rise)
    mass, first, second = moments
    level = second - first**2 / mass
    spin = can.mass * shell.radius**2 / 2 if can.modes == 0 else _SPIN * level
    _inertial(spec.body("liquid") or body.add_body(name="liquid"), mass, middle + first / mass, [level, level, spin])


def lie(can: mujoco.MjsBody, load: mujoco.MjsBody, scene: Scene) -> None:
    """Give two bodies, whose origins are on the axis of a lying can, the masses of its shell and of its load.

    Raises:
      UnsupportedError: if MuJoCo cannot move them freely.
    """
    shell, beer = scene.can, scene.load
    if beer.fill is None:
        raise UnsupportedError(f"a can that is free in space has beer in it, got a load without a fill: {scene!r}")
    if scene.drag > 0:
        raise UnsupportedError(f"a can that is free in space has no drag of the air, got {scene.drag!r} kg/m")
    if scene.attachment == "sliding":
        if shell.mass == 0 or shell.inertia == 0:
            raise UnsupportedError(
                "a can without mass and inertia around a sliding load cannot move freely; give it some, as "
                "can=Can.sheet_metal()"
            )
        law = scene.damping_law.coefficients
        load.add_joint(name="swing", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0], damping=law)
    across = transverse_inertia(shell)
    _inertial(can, shell.mass, 0.0, [across, shell.inertia, across])
    shape = segment(beer.fill)
    wide = beer.mass * shell.radius**2 * shape.width
    along = beer.mass * shell.length**2 / 12
    _inertial(load, beer.mass, -beer.offset, [beer.inertia - wide + along, beer.inertia, wide + along])


def transverse_inertia(can: Can) -> float:
    """Return the moment of inertia of a can about a line across its middle [kg m^2].

    Mass and inertia about the axis leave one answer for a thin wall with two flat ends: the ends have the mass
    2 (m - I/a^2), or as much of that as there is.
    """
    ends = min(max(2 * (can.mass - can.inertia / can.radius**2), 0.0), can.mass)
    return can.inertia / 2 + (can.mass - ends) * can.length**2 / 12 + ends * can.length**2 / 4


def touch(body: mujoco.MjsBody, can: Can, lying: bool = False) -> None:
    """Give a can the cylinder "can", which touches what it meets.

    A standing can is as soft as MuJoCo's default: a hard blow would give its pendulums rates that large timesteps
    cannot follow. A lying one is as hard as `rolling="contact"`, but for the time constant, which fits the timestep.
    """
    geom = body.add_geom(name="can", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[can.radius, can.length / 2, 0], mass=0)
    if lying:
        geom.quat, geom.solimp, geom.solmix = _ALONG_Y, [*numbers.IMPEDANCE, *numbers.WIDTH], _HARD
    else:
        geom.pos = [0, 0, can.length / 2]
    geom.group, geom.rgba = 3, [0.2, 0.6, 0.9, 0.3]


def _add_sensors(spec: mujoco.MjSpec, can: mujoco.MjsBody, slosh: mujoco.MjsBody, rise: float) -> None:
    """Add what tells how a mode moves, in the frame of the can.

    "slosh1_up" is the direction of its pendulum's upper end: x and y are the sines of its tilt. "slosh1_rise" is how
    high the surface rises at the wall at x and at y, over the radius: the way of a site so far below the pivot [m].
    """
    name, kinds, objects = slosh.name, mujoco.mjtSensor, mujoco.mjtObj
    can.add_site(name=f"{name}_pivot", pos=slosh.pos, **_SITES)
    slosh.add_site(name=f"{name}_rise", pos=[0, 0, -rise], **_SITES)
    for sensor, kind, what, where in (
        ("up", kinds.mjSENS_FRAMEZAXIS, (objects.mjOBJ_XBODY, name), (objects.mjOBJ_XBODY, can.name)),
        ("rise", kinds.mjSENS_FRAMEPOS, (objects.mjOBJ_SITE, f"{name}_rise"), (objects.mjOBJ_SITE, f"{name}_pivot")),
    ):
        names = dict(zip(("objtype", "objname", "reftype", "refname"), (*what, *where), strict=True))
        spec.add_sensor(name=f"{name}_{sensor}", type=kind, **names)


def _inertial(body: mujoco.MjsBody, mass: float, height: float, inertia: Sequence[float]) -> None:
    body.explicitinertial, body.mass, body.ipos, body.inertia = True, mass, [0, 0, height], inertia
