"""The theory of a standing can: against polynomials that know no Bessel function, its sums, limits,
and refusals."""

import functools
import math
import warnings

import numpy as np
import pytest

from mjbeer import Can, LiquidWarning, standing
from mjbeer.exceptions import ParameterError
from mjbeer.theory.standing import MOST_MODES, SERIES, Standing
from tests.support import laplace

METAL = Can.sheet_metal()
RADIUS = METAL.radius
GRAVITY = 9.81
DENSITY = 1000.0
VISCOSITY = 1e-6
# Products and roots of a few numbers.
ROUNDING = 1e-14
# The condition of the polynomials' matrices, 5e3, times rounding.
BY_POLYNOMIALS = 1e-12
# The polynomials lack the fastest modes, whose share grows with the square of the frequency.
BY_PRESSURE = 1e-6
DEPTHS = (0.4, 60 / 33, 3.0)

volume_of = functools.cache(laplace.Volume)


def water(depth: float = 60 / 33, modes: int = 1) -> Standing:
    """Water of a depth in radii, in a can of which it fills half."""
    return Standing(
        Can.sheet_metal(length=2 * depth * RADIUS), 0.5, "water", DENSITY, VISCOSITY, modes
    )


@pytest.mark.parametrize("depth", DEPTHS)
def test_modes_are_those_of_laplace_s_equation(depth: float) -> None:
    """Frequency, mass, pivot and damping of three modes, and what is fixed."""
    can = water(depth)
    volume = volume_of(depth)
    omega, masses, bobs = volume.slosh(3)
    unit = math.sqrt(GRAVITY / RADIUS)
    assert can.frequencies(3) == pytest.approx(unit * omega, rel=BY_POLYNOMIALS)
    assert can.slosh_masses(3) == pytest.approx(DENSITY * RADIUS**3 * masses, rel=BY_POLYNOMIALS)
    pivots = RADIUS * (depth / 2 + bobs + omega**-2)
    assert can.pivots(3) == pytest.approx(pivots, rel=BY_POLYNOMIALS)
    reynolds = math.sqrt(GRAVITY * RADIUS**3) / VISCOSITY
    ratios = volume.damping(3) / math.sqrt(reynolds)
    assert can.damping_ratios(3) == pytest.approx(ratios, rel=BY_POLYNOMIALS)
    held_inertia = DENSITY * RADIUS**5 * volume.held_inertia()
    assert can.held_inertia == pytest.approx(held_inertia, rel=BY_POLYNOMIALS)


@pytest.mark.parametrize("depth", DEPTHS)
def test_forces_are_those_of_the_pressure_on_the_walls(depth: float) -> None:
    """Up to twice the first frequency."""
    can = water(depth)
    volume = volume_of(depth)
    clock = math.sqrt(RADIUS / GRAVITY)
    for share in (0.05, 0.5, 0.9, 1.1, 2.0):
        omega = share * can.frequencies(1)[0]
        reaction = can.reaction(omega)
        force, coupling, moment = volume.reaction(omega * clock)
        expected = DENSITY * np.array([RADIUS**3 * force, RADIUS**4 * coupling, RADIUS**5 * moment])
        assert reaction == pytest.approx(expected, rel=BY_PRESSURE), share


@pytest.mark.parametrize("depth", [0.05, 1.0, 50.0])
def test_sums_over_all_modes(depth: float) -> None:
    """The metacentre; the sum of 2/(xi^2 - 1), whose rest after n terms is 2/(pi^2 n); and slow
    motion is a solid's."""
    can = water(depth)
    metacentre = DENSITY * math.pi * RADIUS**4 / 4

    lengths = GRAVITY / can.frequencies(SERIES) ** 2
    # The terms fall with the fourth power of n, and so the rest with the third.
    assert can.slosh_masses(SERIES) @ lengths == pytest.approx(metacentre, rel=1e-12)
    # The next term of the rest is of the order of 1/n^2.
    sum_of_first = 1 - 2 / (math.pi**2 * SERIES)
    assert can.elevations(SERIES).sum() == pytest.approx(sum_of_first, abs=SERIES**-2)
    # The surface follows but for (1e-4)^2, which counts as often as the can is deep in radii.
    slow = can.reaction(1e-4 * can.frequencies(1)[0])
    assert slow.force == pytest.approx(can.mass, rel=1e-6)
    assert slow.coupling == pytest.approx(metacentre, rel=1e-6)


