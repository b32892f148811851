"""What is drawn at the board is true: gravity, the incline's angle, and the distances."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen
from mjbeer.drawing.board import Board
from mjbeer.drawing.camera import View, follow, on_incline
from mjbeer.drawing.scene import Display
from mjbeer.theory.can import RADIUS
from tests.support.recorder import Recorder

PIXELS = (1280, 430)
# Half a pixel is a quarter of the width of the lines.
PIXEL = 0.5


class DrawnBoard(NamedTuple):
    """A board as it was drawn, with its scene."""

    scene: Scene
    start: float
    """Where its distances begin [m]."""
    board: Board
    view: View
    sheet: Recorder


def drawn_board(incline: float, radius: float) -> DrawnBoard:
    """Draw the board of a can of a radius [m] at an incline [degrees]."""
    scene = frozen(math.radians(incline), can=Can.massless(radius, 3.6 * radius))
    # Cans of any size move alike in times that vary with the root of the radius.
    motion = exact(scene, np.linspace(0, 0.5, 51) * math.sqrt(radius / 0.033), 1.0)
    display = Display([scene])
    start = radius / 3
    board = Board(display, start)
    view = follow(motion, "fixed", display.ends()[0], PIXELS).view(0.0)
    sheet = Recorder(*PIXELS)
    board.draw(sheet, view)
    return DrawnBoard(scene, start, board, view, sheet)


RADII = pytest.mark.parametrize("radius", [1e-3, 1.0])


@RADII
@pytest.mark.parametrize("incline", [-60, -10, 0, 10, 30, 80])
def test_gravity_is_plumb(incline: float, radius: float) -> None:
    sheet = drawn_board(incline, radius).sheet

    (gravity,) = sheet.arrows
    assert gravity.tip[0] == gravity.tail[0]
    assert gravity.tip[1] > gravity.tail[1] + 50


@RADII
@pytest.mark.parametrize("incline", [-60, -10, 0, 10, 30, 80])
def test_each_tick_is_where_the_board_is_seen_at_that_distance(
    incline: float, radius: float
) -> None:
    scene, start, board, view, sheet = drawn_board(incline, radius)

    lines_of_the_angle = 2 if incline else 0
    ticks = [line[0] for line in sheet.lines[lines_of_the_angle:]]
    distances = [words.removesuffix(" m") for words in sheet.words if words.endswith(" m")]
    numbers = [float(words.replace("\N{MINUS SIGN}", "-")) for words in distances]
    at_least = 1 if abs(incline) > 45 else 2  # on a steep board there is less room
    assert len(numbers) >= at_least
    for number, tick in zip(numbers, ticks, strict=True):
        x, z = on_incline(scene, (number + start) / radius * RADIUS, board.under)
        assert tick == pytest.approx(view.pixel(np.array([x, board.front, z])), abs=PIXEL)


@RADII
@pytest.mark.parametrize("incline", [-60, -10, 10, 30, 80])
def test_the_incline_s_angle_is_drawn_under_the_board_as_it_is_written(
    incline: float, radius: float
) -> None:
    _, _, board, view, sheet = drawn_board(incline, radius)

    level, arc = sheet.lines[:2]
    corner, end = level
    first = arc[0] - corner
    last = arc[-1] - corner
    assert f"α = {abs(incline):g}°" in sheet.words
    assert end[1] == corner[1]
    assert np.sign(end[0] - corner[0]) == -np.sign(incline)  # uphill
    assert first[1] == pytest.approx(0, abs=1e-9)
    assert math.degrees(math.atan2(-last[1], abs(last[0]))) == pytest.approx(abs(incline))
    on_the_underside = board.pixel(view, board.along(view, corner[0]))
    assert corner == pytest.approx(on_the_underside, abs=PIXEL)


@RADII
def test_level_ground_has_no_angle(radius: float) -> None:
    sheet = drawn_board(0.0, radius).sheet

    assert not any("°" in words for words in sheet.words)
