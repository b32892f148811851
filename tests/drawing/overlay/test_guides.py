"""Down is down, the angle is that of the incline, and the numbers on the board are distances."""

import math

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop
from mjbeer.drawing.overlay import guides
from mjbeer.drawing.overlay.guides import Board
from mjbeer.drawing.world.display import Display, on_incline
from mjbeer.drawing.world.shot import Shot
from mjbeer.drawing.world.view import View
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from tests.support.drawn import Recorder

TIMES = np.linspace(0, 0.5, 51)
PIXELS = (1280, 430)
UNIT = 20.0
# A pixel is a quarter of the width of these lines.
PIXEL = 0.5


def drawn(scene: Scene) -> tuple[Recorder, Board, View]:
    motion = exact(scene, TIMES, 1.0)
    display = Display.of([scene], float(motion.u.min()), float(motion.u.max()))
    board = Board.of(scene, display.model)
    view = Shot.fit(scene, "auto", TIMES, motion.u, motion.lift, display.front(), PIXELS).view(0.2)
    sheet = Recorder(*PIXELS)
    guides.draw(sheet, board, view, 0, UNIT)
    return sheet, board, view


@pytest.mark.parametrize("incline", [-60, -10, 0, 3, 10, 40, 80])
def test_the_arrow_of_gravity_is_plumb(incline: float) -> None:
    sheet, *_ = drawn(frozen(math.radians(incline)))
    ((tail, head),) = sheet.arrows
    assert head[0] == tail[0]
    assert head[1] > tail[1] + 50


@pytest.mark.parametrize("incline", [-60, -10, 3, 10, 40, 80])
def test_the_angle_of_the_incline_is_drawn_and_written(incline: float) -> None:
    sheet, board, view = drawn(frozen(math.radians(incline)))
    level, arc, *_ = sheet.lines
    corner, end = level
    assert end[1] == corner[1]
    assert np.sign(end[0] - corner[0]) == -np.sign(incline)  # uphill
    first, last = arc[0] - corner, arc[-1] - corner
    assert first[1] == pytest.approx(0, abs=1e-9)
    assert math.degrees(math.atan2(-last[1], abs(last[0]))) == pytest.approx(abs(incline))
    # Its corner lies on the board's underside.
    edge = board.pixel(view, board.along(view, corner[0]))
    assert edge == pytest.approx(corner, abs=PIXEL)
    assert f"α = {abs(incline):g}°" in sheet.words


def test_on_level_ground_there_is_no_angle() -> None:
    sheet, *_ = drawn(hoop(0.0))
    assert not any("°" in words for words in sheet.words)


@pytest.mark.parametrize("incline", [-10, 0, 10, 30])
@pytest.mark.parametrize("radius", [1e-4, 0.033, 25.0])
def test_the_numbers_on_the_board_are_distances(incline: float, radius: float) -> None:
    """Each tick is where a point of the board at that distance is seen, in a can of any size."""
    from mjbeer import Can

    scene = frozen(math.radians(incline), can=Can.massless(radius, 3.6 * radius))
    motion = exact(scene, TIMES * math.sqrt(radius / 0.033), 1.0)
    display = Display.of([scene], -0.1, 0.1)
    board = Board.of(scene, display.model)
    view = Shot.fit(scene, "fixed", motion.time, motion.u, motion.lift, display.front(), PIXELS).view(0.0)
    sheet = Recorder(*PIXELS)
    guides.draw(sheet, board, view, 0, UNIT)
    numbers = [float(words[:-2].replace("\N{MINUS SIGN}", "-")) for words in sheet.words if words.endswith(" m")]
    ticks = [line[0] for line in sheet.lines[2 if incline else 0 :]]
    assert len(numbers) == len(ticks) >= 2
    for number, tick in zip(numbers, ticks, strict=True):
        x, z = on_incline(scene, number / radius * RADIUS, board.under)
        assert tick == pytest.approx(view.pixel(np.array([x, board.front, z])), abs=PIXEL)
