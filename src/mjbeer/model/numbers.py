"""A scene in a setting as MuJoCo's numbers: which joints and elements a model has, and what is written into them.

Models of one `kind` have the same elements and differ in numbers alone. The numbers go into a specification, or into a
model that is compiled already, by the same function `write`.
"""

import math
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import DOP853, OWN, Setting
from mjbeer.theory.scene import Scene

Kind: TypeAlias = tuple[Hashable, ...]
"""What decides which elements and flags a model has."""
Made: TypeAlias = mujoco.MjSpec | mujoco.MjModel
"""What numbers are written into."""

_SMALLEST = 1e-9
"""Smallest mass [kg] and inertia [kg m^2] that is not scaled: MuJoCo's smallest value (mjMINVAL, 1e-15), a million
times smaller, changes no sum noticeably."""
_LARGEST = 1e3
"""Largest mass [kg] that is not scaled: MuJoCo's smallest softness, 1e-15 /kg, is then 1e-12 of the inverse mass."""
_NOTHING = 1e-30
"""Mass or inertia over the largest one below which it counts as none, as it adds nothing to any sum."""
_POINT = 1e-6
"""A load's own inertia over m b^2 below which it counts as none."""
_HEAVY_CAN = 10.0
"""Largest mass of a can over that of its load with which its whole mass is moved to the load's body."""
_FORCES_SEEN = 2.0**60
"""Factor of all masses where "discrete" meets the damping of a tendon. It then iterates, and takes forces below 3e-8
[N, N m] for none: a load let go 1e-6 rad beside the top would stay there for ever."""
ARM = 1.0
"""Length r of the arms of the chord [m]; any length gives the same inertia."""
IMPEDANCE = (0.9999, 0.9999)
"""dmin and dmax of solimp, the share of its reference acceleration that a constraint reaches: MuJoCo's mjMAXIMP."""
WIDTH = (0.001, 0.5, 2)
"""The other numbers of solimp, MuJoCo's defaults: they have no effect where dmin = dmax."""
FRICTION_HARDNESS = 100.0
"""impratio. More gains little, and from 1e6 on the solver stops converging (errors measured on frozen: 3e-7 rad at 100,
2e-7 rad at 1e4, 5e-3 rad at 1e6)."""
_TOLERANCE = 1e-14
"""The solver's tolerance over the square of gravity: it ends once an iteration gains less than that, and what moves the
load must be more. MuJoCo's own 1e-8 m^2/s^4 takes the weight of a light load for nothing. One more iteration of
Newton's method brings all digits, and 1e-14 costs none in the four scenes; 1e-18 costs a third of the run time."""
_LIGHTEST, _WEIGHTLESS = 1e-10, 1e-5
"""The least share of the tolerance that a light load has, and the least gravity [m/s^2] it is reckoned with. At a
tolerance of 0 the solver would spend all its iterations on rounding."""
_STIFF_INTEGRATORS = ("RK4", "discrete", DOP853)
"""The integrators that are stable with a time constant of half a timestep."""


