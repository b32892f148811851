"""Random timesteps [s] and numbers of steps, so few that theory can follow every run."""

import math

from mjbeer.studies.stability.search.pick import Pick
from mjbeer.studies.stability.search.scenes import slow
from mjbeer.studies.stability.search.starts import Start
from mjbeer.theory.scene import Scene

Pace = tuple[float, int]
_SWINGS, _TURNED = 400.0, 3e3
"""Longest motion, in swings, and in angle [rad]."""
_DAMPED = 0.05
"""Share of these that a damped motion may have, which theory follows step by step."""


def ordinary(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return timesteps from a thousandth to a third of the time of a fall through the radius."""
    timestep = slow(scene) * pick.decades(1e-3, 0.3)
    return _within(scene, start, timestep, pick.decades(20, 3000))


def swinging(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return ten to a thousand timesteps a small swing, for a part of a swing or for many."""
    timestep = 2 * math.pi / max(_frequency(scene, start), abs(start[1]), 1e-3 / slow(scene)) / pick.decades(10, 1000)
    return _within(scene, start, timestep, pick.decades(20, 3000))


def either(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return a pace that suits the size of the can, or one that suits the swing, which may be very different."""
    return pick.one(ordinary, swinging)(pick, scene, start)


def fast(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return timesteps in which the load turns by a hundredth of a radian to a hundred radians."""
    timestep = pick.decades(1e-2, 1e2) / max(abs(start[1]), 1 / slow(scene))
    return _within(scene, start, timestep, pick.decades(20, 3000))


def resonant(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return timesteps in which the load turns by a whole number of turns, or nearly, in a step or a part of one.

    RK4 evaluates forces at half steps, and the run at half the timestep at quarters of them: at a whole number of turns
    in each all of these see the same angle.
    """
    turns = pick.one(0.25, 0.5, 1.0, 2.0, 4.0, 8.0) * pick.one(1, 1, 1, 2, 3)
    aside = pick.one(0.0, pick.sign() * pick.decades(1e-12, 0.1))
    timestep = 2 * math.pi * turns * (1 + aside) / max(abs(start[1]), 1 / slow(scene))
    return _within(scene, start, timestep, pick.one(pick.decades(2, 30), pick.decades(2, 500)))


def few(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return a run of one step to five, long or short."""
    timestep = slow(scene) * pick.decades(1e-6, 3)
    return _within(scene, start, timestep, pick.between(1, 6))


def long(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return a run of 20 to 200 s, or as much of it as theory can follow, in thousands of steps."""
    duration, steps = pick.decades(20, 200), pick.decades(2e3, 1.5e4)
    timestep = duration / steps
    return _within(scene, start, timestep, steps)


def anything(pick: Pick, scene: Scene, start: Start) -> Pace:
    """Return a pace from anywhere: far too small steps, and far too large ones."""
    timestep = slow(scene) / max(1.0, abs(start[1]) * slow(scene)) * pick.decades(1e-4, 3)
    return _within(scene, start, timestep, pick.decades(10, 1e4))


def _within(scene: Scene, start: Start, timestep: float, steps: float) -> Pace:
    """Return at most the given timestep and number of steps, so that they take no longer than theory can follow."""
    form = scene.oscillator
    share = _DAMPED if scene.dissipates else 1.0
    spin = max(abs(start[1]), 1e-300)
    push = max(abs(form.slope) / (form.base + (form.chord + form.swing) / 2), 1e-300)
    if scene.dissipates:  # the load may turn with the can
        push = max(push, scene.gravity * abs(math.sin(scene.incline)) / scene.can.radius)
    longest = min(share * _TURNED / spin, math.sqrt(2 * share * _TURNED / push))
    if (frequency := _frequency(scene, start)) > 0:
        longest = min(longest, share * _SWINGS * 2 * math.pi / frequency)
    timestep = min(timestep, longest)
    return timestep, max(1, int(min(steps, longest / timestep)))


def _frequency(scene: Scene, start: Start) -> float:
    """Return about the angular frequency of the swing of a start [rad/s].

    Where the can is light and the load has next to no inertia, a small swing about the bottom is faster by many decades
    than a large one.
    """
    form = scene.oscillator
    if form.depth == 0:
        return 0.0
    kinetic = float(form.inertia(start[0])) * start[1] ** 2 / 2
    height = 2 * form.depth * math.sin((start[0] - form.bottom) / 2) ** 2
    square = min(1.0, 2 * (kinetic + height) / form.depth)  # of the swing's amplitude
    inertia = form.base + (form.chord / 4 + form.swing) * square / 2
    return math.sqrt(form.depth / inertia)
