"""A full can: the series against a numerical inversion of its Laplace transform, and its limits."""

import math

import mpmath
import numpy as np
import pytest

from mjbeer import Can
from mjbeer.theory.liquid import LIQUIDS
from tests.support.full_can import FullCan, _terms

FULL = FullCan(Can.sheet_metal())
OIL = FullCan(Can.massless(), LIQUIDS["olive oil"].density, LIQUIDS["olive oil"].viscosity)


def inverted(full: FullCan, time: float, power: int) -> float:
    """The transform of the module, over s^power, by Talbot's method with 30 digits."""

    def transform(s: mpmath.mpc) -> mpmath.mpc:
        z = full.can.radius * mpmath.sqrt(s / full.viscosity)
        mass = full.first_mass + 2 * full.liquid_mass * mpmath.besseli(2, z) / (z * mpmath.besseli(1, z))
        return full.force / (s * mass) / s**power

    with mpmath.workdps(30):
        return float(mpmath.invertlaplace(transform, time, method="talbot"))


@pytest.mark.parametrize("full", [FULL, OIL])
def test_the_series_is_the_inverse_of_the_transform(full: FullCan) -> None:
    """To rounding, which the difference of a speed's two parts makes larger in the way of a short time."""
    times = [0.1, 1.0, 8.0]
    for time in times:
        assert full.acceleration(np.array([time]))[0] == pytest.approx(inverted(full, time, 0), rel=1e-12)
        assert full.way(np.array([time]))[0] == pytest.approx(inverted(full, time, 2), rel=1e-12)


def test_the_first_moments_follow_the_layer() -> None:
    times = np.array([0.0, 1e-5, 1e-3])
    known = [FULL.force / FULL.first_mass, *(inverted(FULL, time, 0) for time in times[1:])]
    for time, value, right in zip(times, FULL.acceleration(times), known, strict=True):
        assert value == pytest.approx(right, rel=3 * FULL.viscosity * time / FULL.can.radius**2 + 1e-14)


def test_the_sum_of_what_decays_is_that_of_the_transform_at_0() -> None:
    """I_2/(z I_1) = 1/4 - z^2/96 + ..., so that the mean delay is known: a missing root would be seen."""
    for full in (FULL, OIL):
        roots, shares = _terms(2 * full.liquid_mass / full.first_mass)
        ratio = full.liquid_mass / full.first_mass
        assert (shares / roots**2).sum() == pytest.approx(ratio / 48 / (1 + ratio / 2) ** 2, rel=1e-9)
        assert (shares > 0).all()


def test_water_in_a_can_of_12_oz() -> None:
    """As found once, to the three digits that were given."""
    full = FULL.gravity * math.sin(FULL.incline)
    known = {0.0: 0.982, 0.25: 0.951, 1.0: 0.923, 2.0: 0.902, 8.0: 0.839, 1e4: 0.663}
    assert FULL.acceleration(np.array([*known])) / full == pytest.approx([*known.values()], abs=6e-4)
    roots, _ = _terms(2 * FULL.liquid_mass / FULL.first_mass)
    assert FULL.can.radius**2 / (1e-6 * roots[0] ** 2) == pytest.approx(61.5, abs=0.05)  # with this viscosity