class Inertial(NamedTuple):
    """The mass [kg] of a body, its distance below the axis [m], and its moment of inertia about itself [kg m^2]."""

    mass: float
    offset: float
    inertia: float


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """The numbers of a scene in a setting; masses and forces are multiplied by `unit`."""

    scene: Scene
    setting: Setting
    timestep: float
    """Timestep of MuJoCo, to which constraints are fitted [s]."""
    tilted: bool
    """Whether gravity is tilted instead of the incline."""
    unit: float
    joints: tuple[str, ...]
    """In the order of qpos."""
    bodies: Mapping[str, Inertial]
    """The bodies that have mass, by name."""
    armature: float = 0.0
    """Mass that only the joint "slide" moves [kg]."""
    force: float = 0.0
    """Constant force [N] or torque [N m] on the first joint, by the actuator "weight"."""
    chord: float = 0.0
    """Armature of the tendon "chord" [kg]."""

    @classmethod
    def of(cls, scene: Scene, setting: Setting, visuals: bool = False, timestep: float | None = None) -> "Numbers":
        """Return the numbers of a scene in a setting; a model with visuals keeps its masses and an upright gravity.

        A `timestep` [s] is instead of the setting's.

        Raises:
          UnsupportedError: if MuJoCo cannot move one of the bodies.
        """
        if setting.rolling != "reduced":
            joints, bodies, forces = _constrained(scene, setting.rolling)
        else:
            joints, bodies, forces = _sliding(scene) if scene.attachment == "sliding" else _frozen(scene)
        unit = mass_unit(scene)
        if setting.rolling == "reduced" and setting.integrator == "discrete" and scene.damping_law and not visuals:
            unit *= _FORCES_SEEN
        return cls(
            scene=scene,
            setting=setting,
            timestep=timestep or setting.timestep,
            tilted=not visuals,
            unit=unit,
            joints=joints,
            bodies={name: Inertial(unit * each.mass, each.offset, unit * each.inertia) for name, each in bodies},
            **{name: unit * force for name, force in forces.items()},
        )

    @cached_property
    def kind(self) -> Kind:
        """Return what decides which elements and flags the model has."""
        forces = self.force != 0, self.chord > 0, bool(self.scene.damping_law), self.scene.dissipates
        return self.setting.rolling, *forces, *self.joints


def mass_unit(scene: Scene) -> float:
    """Return the power of two by which all masses of a scene are multiplied: 1 unless they are tiny or huge.

    Only ratios of masses enter the motion, and a power of two causes no rounding. In a scene with both tiny and huge
    masses the tiny ones decide: MuJoCo's smallest value would otherwise hide them.
    """
    can, base = scene.can, scene.oscillator.base
    if scene.attachment == "frozen":  # one body
        values = scene.mass, _frozen_inertia(scene), base
    else:
        moved = _moved_to_point(scene)
        load = _load_with(scene, moved)
        values = can.mass - moved, can.inertia, load.mass, load.inertia, base
    smallest = min(value for value in values if value > _NOTHING * max(values))
    up = math.ceil(math.log2(_SMALLEST / smallest))
    down = math.floor(math.log2(_LARGEST / scene.effective_mass))
    return 2.0 ** max(up, min(0, down))


def stiffest(integrator: str, timestep: float, contact: bool = False) -> float:
    """Return the time constant [s] of the stiffest critically damped constraint to use with an integrator.

    Semi-implicit Euler, and what is like it, is stable for timesteps up to 0.83 time constants (4 - 4x - x^2 > 0 for
    x = h/tau), and is given 0.5. RK4 is stable up to 2.7 and is given 2, which is stable with DOP853 too; "discrete"
    has no limit. A `contact` opens and closes: with less than a timestep RK4 chatters.
    """
    if integrator not in _STIFF_INTEGRATORS:
        return 2 * timestep
    return timestep if contact else timestep / 2


_Parts: TypeAlias = tuple[tuple[str, ...], list[tuple[str, Inertial]], dict[str, float]]
"""Joints, bodies, and armature, force and chord."""


def _sliding(scene: Scene) -> _Parts:
    """Put the load on a slide (u) and a hinge (phi), with the kinetic energy of eqs. (39) and (44).

    The can's mass is on the same body, as a point on the axis, and its inertia I_can/a^2 is the slide's armature.
    If the can is much heavier than its load, their common centre of mass is so near the axis that the distance would
    be lost in the rounding of u. Then most of the can's mass becomes armature too, and a constant force its weight.
    """
    can = scene.can
    moved = can.mass if can.mass <= _HEAVY_CAN * scene.load.mass else _moved_to_point(scene)
    left = can.mass - moved
    forces = {
        "armature": left + can.inertia / can.radius**2,
        "force": left * scene.gravity * math.sin(scene.incline),
    }
    return ("slide", "phi"), [("can", _load_with(scene, moved))], forces


