"""Random scenes: what one has on a desk, and what nobody has."""

import math
from dataclasses import dataclass, replace

from mjbeer.studies.stability.random_picker import (
    LogUniform,
    Minus,
    OneOf,
    Quantity,
    RandomPicker,
    Uniform,
    signed,
)
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.liquid import liquid
from mjbeer.theory.liquid_properties import NAMES
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, as ratios.

    Masses are divided by that of the load, offsets by the radius a, and inertias by m a^2, where m
    is the mass of the same part.
    """

    radius: Quantity
    """[m]"""
    load: Quantity
    """The load's mass [kg]."""
    can: Quantity
    """The can's mass."""
    rim: Quantity
    """The can's inertia."""
    offset: Quantity
    inertia: Quantity
    """The load's inertia, about its centre of mass."""
    incline: Quantity
    """[degrees]"""
    gravity: Quantity = GRAVITY

    def __call__(self, pick: RandomPicker) -> Scene:
        """Return a scene."""
        radius = pick.number(self.radius)
        load_mass = pick.number(self.load)
        can_mass = load_mass * pick.number(self.can)
        rim = can_mass * radius**2 * pick.number(self.rim)
        offset = radius * pick.number(self.offset)
        inertia = load_mass * radius**2 * pick.number(self.inertia)
        incline = math.radians(pick.number(self.incline))
        attachment = pick.one(*ATTACHMENTS)
        gravity = pick.number(self.gravity)
        can = Can(radius, 3 * radius, can_mass, rim)
        load = Load(load_mass, offset, inertia)
        return Scene(can, load, incline, attachment, gravity)


HEAVY_CAN = Parts(
    radius=OneOf(LogUniform(0.01, 0.3)),
    load=0.1,
    can=LogUniform(1, 1e5),
    rim=OneOf(0.5, 1.0),
    offset=OneOf(1.0, LogUniform(1e-3, 1)),
    inertia=OneOf(0.0, 0.1),
    incline=OneOf(0.0, Uniform(-20, 20)),
)
"""A can so heavy that the inertia hardly depends on the angle."""
RATIOS = Parts(
    radius=OneOf(0.033, LogUniform(1e-3, 10)),
    load=OneOf(0.1, LogUniform(1e-4, 1e3)),
    can=LogUniform(1e-4, 1e4),
    rim=OneOf(0.5, 1.0, LogUniform(1e-12, 1)),
    offset=OneOf(1.0, Uniform(0, 1), Minus(1, LogUniform(1e-15, 1)), LogUniform(1e-12, 1)),
    inertia=OneOf(0.0, 0.3, LogUniform(1e-12, 1)),
    incline=Uniform(-20, 20),
)
ANYTHING = Parts(
    radius=LogUniform(1e-3, 33),
    load=LogUniform(1e-6, 1e4),
    can=OneOf(0.0, LogUniform(1e-4, 1e4)),
    rim=OneOf(0.0, 0.5, 1.0, Uniform(0, 1)),
    offset=OneOf(0.0, 1.0, LogUniform(1e-9, 1), Uniform(0, 1)),
    inertia=OneOf(0.0, LogUniform(1e-12, 1), Uniform(0, 1)),
    incline=OneOf(0.0, 1e-8, 10.0, 89.9, Uniform(-30, 30), Uniform(-89.9, 89.9)),
    gravity=OneOf(GRAVITY, GRAVITY, GRAVITY, 0.0, LogUniform(1e-3, 1e3)),
)
"""Sizes, masses and gravities of many decades, with about as many special cases as others."""


