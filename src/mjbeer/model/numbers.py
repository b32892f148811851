"""A scene in a setting as MuJoCo's numbers: which joints and elements a model has, and what is written into them.

Which elements there are is a `Kind`, decided by few things; models of one kind differ in numbers alone. The numbers go
into a specification, or into a model that is compiled already, by the same function `write`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import mujoco

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import DOP853, OWN, FirstJoint, Setting
from mjbeer.theory.scene import Scene

Made: TypeAlias = mujoco.MjSpec | mujoco.MjModel
"""What numbers are written into."""

_SMALLEST = 1e-9
"""Smallest mass [kg] and inertia [kg m^2] that is not scaled. It is a million times MuJoCo's smallest value (mjMINVAL,
1e-15), which is then too small to change any sum noticeably."""
_LARGEST = 1e3
"""Largest mass [kg] that is not scaled. MuJoCo's smallest softness of a constraint, 1e-15 /kg, is then 1e-12 of the
inverse mass."""
_NOTHING = 1e-30
"""Mass or inertia over the largest one below which it counts as none, as it adds nothing to any sum."""
_POINT = 1e-6
"""A load's own inertia over m b^2 below which it counts as none."""
_HEAVY_CAN = 10.0
"""Largest mass of a can over that of its load with which its whole mass is moved to the load's body."""
_FORCES_SEEN = 2.0**60
"""Factor of all masses where "discrete" meets the damping of a tendon. It then iterates for the acceleration, and takes
forces below 3e-8 [N, N m] for none: at its true mass, a load that is let go 1e-6 rad beside the top would stay there
for ever."""
ARM = 1.0
"""Length r of the arms of the chord [m]; any length gives the same inertia."""
_IMPEDANCE = (0.9999, 0.9999)
"""dmin and dmax of solimp, the share of its reference acceleration that a constraint reaches: the largest that MuJoCo
accepts (mjMAXIMP)."""
_WIDTH = (0.001, 0.5, 2)
"""The other numbers of solimp, MuJoCo's defaults: they have no effect where dmin = dmax."""
_FRICTION_HARDNESS = 100.0
"""impratio, the hardness of the friction rows over that of the normal row. More gains little, and from 1e6 on the
solver stops converging (errors measured on frozen: 3e-7 rad at 100, 2e-7 rad at 1e4, 5e-3 rad at 1e6)."""
_TOLERANCE, _STANDARD_GRAVITY, _WEIGHTLESS = 1e-8, 9.81, 1e-6
"""MuJoCo's default for the tolerance of its solver [m^2/s^4] suits standard gravity [m/s^2]. In weak gravity it must
fall with the square of gravity, or the solver would stop before it begins, and nothing would roll; it is fitted down to
the third number, gravity over standard gravity."""
_STIFF_INTEGRATORS = ("RK4", "discrete", DOP853)
"""The integrators that are stable with a time constant of half a timestep."""


class Kind(NamedTuple):
    """What decides which elements and flags a model has."""

    rolling: str
    joints: tuple[str, ...]
    """In the order of qpos."""
    pushed: bool
    """Whether a constant force acts, by the actuator "weight"."""
    chord: bool
    """Whether it has the tendon "chord"."""
    damped: bool
    """Whether there is damping between can and load; then, or with drag, it `dissipates`."""
    dissipates: bool
    rigid: bool
    """Whether its joint equality is solved exactly; the rest are flags of its softness."""
    first: FirstJoint
    refsafe: bool
    exact_diagonal: bool
    elliptic: bool