def _frozen(scene: Scene) -> _Parts:
    """Put can and load on one hinge, phi, whose inertia J(phi) = base + chord sin^2(phi/2) is that of rolling.

    A tendon runs from a fixed site at a height r above the axis to a site on the body at a depth r below it. It is a
    chord of length 2 r |cos(phi/2)| (inscribed angle), so that its armature A adds A r^2 sin^2(phi/2) to J. Gravity
    acts on the moment m b as in eq. (52), and a constant torque replaces its effect on the motion of the axis.
    """
    oscillator, moment = scene.oscillator, scene.load.moment
    # Any mass with the moment m b is right: the scene's at its centre of mass (38), or, where that has more than half
    # of the inertia, a larger mass on a shorter arm that has exactly half.
    mass, offset = scene.mass, scene.centre_of_mass
    if mass * offset**2 > oscillator.base / 2:
        mass, offset = 2 * moment**2 / oscillator.base, oscillator.base / (2 * moment)
    body = Inertial(mass, offset, oscillator.base - mass * offset**2)
    return ("phi",), [("can", body)], {"force": oscillator.slope, "chord": oscillator.chord / ARM**2}


def _constrained(scene: Scene, rolling: str) -> _Parts:
    """Return can and load as they are, which a constraint makes roll."""
    can, joints = scene.can, ("slide", "lift", "roll") if rolling == "contact" else ("slide", "roll")
    if scene.attachment == "frozen":
        inertia = _frozen_inertia(scene)
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo needs; "
                'use rolling="reduced", or give the can mass'
            )
        return joints, [("can", Inertial(scene.mass, scene.centre_of_mass, inertia))], {}
    for lacking, value, remedy in (
        ("a massless can with", can.mass, "mass, as can=Can.sheet_metal() or, on the command line, --can metal"),
        ("a can without inertia around", can.inertia, "inertia"),
    ):
        if value == 0:
            raise UnsupportedError(
                f'{lacking} a sliding load exists only in rolling="reduced": MuJoCo moves no body without mass and '
                f"inertia; give the can {remedy}"
            )
    moved = _moved_to_point(scene)
    bodies = [("can", Inertial(can.mass - moved, 0.0, can.inertia)), ("load", _load_with(scene, moved))]
    return (*joints, "swing"), bodies, {}


def _moved_to_point(scene: Scene) -> float:
    """Return the mass [kg] to move from the can to a load that is a point, as MuJoCo moves no body without inertia.

    A point on the axis moves with the load exactly as with the can, and gives a point load an inertia.
    """
    load = scene.load
    return min(scene.can.mass / 2, load.mass) if load.inertia < _POINT * load.mass * load.offset**2 else 0.0


def _load_with(scene: Scene, moved: float) -> Inertial:
    """Return the load with the mass `moved` [kg] from the can to it, as a point on the axis."""
    load = scene.load
    mass = load.mass + moved
    return Inertial(mass, load.moment / mass, load.inertia + load.moment * load.offset * moved / mass)


def _frozen_inertia(scene: Scene) -> float:
    """Return the moment of inertia of can and frozen load about their common centre of mass [kg m^2]."""
    can, load = scene.can, scene.load
    return load.inertia + can.inertia + load.mass * can.mass / scene.mass * load.offset**2


