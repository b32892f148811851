"""The front and what is read off it."""

import math

import pytest

from mjbeer.exceptions import ParameterError
from mjbeer.studies.benchmark import frontier
from mjbeer.studies.benchmark.curves import CHOSEN
from mjbeer.studies.benchmark.points import Point


def point(
    time: float, error: float, way: str = "reduced", method: str = "RK4", knob: str = "timestep", value=1e-3
) -> Point:
    return Point("frozen", way, method, knob, value, phi_max=error, u_max=error / 2, times=[time, 2 * time])


LADDER = [point(1, 1e-2), point(2, 1e-3), point(3, 5e-3), point(4, 1e-5), point(8, 1e-5)]


def test_the_front_has_no_point_that_another_beats() -> None:
    assert [(each.time, each.error) for each in frontier.front(LADDER)] == [(1, 1e-2), (2, 1e-3), (4, 1e-5)]


def test_the_cheapest_is_a_measured_one() -> None:
    assert frontier.cheapest(LADDER, 1e-3) is LADDER[1]
    assert frontier.cheapest(LADDER, 9e-4) is LADDER[3]
    assert frontier.cheapest(LADDER, 1e-6) is None


def test_between_points_error_is_a_power_of_time() -> None:
    assert frontier.time_for(LADDER, 1e-4) == pytest.approx(math.sqrt(2 * 4))
    assert frontier.error_for(LADDER, math.sqrt(2 * 4)) == pytest.approx(1e-4)
    assert frontier.time_for(LADDER, 1e-1) == 1  # nothing is faster than the fastest
    assert math.isinf(frontier.time_for(LADDER, 1e-6))
    assert math.isinf(frontier.error_for(LADDER, 0.5))
    assert math.isinf(frontier.time_for([], 1.0))


def test_the_gain_over_the_usual_is_at_equal_time() -> None:
    usual = point(2, 0.5, "equality, slide first", "Euler")
    twins = [point(1, 1e-3, "equality"), point(4, 1e-5, "equality"), point(1, 1e-9)]
    assert frontier.gain_over_usual([usual, *twins], "equality, slide first") == pytest.approx(0.5 / 1e-4)
    assert frontier.gain_over_usual(twins, "equality, slide first") is None


def test_advice_is_from_mjbeer_s_own_models() -> None:
    points = [*LADDER, point(0.1, 1e-9, "heyoka", ""), point(3, 1e-6, "contact")]
    assert frontier.advise(points, 1e-5).way == "contact"
    assert frontier.advise(points, 1e-5, "reduced").time == 4
    with pytest.raises(
        ParameterError, match=r"meets a tolerance of 1e-07 rad with rolling 'contact': the best has 1.0e-06"
    ):
        frontier.advise(points, 1e-7, "contact")


def test_a_failed_point_has_an_infinite_error() -> None:
    assert math.isinf(Point("frozen", "contact", "RK4", "timestep", 1e-3, failure="diverged").error)


def test_fixed_and_asked_for() -> None:
    fixed = [point(time, error, method="DOP853") for time, error in ((1, 1e-3), (2, 1e-7))]
    asked = [point(5, 1e-8, method=CHOSEN, knob="tolerance", value=10.0**-6)]
    assert frontier.fixed_and_global([*fixed, *asked], 1e-6) == (fixed[1], asked[0])
    assert frontier.fixed_and_global(fixed, 1e-9) == (None, None)
