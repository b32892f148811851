"""What is drawn at the can is true: the angle, the paths, the forces, and the ghost."""

import math
from typing import Any

import numpy as np
import pytest

from mjbeer import Can, Trajectory, exact, frozen, hoop, pendulum, simulate, sliding
from mjbeer.drawing.annotations import LONGEST, Annotations, Board
from mjbeer.drawing.camera import View, follow, on_incline, scale
from mjbeer.drawing.overlay import Spans, draw_title, draw_warning, note_spans
from mjbeer.drawing.scene import Display, coordinates
from mjbeer.drawing.sheet import Box, Sheet, overlap
from mjbeer.drawing.style import FilmStyle, Mark
from mjbeer.model.looks import WALL
from mjbeer.theory.can import RADIUS

TIMES = np.linspace(0, 0.5, 501)
PIXELS = (1280, 430)
PLANE = -0.06
UNIT = 20.0
# A pixel is a quarter of the width of the lines of the guides.
PIXEL = 0.5
# Rounding of places of some hundred pixels; the arcs are polygons, whose ends are exact.
ROUNDING = 1e-6


class Recorder(Sheet):
    """A sheet that keeps what is drawn: the places of lines, arrows and discs, and the texts."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__(width, height)
        self.lines: list[np.ndarray] = []
        self.arrows: list[tuple[np.ndarray, np.ndarray]] = []
        self.discs: list[np.ndarray] = []
        self.words: list[str] = []

    def line(self, places: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.lines.append(places)

    def arrow(self, tail: np.ndarray, tip: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.arrows.append((np.asarray(tail), np.asarray(tip)))

    def disc(self, place: np.ndarray, *arguments: Any, **more: Any) -> None:
        self.discs.append(place)

    def text(self, place: Any, words: str, *arguments: Any, **more: Any) -> Box:
        self.words.append(words)
        return super().text(place, words, *arguments, **more)


def drawn(motion: Trajectory, time: float, *kinds: Mark) -> tuple[Recorder, View, np.ndarray]:
    """Draw marks, and return the sheet, the view, and the coordinates at that time."""
    view = follow(motion, "fixed", PLANE, PIXELS).view(time)
    (now,) = coordinates(motion, np.array([time]))
    sheet = Recorder(*PIXELS)
    Annotations(motion, FilmStyle("", marks=kinds), PLANE).draw(sheet, view, time, now)
    return sheet, view, now


@pytest.mark.parametrize("width", [400, 1280])
def test_the_note_on_a_run_that_is_not_trusted_fits_into_the_picture(width: int) -> None:
    sheet = Recorder(width, 720)
    draw_warning(sheet, [], 100)
    assert sheet.boxes == []
    doubt = (
        "phi and u/a are off by 0.499 rad (trusted up to 0.01), as a run at other timesteps shows"
    )
    draw_warning(sheet, [doubt], 100)
    assert " ".join(sheet.words).startswith("Not to be relied on phi and u/a are off by 0.499 rad")
    assert min(box.left for box in sheet.boxes) > 0
    assert max(box.right for box in sheet.boxes) < width
    assert min(box.top for box in sheet.boxes) >= 100


def place(motion: Trajectory, view: View, along: float, height: float) -> np.ndarray:
    """Return where a point of the incline's plane is seen, given in the scene's metres."""
    x, z = on_incline(motion.scene, along * scale(motion.scene), height * scale(motion.scene))
    return view.pixel(np.array([x, PLANE, z]))


def direction(line: np.ndarray) -> float:
    """Return the direction of a line in the picture [rad], counter-clockwise from the right."""
    right, down = line[-1] - line[0]
    return math.atan2(-down, right)


def differ(one: float, other: float) -> float:
    return abs(math.remainder(one - other, 2 * math.pi))


@pytest.mark.parametrize("make", [frozen, sliding, pendulum, hoop])
@pytest.mark.parametrize("phi", [-3.0, -1.0, -0.1, 0.1, 1.0, 3.0, 10.0])
def test_the_angle_is_phi_from_the_incline_to_the_surface(make: Any, phi: float) -> None:
    """One line is along the incline, or across it over a bob.

    The other is turned by phi, clockwise.
    """
    motion = exact(make(), TIMES, phi)
    sheet, _, _ = drawn(motion, 0.0, "phi")
    first, second, arc = sheet.lines
    along = -motion.scene.incline
    if motion.scene.load.fill is None:
        along += math.pi / 2
    assert (
        min(differ(direction(first), along), differ(direction(first), along + math.pi)) < ROUNDING
    )
    assert differ(direction(second), direction(first) - phi) < ROUNDING
    assert differ(direction(np.array([first[0], arc[0]])), direction(first)) < ROUNDING
    assert differ(direction(np.array([second[0], arc[-1]])), direction(second)) < ROUNDING
    assert sheet.words == ["φ"]


@pytest.mark.parametrize("make", [frozen, sliding, pendulum, hoop])
def test_paths_are_those_of_fig_3(make: Any) -> None:
    motion = exact(make(), TIMES, 2.0)
    sheet, view, (u, phi, roll, _) = drawn(motion, 0.3, "paths")
    rim, centre = sheet.lines
    a = motion.scene.can.radius
    b = motion.scene.load.offset
    load = place(motion, view, u - b * math.sin(phi), a - b * math.cos(phi))
    assert centre[-1] == pytest.approx(load, abs=ROUNDING)
    assert sheet.discs[0] == pytest.approx(load, abs=ROUNDING)
    mark = place(motion, view, u + a * math.sin(roll), a + a * math.cos(roll))
    assert rim[-1] == pytest.approx(mark, abs=ROUNDING)
    start = place(motion, view, motion.u[0] - b * math.sin(2.0), a - b * math.cos(2.0))
    assert centre[0] == pytest.approx(start, abs=ROUNDING)


def test_forces_push_the_can_where_it_touches_the_incline() -> None:
    motion = exact(frozen(), TIMES, 2.0)
    sheet, view, (u, *_) = drawn(motion, 0.1, "normal", "friction")
    (tail, head), (start, end) = sheet.arrows
    # Under the drawn wall.
    assert head == pytest.approx(place(motion, view, u, -WALL * 0.033), abs=ROUNDING)
    assert differ(direction(np.array([tail, head])), math.pi / 2 - motion.scene.incline) < ROUNDING
    normal = float(np.interp(0.1, TIMES, motion.forces.normal))
    friction = float(np.interp(0.1, TIMES, motion.forces.friction))
    # Friction is positive up the incline, which is to the left.
    pushed = math.pi * (friction > 0) - motion.scene.incline
    assert differ(direction(np.array([start, end])), pushed) < ROUNDING
    length_of_normal = np.hypot(*(head - tail))
    length_of_friction = np.hypot(*(end - start))
    # What is drawn are means over 10 ms.
    assert length_of_friction / length_of_normal == pytest.approx(abs(friction) / normal, rel=0.02)
    radius = RADIUS * view.scale(np.array([0.0, PLANE, 0.0]))
    assert length_of_normal <= LONGEST * radius * (1 + 1e-9)
    assert sheet.words == ["N", "F"]


def test_the_ghost_is_where_even_acceleration_has_it() -> None:
    """s = g sin(alpha) t^2/2 in a massless can, eq. (9); the can itself is b sin(phi) ahead."""
    motion = exact(sliding(), TIMES, 1.0)
    sheet, view, (u, phi, _, _) = drawn(motion, 0.4, "ghost")
    ring = sheet.lines[0]
    middle = (ring.min(axis=0) + ring.max(axis=0)) / 2
    even = 9.81 * math.sin(motion.scene.incline) * 0.4**2 / 2
    # A polygon of 48 corners.
    assert middle == pytest.approx(place(motion, view, even, 0.033), abs=0.2)
    assert u - even == pytest.approx(motion.scene.load.offset * math.sin(phi))


@pytest.mark.parametrize("incline", [-60, -10, 0, 10, 30, 80])
@pytest.mark.parametrize("radius", [1e-3, 1.0])
def test_gravity_is_plumb_and_the_incline_s_angle_and_distances_are_as_written(
    incline: float, radius: float
) -> None:
    """Each tick is where the board is seen at that distance, for a can of any size."""
    scene = frozen(math.radians(incline), can=Can.massless(radius, 3.6 * radius))
    start = radius / 3
    motion = exact(scene, np.linspace(0, 0.5, 51) * math.sqrt(radius / 0.033), 1.0)
    display = Display([scene])
    board = Board(display, start)
    view = follow(motion, "fixed", display.ends()[0], PIXELS).view(0.0)
    sheet = Recorder(*PIXELS)
    board.draw(sheet, view)
    ((tail, head),) = sheet.arrows
    assert head[0] == tail[0]
    assert head[1] > tail[1] + 50
    ticks = [line[0] for line in sheet.lines[2 if incline else 0 :]]
    distances = [words.removesuffix(" m") for words in sheet.words if words.endswith(" m")]
    numbers = [float(words.replace("\N{MINUS SIGN}", "-")) for words in distances]
    assert len(ticks) == len(numbers) >= 2 - (abs(incline) > 45)
    for number, tick in zip(numbers, ticks, strict=True):
        x, z = on_incline(scene, (number + start) / radius * RADIUS, board.under)
        assert tick == pytest.approx(view.pixel(np.array([x, board.front, z])), abs=PIXEL)
    assert [words for words in sheet.words if "°" in words] == [f"α = {abs(incline):g}°"] * bool(
        incline
    )
    if incline:
        (corner, end), arc, *_ = sheet.lines
        assert end[1] == corner[1]
        assert np.sign(end[0] - corner[0]) == -np.sign(incline)  # uphill
        last = arc[-1] - corner
        assert arc[0][1] == pytest.approx(corner[1], abs=1e-9)
        assert math.degrees(math.atan2(-last[1], abs(last[0]))) == pytest.approx(abs(incline))
        # On the underside.
        assert board.pixel(view, board.along(view, corner[0])) == pytest.approx(corner, abs=PIXEL)


def noted(run: Trajectory, name: str) -> Spans:
    """From when to when a note holds."""
    (spans,) = note_spans(run, [name]).values()
    return spans


def angles(run: Trajectory, spans: Spans) -> np.ndarray:
    """The angles phi [rad] in the middle of some spans of time."""
    return np.interp(np.mean(spans, axis=1), run.time, run.phi)


def test_notes_are_there_while_it_happens() -> None:
    """Frozen beer let go on top with mu = 1 slips, flies from 0.83 s on, and lands."""
    run = simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=1.0)
    ((first, last),) = noted(run, "flies")
    high = run.time[run.lift > 1e-3]
    assert 0.83 < first < high.min() < high.max() < last < 0.97
    slips = noted(run, "slips")
    assert len(slips) == 3  # short rests do not interrupt them
    assert slips[0][0] == pytest.approx(0.73, abs=0.01)
    assert np.cos(angles(run, noted(run, "heavy"))[:3]).min() > 0.7
    assert np.cos(angles(run, noted(run, "light"))[0]) < 0


@pytest.mark.parametrize("make", [sliding, pendulum])
def test_a_can_hesitates_while_its_load_is_uphill(make: Any) -> None:
    """Once a swing; a pause of a few samples does not interrupt the note."""
    run = simulate(make(), 1.2, 1.0, tolerance=1e-9)
    spans = noted(run, "hesitates")
    assert len(spans) == math.ceil(1.2 / make().period(1.0))
    assert angles(run, spans)[1:-1].min() > 0.8


@pytest.mark.parametrize("width", [640, 1280])
def test_no_title_runs_into_the_time(width: int) -> None:
    sheet = Recorder(width, 360)
    draw_title(sheet, "a long title " * 5, "many words " * 8, 0.0, 0.25)
    title, other = (box for box in sheet.boxes if box[0] < width / 4)
    for box in sheet.boxes:
        assert not overlap(box, title) or box == title
        assert not overlap(box, other) or box == other