class Inertial(NamedTuple):
    """The mass of a body."""

    mass: float
    """Mass [kg]."""
    offset: float
    """Distance of its centre of mass below the axis [m]."""
    inertia: float
    """Moment of inertia about the centre of mass [kg m^2]."""


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """The numbers of a scene in a setting; masses and forces are multiplied by the scene's unit of mass."""

    scene: Scene
    setting: Setting
    timestep: float
    """Timestep of MuJoCo, to which constraints are fitted [s]."""
    tilted: bool
    """Whether gravity is tilted instead of the incline."""
    joints: tuple[str, ...]
    """The joints, in the order of qpos."""
    bodies: Mapping[str, Inertial]
    """The bodies that have mass, by name."""
    damping: tuple[float, ...]
    """The coefficients of damping between can and load [N m s], [N m s^2] and [N m s^3]."""
    drag: float
    """Force against the joint "slide" over the square of its rate [kg/m]."""
    armature: float = 0.0
    """Mass that only the joint "slide" moves [kg]."""
    force: float = 0.0
    """Constant force [N] or torque [N m] on the first joint."""
    chord: float = 0.0
    """Armature of the tendon "chord" [kg]."""

    @classmethod
    def of(cls, scene: Scene, setting: Setting, visuals: bool = False, timestep: float | None = None) -> "Numbers":
        """Return the numbers of a scene in a setting; a model with visuals keeps its masses and an upright gravity.

        A `timestep` [s] is instead of the setting's.

        Raises:
          UnsupportedError: if MuJoCo cannot move one of the bodies.
        """
        unit = mass_unit(scene)
        if setting.rolling == "reduced" and setting.integrator == "discrete" and scene.damping_law and not visuals:
            unit *= _FORCES_SEEN
        if setting.rolling != "reduced":
            own = _constrained(scene, unit, setting.rolling)
        else:
            own = _sliding(scene, unit) if scene.attachment == "sliding" else _frozen(scene, unit)
        damping = tuple(unit * each for each in scene.damping_law.coefficients)
        return cls(
            scene=scene,
            setting=setting,
            timestep=timestep or setting.timestep,
            tilted=not visuals,
            damping=damping,
            drag=unit * scene.drag,
            **own,
        )

    @cached_property
    def kind(self) -> Kind:
        """Return what decides which elements the model has."""
        soft, damped = self.setting.softness, any(self.damping)
        return Kind(
            self.setting.rolling,
            self.joints,
            pushed=self.force != 0,
            chord=self.chord > 0,
            damped=damped,
            dissipates=damped or self.drag > 0,
            rigid=self.setting.rigid,
            first=soft.first,
            refsafe=soft.refsafe,
            exact_diagonal=soft.exact_diagonal,
            elliptic=soft.elliptic,
        )


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
    has no limit. A `contact` opens and closes, and its time constant is at least a timestep: with half a timestep RK4
    chatters. MuJoCo's `refsafe`, which would raise all of them to two timesteps, is off.
    """
    if integrator not in _STIFF_INTEGRATORS:
        return 2 * timestep
    return timestep if contact else timestep / 2


def _sliding(scene: Scene, unit: float) -> dict[str, Any]:
    """Put the load on a slide (u) and a hinge (phi), with the kinetic energy of eqs. (39) and (44).

    The can's mass is on the same body, as a point on the axis, and its inertia I_can/a^2 is the slide's armature.
    If the can is much heavier than its load, their common centre of mass is so near the axis that the distance would
    be lost in the rounding of u. Then most of the can's mass becomes armature too, and a constant force its weight.
    """
    can = scene.can
    moved = can.mass if can.mass <= _HEAVY_CAN * scene.load.mass else _moved_to_point(scene)
    return {
        "joints": ("slide", "phi"),
        "bodies": {"can": _scaled(unit, _load_with(scene, moved))},
        "armature": unit * (can.mass - moved + can.inertia / can.radius**2),
        "force": unit * (can.mass - moved) * scene.gravity * math.sin(scene.incline),
    }


def _frozen(scene: Scene, unit: float) -> dict[str, Any]:
    """Put can and load on one hinge, phi, whose inertia J(phi) = base + chord sin^2(phi/2) is that of rolling.

    A tendon runs from a fixed site at a height r above the axis to a site on the body at a depth r below it. It is a
    chord of length 2 r |cos(phi/2)| (inscribed angle), so that its armature A adds A r^2 sin^2(phi/2) to J. Gravity
    acts on the moment m b as in eq. (52), and a constant torque replaces its effect on the motion of the axis.
    """
    oscillator = scene.oscillator
    moment = scene.load.moment
    # Any mass with the moment m b is right. The scene's mass at its centre of mass (38) is the natural choice. Where it
    # would have more than half of the inertia, a larger mass on a shorter arm is chosen that has exactly half.
    mass, offset = scene.mass, scene.centre_of_mass
    if mass * offset**2 > oscillator.base / 2:
        mass, offset = 2 * moment**2 / oscillator.base, oscillator.base / (2 * moment)
    return {
        "joints": ("phi",),
        "bodies": {"can": _scaled(unit, Inertial(mass, offset, oscillator.base - mass * offset**2))},
        "force": unit * oscillator.slope,
        "chord": unit * oscillator.chord / ARM**2,
    }


def _constrained(scene: Scene, unit: float, rolling: str) -> dict[str, Any]:
    """Return the joints and masses of can and load as they are, which a constraint makes roll.

    Raises:
      UnsupportedError: if MuJoCo cannot move one of them, as it has no mass or no inertia.
    """
    can, joints = scene.can, ("slide", "lift", "roll") if rolling == "contact" else ("slide", "roll")
    if scene.attachment == "frozen":
        inertia = _frozen_inertia(scene)
        if inertia == 0:
            raise UnsupportedError(
                "a point load frozen to a massless can has no inertia about its centre of mass, which MuJoCo needs; "
                'use rolling="reduced", or give the can mass'
            )
        return {"joints": joints, "bodies": {"can": _scaled(unit, Inertial(scene.mass, scene.centre_of_mass, inertia))}}
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
    moved = _moved_to_point(scene)
    bodies = {"can": Inertial(can.mass - moved, 0.0, can.inertia), "load": _load_with(scene, moved)}
    return {"joints": (*joints, "swing"), "bodies": {name: _scaled(unit, body) for name, body in bodies.items()}}


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
    inertia = load.inertia + load.moment * load.offset * moved / mass
    return Inertial(mass, load.moment / mass, inertia)


def _frozen_inertia(scene: Scene) -> float:
    """Return the moment of inertia of can and frozen load about their common centre of mass [kg m^2]."""
    can, load = scene.can, scene.load
    return load.inertia + can.inertia + load.mass * can.mass / scene.mass * load.offset**2


def _scaled(unit: float, body: Inertial) -> Inertial:
    return Inertial(unit * body.mass, body.offset, unit * body.inertia)


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
    if numbers.chord > 0:
        chord = made.tendon("chord")
        if compiled:
            made.tendon_armature[chord.id] = numbers.chord
        else:
            chord.armature = numbers.chord
    # MuJoCo's polynomials of a rate v: d1 v + d2 v |v| + d3 v^3. A drag of 0 may follow another one in a model.
    if numbers.kind.dissipates:
        _write_damping(made, "slide", (0.0, numbers.drag, 0.0))
    if numbers.kind.damped and "swing" in numbers.joints:
        _write_damping(made, "swing", numbers.damping)
    elif numbers.kind.damped:
        _write_damper(made, numbers.damping, -1 / scene.can.radius)
    if setting.rolling == "equality":
        rolling, radius = made.equality("rolling"), scene.can.radius
        rolling.data[:5] = [0, radius if setting.softness.first == "slide" else 1 / radius, 0, 0, 0]
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
    option.impratio = setting.softness.impratio or _FRICTION_HARDNESS
    weight = max(scene.gravity / _STANDARD_GRAVITY, _WEIGHTLESS)
    option.tolerance = _TOLERANCE * min(1.0, weight) ** 2
    if isinstance(made, mujoco.MjModel):  # what the compiler derives from the size
        made.geom("can").rbound = math.sqrt(radius**2 + half**2)
        made.geom_aabb[made.geom("can").id] = [0, 0, 0, radius, radius, half]


def _write_softness(rolling: Any, numbers: Numbers) -> None:
    """Write the softness of the row of a joint equality, or of a contact's rows."""
    setting, softness = numbers.setting, numbers.setting.softness
    rolling.solimp = [*(softness.impedance or _IMPEDANCE), *_WIDTH]
    fastest = stiffest(setting.integrator, numbers.timestep, contact=setting.rolling == "contact")
    rolling.solref = softness.solref or (fastest, 1)


def _write_damping(made: Made, joint: str, damping: tuple[float, ...]) -> None:
    if isinstance(made, mujoco.MjModel):
        made.joint(joint).damping, made.joint(joint).dampingpoly = damping[0], damping[1:]
    else:
        made.joint(joint).damping = damping


def _write_damper(made: Made, damping: tuple[float, ...], slide: float) -> None:
    """Write the damping of the tendon "damper", and the weight with which the joint "slide" is part of its length."""
    damper = made.tendon("damper")
    if isinstance(made, mujoco.MjModel):
        made.tendon_damping[damper.id], made.tendon_dampingpoly[damper.id] = damping[0], damping[1:]
        made.wrap_prm[made.tendon_adr[damper.id] + 1] = slide
    else:
        damper.damping = damping
        damper.wrap_joint("slide", slide)