def write(numbers: Numbers, made: Made) -> None:
    """Write all numbers into a specification that has the elements of their kind, or a model compiled from it."""
    scene, setting, compiled = numbers.scene, numbers.setting, isinstance(made, mujoco.MjModel)
    option = made.opt if compiled else made.option
    integrator = "RK4" if setting.integrator in OWN else setting.integrator  # mjbeer's own step by themselves
    option.integrator = int(mujoco.mjtIntegrator.__members__[f"mjINT_{integrator.upper()}"])
    option.timestep = numbers.timestep
    tilt = scene.incline if numbers.tilted else 0.0
    option.gravity = [scene.gravity * math.sin(tilt), 0, -scene.gravity * math.cos(tilt)]
    for name, body in numbers.bodies.items():
        part = made.body(name)
        part.mass, part.ipos, part.inertia = body.mass, [0, 0, -body.offset], [body.inertia] * 3
    if "slide" in numbers.joints:
        made.joint("slide").armature = numbers.armature
    if numbers.force != 0:
        made.actuator("weight").biasprm[0] = numbers.force
    if numbers.chord > 0 and compiled:
        made.tendon_armature[made.tendon("chord").id] = numbers.chord
    elif numbers.chord > 0:
        made.tendon("chord").armature = numbers.chord
    if scene.dissipates:
        _write_damping(numbers, made)
    if setting.rolling == "equality":
        rolling, radius = made.equality("rolling"), scene.can.radius
        rolling.data[:5] = [0, radius, 0, 0, 0]
        _write_softness(rolling, numbers)
    elif setting.rolling == "contact":
        _write_contact(made, option, numbers)


def _write_contact(made: Made, option: Any, numbers: Numbers) -> None:
    scene, setting = numbers.scene, numbers.setting
    radius, half = scene.can.radius, scene.can.length / 2
    made.body("can").pos = [0, 0, radius]
    made.geom("can").size = [radius, half, 0]
    rolling = made.pair("rolling")
    rolling.friction = [setting.friction, setting.friction, 0.005, 1e-4, 1e-4]
    _write_softness(rolling, numbers)
    option.impratio = FRICTION_HARDNESS
    # What the weight of the load gains, over what that of all masses gains: each is a force squared over an inertia.
    light = scene.load.moment**2 / (scene.mass * float(scene.oscillator.inertia(math.pi / 2)))
    option.tolerance = _TOLERANCE * min(1.0, max(light, _LIGHTEST)) * max(scene.gravity, _WEIGHTLESS) ** 2
    if isinstance(made, mujoco.MjModel):  # what the compiler derives from the size
        made.geom("can").rbound = math.sqrt(radius**2 + half**2)
        made.geom_aabb[made.geom("can").id] = [0, 0, 0, radius, radius, half]


def _write_softness(rolling: Any, numbers: Numbers) -> None:
    """Write the softness of the row of a joint equality, or of a contact's rows."""
    rolling.solimp = [*IMPEDANCE, *WIDTH]
    contact = numbers.setting.rolling == "contact"
    rolling.solref = stiffest(numbers.setting.integrator, numbers.timestep, contact), 1


def _write_damping(numbers: Numbers, made: Made) -> None:
    """Write MuJoCo's polynomials of a rate v, d1 v + d2 v |v| + d3 v^3; a drag of 0 may follow another one."""
    scene, compiled = numbers.scene, isinstance(made, mujoco.MjModel)
    damped = [("dof", made.joint("slide"), (0.0, scene.drag, 0.0))]
    if scene.damping_law:
        load = ("dof", made.joint("swing")) if "swing" in numbers.joints else ("tendon", made.tendon("damper"))
        damped.append((*load, scene.damping_law.coefficients))
    for kind, element, coefficients in damped:
        first, *others = (numbers.unit * each for each in coefficients)
        if compiled:  # each joint has one degree of freedom
            getattr(made, f"{kind}_damping")[element.id], getattr(made, f"{kind}_dampingpoly")[element.id] = (
                first,
                others,
            )
        else:
            element.damping = [first, *others]
    if scene.damping_law and "swing" not in numbers.joints:  # the tendon's length is phi - u/a
        if compiled:
            made.wrap_prm[made.tendon_adr[made.tendon("damper").id] + 1] = -1 / scene.can.radius
        else:
            made.tendon("damper").wrap_joint("slide", -1 / scene.can.radius)
