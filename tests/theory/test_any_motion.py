"""Random scenes, starts and times, over many orders of magnitude, against Taylor series in extended precision."""

import math

import numpy as np
import pytest

from mjbeer import Can, Load, Scene, frozen
from mjbeer.exceptions import NoLibrationError, ParameterError
from mjbeer.theory.motion import UNCERTAIN
from mjbeer.theory.motion import solve
from tests.support import taylor

# Rounding of the start, of J and of V: a few eps, a hundred times that after a hundred swings, and more where J has a
# narrow minimum, which magnifies the rounding of phi. Measured in 6,000 cases: 2e-13, and 3e-15 for 95 % of them.
ANGLE = 5e-13
USUAL = 1e-14
# Beside the steepest incline, what rounding changes is divided by the distance from it. Measured: 5e-12 for 90 %.
USUAL_BESIDE_STEEPEST = 5e-11


def scene(pick: np.random.Generator) -> Scene:
    """Cans of 1 um to 100 m, masses 1e6 times as large or small as the load, inclines up to 89.9 degrees."""

    def decades(low: float, high: float) -> float:
        return 10 ** pick.uniform(low, high)

    radius, load_mass = decades(-6, 2), decades(-6, 6)
    mass = pick.choice([0.0, load_mass * decades(-6, 6)])
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.choice([0.0, 0.5, 1.0, pick.uniform()]))
    offset = radius * pick.choice([0.0, 1.0, decades(-9, 0), pick.uniform(), pick.uniform()])
    load = Load(load_mass, offset, load_mass * radius**2 * pick.choice([0.0, decades(-6, 0), pick.uniform()]))
    degrees = pick.choice([0.0, 0.0, 1e-8, decades(-20, 0), pick.uniform(-30, 30), pick.uniform(-89.9, 89.9)])
    gravity = pick.choice([9.81, 9.81, 0.0, decades(-5, 5)])
    return Scene(can, load, math.radians(degrees), str(pick.choice(["sliding", "frozen"])), float(gravity))


def case(pick: np.random.Generator, longest: float) -> taylor.Case:
    """A start at rest, slow or fast, and up to `longest` times the time in which something happens."""
    while True:
        try:
            made = scene(pick)
            break
        except ParameterError:  # no inertia
            continue
    form = made.oscillator
    torque = max(form.depth, abs(form.slope))
    pace = math.sqrt(torque / (form.base + form.chord + form.swing)) if torque > 0 else 1.0
    angles = [0.0, 1.0, 10 ** pick.uniform(-9, 1), *(pick.uniform(-most, most) for most in (3, 100, 1e9))]
    speeds = [0.0, 0.0, pick.uniform(-3, 3), 10 ** pick.uniform(-3, 3), -(10 ** pick.uniform(-3, 3))]
    phi_dot0 = float(pace * pick.choice(speeds))
    duration = longest * 10 ** pick.uniform(-4, 0) / (abs(phi_dot0) + pace)
    return taylor.Case(made, float(pick.choice(angles)), phi_dot0, np.sort(duration * pick.uniform(0, 1, 4)))


def errors(cases: list[taylor.Case], steps: int = 4000) -> np.ndarray:
    """The largest error, relative beyond 1 rad, of each motion that is not refused and that the witness follows."""
    turns, _ = taylor.integrate(cases, steps)
    found = []
    for each, turned in zip(cases, turns, strict=True):
        try:
            phi, _ = solve(each.scene.oscillator, each.time, each.phi0, each.phi_dot0)
        except NoLibrationError:
            continue
        off = np.abs(phi - each.phi0 - turned.astype(float))
        # phi is rounded beside its start, as a sum of the two.
        scale = np.maximum(max(1, abs(each.phi0)), np.maximum.accumulate(np.abs(turned.astype(float))))
        found.append(np.max(off / scale))
    return np.array([each for each in found if not np.isnan(each)])


@pytest.mark.skipif(not taylor.ENOUGH, reason="long double has no more digits than double")
@pytest.mark.parametrize(("count", "longest"), [(80, 5.0), pytest.param(1500, 500.0, marks=pytest.mark.slow)])
def test_any_motion(count: int, longest: float) -> None:
    pick = np.random.default_rng(count)
    found = errors([case(pick, longest) for _ in range(count)])
    assert len(found) > 0.9 * count
    assert found.max() < ANGLE
    assert np.quantile(found, 0.95) < USUAL


@pytest.mark.slow
@pytest.mark.skipif(not taylor.ENOUGH, reason="long double has no more digits than double")
def test_beside_the_steepest_incline() -> None:
    """There a well of no depth, or a slope of no torque, decides for how long the load hesitates."""
    pick, steepest, cases = np.random.default_rng(230), frozen().largest_incline(), []
    while len(cases) < 230:
        beside = 10 ** pick.uniform(-11, -1)
        made, width = frozen(steepest * (1 + pick.choice([-1, 1]) * beside)), math.sqrt(beside)
        slowness = 0.1 / math.sqrt(width)
        phi0 = math.pi / 2 - steepest + width * pick.choice([0.0, pick.uniform(-3, 3), pick.uniform(-100, 100)])
        phi_dot0 = pick.choice([0.0, width / slowness * pick.uniform(-3, 3), pick.uniform(-20, 20)])
        time = slowness * np.sort(pick.uniform(0, 2, 3))
        cases.append(taylor.Case(made, float(phi0), float(phi_dot0), time))
    found = errors(cases, steps=1000)
    assert len(found) > 0.6 * len(cases)  # others turn so often that the witness takes more steps
    assert found.max() < UNCERTAIN
    assert np.quantile(found, 0.9) < USUAL_BESIDE_STEEPEST
