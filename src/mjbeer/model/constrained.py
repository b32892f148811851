"""Models in which MuJoCo's constraint solver makes the can roll: by a joint equality, or by contact with friction.

MuJoCo's constraints are soft. Here they are made as hard as is stable under the integrator.
"""

import math

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import joints
from mjbeer.model.inertia import frozen_inertia, load_with_inertia, remove_mass, set_inertial
from mjbeer.model.setting import Setting
from mjbeer.theory.scene import Scene

_IMPEDANCE = (0.9999, 0.9999)
"""dmin and dmax of solimp, the share of its reference acceleration that a constraint reaches: the largest that MuJoCo
accepts (mjMAXIMP)."""
_WIDTH = (0.001, 0.5, 2)
"""The other numbers of solimp, MuJoCo's defaults: they have no effect where dmin = dmax."""
_FRICTION_HARDNESS = 100.0
"""impratio, the hardness of the friction rows over that of the normal row. More gains little, and from 1e6 on the
solver stops converging (errors measured on frozen: 3e-7 rad at 100, 2e-7 rad at 1e4, 5e-3 rad at 1e6)."""
_TOLERANCE = 1e-8
"""MuJoCo's default for the tolerance of its solver [m^2/s^4], which suits standard gravity. In weak gravity it must
fall with the square of gravity, or the solver would stop before it begins, and nothing would roll."""
_STANDARD_GRAVITY = 9.81
"""Standard acceleration of gravity [m/s^2]."""
_WEIGHTLESS = 1e-6
"""Smallest gravity over standard gravity to which the tolerance is fitted."""
_STIFF_INTEGRATORS = ("RK4", "discrete", "DOP853")
"""The integrators that are stable with a time constant of half a timestep."""


def stiffest(integrator: str, timestep: float, contact: bool = False) -> float:
    """Return the time constant [s] of the stiffest critically damped constraint to use with an integrator.

    Semi-implicit Euler, and what is like it, is stable for timesteps up to 0.83 time constants (4 - 4x - x^2 > 0 for
    x = h/tau), and is given 0.5. RK4 is stable up to 2.7 and is given 2, which is stable with DOP853 too; "discrete"
    has no limit. A `contact` opens and closes, and its time constant is at least a timestep: with half a timestep RK4
    chatters. MuJoCo's `refsafe`, which would raise all of them to two timesteps, is off.
    """
    if integrator not in _STIFF_INTEGRATORS:
        return 2 * timestep
    return timestep if contact else timestep / 2


def roll_by_equality(spec: mujoco.MjSpec, scene: Scene, unit: float, setting: Setting) -> None:
    """Make the can roll by a joint equality u = a roll."""
    _set_inertias(spec, scene, unit)
    joints.add(spec, "slide", "roll", *_load_joints(scene))
    rolling = spec.add_equality(name="rolling", type=mujoco.mjtEq.mjEQ_JOINT, name1="slide", name2="roll")
    rolling.data[:5] = [0, scene.can.radius, 0, 0, 0]
    if setting.softness.first == "hinge":
        rolling.name1, rolling.name2 = rolling.name2, rolling.name1
        rolling.data[1] = 1 / scene.can.radius
    _harden(spec, rolling, setting)


def make_rigid(model: mujoco.MjModel) -> None:
    """Change a compiled model so that MuJoCo solves its joint equality exactly, which MJCF cannot express.

    A row's softness is proportional to the inverse inertia that the compiled model stores for its joints, which is
    used for nothing else here, and so is set to 0. One sweep of PGS then solves the single row,
    where Newton would add a nearly infinite stiffness to the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations, model.opt.tolerance = 1, 0.0


def roll_by_contact(spec: mujoco.MjSpec, scene: Scene, unit: float, setting: Setting) -> None:
    """Make the can roll as a cylinder that only gravity and friction hold on a plane."""
    _set_inertias(spec, scene, unit)
    joints.add(spec, "slide", "lift", "roll", *_load_joints(scene))
    _add_collision(spec, body="incline", name="surface", kind=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    size = [scene.can.radius, scene.can.length / 2, 0]
    cylinder = _add_collision(spec, body="can", name="can", kind=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size)
    cylinder.quat = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    rolling = spec.add_pair(name="rolling", geomname1="surface", geomname2="can", condim=3)
    rolling.friction = [setting.friction, setting.friction, 0.005, 1e-4, 1e-4]
    _harden(spec, rolling, setting)
    cones = mujoco.mjtCone
    spec.option.cone = cones.mjCONE_ELLIPTIC if setting.softness.elliptic else cones.mjCONE_PYRAMIDAL
    spec.option.impratio = setting.softness.impratio or _FRICTION_HARDNESS
    relative_gravity = max(scene.gravity / _STANDARD_GRAVITY, _WEIGHTLESS)
    spec.option.tolerance = _TOLERANCE * min(1.0, relative_gravity) ** 2


def _load_joints(scene: Scene) -> tuple[str, ...]:
    return ("swing",) if scene.attachment == "sliding" else ()


def _add_collision(
    spec: mujoco.MjSpec, body: str, name: str, kind: mujoco.mjtGeom, size: list[float]
) -> mujoco.MjsGeom:
    """Add a massless geom that collides only in explicit pairs and looks like the template's class "collision"."""
    geom = spec.body(body).add_geom(spec.default, name=name, type=kind, size=size)
    geom.contype = geom.conaffinity = 0
    geom.mass = 0.0
    looks = spec.find_default("collision").geom
    geom.group, geom.rgba = looks.group, looks.rgba
    return geom


def _harden(spec: mujoco.MjSpec, rolling: mujoco.MjsEquality | mujoco.MjsPair, setting: Setting) -> None:
    softness = setting.softness
    timeconst = stiffest(setting.integrator, setting.timestep, contact=setting.rolling == "contact")
    rolling.solref = softness.solref or (timeconst, 1)
    rolling.solimp = [*(softness.impedance or _IMPEDANCE), *_WIDTH]
    # MuJoCo's default diagonal adds the inverse inertias of slide and hinge without regard to metres and radians.
    if softness.exact_diagonal:
        spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    if not softness.refsafe:
        spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)


def _set_inertias(spec: mujoco.MjSpec, scene: Scene, unit: float) -> None:
    can = scene.can
    if scene.attachment == "frozen":  # one rigid body, all of whose mass is on the body "can"
        inertia = frozen_inertia(scene)
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo needs; "
                'use rolling="reduced", or give the can mass'
            )
        mass, offset = unit * scene.mass, scene.centre_of_mass
        set_inertial(spec.body("can"), mass=mass, offset=offset, inertia=unit * inertia)
        remove_mass(spec.body("load"))
        return
    if can.mass == 0:
        raise UnsupportedError(
            'a massless can with a sliding load exists only in rolling="reduced": MuJoCo has no massless moving body; '
            "give the can mass, as can=Can.sheet_metal() or, on the command line, --can metal"
        )
    if can.inertia == 0:
        raise UnsupportedError(
            'a can without inertia around a sliding load exists only in rolling="reduced": MuJoCo has no moving body '
            "without inertia; give the can inertia"
        )
    load = load_with_inertia(scene)
    can_mass, load_mass = unit * (can.mass - load.moved), unit * load.mass
    set_inertial(spec.body("can"), mass=can_mass, offset=0.0, inertia=unit * can.inertia)
    set_inertial(spec.body("load"), mass=load_mass, offset=load.offset, inertia=unit * load.inertia)
