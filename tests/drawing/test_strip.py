"""The charts below a film: a line up to now, theory's whole line, and a dot at what is now."""

import math

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, simulate
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import Chart, ChartStrip, Line, charts, unbroken

TIME = np.linspace(0, 2, 201)
SIZE = (400, 120)


def coloured(picture: np.ndarray, colour: list[int]) -> np.ndarray:
    """Return rows and columns of the pixels of a colour, shape (2, pixels)."""
    return np.stack(np.nonzero(np.abs(picture.astype(int) - colour).max(axis=2) < 55))


@pytest.fixture
def ramp() -> list[np.ndarray]:
    """Return pictures of a red line that rises and theory's, which falls, after 0.5, 1, 1.5 s."""
    red = Line("MuJoCo", TIME, TIME, (1.0, 0.0, 0.0))
    theory = Line("theory", TIME, 1.5 - TIME)
    strip_of_one = ChartStrip([Chart("a ramp", [theory, red])], *SIZE)
    sheet = Sheet(*SIZE)
    pictures = []
    for time in (0.5, 1.0, 1.5):
        strip_of_one.draw(sheet, time, 0)
        pictures.append(sheet.picture()[:90])  # without the key below
    return pictures


def test_a_line_is_drawn_up_to_now_with_a_dot_at_its_end(ramp: list[np.ndarray]) -> None:
    ends = []
    for picture in ramp:
        rows, columns = coloured(picture, [255, 0, 0])
        ends.append((columns.max(), rows.min()))

    first, second, third = np.array(ends)
    assert third - second == pytest.approx(second - first, abs=2)  # even in time and in value
    right, down = second - first
    assert right > 50
    assert down < 0


def test_theory_s_line_is_there_from_the_beginning(ramp: list[np.ndarray]) -> None:
    for picture in ramp:
        _, columns = coloured(picture, [180, 188, 200])
        assert np.ptp(columns) > 250


def test_theory_ends_where_the_incline_would_have_to_pull() -> None:
    """From the top, after 0.834 s; the roll-down in contact goes on, and flies."""
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4)
    (chart,) = charts(run, ["normal"])
    simulated, theory = chart.lines
    assert simulated.time[-1] == 1.0
    assert theory.time[-1] == pytest.approx(0.834, abs=1e-3)
    assert theory.values.min() > 0


def test_theory_is_not_named_where_a_can_does_not_roll_at_all() -> None:
    """A hoop that turns at 30 rad/s with its weight in front leaves the ground at once."""
    run = simulate(
        hoop(hoop_mass=0.06),
        0.02,
        -math.pi / 2,
        30.0,
        rolling="contact",
        friction=0.01,
        timestep=2e-4,
    )
    (chart,) = charts(run, ["normal"])
    assert [line.name for line in chart.lines] == ["MuJoCo"]


@pytest.mark.parametrize(
    ("values", "ticks"),
    [
        ((-4.9, 4.9), [-5, 0, 5]),  # both ends of what swings are named
        ((-11.1, 11.2), [-10, 0, 10]),
        ((0.06, 5.3), [0, 2, 4, 6]),
        ((0.0, 0.017), [0, 0.01, 0.02]),
        ((-0.05, 1.6), [0, 0.5, 1, 1.5]),
        ((-170.0, 110.0), [-200, -100, 0, 100]),
        ((3.0, 3.0), [3, 3.5, 4]),
    ],
)
def test_an_axis_reaches_from_round_value_to_round_value(
    values: tuple[float, float], ticks: list[float]
) -> None:
    line = Line("a line", np.array([0.0, 1.0]), np.array(values))

    assert Chart("a chart", [line]).ticks() == pytest.approx(np.array(ticks))


def test_an_angle_that_takes_all_values_has_an_axis_of_a_whole_turn() -> None:
    line = Line("a line", np.array([0.0, 1.0]), np.array([-170.0, 110.0]))

    assert Chart("angle [°]", [line]).ticks().tolist() == [-180, 0, 180]


def test_no_value_of_a_film_is_beyond_its_axis() -> None:
    """Frozen beer that rolls down presses with up to five weights."""
    run = simulate(frozen(), 0.82, math.pi, tolerance=1e-9)

    (chart,) = charts(run, ["normal"])

    most = chart.lines[0].values.max()
    assert 4.5 < most < chart.ticks()[-1]
    assert "up to" not in chart.title


def test_the_equilibrium_is_a_line_of_the_chart_of_phi() -> None:
    run = exact(frozen(), np.linspace(0, 2, 401), 0.0)

    distance, angle = charts(run, ["u", "phi"], equilibrium=True)

    assert [line.thin for line in angle.lines] == [False, True]
    assert not any(line.thin for line in distance.lines)
    middle = (angle.lines[0].values.max() + angle.lines[0].values.min()) / 2
    assert angle.lines[1].values == pytest.approx(middle, abs=1.0)  # [degrees]


def test_an_angle_that_jumps_is_not_joined() -> None:
    jumping = np.array([170.0, 175.0, -179.0, -170.0])

    values = unbroken(jumping)

    assert np.isnan(values).tolist() == [False, False, True, False]


@pytest.mark.parametrize("values", [[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]])
def test_what_does_not_jump_is_left_as_it_is(values: list[float]) -> None:
    assert unbroken(np.array(values)).tolist() == values
