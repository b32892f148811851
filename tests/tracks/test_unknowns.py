"""The solver's variables of unknowns belong to their values, and so do the errors."""

import numpy as np
import pytest

from mjbeer import Track, frozen, liquid
from mjbeer.tracks.unknowns import (
    NAMES,
    Measurement,
    distance_from_guess,
    make_unknowns,
    motion_slice,
    to_values,
    to_variables,
)

TRACK = Track(np.linspace(17, 20, 50), np.linspace(0, 2, 50) ** 2, roll=np.linspace(3, 9, 50))
LIQUID = liquid("water", 0.03)
VALUES = {
    "incline": 0.04,
    "fill": 0.3,
    "damping": 1.7,
    "drag": 0.002,
    "phi0": -0.3,
    "place": 0.2,
    "released": 17.6,
    "bend": -0.004,
    "scale": 1.02,
    "turned": 3.1,
}


@pytest.mark.parametrize("scene", [LIQUID, frozen(0.05)], ids=["sliding", "frozen"])
def test_values_come_back_from_their_variables(scene) -> None:
    unknowns = make_unknowns(NAMES, TRACK, scene, {})
    variables = to_variables(unknowns, VALUES)
    assert to_values(unknowns, variables) == pytest.approx(VALUES, rel=1e-10)


def test_a_guess_is_the_middle_and_a_measured_value_is_a_guess() -> None:
    measured = {"fill": Measurement(0.4, 0.01)}
    unknowns = make_unknowns(["incline", "fill", "turned"], TRACK, LIQUID, measured)
    guesses = {unknown.name: unknown.guess for unknown in unknowns}
    assert guesses == {"incline": LIQUID.incline, "fill": 0.4, "turned": 3.0}
    middle = to_variables(unknowns, guesses)
    assert (middle == middle[0]).all()
    assert distance_from_guess(unknowns, middle) == 0
    # Of a scale of 0.1 in the fill this is two; where the mark was at first is no motion.
    moved = to_variables(unknowns, guesses | {"fill": 0.2, "turned": 0.0})
    assert distance_from_guess(unknowns, moved) == pytest.approx(2.0, rel=1e-10)


def test_the_motion_comes_first() -> None:
    unknowns = make_unknowns({"released", "phi0", "bend", "damping"}, TRACK, LIQUID, {})
    names = [unknown.name for unknown in unknowns]
    assert names[motion_slice(unknowns)] == ["damping", "phi0"]


@pytest.mark.parametrize("name", ["incline", "fill", "damping"])
def test_an_error_is_the_slope_of_the_value_times_the_deviation(name: str) -> None:
    """Two of these three have logarithms as variables."""
    (unknown,) = make_unknowns([name], TRACK, LIQUID, {})
    value = 1.3 * unknown.guess
    variable = unknown.to_variable(value)
    step = 1e-4
    slope = (unknown.to_value(variable + step) - unknown.to_value(variable - step)) / (2 * step)
    # The central difference is off by the square of the step, and by rounding of 1e-13 in 1e-4.
    assert unknown.to_error(value, 0.3) == pytest.approx(0.3 * slope, rel=1e-6)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_guesses_are_within_bounds_either_way(direction: float) -> None:
    scene = liquid("water", direction * 0.03)
    track = Track(TRACK.time, direction * TRACK.along)
    unknowns = make_unknowns(["incline", "fill", "damping"], track, scene, {})
    for unknown in unknowns:
        low = unknown.to_variable(unknown.low)
        high = unknown.to_variable(unknown.high)
        assert low < unknown.to_variable(unknown.guess) < high, unknown
