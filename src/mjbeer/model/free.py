"""Cans that are free in space, as bodies of a MuJoCo specification, and how one is attached to another world.

The pendulums of a standing can's slosh are on ball joints: two hinges diverge in a can that tumbles, and two slides do
not follow gravity.
"""

import functools
import math
import pathlib
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Sequence

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError, TemplateError, UnsupportedError, UntrustedWarning
from mjbeer.model import looks, mechanics, mjcf_file
from mjbeer.model.setting import INTEGRATORS, Setting
from mjbeer.theory.can import Can, segment
from mjbeer.theory.scene import Scene, sliding
from mjbeer.theory.standing import MOST_MODES, Standing, standing

_BOB = 1e-3, 0.1
"""Share of a pendulum's inertia that its bob has about itself, at least and over the damping ratio. MuJoCo moves
nothing without inertia, and with too little of it the damping of a spin is too stiff for RK4. The bob is heavier by as
much, and nearer to the pivot, so that the motion is exactly the pendulum's."""
_BREAKING = 0.02
"""Damping ratio that a mode has more at the rate omega, growing with the square of the rate: waves break. It is chosen,
not computed: with it thrown cans are stable at 5 ms. At an elevation of 0.1 R it adds 2e-4."""
_COARSE = 0.5
"""Largest angle [rad] of a mode's oscillation in a timestep: semi-implicit integrators then have it 1 % too fast."""
_RK4 = 2.785
"""Largest product of a timestep and a rate of decay with which RK4 is stable."""
_PARTS = ("can", "load", "swing", "liquid", *(f"slosh{mode}" for mode in range(1, MOST_MODES + 1)), "slide", "phi")
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
    """Attach a can to another world and return its body there: the name of all that is in it begins with `prefix`.

    A `standing` can stands on its origin, the middle of the bottom; a scene with beer gives a lying can, whose origin
    is in the middle of its axis, which is y. The scene's incline is not built, and counts only in the damping that
    `mjbeer.liquid` has for it. `pos` [m] and `quat` are those of the origin in a `body` of the parent; a can that is
    not `free` is fixed to it.

    `friction` is one coefficient, or two or three: sliding, torsional, rolling. `None` is MuJoCo's default: 1, 0.005
    and 0.0001. Of two geoms that meet, MuJoCo takes the larger ones, so that a can slides with 0.2 only if the floor
    *and* the can have it, and the larger condim; the can has 3.

    Options of the parent that are MuJoCo's defaults are taken as not chosen, and changed for the whole world: to an
    elliptic cone; for a lying can to impratio 100 and RK4, too. An `UntrustedWarning` says what other options spoil.

    Raises:
      ParameterError: if a parameter is not allowed, or there is no such body.
      UnsupportedError: if MuJoCo cannot move such a can freely.
      TemplateError: if a file of MJCF is missing or lacks an element.
    """
    require.instance("parent", parent, mujoco.MjSpec)
    free = require.choice("free", free, (True, False))
    if len(require.samples("pos", pos, "m")) != 3:
        raise ParameterError(f"pos must have 3 numbers, got {require.format_value(pos)}")
    if len(require.samples("quat", quat)) != 4 or not np.any(quat):
        raise ParameterError(f"quat must have 4 numbers, not all 0, got {require.format_value(quat)}")
    if parent.body(f"{require.instance('prefix', prefix, str)}can") is not None:
        raise ParameterError(f"the parent has a can of this prefix already: give another one, got {prefix!r}")
    require.choice("body", body, ["world"] if free else [each.name for each in parent.bodies])
    coefficients = np.empty(0) if friction is None else require.samples("friction", np.atleast_1d(friction))
    if len(coefficients) > 3 or np.any(coefficients < 0):
        raise ParameterError(f"friction must be 1, 2 or 3 numbers of 0 or more, got {require.format_value(friction)}")
    child, option = _specification(can), parent.option
    if free:
        child.body("can").add_freejoint(name="free")
    mjcf_file.compile_spec(child.copy())
    if option.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:
        option.cone = child.option.cone
    touching = child.geom("can")
    touching.friction[: len(coefficients)] = coefficients
    if isinstance(can, Scene):
        if option.impratio == 1:
            option.impratio = child.option.impratio
        if option.integrator == mujoco.mjtIntegrator.mjINT_EULER:
            option.integrator = child.option.integrator
        kind = mujoco.mjtIntegrator(option.integrator).name.removeprefix("mjINT_")
        (integrator,) = (each for each in INTEGRATORS if each.upper() == kind)
        touching.solref = [mechanics.stiffest(integrator, option.timestep, contact=True), 1]
    reasons = _spoiling_options(option, can) + _mass_bounds(parent.compiler, child)
    child.option, child.visual.map.zfar = parent.option, parent.visual.map.zfar  # MuJoCo warns of what differs
    attached = parent.body(body).add_frame(pos=pos, quat=quat).attach_body(child.body("can"), prefix, "")
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
    require.instance("prefix", prefix, str)
    spec, kinds = _specification(can, visuals=False), (mujoco.mjtObj.mjOBJ_BODY, mujoco.mjtObj.mjOBJ_JOINT)
    there = [each for each in _PARTS if any(mujoco.mj_name2id(model, kind, f"{prefix}{each}") >= 0 for kind in kinds)]
    needed = [each for each in _PARTS if spec.body(each) is not None or spec.joint(each) is not None]
    size = [can.can.radius, can.can.length / 2]  # written to MJCF with 6 digits or more
    if there != needed or not np.allclose(model.geom(f"{prefix}can").size[:2], size, rtol=1e-6, atol=0):
        raise ParameterError(
            f"the model must have a can under the prefix {require.format_value(prefix)} with radius and half length "
            f"{size} m and with {', '.join(needed)}; it has {', '.join(there) or 'none'}, "
            f"got {require.format_value(can)}"
        )
    if any(min(spec.body(each.name).inertia) < mujoco.mjMINVAL for each in spec.joints if each.name != "swing"):
        raise UnsupportedError(f"MuJoCo moves no pendulum of less than {mujoco.mjMINVAL:g} kg m^2, as of {can}")
    for each in filter(None, map(spec.body, _PARTS)):
        part = model.body(f"{prefix}{each.name}")
        part.mass, part.inertia, part.ipos = each.mass, each.inertia, each.ipos
        if each.name != "can":
            part.pos = each.pos
    for each in spec.joints:
        joint = model.joint(f"{prefix}{each.name}")
        joint.damping[:], joint.dampingpoly[:] = each.damping[0], each.damping[1:]
    for each in spec.sites:
        model.site(f"{prefix}{each.name}").pos = each.pos
    if isinstance(can, Standing) and mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, f"{prefix}beer") >= 0:
        for name, (low, high, radius) in looks.beer_column(can).items():
            geom = model.geom(f"{prefix}{name}")
            geom.pos[2], geom.size[:2] = (low + high) / 2, (radius, (high - low) / 2)
    mujoco.mj_setConst(model, mujoco.MjData(model))  # which it takes as its workspace
    if reasons := _spoiling_options(model.opt, can):
        warnings.warn(f"the model's options spoil the can: {'; '.join(reasons)}", UntrustedWarning, stacklevel=2)


