"""Random scenes: such as one has on a desk, and such as nobody has."""

import math
from dataclasses import replace

from mjbeer.studies.stability.search.pick import Pick
from mjbeer.theory.can import Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene


def slow(scene: Scene) -> float:
    """Return the time of a fall through the radius [s], or a second without gravity: the pace of a scene."""
    return math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else 1.0


def ordinary(pick: Pick) -> Scene:
    """Return a scene of the paper, on a moderate incline, with a can of any size that one can carry."""
    incline = math.radians(pick.one(0.0, 10.0, pick.between(-20, 20)))
    radius = pick.one(0.033, pick.decades(0.01, 0.3))
    kind = pick.one("beer", "beer", "beer", "pendulum", "hoop")
    if kind == "pendulum":
        offset = radius * pick.between(0.2, 1)
        return pendulum(incline, pick.decades(0.02, 2), pick.decades(0.01, 1), offset, radius, 3 * radius)
    if kind == "hoop":
        return hoop(incline, pick.decades(2e-3, 0.2), 0.2, radius, 3 * radius)
    make, can = pick.one(sliding, frozen), pick.one(Can.massless, Can.sheet_metal)
    return make(incline, pick.one(0.5, pick.between(0.05, 1)), can(radius, 3.6 * radius))


def mostly_ordinary(pick: Pick) -> Scene:
    """Return an ordinary scene, or one from anywhere."""
    return pick.one(ordinary, ordinary, anything)(pick)


def steady(pick: Pick) -> Scene:
    """Return a scene whose inertia hardly depends on the angle, as the can is much heavier than its load."""
    radius, mass = pick.decades(0.01, 0.3), pick.decades(0.1, 1e6)
    load = Load(0.1, radius * pick.one(1.0, pick.decades(1e-3, 1)), 0.1 * radius**2 * pick.one(0.0, 0.1))
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.5, 1.0))
    return Scene(can, load, math.radians(pick.one(0.0, pick.between(-20, 20))), pick.one(*ATTACHMENTS))


def steady_or_ordinary(pick: Pick) -> Scene:
    """Return one or the other."""
    return pick.one(steady, steady, ordinary)(pick)


def fills(pick: Pick) -> Scene:
    """Return a scene with a film of beer, or with a can that is nearly full."""
    fill = pick.one(pick.decades(1e-5, 0.1), 1 - pick.decades(1e-9, 0.1))
    can = pick.one(Can.massless, Can.sheet_metal)
    return pick.one(sliding, frozen)(math.radians(pick.between(-20, 20)), fill, can())


def steep(pick: Pick) -> Scene:
    """Return a scene on a steep incline, to either side."""
    scene = ordinary(pick)
    return replace(
        scene, incline=pick.sign() * math.radians(pick.one(pick.between(30, 89.9), 90 - pick.decades(1e-6, 1)))
    )


def gravity(pick: Pick) -> Scene:
    """Return a scene in no gravity, on an asteroid, or on a star."""
    return replace(ordinary(pick), gravity=pick.one(0.0, pick.decades(1e-3, 1), pick.decades(20, 1e3)))


def ratios(pick: Pick) -> Scene:
    """Return a scene of a can and a load with very different masses and moments of inertia.

    Raises:
      ParameterError: if they make a scene that cannot be.
    """
    radius, load_mass = pick.one(0.033, pick.decades(1e-3, 10)), pick.one(0.1, pick.decades(1e-6, 1e3))
    mass = load_mass * pick.decades(1e-6, 1e6)
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.5, 1.0, pick.decades(1e-12, 1)))
    offset = radius * pick.one(1.0, pick.between(0, 1), 1 - pick.decades(1e-15, 1), pick.decades(1e-12, 1))
    load = Load(load_mass, offset, load_mass * radius**2 * pick.one(0.0, 0.3, pick.decades(1e-12, 1)))
    return Scene(can, load, math.radians(pick.between(-20, 20)), pick.one(*ATTACHMENTS))


def anything(pick: Pick) -> Scene:
    """Return a scene from anywhere: sizes, masses and gravities are spread over their decades.

    Special cases (an empty can, a full can, a point load, no gravity, no incline) are about as frequent as others.

    Raises:
      ParameterError: if the choices make a scene that cannot be.
    """
    radius, load_mass = pick.decades(1e-4, 33), pick.decades(1e-9, 1e6)
    mass = pick.one(0.0, load_mass * pick.decades(1e-6, 1e6))
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.0, 0.5, 1.0, pick.between(0, 1)))
    fill = pick.one(1e-6, 1 - 1e-6, 1.0, 0.5, pick.between(1e-6, 1))
    segment = Load.segment(radius, 3 * radius, fill, load_mass / (3 * math.pi * radius**3))
    offset = radius * pick.one(0.0, 1.0, pick.decades(1e-9, 1), pick.between(0, 1))
    inertia = load_mass * radius**2 * pick.one(0.0, pick.decades(1e-12, 1), pick.between(0, 1))
    load = pick.one(segment, Load(load_mass, offset, inertia))
    incline = pick.one(0.0, 1e-8, 10.0, 89.9, pick.between(-30, 30), pick.between(-89.9, 89.9))
    weight = pick.one(GRAVITY, GRAVITY, GRAVITY, 0.0, pick.decades(1e-3, 1e3))
    return Scene(can, load, math.radians(incline), pick.one(*ATTACHMENTS), weight)


def damped(pick: Pick, scene: Scene) -> Scene:
    """Return a scene with a sliding load and with damping over twelve decades, drag over eight, or both.

    The unit of damping is M a^2 over the time of a fall through the radius, and that of drag is M/a; the torque may
    grow with several powers of the slip rate.

    Raises:
      ParameterError: if the load cannot slide in its can.
    """
    radius, mass = scene.can.radius, scene.effective_mass
    clock = slow(scene)
    linear = mass * radius**2 / clock * pick.decades(1e-6, 1e6)
    law = pick.one(
        linear,
        linear,
        Damping(linear, linear * clock * pick.decades(1e-6, 1e2)),
        Damping(pick.one(0.0, linear), *(linear * clock**power * pick.decades(1e-6, 1e2) for power in (1, 2))),
        0.0,
    )
    drag = mass / radius * pick.decades(1e-6, 1e2)
    return replace(scene, attachment="sliding", damping=law, drag=pick.one(drag, drag if law == 0 else 0.0))


def damped_ordinary(pick: Pick) -> Scene:
    """Return an ordinary scene with damping, drag, or both."""
    return damped(pick, ordinary(pick))
