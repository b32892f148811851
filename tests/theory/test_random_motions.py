"""Random motions against Taylor series in extended precision, also beside the steepest incline."""

import contextlib
import math
from typing import NamedTuple

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, frozen
from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.motion import UNCERTAIN, solve
from tests.support import taylor


class Case(NamedTuple):
    """A motion and the increasing times at which it is asked for [s]."""

    scene: Scene
    phi0: float
    phi_dot0: float
    time: np.ndarray


# Random motions against series: a few eps, more where J has a narrow minimum, which magnifies the
# rounding of phi.
RANDOM = 2e-12
USUAL = 1e-14
# Beside the steepest incline, what rounding changes is divided by the distance from it. Measured:
# 5e-12 for 90 %.
BESIDE_STEEPEST = 5e-11


def random_scene(pick: np.random.Generator) -> Scene:
    """Any size of can, ratio of masses, incline and gravity that is allowed."""

    def decades(low: float, high: float) -> float:
        return 10 ** pick.uniform(low, high)

    def one_of(*values: float) -> float:
        return float(pick.choice(values))

    radius = decades(-3, 1.5)
    load_mass = decades(-2, 2)
    can_mass = one_of(0.0, load_mass * decades(-3, 3))
    can_inertia = can_mass * radius**2 * one_of(0.0, 0.5, 1.0, pick.uniform())
    offset = radius * one_of(0.0, 1.0, decades(-9, 0), pick.uniform(), pick.uniform())
    load_inertia = load_mass * radius**2 * one_of(0.0, decades(-6, 0), pick.uniform())
    flat = one_of(0.0, 0.0, 1e-8, decades(-20, 0))
    degrees = one_of(flat, flat, pick.uniform(-30, 30), pick.uniform(-85, 85))
    gravity = one_of(9.81, 9.81, 0.0, decades(-3, 3))
    attachment = str(pick.choice(["sliding", "frozen"]))
    can = Can(radius, 3 * radius, can_mass, can_inertia)
    load = Load(load_mass, offset, load_inertia)
    return Scene(can, load, math.radians(degrees), attachment, gravity)


def case(pick: np.random.Generator, longest: float) -> Case:
    """A start at rest, slow or fast, and up to `longest` times the time in which something
    happens."""
    scene = None
    while scene is None:
        with contextlib.suppress(ParameterError):  # no inertia, or too small a share of it
            scene = random_scene(pick)
    form = scene.oscillator
    torque = max(form.depth, abs(form.ramp))
    pace = math.sqrt(torque / (form.base + form.chord + form.coupling)) if torque > 0 else 1.0
    far = pick.choice([3, 100, 1e4])
    angles = [0.0, 1.0, 10 ** pick.uniform(-9, 1), *pick.uniform(-far, far, 3)]
    fast = 10 ** pick.uniform(-3, 3)
    speeds = [0.0, 0.0, pick.uniform(-3, 3), fast, -fast]
    phi_dot0 = float(pace * pick.choice(speeds))
    duration = longest * 10 ** pick.uniform(-4, 0) / (abs(phi_dot0) + pace)
    times = np.sort(duration * pick.uniform(0, 1, 4))
    return Case(scene, float(pick.choice(angles)), phi_dot0, times)


def errors(cases: list[Case], steps: int = 4000) -> np.ndarray:
    """The largest error, relative beyond 1 rad, of each motion that is not refused and that the
    witness follows."""
    found = []
    for scene, phi0, phi_dot0, time in cases:
        try:
            phi, _ = solve(scene.oscillator, time, phi0, phi_dot0)
        except (NoLibrationError, ParameterError):
            continue  # beside a separatrix, or beyond the turns that are followed
        turned = taylor.motion(scene, time, phi0, phi_dot0, steps)[:, 0].astype(float)
        # phi is rounded beside its start, as a sum of the two.
        scale = np.maximum(max(1, abs(phi0)), np.maximum.accumulate(np.abs(turned)))
        found.append(np.max(np.abs(phi - phi0 - turned) / scale))
    largest = np.array(found)
    return largest[~np.isnan(largest)]


@taylor.NEEDED
@pytest.mark.slow
def test_any_motion() -> None:
    pick = np.random.default_rng(1500)
    count = 250
    found = errors([case(pick, 500.0) for _ in range(count)])
    assert len(found) > 0.9 * count
    assert found.max() < RANDOM
    assert np.quantile(found, 0.95) < USUAL


@taylor.NEEDED
@pytest.mark.slow
def test_beside_the_steepest_incline() -> None:
    """There a well of no depth, or a slope of no torque, decides for how long the load
    hesitates."""
    pick = np.random.default_rng(230)
    steepest = frozen().largest_incline()
    cases = []
    for _ in range(80):
        beside = 10 ** pick.uniform(-11, -1)
        scene = frozen(steepest * (1 + pick.choice([-1, 1]) * beside))
        width = math.sqrt(beside)
        slowness = 0.1 / math.sqrt(width)
        away = width * pick.choice([0.0, pick.uniform(-3, 3), pick.uniform(-100, 100)])
        phi0 = math.pi / 2 - steepest + away
        phi_dot0 = pick.choice([0.0, width / slowness * pick.uniform(-3, 3), pick.uniform(-20, 20)])
        time = slowness * np.sort(pick.uniform(0, 2, 3))
        cases.append(Case(scene, float(phi0), float(phi_dot0), time))
    found = errors(cases, steps=1000)
    assert len(found) > 0.5 * len(cases)  # others turn so often that the witness takes more steps
    assert found.max() < UNCERTAIN
    assert np.quantile(found, 0.9) < BESIDE_STEEPEST
