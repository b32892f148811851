"""The pictures show what theory says of beer, can and mark, at any size."""

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, simulate, sliding
from mjbeer.drawing.camera import View, follow, on_incline, scale
from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.overlay import HEADER
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.style import FilmStyle
from mjbeer.theory.can import RADIUS
from mjbeer.theory.segment import segment

pytestmark = pytest.mark.slow

FIXED = FilmStyle("a title", strips=(), marks=(), camera="fixed")
SIZE = (640, 360)
TOP = round(HEADER * Sheet(*SIZE).unit)
"""Row at which the scene begins, below the title."""


def rocking(incline: float = 0.2) -> Trajectory:
    return exact(frozen(incline), np.linspace(0, 0.5, 51), 1.0)


def still_view(motion: Trajectory, pixels: tuple[int, int]) -> View:
    """Return the view of the film of a motion without charts and marks, below its title."""
    plane = -motion.scene.can.length / motion.scene.can.radius * RADIUS / 2
    return follow(motion, "fixed", plane, pixels).view(0.0)


class EndOfCan(NamedTuple):
    """The open end of a can in a picture."""

    picture: np.ndarray
    view: View
    axis: np.ndarray
    """Where the axis is, x and z [m]."""

    def colour(self, x: float, z: float, tilt: float) -> np.ndarray:
        """Return the colour at x and z in radii, on axes that are turned by a `tilt` [rad]."""
        cosine = math.cos(tilt)
        sine = math.sin(tilt)
        turned = np.array([x * cosine + z * sine, z * cosine - x * sine])
        right, up = self.axis + RADIUS * turned
        plane = self.view.eye[1] + self.view.distance
        column, row = self.view.pixel(np.array([right, plane, up]))
        return self.picture[int(row) + TOP, int(column)].astype(int)


def ends_of_can(scene: Scene, phis: np.ndarray, rolls: np.ndarray) -> list[EndOfCan]:
    """Draw a scene at some angles phi of the load and roll of the can [rad]."""
    times = np.arange(len(phis), dtype=float)
    rest = np.zeros(len(phis))
    motion = Trajectory(
        scene=scene,
        phi0=phis[0],
        phi_dot0=0.0,
        time=times,
        u=scene.can.radius * rolls,
        phi=phis,
        roll=rolls,
        lift=rest,
        u_dot=rest,
        phi_dot=rest,
        roll_dot=rest,
        lift_dot=rest,
    )
    view = still_view(motion, (SIZE[0], SIZE[1] - TOP))
    axes = on_incline(scene, motion.u * scale(scene), np.full(len(phis), RADIUS))
    pictures = MotionFilm(lambda: motion, FIXED, speed=1.0).plan().draw(times, *SIZE)
    return [EndOfCan(picture, view, axis) for picture, axis in zip(pictures, axes, strict=True)]


def is_amber(colour: np.ndarray) -> bool:
    """Return whether a colour is that of beer, and not that of foam, metal or a mark."""
    red, green, blue = colour
    return bool(red > 1.2 * green > 1.8 * blue)


def is_red(colour: np.ndarray) -> bool:
    red, green, blue = colour
    return bool(red > 2 * green and red > 2 * blue)


@pytest.mark.draws
@pytest.mark.parametrize("fill", [0.25, 0.5, 0.8])
def test_the_end_shows_a_circular_segment_of_beer(fill: float) -> None:
    """Points on the can's open end have the beer's colour below the chord of eq. (32) only.

    The foam, which one sees over the chord, is cream.
    """
    scene = sliding(0.3, fill=fill)
    phis = np.array([0.0, 1.0, 3.0, -2.0])
    chord = 2 * fill - 1
    centre = -segment(fill).offset
    anywhere = np.random.default_rng(1).uniform(-0.95, 0.95, (500, 2))
    inside = [(x, z) for x, z in anywhere if math.hypot(x, z) < 0.95]
    above = [(x, z) for x, z in inside if z > chord + 0.05]
    below = [(x, z) for x, z in inside if z < chord - 0.05]
    assert min(len(above), len(below)) > 20

    ends = ends_of_can(scene, phis, rolls=phis + 0.1)

    for phi, end in zip(phis, ends, strict=True):
        tilt = phi + scene.incline
        assert is_amber(end.colour(0, centre, tilt))
        assert all(is_amber(end.colour(x, z, tilt)) for x, z in below), phi
        assert not any(is_amber(end.colour(x, z, tilt)) for x, z in above), phi