@pytest.mark.parametrize("modes", range(MOST_MODES + 1))
def test_what_is_fixed_is_positive_everywhere(modes: int) -> None:
    """A body must have a mass and an inertia; the least share is 0.046 for shallow liquids."""
    for depth in np.geomspace(0.05, 50, 20):
        can = water(float(depth), modes)
        mass, first, second = can.total_moments()
        masses = can.slosh_masses()
        bobs = can.pivots() - GRAVITY / can.frequencies() ** 2 - can.height / 2
        left = mass - masses.sum()
        inertia = second - masses @ bobs**2 - (first - masses @ bobs) ** 2 / left
        assert min(left / mass, inertia / second) > 0.045


def test_damping_may_be_given_and_gravity_scales_time() -> None:
    assert np.array_equal(standing(damping_ratio=0.02).damping_ratios(2), [0.02, 0.02])
    moon = standing(gravity=GRAVITY / 4)
    earth = standing()
    assert moon.frequencies(2) == pytest.approx(earth.frequencies(2) / 2, rel=ROUNDING)
    damped_more = earth.damping_ratios(2) * math.sqrt(2)
    assert moon.damping_ratios(2) == pytest.approx(damped_more, rel=ROUNDING)


def test_a_thick_liquid_warns() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        standing("olive oil")
        standing("honey", damping_ratio=0.3)
        standing("honey", modes=0)
    with pytest.warns(LiquidWarning, match=r"honey is too thick .* give a damping_ratio"):
        standing("honey")


def test_a_liquid_that_is_over_damped_does_not_slosh() -> None:
    """It is a solid as with modes=0, though a `count` still asks for what theory has of each
    mode."""
    with pytest.warns(
        LiquidWarning,
        match=r"does not slosh: .* 2\.72 times the critical one; give a damping_ratio",
    ):
        honey = standing("honey", fill=0.03, modes=3)
    assert honey.moving_modes == 0
    for method in ("frequencies", "slosh_masses", "pivots", "damping_ratios", "elevations"):
        assert len(getattr(honey, method)()) == 0
        assert len(getattr(honey, method)(3)) == 3
    assert honey.damping_ratios(1)[0] > 1
    assert np.array_equal(
        honey.total_moments(), standing("honey", fill=0.03, modes=0).total_moments()
    )
    assert standing("water", modes=3, damping_ratio=1.0).moving_modes == 0
    assert standing("water", modes=3, damping_ratio=0.999).moving_modes == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"fill": 1.0},
            r"fill must be a fraction between 0 and 1 .*: a full can has no free surface, got 1\.0",
        ),
        ({"fill": 0.001}, r"liquid divided by the radius must be between 0\.05 and 50"),
        ({"can": Can()}, r"a standing can must have mass and inertia, as Can\.sheet_metal\(\)"),
        ({"modes": 6}, r"modes must be one of 0, 1, \.\.\. 5, got 6"),
        ({"liquid": "bear"}, "liquid must be one of .*'beer', .*; got 'bear'$"),
        ({"gravity": 0.0}, "gravity must be between"),
    ],
)
def test_what_a_can_cannot_be_is_refused(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        standing(**arguments)


@pytest.mark.parametrize(
    ("call", "argument"), [("frequencies", 1.5), ("pivots", -1), ("reaction", 0.0)]
)
def test_what_theory_cannot_say_is_refused(call: str, argument: float) -> None:
    with pytest.raises(ParameterError, match=r"(count|omega) must be"):
        getattr(standing(), call)(argument)
