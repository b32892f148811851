"""The front and what is read off it, the tables, and the study that comes with mjbeer."""

import math

import pytest

from mjbeer.studies.benchmark import benchmark_tables as tables
from mjbeer.studies.benchmark import points
from mjbeer.studies.benchmark.other_tools import COMPILED_DOP853, HEYOKA, ODEINT, WHOLE_CALL
from mjbeer.studies.benchmark.points import (
    CASES,
    SHIPPED,
    TIMESTEP,
    TOLERANCE,
    Benchmark,
    Curve,
    Point,
)
from mjbeer.studies.benchmark.timing import measure

STALE = 2.0
"""The shipped study is stale if an error differs by more than this factor from that of the code.
RK4 takes 2^(1/4), 1.19 times as long for half the error, and Gauss-Jackson 2^(1/13), 1.05 times:
ratios of run times move less than from one processor to the next. Rounding, in which processors
differ, changes the error of a contact by 1.6 %, and others by less."""
STALE_EVALUATIONS = 0.1
"""The same for the number of evaluations: a relative change, which is that of the run time. In a
run of fixed timesteps it is the same on all processors, but for a step at the end."""
ABOVE_ROUNDING = 1e-10
"""Errors above this [rad] are not those of rounding, which amounts to 1e-13 here."""
QUICK = 3e-3
"""Settings that take longer than this [s] are not measured again here."""


def point(
    time: float,
    error: float,
    model: str = "reduced",
    method: str = "RK4",
    parameter: str = TIMESTEP,
) -> Point:
    return Point(
        "frozen",
        model,
        method,
        parameter,
        1e-3,
        phi_max=error,
        u_max=error / 2,
        times=[time, 2 * time],
    )


LADDER = [point(1, 1e-2), point(2, 1e-3), point(3, 5e-3), point(4, 1e-5), point(8, 1e-5)]


def test_a_front_has_the_points_that_none_beats() -> None:
    front = points.pareto_front(LADDER)
    assert front == [LADDER[0], LADDER[1], LADDER[3]]


def test_the_cheapest_point_is_the_fastest_that_keeps_an_error() -> None:
    assert points.cheapest(LADDER, 9e-4) is LADDER[3]
    assert points.cheapest(LADDER, 1e-6) is None


def test_between_points_of_a_curve_error_is_a_power_of_time() -> None:
    assert points.time_for(LADDER, 1e-4) == pytest.approx(math.sqrt(2 * 4))
    assert points.time_for(LADDER, 1e-1) == 1  # nothing is faster than the fastest
    assert math.isinf(points.time_for(LADDER, 1e-6))


def test_a_time_is_not_interpolated_between_two_methods() -> None:
    """Gauss-Jackson, whose coarsest run is exact to 1e-8 rad, is taken as it ran.

    Between this run and that of DOP853 1e-4 rad would take 1.5^(1/2) s.
    """
    coarse = point(1, 1e-2, method="DOP853")
    fine = point(3, 1e-6, method="DOP853")
    exact = point(1.5, 1e-8, method="GaussJackson")
    assert points.time_for([coarse, fine, exact], 1e-4) == pytest.approx(1.5)
    assert points.times_in_rounds([coarse, fine, exact], 1e-4) == pytest.approx([1.5, 3])
    assert points.time_for([coarse, fine, exact], 1e-2) == pytest.approx(1)


def test_a_ratio_is_that_of_the_least_times_with_its_range_over_rounds() -> None:
    """One takes 2 and 6 s in two rounds, the other 1 and 2 s.

    The ratio of the least times is 2 s to 1 s; those of the rounds are 2 and 3.
    """
    slow = Point("frozen", "reduced", "RK4", TIMESTEP, 1e-3, 1e-3, 1e-3, times=[2, 6])
    fast = Point("frozen", "reduced", "DOP853", TIMESTEP, 1e-3, 1e-3, 1e-3, times=[1, 2])
    ratio = points.time_ratio([slow], [fast], 1e-3)
    assert ratio == pytest.approx((2, 2, 3))
    assert points.time_ratio([slow], [fast], 1e-4) is None


@pytest.fixture
def made_up() -> Benchmark:
    """RK4 takes twice as long as the best for 1e-3 rad.

    heyoka takes half as long, and 10 s to compile.
    """
    best = point(1, 1e-3, method="DOP853")
    rk4 = point(2, 1e-3)
    rk4.evaluations = 4096
    heyoka = point(0.5, 1e-12, HEYOKA, "", TOLERANCE)
    heyoka.setup = 10.0
    whole_call = point(4, 1e-5, WHOLE_CALL, "", TOLERANCE)
    odeint = point(2, 1e-4, ODEINT, "", TOLERANCE)
    return Benchmark({}, {}, [best, rk4, heyoka, whole_call, odeint])


