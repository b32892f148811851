"""Models without a constraint: the can's rotation is folded into the coordinates of the load.

Nothing rolls in them, so there is nothing to solve for and no error but the integrator's.
"""

import math

import mujoco

from mjbeer.model import joints
from mjbeer.model.inertia import point_share, set_inertial, share, weightless
from mjbeer.theory.scene import Scene

_HEAVY = 10.0
"""Mass of a can over that of its load from which on it stays out of their common centre of mass."""
_ARM = 1.0
"""Length r of the chord's arms [m]; any length gives the same inertia."""


def reduce(spec: mujoco.MjSpec, scene: Scene, unit: float) -> None:
    """Make the body "can" move as can and load do together."""
    weightless(spec.body("load"))
    if scene.attachment == "sliding":
        _sliding(spec, scene, unit)
    else:
        _frozen(spec, scene, unit)


def _sliding(spec: mujoco.MjSpec, scene: Scene, unit: float) -> None:
    """The load on a slide (u) and a hinge (phi), with the kinetic energy of eqs. (39) and (44).

    The can's mass is on the same body, as a point on the axis; its inertia I_can/a^2 is the slide's armature.
    A can much heavier than its load would leave so short an arm to the centre of mass of both that it would drown in
    the rounding of u: most of its mass becomes armature as well, and a constant force stands for its weight.
    """
    body, can = spec.body("can"), scene.can
    part = share(scene, can.mass) if can.mass <= _HEAVY * scene.load.mass else point_share(scene)
    for mark in (spec.geom("can_mark"), spec.geom("can_spot")):
        if mark is not None:  # no joint turns with the can, whose marks would be seen to turn with the load
            spec.delete(mark)
    joints.add(spec, "slide", "phi")
    set_inertial(body, unit * part.mass, part.offset, unit * part.inertia)
    rest = can.mass - part.moved
    spec.joint("slide").armature = unit * (rest + can.inertia / can.radius**2)
    _constant_force(spec, "slide", unit * rest * scene.gravity * math.sin(scene.incline))


def _frozen(spec: mujoco.MjSpec, scene: Scene, unit: float) -> None:
    """One hinge, phi, whose inertia J(phi) = base + chord sin^2(phi/2) is that of rolling.

    A tendon from a fixed site at height r above the axis to a site on the body at -r is a chord of length
    2 r |cos(phi/2)| (inscribed angle), so that its armature A adds A r^2 sin^2(phi/2). Gravity acts on the
    arm m b as in eq. (52), and a constant torque does what it does on the axis.
    """
    body, form = spec.body("can"), scene.oscillator
    joints.add(spec, "phi")
    moment = scene.load.mass * scene.load.offset
    # Any mass with the moment m b does. That of the scene, at its centre of mass (38), is the natural one; where
    # it would have more than half of the inertia, a greater mass on a shorter arm has just half.
    mass, offset = scene.mass, scene.centre_of_mass
    if mass * offset**2 > form.base / 2:
        mass, offset = 2 * moment**2 / form.base, form.base / (2 * moment)
    set_inertial(body, unit * mass, offset, unit * (form.base - mass * offset**2))
    _constant_force(spec, "phi", unit * form.slope)
    if form.chord > 0:
        top = [0, 0, float(body.pos[2]) + _ARM]
        spec.body("incline").add_site(spec.default, name="chord_top", pos=top, group=4)
        body.add_site(spec.default, name="chord_end", pos=[0, 0, -_ARM], group=4)
        chord = spec.add_tendon(name="chord", armature=unit * form.chord / _ARM**2, rgba=[0, 0, 0, 0])
        chord.wrap_site("chord_top")
        chord.wrap_site("chord_end")


def _constant_force(spec: mujoco.MjSpec, joint: str, force: float) -> None:
    """A force [N] or torque [N m] on a joint that never changes: an actuator that is all bias."""
    if force != 0:
        bias = mujoco.mjtBias.mjBIAS_AFFINE
        actuator = spec.add_actuator(name="weight", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, biastype=bias)
        actuator.gainprm[0], actuator.biasprm[0] = 0.0, force
