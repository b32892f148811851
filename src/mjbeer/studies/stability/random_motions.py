"""Random starts and paces: how a motion begins, with which timestep it is followed, and how far."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.studies.stability.random_picker import (
    LogUniform,
    Minus,
    OneOf,
    Quantity,
    RandomPicker,
    Uniform,
    signed,
)
from mjbeer.studies.stability.random_scenes import falling_time
from mjbeer.theory.scene import Scene

_SWINGS = 400.0
"""Number of swings of the longest motion that theory can follow."""
_TURNED = 3e3
"""Largest angle of a motion that theory can follow [rad]."""
_DAMPED = 0.05
"""Share of both that a damped motion may have, as theory follows it step by step."""


class Start(NamedTuple):
    """The start of a motion."""

    phi0: Quantity
    """[rad]"""
    rate: Quantity
    """phi_dot0 times the time of `falling_time`."""


_STARTS = {
    "by hand": Start(
        OneOf(0.0, 1.0, math.pi, Uniform(-math.pi, math.pi), LogUniform(1e-9, 1)),
        OneOf(0.0, 0.0, Uniform(-3, 3)),
    ),
    "spun": Start(
        Uniform(-4, 4),
        signed(OneOf(LogUniform(2, 500), LogUniform(2, 500), LogUniform(1e2, 1e6))),
    ),
    "far": Start(
        signed(LogUniform(1e2, 1e4)),
        OneOf(0.0, Uniform(-3, 3), signed(LogUniform(1e1, 1e5))),
    ),
    "let go": Start(Uniform(-2.5, 2.5), 0.0),
}
BESIDE_THE_SEPARATRIX = "separatrix"
"""The name of starts that depend on the scene."""


def random_start(pick: RandomPicker, scene: Scene, name: str) -> tuple[float, float]:
    """Return phi0 [rad] and phi_dot0 [rad/s]. A scene without a separatrix starts by hand."""
    if name == BESIDE_THE_SEPARATRIX:
        try:
            low, high = replace(scene, damping=0.0, drag=0.0).separatrix()
        except NoEquilibriumError:
            name = "by hand"
        else:
            return _start_beside(pick, scene, low, high)
    start = _STARTS[name]
    phi0 = pick.number(start.phi0)
    rate = pick.number(start.rate)
    return phi0, rate / falling_time(scene)


def _start_beside(pick: RandomPicker, scene: Scene, low: float, high: float) -> tuple[float, float]:
    """Return a start at rest near one of two tops, or between them with nearly a top's energy."""
    beside = pick.number(signed(LogUniform(1e-15, 0.1)))
    at_rest = pick.one(True, False)
    if at_rest:
        return pick.one(low, high) + beside, 0.0
    phi0 = pick.number(Uniform(low, high))
    oscillator = scene.oscillator
    drop = max(0.0, float(oscillator.drop(phi0, high)))
    rate = math.sqrt(2 * drop / float(oscillator.inertia(phi0)))
    return phi0, pick.one(1, -1) * rate * (1 + beside)


class Pace(NamedTuple):
    """The timestep and the length of a run."""

    unit: str
    """The unit of the timestep, by its name in `_unit`."""
    timestep: Quantity
    steps: Quantity