def ordinary(pick: RandomPicker) -> Scene:
    """Return a scene of the paper on a moderate incline, with a can that one can carry."""
    incline = math.radians(pick.number(OneOf(0.0, 10.0, Uniform(-20, 20))))
    radius = pick.number(OneOf(0.033, LogUniform(0.01, 0.3)))
    kind = pick.one("beer", "beer", "beer", "pendulum", "hoop")
    if kind == "pendulum":
        wheel_mass = pick.number(LogUniform(0.02, 2))
        load_mass = pick.number(LogUniform(0.01, 1))
        offset = radius * pick.number(Uniform(0.2, 1))
        return pendulum(incline, wheel_mass, load_mass, offset, radius, 3 * radius)
    if kind == "hoop":
        hoop_mass = pick.number(LogUniform(2e-3, 0.2))
        return hoop(incline, hoop_mass, 0.2, radius, 3 * radius)
    can = pick.one(Can.massless, Can.sheet_metal)(radius, 3.6 * radius)
    make = pick.one(sliding, frozen)
    fill = pick.number(OneOf(0.5, Uniform(0.05, 1)))
    return make(incline, fill, can)


def thin_or_full(pick: RandomPicker) -> Scene:
    """Return a scene with a film of beer, or with a can that is nearly full."""
    fill = pick.number(OneOf(LogUniform(1e-4, 0.1), Minus(1, LogUniform(1e-9, 0.1))))
    can = pick.one(Can.massless, Can.sheet_metal)()
    make = pick.one(sliding, frozen)
    incline = math.radians(pick.number(Uniform(-20, 20)))
    return make(incline, fill, can)


def steep(pick: RandomPicker) -> Scene:
    """Return an ordinary scene on a steep incline, up or down."""
    steepness = OneOf(Uniform(30, 89.9), Minus(90, LogUniform(1e-6, 1)))
    incline = math.radians(pick.number(signed(steepness)))
    return replace(ordinary(pick), incline=incline)


def weak_or_strong_gravity(pick: RandomPicker) -> Scene:
    """Return a scene in no gravity, on an asteroid, or on a star."""
    scene = ordinary(pick)
    gravity = pick.number(OneOf(0.0, LogUniform(1e-3, 1), LogUniform(20, 1e3)))
    return replace(scene, gravity=gravity)


def real_liquid(pick: RandomPicker) -> Scene:
    """Return a scene with a real liquid."""
    make_can = pick.one(Can.massless, Can.sheet_metal)
    can = make_can(pick.number(OneOf(0.033, LogUniform(0.02, 0.1))))
    name = pick.one(*NAMES)
    incline = math.radians(pick.number(Uniform(-15, 15)))
    fill = pick.number(Uniform(0.05, 0.95))
    return liquid(name, incline, fill, can)


def sheet_metal(pick: RandomPicker) -> Scene:
    """Return a scene with a can of sheet metal, as it is attached to a world."""
    can = Can.sheet_metal(pick.number(OneOf(0.033, LogUniform(0.02, 0.1))))
    make = pick.one(sliding, frozen)
    incline = math.radians(pick.number(Uniform(-15, 15)))
    fill = pick.number(Uniform(0.1, 0.9))
    return make(incline, fill, can)


def with_damping(pick: RandomPicker, scene: Scene) -> Scene:
    """Return a scene with a sliding load and with damping, drag or both, over many decades.

    Damping is in units of M a^2 divided by the time of a fall through the radius, and drag in units
    of M/a. The torque may have terms in several powers of the slip rate.
    """
    radius = scene.can.radius
    mass = scene.effective_mass
    clock = falling_time(scene)
    linear = mass * radius**2 / clock * pick.number(LogUniform(1e-6, 1e6))
    squared = Damping(linear, linear * clock * pick.number(LogUniform(1e-6, 1e2)))
    cubed = Damping(
        pick.number(OneOf(0.0, linear)),
        linear * clock * pick.number(LogUniform(1e-6, 1e2)),
        linear * clock**2 * pick.number(LogUniform(1e-6, 1e2)),
    )
    damping = pick.one(linear, linear, squared, cubed, 0.0)
    drag = mass / radius * pick.number(LogUniform(1e-6, 1e2))
    drag = pick.one(drag, drag if damping == 0 else 0.0)
    return replace(scene, attachment="sliding", damping=damping, drag=drag)


def falling_time(scene: Scene) -> float:
    """Return the time of a fall through the radius [s], or a second without gravity."""
    if scene.gravity == 0:
        return 1.0
    return math.sqrt(scene.can.radius / scene.gravity)