@pytest.mark.draws
@pytest.mark.parametrize("make", [sliding, frozen])
def test_the_mark_turns_with_the_can(make: Callable[[float], Scene]) -> None:
    scene = make(0.3)
    rolls = np.linspace(0, 2 * np.pi, 9)[:-1]
    phis = rolls if make is frozen else np.ones(8)

    ends = ends_of_can(scene, phis, rolls)

    for roll, end in zip(rolls, ends, strict=True):
        tilt = roll + scene.incline
        assert is_red(end.colour(0, 1.03, tilt)), roll
        assert not is_red(end.colour(0, -1.03, tilt)), roll


@pytest.fixture
def plates(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, ...]]:
    """Return a list that is filled with the lines of each plate, in place of drawing it."""
    written: list[tuple[str, ...]] = []

    def keep(_: Sheet, place: np.ndarray, lines: Sequence[str], *others: Any, **more: Any) -> None:
        written.append(tuple(lines))

    monkeypatch.setattr(Sheet, "plate", keep)
    return written


def rolling_off() -> Trajectory:
    """Return a motion that is solved, in which the incline would have to pull the can."""
    run = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    assert run.rolling_warnings
    return run


def wrong() -> Trajectory:
    """Return a motion that says of itself that it is not solved."""
    run = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    vars(run)["solver_warnings"] = ("it is off by 3 rad",)
    return run


def draw_two_pictures(film: Film) -> None:
    pictures = list(film.plan().draw(np.array([0.1, 0.2]), *SIZE))
    assert len(pictures) == 2


@pytest.mark.draws
def test_every_picture_of_a_run_that_is_not_solved_says_so(plates: list[tuple[str, ...]]) -> None:
    draw_two_pictures(MotionFilm(wrong, FIXED, speed=1.0))

    assert plates == [("Not to be relied on", "it is off by 3 rad")] * 2


@pytest.mark.draws
def test_a_run_to_a_tolerance_has_no_warning_even_if_its_can_leaves_the_incline(
    plates: list[tuple[str, ...]],
) -> None:
    draw_two_pictures(MotionFilm(rolling_off, FIXED, speed=1.0))

    assert plates == []


@pytest.mark.draws
def test_the_warning_in_a_race_names_the_can(plates: list[tuple[str, ...]]) -> None:
    def cans() -> list[Runner]:
        return [
            Runner("one", rolling_off(), (1.0, 0.0, 0.0)),
            Runner("other", wrong(), (0.0, 0.0, 1.0)),
        ]

    draw_two_pictures(Race("a race", cans, length=0.3, duration=0.5, speed=1.0))

    warnings = [lines for lines in plates if "Not to be relied on" in lines]
    assert warnings == [("Not to be relied on", "other: it is off by 3 rad")] * 2


@pytest.mark.draws
def test_before_a_still_camera_nothing_is_left_of_earlier_pictures() -> None:
    motion = rocking()
    display = Display([motion.scene])
    view = still_view(motion, SIZE)

    def second_picture(still: bool) -> np.ndarray:
        sheet = Sheet(*SIZE)
        with closing(Painter(display, SIZE, still)) as painter:
            for u in (0.0, 0.01):
                painter.paint(sheet, view, np.array([[u, 0.5, 0.5, 0.002]]))
        return sheet.picture()

    drawn_anew = second_picture(still=False)
    drawn_on_top = second_picture(still=True)

    assert np.array_equal(drawn_on_top, drawn_anew)
    assert np.ptp(drawn_on_top) > 200


@pytest.mark.draws
@pytest.mark.parametrize("incline", [-60.0, -5.0, 0.0, 10.0, 80.0])
@pytest.mark.parametrize("above", [False, True], ids=["across the axis", "from above"])
def test_the_scenery_is_what_opengl_would_draw(incline: float, above: bool) -> None:
    """Textures differ a little on edges and far away, where OpenGL blurs them."""
    scene = sliding(math.radians(incline))
    display = Display([scene])
    display.pose(np.zeros((1, 4)))
    view = still_view(rocking(scene.incline), (400, 200))
    if above:
        outlines = [display.outline(0, np.array([u, 0.0, 0.0, 0.0])) for u in (-0.2, 0.4)]
        points = np.reshape(outlines, (-1, 3))
        eye = points.mean(axis=0) + np.array([0.0, -2.4, 1.6])
        view = View.towards(eye, points, (400, 200), 0, 0.01)
    show_only_the_scenery(display)

    sheet = Sheet(*view.pixels)
    display.scenery.draw(sheet, view)
    with closing(Painter(display, view.pixels)) as painter:
        by_opengl = painter._draw(view, 0)

    assert (by_opengl[..., 3] == 255).all()
    difference = np.abs(sheet.picture().astype(int) - by_opengl[..., :3]).max(axis=2)
    assert difference.mean() < 2
    assert (difference > 25).mean() < 0.01


