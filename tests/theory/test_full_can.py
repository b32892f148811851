"""A full can, the witness of the document on real beer: its series against a numerical inversion of its transform."""

import mpmath
import numpy as np
import pytest

from mjbeer import Can
from mjbeer.theory.liquid import LIQUIDS
from tests.support.full_can import FullCan, terms

FULL = FullCan(Can.sheet_metal())
OIL = FullCan(Can.massless(), LIQUIDS["olive oil"].density, LIQUIDS["olive oil"].viscosity)


@pytest.mark.slow
@pytest.mark.parametrize("full", [FULL, OIL])
@pytest.mark.parametrize("time", [0.1, 1.0, 8.0])
def test_the_way_is_the_inverse_of_the_transform(full: FullCan, time: float) -> None:
    """By Talbot's method with 30 digits; to rounding, which the difference of two parts makes larger at first."""

    def transform(s: mpmath.mpc) -> mpmath.mpc:
        z = full.can.radius * mpmath.sqrt(s / full.viscosity)
        mass = full.first_mass + 2 * full.liquid_mass * mpmath.besseli(2, z) / (z * mpmath.besseli(1, z))
        return full.force / (s * mass) / s**2

    with mpmath.workdps(30):
        expected = float(mpmath.invertlaplace(transform, time, method="talbot"))
    assert full.way(np.array([time]))[0] == pytest.approx(expected, rel=1e-12)


def test_the_sum_of_what_decays_is_that_of_the_transform_at_0() -> None:
    """I_2/(z I_1) = 1/4 - z^2/96 + ..., so that the mean delay is known: a missing root would be seen."""
    ratio = FULL.liquid_mass / FULL.first_mass
    roots, shares = terms(2 * ratio)
    assert (shares / roots**2).sum() == pytest.approx(ratio / 48 / (1 + ratio / 2) ** 2, rel=1e-9)
    assert (shares > 0).all()
