"""The charts below a film: a line up to now, theory's whole line, and a dot at what is now."""

import numpy as np
import pytest

from mjbeer import exact, frozen, simulate
from mjbeer.drawing.overlay.charts import charts
from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.overlay.strip import Chart, Line, Strip, unbroken

RED = (1.0, 0.0, 0.0)
TIME = np.linspace(0, 2, 201)
SIZE = (400, 120)


def red(picture: np.ndarray) -> np.ndarray:
    """Rows and columns of the red pixels, shape (2, pixels)."""
    return np.stack(np.nonzero((picture[..., 0] > 200) & (picture[..., 1:] < 80).all(axis=2)))


def drawn(time: float, values: np.ndarray) -> np.ndarray:
    strip, sheet = Strip([Chart("a ramp", [Line("MuJoCo", TIME, values, RED)])], *SIZE), Sheet(*SIZE)
    strip.draw(sheet, time, 0)
    return sheet.picture()


def test_the_line_is_drawn_up_to_now_with_a_dot_at_its_end() -> None:
    last = []
    for time in (0.5, 1.0, 1.5):
        rows, columns = red(drawn(time, TIME))
        last.append((columns.max(), rows.min()))
    (x1, y1), (x2, y2), (x3, y3) = last
    assert x3 - x2 == pytest.approx(x2 - x1, abs=2)  # even time
    assert y3 - y2 == pytest.approx(y2 - y1, abs=2)  # even values, upwards
    assert x2 - x1 > 50
    assert y2 < y1


def test_theory_is_there_from_the_beginning_and_dotted_where_it_is_not_possible() -> None:
    lengths = []
    for possible in (np.inf, 1.0):
        lines = [Line("theory", TIME, TIME, possible=possible), Line("MuJoCo", TIME, 0 * TIME, RED)]
        sheet = Sheet(*SIZE)
        Strip([Chart("a ramp", lines)], *SIZE).draw(sheet, 0.0, 0)
        grey = np.abs(sheet.picture().astype(int) - [180, 188, 200]).max(axis=2) < 12
        lengths.append((grey[:, :200].sum(), grey[:, 230:350].sum()))
    assert lengths[0][0] == pytest.approx(lengths[1][0], rel=0.2)
    assert lengths[1][1] < 0.5 * lengths[0][1]


def test_an_angle_that_jumps_is_not_joined() -> None:
    values = unbroken(np.array([170.0, 175.0, -179.0, -170.0]))
    assert np.isnan(values).tolist() == [False, False, True, False]
    assert not np.isnan(unbroken(np.array([1.0, 2.0, 3.0]))).any()
    assert not np.isnan(unbroken(np.zeros(3))).any()


def test_a_small_range_is_not_made_large() -> None:
    """A dot for 0 and one for 0.01 are at the same height, where at least 10 is shown."""
    heights = []
    for value in (0.0, 0.01):
        values = np.where(TIME > 1, value, 0.0)
        strip = Strip([Chart("rest", [Line("MuJoCo", TIME, values, RED)], least=10.0)], *SIZE)
        sheet = Sheet(*SIZE)
        strip.draw(sheet, 1.5, 0)
        heights.append(red(sheet.picture())[0].mean())
    assert heights[0] == pytest.approx(heights[1], abs=0.5)


def test_a_simulation_has_theory_beside_it_and_theory_has_not() -> None:
    run = simulate(frozen(), 0.5, 1.0)
    (chart,) = charts(run, ["phi"])
    assert [line.name for line in chart.lines] == ["MuJoCo", "theory"]
    truth = exact(frozen(), chart.lines[1].time, 1.0)
    assert chart.lines[1].values == pytest.approx(np.degrees(truth.phi))
    (chart,) = charts(exact(frozen(), TIME, 1.0), ["phi"])
    assert [line.name for line in chart.lines] == ["exact theory"]
