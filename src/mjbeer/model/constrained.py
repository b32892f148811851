"""Models in which MuJoCo's constraint solver makes the can roll: by a joint equality, or by contact with friction.

MuJoCo's constraints are soft. Here they are made as hard as is stable under the integrator.
"""

import math
from typing import Any

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import joints
from mjbeer.model.inertia import frozen_inertia, hold_inertial, load_with_inertia, remove_mass
from mjbeer.model.mechanics import Inertial, Mechanics, dissipation
from mjbeer.model.setting import TUNED, Setting
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


def mechanics(scene: Scene, unit: float, rolling: str) -> Mechanics:
    """Return the joints and masses of can and load, and the damping between them.

    Raises:
      UnsupportedError: if MuJoCo cannot move one of them, as it has no mass or no inertia.
    """
    axis = ("slide", "lift", "roll") if rolling == "contact" else ("slide", "roll")
    return Mechanics(joints=(*axis, *_load_joints(scene)), bodies=_inertials(scene, unit), **dissipation(scene, unit))


def add_equality(spec: mujoco.MjSpec, moving: Mechanics, setting: Setting) -> None:
    """Add the elements of a model whose can rolls by a joint equality u = a roll, without their numbers."""
    _add_bodies(spec, moving)
    names = ("slide", "roll") if setting.softness.first == "slide" else ("roll", "slide")
    rolling = spec.add_equality(name="rolling", type=mujoco.mjtEq.mjEQ_JOINT, name1=names[0], name2=names[1])
    _harden(spec, rolling, setting)


def fit_equality(made: mujoco.MjSpec | mujoco.MjModel, scene: Scene, setting: Setting) -> None:
    """Write the numbers of the joint equality into a specification or a compiled model that has it."""
    rolling, radius = made.equality("rolling"), scene.can.radius
    rolling.data[:5] = [0, radius if setting.softness.first == "slide" else 1 / radius, 0, 0, 0]
    _fit_stiffness(rolling, setting)


def is_rigid(setting: Setting) -> bool:
    """Return whether a model's rolling is a joint equality that `make_rigid` makes exact."""
    return setting.rolling == "equality" and setting.softness == TUNED


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


def add_contact(spec: mujoco.MjSpec, moving: Mechanics, setting: Setting) -> None:
    """Add the elements of a cylinder that only gravity and friction hold on a plane, without their numbers."""
    _add_bodies(spec, moving)
    _add_collision(spec, body="incline", name="surface", kind=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    cylinder = _add_collision(spec, body="can", name="can", kind=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[1, 1, 0])
    cylinder.quat = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    rolling = spec.add_pair(name="rolling", geomname1="surface", geomname2="can", condim=3)
    _harden(spec, rolling, setting)
    cones = mujoco.mjtCone
    spec.option.cone = cones.mjCONE_ELLIPTIC if setting.softness.elliptic else cones.mjCONE_PYRAMIDAL
    spec.option.impratio = setting.softness.impratio or _FRICTION_HARDNESS


def fit_contact(made: mujoco.MjSpec | mujoco.MjModel, scene: Scene, setting: Setting) -> None:
    """Write the numbers of the contact into a specification or a compiled model that has it."""
    radius, half = scene.can.radius, scene.can.length / 2
    made.body("can").pos = [0, 0, radius]
    made.geom("can").size = [radius, half, 0]
    rolling = made.pair("rolling")
    rolling.friction = [setting.friction, setting.friction, 0.005, 1e-4, 1e-4]
    _fit_stiffness(rolling, setting)
    option = made.opt if isinstance(made, mujoco.MjModel) else made.option
    relative_gravity = max(scene.gravity / _STANDARD_GRAVITY, _WEIGHTLESS)
    option.tolerance = _TOLERANCE * min(1.0, relative_gravity) ** 2
    if isinstance(made, mujoco.MjModel):  # what the compiler derives from the size
        made.geom("can").rbound = math.sqrt(radius**2 + half**2)
        made.geom_aabb[made.geom("can").id] = [0, 0, 0, radius, radius, half]


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
    rolling.solimp = [*(softness.impedance or _IMPEDANCE), *_WIDTH]
    # MuJoCo's default diagonal adds the inverse inertias of slide and hinge without regard to metres and radians.
    if softness.exact_diagonal:
        spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    if not softness.refsafe:
        spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)


def _fit_stiffness(rolling: Any, setting: Setting) -> None:
    """Write the time constant and damping of the row of a joint equality, or of a contact's rows."""
    timeconst = stiffest(setting.integrator, setting.timestep, contact=setting.rolling == "contact")
    rolling.solref = setting.softness.solref or (timeconst, 1)


def _add_bodies(spec: mujoco.MjSpec, moving: Mechanics) -> None:
    for body in ("can", "load"):
        if body in moving.bodies:
            hold_inertial(spec.body(body))
        else:  # one rigid body, all of whose mass is on the body "can"
            remove_mass(spec.body(body))
    joints.add(spec, *moving.joints)


def _inertials(scene: Scene, unit: float) -> dict[str, Inertial]:
    can = scene.can
    if scene.attachment == "frozen":
        inertia = frozen_inertia(scene)
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo needs; "
                'use rolling="reduced", or give the can mass'
            )
        return {"can": Inertial(unit * scene.mass, scene.centre_of_mass, unit * inertia)}
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
    return {
        "can": Inertial(unit * (can.mass - load.moved), 0.0, unit * can.inertia),
        "load": Inertial(unit * load.mass, load.offset, unit * load.inertia),
    }
