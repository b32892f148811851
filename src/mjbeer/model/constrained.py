"""Models in which MuJoCo's constraint solver makes the can roll: a joint equality, or contact with friction.

MuJoCo's constraints are soft. What follows makes them as hard as each integrator bears.
"""

import math

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model import joints
from mjbeer.model.inertia import frozen_inertia, point_share, set_inertial, weightless
from mjbeer.model.setting import Setting
from mjbeer.theory.scene import Scene

_IMPEDANCE = (0.9999, 0.9999)
"""dmin and dmax of solimp: the hardest that MuJoCo takes (mjMAXIMP). It is the share of a force that is not let
through."""
_WIDTH = (0.001, 0.5, 2)
"""The rest of solimp, MuJoCo's default: with dmin = dmax it does nothing."""
_FRICTION_HARDNESS = 100.0
"""impratio: friction rows this much harder than the normal one. More gains little; from 1e6 on the solver
stops converging (measured on frozen: error 3e-7 rad at 100, 2e-7 at 1e4, 5e-3 at 1e6)."""
_TOLERANCE, _STANDARD_GRAVITY = 1e-8, 9.81
"""Where MuJoCo's solver stops [m^2/s^4], its own default, and the gravity that suits [m/s^2]: its scale is the square
of an acceleration, so that in weak gravity it would stop before it begins, and nothing would roll."""
_WEIGHTLESS = 1e-6
"""Gravity over the standard one that stands for none at all."""
_BEARS_STIFFNESS = ("RK4", "discrete", "DOP853")


def stiffest(integrator: str, timestep: float, contact: bool = False) -> float:
    """Time constant [s] of the stiffest critically damped constraint under an integrator.

    Semi-implicit Euler and its kin are stable for a timestep up to 0.83 time constants
    (4 - 4x - x^2 > 0 for x = h/tau) and get 0.5. RK4 is up to 2.7 and gets 2, which DOP853 bears as well;
    for "discrete" there is no bound. A `contact` comes and goes and gets no less than a timestep: with half
    of one RK4 chatters. MuJoCo's `refsafe` would raise all to two timesteps and is off.
    """
    if integrator not in _BEARS_STIFFNESS:
        return 2 * timestep
    return timestep if contact else timestep / 2


def roll_by_equality(spec: mujoco.MjSpec, scene: Scene, unit: float, setting: Setting) -> None:
    """Make the can roll by a joint equality u = a roll."""
    _inertials(spec, scene, unit)
    joints.add(spec, "slide", "roll", *_swing(scene))
    rolling = spec.add_equality(name="rolling", type=mujoco.mjtEq.mjEQ_JOINT, name1="slide", name2="roll")
    rolling.data[:5] = [0, scene.can.radius, 0, 0, 0]
    if setting.softness.first == "hinge":
        rolling.name1, rolling.name2 = rolling.name2, rolling.name1
        rolling.data[1] = 1 / scene.can.radius
    _harden(spec, rolling, setting)


def make_rigid(model: mujoco.MjModel) -> None:
    """Have the joint equality of a compiled model solved exactly; MJCF cannot say this.

    A row's softness is a share of the inverse inertia that the compiled model has for its joints, which nothing else
    reads here. Without it, one sweep of PGS over the one row is its solution, without a tolerance, where Newton
    would weigh a nearly infinite stiffness against the inertias.
    """
    model.dof_invweight0[:] = 0
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    model.opt.iterations, model.opt.tolerance = 1, 0.0


def roll_by_contact(spec: mujoco.MjSpec, scene: Scene, unit: float, setting: Setting) -> None:
    """Make the can roll as a cylinder on a plane, with friction and nothing else to hold it there."""
    _inertials(spec, scene, unit)
    joints.add(spec, "slide", "lift", "roll", *_swing(scene))
    _add_collision(spec, "incline", "surface", mujoco.mjtGeom.mjGEOM_PLANE, [0, 0, 1])
    cylinder = _add_collision(
        spec, "can", "can", mujoco.mjtGeom.mjGEOM_CYLINDER, [scene.can.radius, scene.can.length / 2, 0]
    )
    cylinder.quat = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    rolling = spec.add_pair(name="rolling", geomname1="surface", geomname2="can", condim=3)
    rolling.friction = [setting.friction, setting.friction, 0.005, 1e-4, 1e-4]
    _harden(spec, rolling, setting)
    cones = mujoco.mjtCone
    spec.option.cone = cones.mjCONE_ELLIPTIC if setting.softness.elliptic else cones.mjCONE_PYRAMIDAL
    spec.option.impratio = setting.softness.impratio or _FRICTION_HARDNESS
    weight = max(scene.gravity / _STANDARD_GRAVITY, _WEIGHTLESS)
    spec.option.tolerance = _TOLERANCE * min(1.0, weight) ** 2


def _swing(scene: Scene) -> tuple[str, ...]:
    return ("swing",) if scene.attachment == "sliding" else ()


def _add_collision(
    spec: mujoco.MjSpec, body: str, name: str, kind: mujoco.mjtGeom, size: list[float]
) -> mujoco.MjsGeom:
    """Add a massless geom that touches in the pair alone; the template's class "collision" says how it looks."""
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
    # The default diagonal adds the inverse inertias of slide and hinge, metres and radians alike.
    if softness.exact_diagonal:
        spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    if not softness.refsafe:
        spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)


def _inertials(spec: mujoco.MjSpec, scene: Scene, unit: float) -> None:
    can = scene.can
    if scene.attachment == "frozen":  # one rigid body: all of it on the can
        inertia = frozen_inertia(scene)
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo wants; "
                'use rolling="reduced", or give the can mass'
            )
        set_inertial(spec.body("can"), unit * scene.mass, scene.centre_of_mass, unit * inertia)
        weightless(spec.body("load"))
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
    share = point_share(scene)
    set_inertial(spec.body("can"), unit * (can.mass - share.moved), 0.0, unit * can.inertia)
    set_inertial(spec.body("load"), unit * share.mass, share.offset, unit * share.inertia)