def _spoiling_options(option: mujoco.MjOption, can: Standing | Scene) -> list[str]:
    """Return what a world's options spoil."""
    reasons, size = [], float(np.linalg.norm(option.gravity))
    explicit, decay = option.integrator == mujoco.mjtIntegrator.mjINT_RK4, _fastest_decay(can)
    if isinstance(can, Scene):
        if not explicit:
            reasons.append("with another integrator than RK4 the error of rolling is of the order of the timestep")
    elif (turned := option.timestep * max(can.frequencies(), default=0.0)) > _COARSE:
        turn = f"{turned:.3g} rad in it, not {_COARSE:g} or less"
        reasons.append(f"the timestep of {option.timestep:g} s is coarse: the fastest mode turns by {turn}")
    if explicit and option.timestep * decay > _RK4:
        limit = f"{_RK4 / decay:.2g} s or less"
        reasons.append(f"with RK4 its damping may diverge at a timestep of {option.timestep:g} s: give {limit}")
    if not math.isclose(size, can.gravity, rel_tol=1e-6):
        reasons.append(f"gravity is {size:.6g} m/s^2, and the can is made for {can.gravity:.6g}")
    if decay > 0 and option.disableflags & int(mujoco.mjtDisableBit.mjDSBL_DAMPER):
        reasons.append("with the flag damper disabled it has no damping")
    return reasons


def _mass_bounds(compiler: mujoco.MjsCompiler, child: mujoco.MjSpec) -> list[str]:
    """Return what a parent's compiler does to the masses of a can."""
    moving = [body for body in child.bodies if body.mass > 0]
    least = {"boundmass": min(body.mass for body in moving), "boundinertia": min(min(body.inertia) for body in moving)}
    reasons = ["settotalmass scales its masses"] if compiler.settotalmass > 0 else []
    for name, value in least.items():
        if getattr(compiler, name) > value:
            reasons.append(f"{name} raises what is less, from {value:.2g} on, once the world is saved and read again")
    return reasons


