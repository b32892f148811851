"""Marks on a board undo the perspective of an oblique camera, or are refused."""

import math
import pathlib
import re
from typing import Any

import numpy as np
import pytest

from mjbeer import read_track
from mjbeer.exceptions import ParameterError
from mjbeer.tracks.board import perspective
from tests.support.tables import PLACE, TIME, table
from tests.tracks.filmed import Camera

INCLINE = math.radians(3)
MIDDLE = 0.6
MARKS = np.array([0.0, 0.5, 1.2])
"""Places of marks on a board [m]."""
OBLIQUE = Camera(yaw=math.radians(20), tilt=0.02)


def marked(camera: Camera, places: np.ndarray = MARKS, above: float = 0.0) -> np.ndarray:
    """The marks at some places, as they are clicked: x and y [pixels], and the place [m]."""
    points = camera.picture(places, above, INCLINE, MIDDLE)
    return np.column_stack([points, places])


@pytest.mark.parametrize("degrees", [-40, -5, 0, 20])
@pytest.mark.parametrize("count", [3, 7])
def test_the_perspective_of_a_line_is_undone(degrees: float, count: int) -> None:
    camera = Camera(yaw=math.radians(degrees), tilt=0.05)
    board = perspective(marked(camera, np.linspace(0, 1.2, count)))
    places = np.linspace(-0.2, 1.4, 30)
    seen = camera.picture(places, 0.0, INCLINE, MIDDLE)
    # The least squares end at a relative change of 1e-8.
    assert board.places(seen) == pytest.approx(places, abs=1e-7)


def test_an_axis_above_the_marks_is_projected_on_their_line() -> None:
    """Of the 2 % by which the scale is off without marks, the projection leaves 0.2 %.

    A point 33 mm above the board is moved along its picture by as much times the slope of the
    board's line there, whose change along the board is below 0.06.
    """
    places = np.linspace(0, 1.2, 30)
    seen = OBLIQUE.picture(places, 0.033, INCLINE, MIDDLE)
    found = perspective(marked(OBLIQUE)).places(seen)
    moved = found - places
    assert np.ptp(moved) < 0.06 * 0.033
    straight = np.hypot(*(seen - seen[0]).T)
    without_marks = straight * 1.2 / straight[-1]
    assert np.abs(without_marks - places).max() > 10 * np.ptp(moved)


def test_the_error_of_the_scale_is_that_of_the_clicks() -> None:
    """Each mark is clicked with an error of a pixel in x and in y."""
    rng = np.random.default_rng(0)
    true = marked(OBLIQUE)
    seen = OBLIQUE.picture(np.array([0.1, 1.1]), 0.0, INCLINE, MIDDLE)
    lengths = []
    for _ in range(400):
        clicked = true.copy()
        clicked[:, :2] += rng.standard_normal((len(true), 2))
        places = perspective(clicked).places(seen)
        lengths.append(places[1] - places[0])
    # The standard deviation of 400 is within 14 % of the true one, by four of its own.
    assert perspective(true).scale_error(seen) == pytest.approx(np.std(lengths), rel=0.14)


def test_marks_that_scatter_have_larger_errors() -> None:
    """Of seven marks the middle one is 3 pixels off, and four numbers are left for the scatter."""
    true = marked(OBLIQUE, np.linspace(0, 1.2, 7))
    seen = true[[0, -1], :2]
    moved = true.copy()
    moved[3, 0] += 3
    ratio = perspective(moved).scale_error(seen) / perspective(true).scale_error(seen)
    # 2 of the 3 pixels are left when the others follow: 9/4 (1 - 0.42) is 1.3, and its root 1.1.
    assert 1.05 < ratio < 1.5


def test_the_error_of_a_can_that_comes_back_is_that_of_its_way() -> None:
    """It ends where it began."""
    seen = OBLIQUE.picture(np.array([0.1, 1.1, 0.1]), 0.0, INCLINE, MIDDLE)
    board = perspective(marked(OBLIQUE))
    assert board.scale_error(seen) == board.scale_error(seen[:2])


def changed(row: int, *values: float) -> np.ndarray:
    """Four good marks, one of which has other values."""
    marks = marked(OBLIQUE, np.linspace(0, 1.2, 4))
    marks[row] = values
    return marks


