"""Random timesteps [s] and numbers of steps, so few that theory can follow every run."""

import math

from mjbeer.studies.stability.search.pick import Pick
from mjbeer.studies.stability.search.starts import slow
from mjbeer.theory.scene import Scene

Pace = tuple[float, int]
_SWINGS, _TURNED = 400.0, 3e3
"""Longest motion, in swings, and in angle [rad]."""


def ordinary(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return timesteps from a thousandth to a third of the time of a fall through the radius."""
    timestep = slow(scene) * pick.decades(1e-3, 0.3)
    return _within(scene, rate, timestep, pick.decades(20, 3000))


def swinging(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return ten to a thousand timesteps a small swing, for a part of a swing or for many."""
    timestep = 2 * math.pi / max(_frequency(scene), abs(rate), 1e-3 / slow(scene)) / pick.decades(10, 1000)
    return _within(scene, rate, timestep, pick.decades(20, 3000))


def either(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return a pace that suits the size of the can, or one that suits the swing, which may be very different."""
    return pick.one(ordinary, swinging)(pick, scene, rate)


def fast(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return timesteps in which the load turns by a hundredth of a radian to a hundred radians."""
    timestep = pick.decades(1e-2, 1e2) / max(abs(rate), 1 / slow(scene))
    return _within(scene, rate, timestep, pick.decades(20, 3000))


def resonant(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return timesteps in which the load turns by a whole number of turns, or nearly, in a step or a part of one.

    RK4 evaluates forces at half steps, and the run at half the timestep at quarters of them: at a whole number of turns
    in each all of these see the same angle.
    """
    turns = pick.one(0.25, 0.5, 1.0, 2.0, 4.0, 8.0) * pick.one(1, 1, 1, 2, 3)
    aside = pick.one(0.0, pick.sign() * pick.decades(1e-12, 0.1))
    timestep = 2 * math.pi * turns * (1 + aside) / max(abs(rate), 1 / slow(scene))
    return _within(scene, rate, timestep, pick.one(pick.decades(2, 30), pick.decades(2, 500)))


def few(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return a run of one step to five, long or short."""
    timestep = slow(scene) * pick.decades(1e-6, 3)
    return _within(scene, rate, timestep, pick.between(1, 6))


def long(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return a run of 20 to 200 s, or as much of it as theory can follow, in thousands of steps."""
    duration, steps = pick.decades(20, 200), pick.decades(2e3, 1.5e4)
    timestep = duration / steps
    return _within(scene, rate, timestep, steps)


def anything(pick: Pick, scene: Scene, rate: float) -> Pace:
    """Return a pace from anywhere: far too small steps, and far too large ones."""
    timestep = slow(scene) / max(1.0, abs(rate) * slow(scene)) * pick.decades(1e-4, 3)
    return _within(scene, rate, timestep, pick.decades(10, 1e4))


def _within(scene: Scene, rate: float, timestep: float, steps: float) -> Pace:
    """Return at most the given timestep and number of steps, so that they take no longer than theory can follow."""
    form = scene.oscillator
    spin, push = max(abs(rate), 1e-300), max(abs(form.slope) / _inertia(scene), 1e-300)
    longest = min(_TURNED / spin, math.sqrt(2 * _TURNED / push))
    if (frequency := _frequency(scene)) > 0:
        longest = min(longest, _SWINGS * 2 * math.pi / frequency)
    timestep = min(timestep, longest)
    return timestep, max(1, int(min(steps, longest / timestep)))


def _frequency(scene: Scene) -> float:
    """Return about the angular frequency of the swing [rad/s]."""
    return math.sqrt(scene.oscillator.depth / _inertia(scene))


def _inertia(scene: Scene) -> float:
    """Return the mean of the inertia over a turn [kg m^2]."""
    form = scene.oscillator
    return form.base + (form.chord + form.swing) / 2