_MANY_STEPS = LogUniform(20, 3000)
_NEARLY_ONE = OneOf(1.0, Minus(1, signed(LogUniform(1e-12, 0.1))))
_MULTIPLES = (1, 1, 1, 2, 3)
_TURNS = math.pi * np.array([0.5, 1.0, 2.0, 4.0, 8.0, 16.0])
_WHOLE_TURNS = OneOf(*np.outer(_TURNS, _MULTIPLES).ravel().tolist())
RESONANT = "resonant"
"""A pace with a whole number of turns, or nearly, in a step or a part of one.

RK4 evaluates forces at half steps, and at half the timestep it does so at quarters. With whole
turns all of these see the same angle.
"""
_LONG_STEPS = LogUniform(4e3, 1.5e4)
_PACES = {
    "usual": Pace("clock", LogUniform(1e-3, 0.3), _MANY_STEPS),
    "swinging": Pace("swing", LogUniform(1e-3, 0.1), _MANY_STEPS),
    "extreme": Pace("fast", LogUniform(1e-4, 3), LogUniform(10, 1e4)),
    "turning": Pace("turn", LogUniform(1e-2, 1e2), _MANY_STEPS),
    RESONANT: Pace("turn", _WHOLE_TURNS, OneOf(LogUniform(2, 30), LogUniform(2, 500))),
    "few": Pace("clock", LogUniform(1e-6, 3), Uniform(1, 6)),
    "long": Pace("second", LogUniform(5e-3, 3e-2), _LONG_STEPS),
    "desk": Pace("second", LogUniform(1e-4, 1e-3), LogUniform(100, 2000)),
}


def _unit(name: str, clock: float, spin: float, frequency: float) -> float:
    """Return a unit of time [s]. `spin` and `frequency` are rates of turns and swings [rad/s]."""
    match name:
        case "clock":
            return clock
        case "fast":
            return clock / max(1.0, spin * clock)
        case "turn":
            return 1 / max(spin, 1 / clock)
        case "swing":
            return 2 * math.pi / max(frequency, spin, 1e-3 / clock)
    return 1.0  # a second


def random_pace(
    pick: RandomPicker, scene: Scene, phi0: float, phi_dot0: float, name: str
) -> tuple[float, int]:
    """Return timestep [s] and number of steps of a pace, shortened to what theory can follow."""
    pace = _PACES[name]
    spin = abs(phi_dot0)
    frequency = _frequency(scene, phi0, phi_dot0)
    timestep = _unit(pace.unit, clock=falling_time(scene), spin=spin, frequency=frequency)
    timestep *= pick.number(pace.timestep)
    if name == RESONANT:
        timestep *= pick.number(_NEARLY_ONE)
    longest = _longest(scene, spin, frequency)
    timestep = min(timestep, longest)
    steps = min(pick.number(pace.steps), longest / timestep)
    return timestep, max(1, int(steps))


def _longest(scene: Scene, spin: float, frequency: float) -> float:
    """Return the longest time [s] over which theory can follow a motion."""
    oscillator = scene.oscillator
    mean_inertia = oscillator.base + (oscillator.chord + oscillator.coupling) / 2
    acceleration = max(abs(oscillator.ramp) / mean_inertia, 1e-300)  # mean angular one [rad/s^2]
    share = 1.0
    if scene.dissipates:
        share = _DAMPED
        # The load may turn with the can, which accelerates down the incline.
        of_can = scene.gravity * abs(math.sin(scene.incline)) / scene.can.radius
        acceleration = max(acceleration, of_can)
    turned = share * _TURNED
    longest = min(turned / max(spin, 1e-300), math.sqrt(2 * turned / acceleration))
    if frequency > 0:
        longest = min(longest, share * _SWINGS * 2 * math.pi / frequency)
    return longest


def _frequency(scene: Scene, phi0: float, phi_dot0: float) -> float:
    """Return an estimate of the angular frequency of the swing from a start [rad/s].

    It depends on the amplitude: if the can is light and the load has hardly any inertia, a small
    swing about the bottom is faster than a large one by many powers of ten.
    """
    oscillator = scene.oscillator
    depth = oscillator.depth
    if depth == 0:
        return 0.0
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    height = 2 * depth * math.sin((phi0 - oscillator.bottom) / 2) ** 2
    square_of_amplitude = min(1.0, 2 * (kinetic + height) / depth)
    varying = (oscillator.chord / 4 + oscillator.coupling) * square_of_amplitude / 2
    return math.sqrt(depth / (oscillator.base + varying))
