"""Models without a constraint, whose coordinates allow no other motion than rolling without slipping.

The can's rotation follows from u, or from phi, and its inertia is added to theirs. There is no constraint to solve,
and no error but the integrator's.
"""

import math

import mujoco

from mjbeer.model import joints
from mjbeer.model.appearance import TURNING
from mjbeer.model.inertia import hold_inertial, load_with_can_mass, load_with_inertia, remove_mass
from mjbeer.model.mechanics import Inertial, Mechanics, dissipation
from mjbeer.theory.scene import Scene

_HEAVY = 10.0
"""Largest mass of a can over that of its load with which its whole mass is moved to the load's body."""
_ARM = 1.0
"""Length r of the arms of the chord [m]; any length gives the same inertia."""


def mechanics(scene: Scene, unit: float) -> Mechanics:
    """Return the joints, masses and forces of the body "can", which moves as can and load do together."""
    return _sliding(scene, unit) if scene.attachment == "sliding" else _frozen(scene, unit)


def _sliding(scene: Scene, unit: float) -> Mechanics:
    """Put the load on a slide (u) and a hinge (phi), with the kinetic energy of eqs. (39) and (44).

    The can's mass is on the same body, as a point on the axis, and its inertia I_can/a^2 is the slide's armature.
    If the can is much heavier than its load, their common centre of mass is so near the axis that the distance would
    be lost in the rounding of u. Then most of the can's mass becomes armature too, and a constant force its weight.
    """
    can = scene.can
    light = can.mass <= _HEAVY * scene.load.mass
    load = load_with_can_mass(scene, can.mass) if light else load_with_inertia(scene)
    rest = can.mass - load.moved
    return Mechanics(
        joints=("slide", "phi"),
        bodies={"can": Inertial(unit * load.mass, load.offset, unit * load.inertia)},
        armature=unit * (rest + can.inertia / can.radius**2),
        force=unit * rest * scene.gravity * math.sin(scene.incline),
        **dissipation(scene, unit),
    )


def _frozen(scene: Scene, unit: float) -> Mechanics:
    """Put can and load on one hinge, phi, whose inertia J(phi) = base + chord sin^2(phi/2) is that of rolling.

    A tendon runs from a fixed site at a height r above the axis to a site on the body at a depth r below it. It is a
    chord of length 2 r |cos(phi/2)| (inscribed angle), so that its armature A adds A r^2 sin^2(phi/2) to J. Gravity
    acts on the moment m b as in eq. (52), and a constant torque replaces its effect on the motion of the axis.
    """
    oscillator = scene.oscillator
    moment = scene.load.mass * scene.load.offset
    # Any mass with the moment m b is right. The scene's mass at its centre of mass (38) is the natural choice. Where it
    # would have more than half of the inertia, a larger mass on a shorter arm is chosen that has exactly half.
    mass, offset = scene.mass, scene.centre_of_mass
    if mass * offset**2 > oscillator.base / 2:
        mass, offset = 2 * moment**2 / oscillator.base, oscillator.base / (2 * moment)
    return Mechanics(
        joints=("phi",),
        bodies={"can": Inertial(unit * mass, offset, unit * (oscillator.base - mass * offset**2))},
        force=unit * oscillator.slope,
        chord=unit * oscillator.chord / _ARM**2,
    )


def add(spec: mujoco.MjSpec, moving: Mechanics) -> None:
    """Add the elements of a reduced model to a template, without their numbers, which `mechanics.fit` writes."""
    remove_mass(spec.body("load"))
    if "slide" in moving.joints:
        for name in TURNING:
            if (mark := spec.geom(name)) is not None:  # no joint turns with the can, and these would turn with the load
                spec.delete(mark)
    joints.add(spec, *moving.joints)
    hold_inertial(spec.body("can"))
    if moving.force != 0:
        _add_constant_force(spec, moving.joints[0])
    if moving.chord > 0:
        _add_chord(spec)
    if moving.damps:
        _add_damper(spec, moving)


def _add_chord(spec: mujoco.MjSpec) -> None:
    """Add the tendon between a site above the axis and one that turns with the body."""
    body = spec.body("can")
    top = [0, 0, float(body.pos[2]) + _ARM]
    spec.body("incline").add_site(spec.default, name="chord_top", pos=top, group=4)
    body.add_site(spec.default, name="chord_end", pos=[0, 0, -_ARM], group=4)
    chord = spec.add_tendon(name="chord", rgba=[0, 0, 0, 0])
    chord.wrap_site("chord_top")
    chord.wrap_site("chord_end")


def _add_damper(spec: mujoco.MjSpec, moving: Mechanics) -> None:
    """Add the tendon whose length is phi - u/a, the angle by which the load is ahead of the can, with no stiffness.

    Its damping is the torque between can and load, though the can has no joint: the torque on the can, over its radius,
    acts on the slide.
    """
    damper = spec.add_tendon(name="damper")
    damper.wrap_joint("phi", 1.0)
    damper.wrap_joint("slide", moving.slide_in_damper)


def _add_constant_force(spec: mujoco.MjSpec, joint: str) -> None:
    """Add a constant force on a joint: an actuator that has a bias and no gain."""
    bias = mujoco.mjtBias.mjBIAS_AFFINE
    actuator = spec.add_actuator(name="weight", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, biastype=bias)
    actuator.gainprm[0] = 0.0