REFUSED: list[tuple[Any, str]] = [
    (MARKS, "marks must be 3 or more of x and y"),
    (marked(OBLIQUE)[:2], "marks must be 3 or more of x and y"),
    (changed(1, math.nan, 400, 0.4), "marks must be 3 or more of x and y"),
    ("1,2=3", "marks must be 3 or more of x and y"),
    (changed(1, 700, 400, 0.0), "marks must be at different places on the board"),
    (changed(1, 700, 900, 0.4), "the marks are .* % of their length off a straight line"),
    ([(0, 0, 0), (200, 0, 1), (100, 0, 2)], "in the same order on the board and in the picture"),
    ([(0, 0, 0), (100, 0, 1), (101, 0, 2)], "of a camera that looks at the board, not along it"),
    ([(0, 0, 0), (90, 0, 1), (200, 0, 2), (300, 0, 3)], "is one of them mistyped"),
]


@pytest.mark.parametrize(("marks", "message"), REFUSED)
def test_what_marks_no_board_is_refused(marks: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        perspective(marks)


@pytest.mark.parametrize("shift", [(400.0, 0.0), (0.0, 400.0)])
def test_a_can_far_from_the_marks_is_refused(shift: tuple[float, float]) -> None:
    """As where the marks have another origin, or y in another direction."""
    with pytest.raises(ParameterError, match="the can must be at most a quarter"):
        perspective(marked(OBLIQUE)).places(marked(OBLIQUE)[:, :2] + shift)


def in_pixels(folder: pathlib.Path, heading: str, *columns: np.ndarray) -> pathlib.Path:
    """A file with a table of times and of places in a picture."""
    path = folder / "can.csv"
    path.write_text(table(heading, ",", TIME, *columns))
    return path


@pytest.mark.parametrize("heading", ["t,x,y", "t,x (px),y (pixels)"])
@pytest.mark.parametrize("uphill", [False, True])
def test_a_table_in_pixels_is_read_by_its_marks(
    heading: str, uphill: bool, tmp_path: pathlib.Path
) -> None:
    """Places grow as the can goes, wherever the board's metres begin; their scale has an error."""
    x, y = OBLIQUE.picture(PLACE, 0.0, INCLINE, MIDDLE).T
    marks = marked(OBLIQUE)
    if uphill:
        marks[:, 2] = 1.2 - marks[:, 2]
    track = read_track(in_pixels(tmp_path, heading, x, y), marks=marks)
    assert track.along - track.along[0] == pytest.approx(PLACE - PLACE[0], abs=1e-7)
    assert 1e-3 < track.scale_error < 1e-1


@pytest.mark.parametrize("heading", ["t,x", "t,x,y"])
def test_a_table_in_pixels_is_read_by_its_scale(heading: str, tmp_path: pathlib.Path) -> None:
    columns = [500 * PLACE, 0 * PLACE][: heading.count(",")]
    track = read_track(in_pixels(tmp_path, heading, *columns), scale=500)
    assert track.along - track.along[0] == pytest.approx(PLACE - PLACE[0], abs=1e-9)
    assert track.scale_error == 0


@pytest.mark.parametrize(
    ("heading", "options", "message"),
    [
        ("t,x (px),y", {}, "one of m, cm, mm, or pixels with a scale or marks, got 'x (px)'"),
        ("t,x (m),y", {"scale": 500}, "pixels with a scale of 500.0 pixels/m, got 'x (m)'"),
        (
            "t,x,y",
            {"scale": 500, "marks": marked(OBLIQUE)},
            "marks have a scale of their own, got a scale of 500.0",
        ),
        ("t,x,y", {"scale": 0}, "scale must be greater than 0 [pixels/m]"),
        ("t,x,z", {"marks": marked(OBLIQUE)}, "line 1: with marks, x and y are needed"),
    ],
)
def test_a_table_whose_unit_is_unclear_is_refused(
    heading: str, options: dict[str, Any], message: str, tmp_path: pathlib.Path
) -> None:
    path = in_pixels(tmp_path, heading, 500 * PLACE, 0 * PLACE)
    with pytest.raises(ParameterError, match=re.escape(message)):
        read_track(path, **options)
