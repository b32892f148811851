"""The diagram of the benchmark: what is drawn where."""

import pathlib
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from mjbeer.output.plots import Picture
from mjbeer.studies.benchmark import benchmark_tables, points, work_precision
from mjbeer.studies.benchmark.other_tools import HEYOKA
from mjbeer.studies.benchmark.points import SHIPPED, TOLERANCE, Benchmark, Point

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def stored() -> Benchmark:
    return Benchmark.load(SHIPPED)


def test_a_curve_is_of_run_times_in_milliseconds_and_of_errors(stored: Benchmark) -> None:
    axes = Figure().subplots()
    work_precision._draw(axes, stored.of("frozen"), work_precision._SMOOTH)
    (line,) = (line for line in axes.lines if line.get_label() == "MuJoCo's RK4")
    rk4 = [
        point for point in stored.of("frozen") if (point.model, point.method) == ("reduced", "RK4")
    ]
    assert len(rk4) == 10
    above_rounding = [(1e3 * point.time, point.error) for point in rk4 if point.error > 1e-13]
    assert len(above_rounding) > 6
    drawn = np.column_stack([line.get_xdata(), line.get_ydata()])
    assert np.array_equal(drawn[: len(above_rounding)], above_rounding)


def test_a_curve_ends_where_it_reaches_rounding() -> None:
    """The first point at the floor is drawn there, and no slower one."""
    errors = [1e-6, 1e-15, 1e-16]
    found = [
        Point("frozen", HEYOKA, "", TOLERANCE, error, error, error, times=[1.0]) for error in errors
    ]
    axes = Figure().subplots()
    work_precision._draw(axes, found, work_precision._SMOOTH)
    (line,) = axes.lines
    assert list(line.get_ydata()) == [1e-6, 1e-13]


def test_a_panel_has_few_curves() -> None:
    for lines in (work_precision._SMOOTH, work_precision._CONTACT):
        assert len(lines) <= 5


def test_all_panels_have_the_same_axes(stored: Benchmark, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three scenes, and contacts in the fourth panel."""
    cases = ("sliding", "frozen", "pendulum")
    some = replace(stored, points=[point for point in stored.points if point.case in cases])
    drawn = []
    monkeypatch.setattr(
        work_precision, "name_below", lambda panels, _: drawn.extend(panels[0].figure.axes)
    )
    picture = Picture("some")
    work_precision.draw(some, picture)
    assert len(drawn) == 4
    assert len({axes.get_xlim() for axes in drawn}) == 1
    assert len({axes.get_ylim() for axes in drawn}) == 1
    assert "in a can that rolls by friction" in picture.svg


def test_a_single_scene_is_drawn_without_contacts(
    stored: Benchmark, tmp_path: pathlib.Path
) -> None:
    one = replace(stored, points=stored.of("frozen"))
    work_precision.draw(one, tmp_path / "picture")
    text = (tmp_path / "picture.svg").read_text()
    assert "in a can that rolls by friction" not in text
    assert "without compiling" in text


def test_a_panel_and_the_title_say_how_much_longer_rk4_takes(stored: Benchmark) -> None:
    """The numbers are those of the table."""
    table = benchmark_tables.ratios(stored, (1e-6,))
    rk4 = table.columns.index(benchmark_tables.RK4)
    in_table = [row[rk4].partition(" ")[0] for row in table.rows]
    picture = Picture("all")

    work_precision.draw(stored, picture)

    assert len(in_table) == 5
    for ratio in in_table:
        assert f">{ratio} times as long<" in picture.svg
    ordered = sorted(in_table, key=float)
    assert f"RK4 takes {ordered[0]} to {ordered[-1]} times" in picture.title


def test_the_contact_that_rk4_wins_is_excepted(stored: Benchmark) -> None:
    """The arrow, the subtitle and the picture of its own have the ratio of the curves."""
    found = stored.of("frozen")
    dop853 = [point for point in found if (point.model, point.method) == ("contact", "DOP853")]
    rk4 = [point for point in found if (point.model, point.method) == ("contact", "RK4")]
    factor = points.time_for(dop853, 1e-6) / points.time_for(rk4, 1e-6)
    assert factor > 2
    whole = Picture("all")
    alone = Picture("alone")

    work_precision.draw(stored, whole)
    work_precision.draw_contact(stored, alone)

    assert whole.title.startswith("Without contacts ")
    assert f"DOP853 takes {factor:.1f} times as long as RK4" in whole.subtitle
    for picture in (whole, alone):
        assert f">{factor:.1f} times as long<" in picture.svg
        assert ">as RK4<" in picture.svg