def _fastest_decay(can: Standing | Scene) -> float:
    """Return the largest rate [1/s] at which damping slows a spin, of a bob or of a can that turns around its load.

    Where damping grows with the rate, it is that at the frequency of the first mode, or at sqrt(g/a): thrown at 1 m/s,
    0 of 1,976 cans diverge under RK4 up to its limit, and 510 of 1,112 beyond. What is in proportion has a sharp limit.
    """
    if isinstance(can, Scene):
        if not can.damping_law:
            return 0.0
        load, slope = can.load, can.damping_law.derivative(math.sqrt(can.gravity / can.can.radius))
        return float(slope * (1 / can.can.inertia + 1 / (load.inertia + load.moment * load.offset)))
    ratios, omega = can.damping_ratios(), can.frequencies()
    rates = 2 * (ratios * omega + _BREAKING * omega[:1] ** 2 / omega) / _bob_shares(can)
    return float(np.max(rates, initial=0.0))


def _bob_shares(can: Standing) -> np.ndarray:
    """Return the share of each pendulum's inertia that its bob has about itself.

    A share s makes a bob heavier by m s / (1 - s), as if so much of what does not slosh were moved to the pivot. Half
    of the mass and of the inertia of that part are left, which is light in a shallow liquid.
    """
    masses = can.slosh_masses()
    if len(masses) == 0:
        return masses
    wanted = np.maximum(_BOB[0], _BOB[1] * can.damping_ratios())
    moved = masses * wanted / (1 - wanted)
    pivots = can.pivots() - can.height / 2
    bobs = pivots - can.gravity / can.frequencies() ** 2
    mass, first, second = can.fixed_moments() - [masses.sum(), masses @ bobs, masses @ bobs**2]
    middle = first / mass
    inertia = second - mass * middle**2
    # Without masses d_n at distances r_n from its middle, that part keeps I - sum(d_n r_n^2) less what the shift of its
    # middle takes: together no less than I - sum(d_n r_n^2) / (1 - sum(d_n) / m), by Schwarz's inequality.
    most = min(mass / 2 / moved.sum(), inertia / 4 / (moved @ (pivots - middle) ** 2))
    moved *= min(1.0, most)
    return moved / (masses + moved)


def _specification(can: Standing | Scene, visuals: bool = True) -> mujoco.MjSpec:
    """Return the specification of a can that has no free joint yet."""
    if not isinstance(can, Scene):
        return standing_spec(require.instance("can", can, Standing), Setting(), visuals, free=False)
    root, path = _read("lying", Setting().folder)
    mjcf_file.remove(root, "freejoint")
    if can.attachment == "frozen":
        mjcf_file.remove(root, "joint[@name='swing']", "jointpos", "jointvel")
    placed = ("body incline", "euler"), ("body can", "euler"), ("body can", "pos")
    mjcf_file.write(root, lying_parameters(can) | dict.fromkeys(placed, (0.0, 0.0, 0.0)), path)
    return looks.to_spec(root, path, can, visuals)


def standing_spec(can: Standing, setting: Setting, visuals: bool, free: bool) -> mujoco.MjSpec:
    """Return the specification of a standing can; one that is not `free` has neither a joint nor a floor."""
    integrator = require.choice("integrator", setting.integrator, INTEGRATORS)
    root, path = _read("standing", setting.folder)
    if not free:
        mjcf_file.remove(root, "freejoint", "geom[@name='surface']")
    parents = [*root.iterfind(".//body[@name='can']"), *root.iterfind("sensor")]
    first = [(parent, each) for parent in parents for each in parent if "slosh1" in each.get("name", "")]
    for parent, each in first:
        parent.remove(each)
        text = ET.tostring(each, encoding="unicode")
        parent.extend(ET.fromstring(text.replace("slosh1", f"slosh{mode}")) for mode in range(1, can.moving_modes + 1))
    options = {("option", "integrator"): integrator, ("option", "timestep"): (setting.timestep,)}
    mjcf_file.write(root, standing_parameters(can) | options, path)
    return looks.to_spec(root, path, can, visuals)


def _read(name: str, folder: pathlib.Path) -> tuple[ET.Element, pathlib.Path]:
    """Return a mechanics file without keyframes, and its path; numbers that somebody has changed are an error."""
    path = folder / "mechanics" / f"{name}.xml"
    root = mjcf_file.read(path)
    if edited := mjcf_file.differences(root, _paper_parameters(name)):
        raise TemplateError(f"{path} has numbers of its own in {', '.join(edited)}, into which mjbeer writes a can's")
    mjcf_file.remove(root, "keyframe")
    return root, path


