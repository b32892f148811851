"""The maps of the documents: MuJoCo's outcomes lie within theory's borders, and its periods are theory's."""

import math

import numpy as np
import pytest

from mjbeer.studies.sweep import maps

pytestmark = pytest.mark.slow
INCLINES, FILLS = np.radians([3.0, 8.5, 18.0, 28.0, 40.0]), np.array([0.1, 0.3, 0.6, 0.9])
"""None is within a degree of a border."""


def by_theory(incline: float, fill: float) -> int:
    part, slip, down = (maps.border(excess, fill) for excess in (maps.parts, maps.slips, maps.rolls_down))
    if incline > part:
        return maps.PARTS
    return maps.SLIPS if incline > slip else maps.ROLLS_DOWN if incline > down else maps.ROCKS


def test_what_a_can_does_is_what_theory_says() -> None:
    expected = [[by_theory(incline, fill) for fill in FILLS] for incline in INCLINES]
    assert {kind for row in expected for kind in row} == {maps.ROCKS, maps.ROLLS_DOWN, maps.SLIPS, maps.PARTS}
    assert maps.outcomes(INCLINES, FILLS).tolist() == expected


def test_the_border_of_rocking_is_where_the_release_is_on_the_separatrix() -> None:
    incline = maps.border(maps.rolls_down, 0.8)
    for aside, kind in ((-1, maps.ROCKS), (1, maps.ROLLS_DOWN)):
        beside = np.array([incline + aside * math.radians(0.2)])
        assert maps.outcomes(beside, np.array([0.8])).tolist() == [[kind]]


def test_periods_are_those_of_theory_up_to_the_separatrix() -> None:
    measured, theory = maps.periods(np.radians([0.0, 12.0]), np.radians([5.0, 90.0, 120.0, 170.0]))
    assert np.isfinite(theory).tolist() == [[True, True, True, True], [True, True, True, False]]
    # A turning point is off by 1.5e-8 of a radian of phase, and by the tolerance of 1e-6 rad over a swing of 0.09 rad.
    assert np.nanmax(np.abs(measured / theory - 1)) < 1e-5
