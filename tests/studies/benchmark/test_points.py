"""The front and what is read off it; the study that comes with mjbeer, its tables and its diagrams."""

import math

import numpy as np
import pytest
from matplotlib.figure import Figure

from mjbeer.studies.benchmark import benchmark_tables as tables
from mjbeer.studies.benchmark import points
from mjbeer.studies.benchmark.points import CASES, SHIPPED, Benchmark, Point
from mjbeer.studies.benchmark.timing import measure


def point(time: float, error: float, model: str = "reduced", method: str = "RK4", parameter: str = "timestep") -> Point:
    return Point("frozen", model, method, parameter, 1e-3, phi_max=error, u_max=error / 2, times=[time, 2 * time])


LADDER = [point(1, 1e-2), point(2, 1e-3), point(3, 5e-3), point(4, 1e-5), point(8, 1e-5)]


def test_a_front_has_the_best_points_and_between_them_error_is_a_power_of_time() -> None:
    assert [(each.time, each.error) for each in points.pareto_front(LADDER)] == [(1, 1e-2), (2, 1e-3), (4, 1e-5)]
    assert points.cheapest(LADDER, 9e-4) is LADDER[3]
    assert points.cheapest(LADDER, 1e-6) is None
    assert points.time_for(LADDER, 1e-4) == pytest.approx(math.sqrt(2 * 4))
    assert points.time_for(LADDER, 1e-1) == 1  # nothing is faster than the fastest
    assert math.isinf(points.time_for(LADDER, 1e-6))


def test_others_are_compared_at_equal_error_and_whole_calls_with_their_set_up() -> None:
    """RK4 takes twice as long as the best for 1e-3 rad; a whole call takes twice as long as SciPy's best."""
    found = [point(1, 1e-3, method="DOP853"), point(2, 1e-3), point(0.5, 1e-12, "heyoka", "", "tolerance")]
    found[1].evaluations, found[2].setup = 4096, 10.0
    found += [point(4, 1e-5, "mjbeer.simulate", "", "tolerance"), point(2, 1e-4, "SciPy odeint", "", "tolerance")]
    study = Benchmark({}, {}, found)
    first, *_, last = tables.others(study).rows
    assert first == ("frozen, 1e-03 rad", "1e+03 ms", "2 (4,096)", "-", "2", "0.5")
    assert last[1:] == ("not reached", "-", "-", "-", "-")
    assert tables.span(study, "MuJoCo RK4") == (2, 2)
    (whole,) = tables.whole_calls(study).rows
    assert whole[1:] == ("4e+03 ms", "1.0e-05", "2e+03 ms (odeint)", "0.5", "1e+04 ms + 500 ms")
    assert tables.cheapest(study, "frozen").rows[0][1] == "DOP853 1 ms: 1e+03 ms"


@pytest.fixture(scope="module")
def stored() -> Benchmark:
    return Benchmark.load(SHIPPED)


@pytest.mark.slow
def test_the_study_that_comes_with_mjbeer_is_of_this_code(stored: Benchmark) -> None:
    """On a few of its points, to the digits that rounding leaves."""
    assert set(stored.cases) <= set(CASES)
    compared = 0
    for old in stored.points[:: len(stored.points) // 72]:
        if old.failure or not 1e-10 < old.error < 1e-2 or not old.method:  # of another tool
            continue
        case, new = CASES[old.case], Point(old.case, old.model, old.method, old.parameter, old.value)
        measure(case, new, case.truth())
        # What MuJoCo's solver leaves of a contact's force depends on rounding: 1.6 % on an inertia's last digit.
        assert new.error == pytest.approx(old.error, rel=3e-2 if old.model == "contact" else 1e-3)
        assert new.evaluations == old.evaluations
        compared += 1
    assert compared > 10


@pytest.mark.slow
def test_the_diagram_is_of_run_times_in_milliseconds_and_of_errors(stored: Benchmark) -> None:
    axes = Figure().subplots()
    tables._draw(axes, stored.of("frozen"))
    (line,) = (line for line in axes.lines if line.get_label() == "MuJoCo's RK4")
    rk4 = [point for point in stored.of("frozen") if (point.model, point.method) == ("reduced", "RK4")]
    assert np.array_equal(line.get_xydata(), [(1e3 * point.time, point.error) for point in rk4])