def standing_parameters(can: Standing) -> mjcf_file.Parameters:
    """Return the parameters of a standing can, in whose file the origin is the middle of the inside of the bottom.

    What does not slosh is the body "liquid". Each mode is a body "slosh1", "slosh2" ... on a ball joint of its name.
    The masses, first and second moments of all of them together are those of theory, bobs as they are included.
    """
    shell, half = can.can, can.can.length / 2
    across = transverse_inertia(shell)
    found: mjcf_file.Parameters = {
        ("option", "gravity"): (0, 0, -can.gravity),
        ("geom can", "size"): (shell.radius, half),
        ("geom can", "pos"): (0, 0, half),
        **_inertial("can", shell.mass, half, (across, across, shell.inertia)),
    }
    middle, omega, share = can.height / 2, can.frequencies(), _bob_shares(can)
    masses, pivots, lengths = can.slosh_masses(), can.pivots(), can.gravity / omega**2
    critical = 2 * omega * masses * lengths**2
    bobs, arms, spins = masses / (1 - share), lengths * (1 - share), share * masses * lengths**2
    places = pivots - middle - arms
    mass, first, second = can.fixed_moments() - [bobs.sum(), bobs @ places, bobs @ places**2 + spins.sum()]
    dampers = can.damping_ratios() * critical, _BREAKING / omega**2 * critical
    columns = bobs, arms, spins, pivots, *dampers, can.elevations()
    for number, each in enumerate(np.transpose(columns).tolist(), 1):
        name, (bob, arm, spin, pivot, damper, cubic, rise) = f"slosh{number}", each
        found |= _inertial(name, bob, -arm, (spin,) * 3)
        found[f"body {name}", "pos"] = found[f"site {name}_pivot", "pos"] = 0, 0, pivot
        found[f"joint {name}", "damping"] = damper, 0, cubic
        found[f"site {name}_rise", "pos"] = 0, 0, -rise
    level = second - first**2 / mass
    axial = can.mass * shell.radius**2 / 2 if can.moving_modes == 0 else 1e-9 * level  # nothing drags the liquid along
    return found | _inertial("liquid", mass, middle + first / mass, (level, level, axial))


def lying_parameters(scene: Scene) -> mjcf_file.Parameters:
    """Return the parameters of a lying can, in whose file the origin is on the axis."""
    shell, beer = scene.can, scene.load
    if beer.fill is None:
        raise UnsupportedError(f"a can that is free in space has beer in it, got a load without a fill: {scene!r}")
    if scene.drag > 0:
        raise UnsupportedError(f"a can that is free in space has no drag of the air, got {scene.drag!r} kg/m")
    found: mjcf_file.Parameters = {("geom can", "size"): (shell.radius, shell.length / 2)}
    if scene.attachment == "sliding":
        if shell.inertia == 0:
            raise UnsupportedError(
                "MuJoCo moves no can without inertia around a sliding load: give it some, as can=Can.sheet_metal()"
            )
        found["joint swing", "damping"] = tuple(scene.damping_law.coefficients)
    across = transverse_inertia(shell)
    wide = beer.mass * shell.radius**2 * segment(beer.fill).width
    along = beer.mass * shell.length**2 / 12
    load = beer.inertia - wide + along, beer.inertia, wide + along
    found |= _inertial("can", shell.mass, 0.0, (across, shell.inertia, across))
    return found | _inertial("load", beer.mass, -beer.offset, load)


@functools.cache
def _paper_parameters(name: str) -> mjcf_file.Parameters:
    """Return the parameters that a file has as it stands."""
    return lying_parameters(sliding(can=Can.sheet_metal())) if name == "lying" else standing_parameters(standing())


def _inertial(body: str, mass: float, height: float, inertia: tuple[float, ...]) -> mjcf_file.Parameters:
    name = f"inertial {body}"
    return {(name, "mass"): (mass,), (name, "pos"): (0, 0, height), (name, "diaginertia"): inertia}


def transverse_inertia(can: Can) -> float:
    """Return the moment of inertia of a can about a line across its middle [kg m^2].

    Mass and inertia about the axis leave one answer for a thin wall with two flat ends: the ends have the mass
    2 (m - I/a^2), or as much of that as there is.
    """
    ends = min(max(2 * (can.mass - can.inertia / can.radius**2), 0.0), can.mass)
    return can.inertia / 2 + (can.mass + 2 * ends) * can.length**2 / 12