def show_only_the_scenery(display: Display) -> None:
    """Put wall and board into the group of the first can, and all else into the unseen group."""
    model = display.model
    model.geom_group[:] = 5
    model.geom_group[[model.geom("wall").id, model.geom("board").id]] = 0


def test_motion_between_samples_is_of_fourth_order() -> None:
    """Half the distance between samples, a sixteenth of the error: the cubic's order."""
    times = np.linspace(0, 1, 1001)
    true = exact(frozen(), times, 2.0)

    def error(samples: int) -> float:
        coarse = exact(frozen(), np.linspace(0, 1, samples), 2.0)
        phi = coordinates(coarse, times)[:, 1]
        return np.abs(phi - true.phi).max()

    assert math.log2(error(101) / error(201)) == pytest.approx(4, abs=0.3)


@pytest.mark.draws
@pytest.mark.parametrize("size", [(2, 2), (400, 40), (60, 400)])
def test_a_picture_of_any_shape_can_be_drawn(size: tuple[int, int]) -> None:
    width, height = size
    drawing = MotionFilm(rocking, speed=1.0).plan().draw(np.array([0.1]), width, height)

    (picture,) = drawing

    assert picture.shape == (height, width, 3)


@pytest.mark.draws
def test_graphics_memory_is_freed_even_if_drawing_stops_early(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[Painter] = []
    close = Painter.close

    def keep(painter: Painter) -> None:
        closed.append(painter)
        close(painter)

    monkeypatch.setattr(Painter, "close", keep)
    drawing = MotionFilm(rocking, speed=1.0).plan().draw(np.linspace(0, 0.4, 5), 64, 36)
    next(drawing)
    assert closed == []

    drawing.close()

    assert len(closed) == 1


@pytest.mark.draws
@pytest.mark.parametrize(
    "motion",
    [
        partial(simulate, frozen(gravity=0.0), 0.5, 1.0, 1.0, rolling="contact"),
        partial(exact, sliding(), np.linspace(0, 0.5, 51), 1.0, 1e4),
        partial(exact, frozen(), np.linspace(0, 1e-9, 20), 1.0),
        partial(exact, frozen(), np.linspace(0, 1e5, 2000), 1.0),
        partial(exact, frozen(), np.linspace(1, 2, 20), 1.0),
        partial(exact, frozen(), np.array([0.0]), 1.0),
    ],
    ids=["weightless", "fast", "short", "long", "late", "one sample"],
)
def test_a_motion_of_any_kind_can_be_drawn(motion: Callable[[], Trajectory]) -> None:
    film = MotionFilm(motion, speed=1.0).plan()
    middle = np.array([(film.start + film.end) / 2])

    (picture,) = film.draw(middle, 320, 180)

    assert np.ptp(picture) > 200


def test_a_film_holds_its_end() -> None:
    """For 1.5 s of the video its time is the last one of the motion."""
    film = MotionFilm(rocking, speed=0.5, hold=1.5).plan()

    times = film.times(20)

    moving = times[:20]
    assert np.diff(moving) == pytest.approx(0.025)
    assert times[20:].tolist() == [0.5] * 30


@pytest.mark.draws
def test_an_answer_is_given_at_the_end_in_place_of_notes(plates: list[tuple[str, ...]]) -> None:
    """Frozen beer on top presses as it goes through below, and not at other times."""
    run = partial(simulate, frozen(), 0.33, math.pi, tolerance=1e-9)
    style = FilmStyle("a title", (), (), notes=("heavy",), answer="yes, it does")
    film = MotionFilm(run, speed=1.0, style=style).plan()

    list(film.draw(np.array([0.1, 0.32, 0.33]), 640, 360))

    assert plates == [("the beer below presses the can down",), ("yes, it does",)]