def test_others_are_compared_at_equal_error(made_up: Benchmark) -> None:
    first, last = tables.ratios(made_up, (1e-3, 1e-6)).rows
    assert first == (
        "frozen, 1e-03 rad",
        "1e+03 to 2e+03 ms",
        "2.0 (2.0 to 2.0)",
        "2.0 (2.0 to 2.0)",
        "-",
        "-",
        "0.50 (0.50 to 0.50)",
    )
    assert last == ("frozen, 1e-06 rad", "not reached", "-", "-", "-", "-", "-")
    assert tables.ratio_range(made_up, tables.RK4, 1e-3) == "2.0 to 2.0"
    assert tables.ratio_range(made_up, tables.RK4, 1e-6) == "-"


def test_evaluations_are_of_the_fastest_settings(made_up: Benchmark) -> None:
    first, _ = tables.evaluations(made_up).rows
    assert first == ("frozen, 1e-03 rad", "-", "4,096", "-", "-", "-", "-")


def test_whole_calls_have_their_set_up(made_up: Benchmark) -> None:
    (whole,) = tables.whole_calls(made_up).rows
    assert whole == (
        "frozen, 1e-03 rad",
        "4e+03 to 8e+03 ms",
        "1.0e-05",
        "2e+03 to 4e+03 ms",
        "-",
        "1e+04 ms + 500 ms",
    )


def test_the_fastest_setting_is_named(made_up: Benchmark) -> None:
    first, *_ = tables.cheapest(made_up, "frozen").rows
    assert first == ("1e-02 rad", "DOP853 1 ms: 1e+03 to 2e+03 ms")


def test_a_contact_converges_with_an_order() -> None:
    """An error that falls to a quarter in half the timestep is of order 2.

    One that stays is of order 0.
    """
    contact = Curve("contact", "RK4")
    usual = Curve("contact, defaults", "Euler")
    rungs = [
        (contact, 2e-3, 4e-4),
        (contact, 1e-3, 1e-4),
        (usual, 2e-3, 0.1),
        (usual, 1e-3, 0.1001),
    ]
    study = Benchmark({}, {}, [])
    for curve, timestep, error in rungs:
        study.points.append(Point("frozen", *curve, timestep, error, 0.0, times=[1.0]))
    assert tables.convergence(study, "frozen").rows == [
        ("2 ms", "4.0e-04", "1.0e-01"),
        ("1 ms", "1.0e-04 (2.0)", "1.0e-01 (0.0)"),
    ]


@pytest.fixture(scope="module")
def stored() -> Benchmark:
    return Benchmark.load(SHIPPED)


def measured_again(stored: Benchmark) -> list[Point]:
    """One quick point of every curve of a case; its error is the method's own, not rounding."""
    found = {}
    for old in stored.points:
        suitable = ABOVE_ROUNDING < old.error < 1.0 and old.time < QUICK
        if suitable and old.method and old.parameter == TIMESTEP:
            found[old.case, old.curve] = old
    return list(found.values())


@pytest.mark.slow
def test_the_study_that_comes_with_mjbeer_is_of_this_code(stored: Benchmark) -> None:
    assert set(stored.cases + stored.long_cases) == set(CASES)
    again = measured_again(stored)
    assert len(again) > 30
    for old in again:
        case = CASES[old.case]
        new = Point(old.case, old.model, old.method, old.parameter, old.value)
        measure(case, new, case.truth())
        assert old.error / STALE < new.error < STALE * old.error, old
        assert new.evaluations == pytest.approx(old.evaluations, rel=STALE_EVALUATIONS), old


@pytest.mark.slow
def test_tolerances_of_the_study_hold_in_this_code(stored: Benchmark) -> None:
    """Which steps a tolerance takes may change from release to release; that it is kept may not."""
    for old in stored.points:
        if (
            old.method != points.CHOSEN
            or old.case not in stored.cases
            or old.value not in (1e-3, 1e-9)
        ):
            continue
        assert old.error <= old.value
        case = CASES[old.case]
        new = Point(old.case, old.model, old.method, old.parameter, old.value)
        measure(case, new, case.truth())
        assert new.error <= old.value


def test_the_study_that_comes_with_mjbeer_has_all_that_is_told_of_it(stored: Benchmark) -> None:
    """Every tool took part, five times, and every case has all of its tables."""
    assert stored.settings["absent"] == {}
    assert not stored.settings["quick"]
    for row in tables.ratios(stored, (1e-3, 1e-6)).rows:
        assert "-" not in row
    for case in stored.cases:
        assert any(
            found.curve == Curve(COMPILED_DOP853, "", TOLERANCE) for found in stored.of(case)
        )
    for case in stored.long_cases:
        for row in tables.drift(stored, case).rows:
            assert "nan" not in row
    for found in stored.points:
        assert found.failure is None or not found.times
        assert len(found.times) in (0, 5)
