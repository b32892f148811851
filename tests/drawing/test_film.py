"""The pictures show what theory says of beer, can and mark, at any size."""

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from typing import Any

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
from mjbeer.theory.can import RADIUS, segment

pytestmark = pytest.mark.slow

FIXED = FilmStyle("a title", strips=(), marks=(), camera="fixed")
SIZE = (640, 360)


def motion(incline: float = 0.2) -> Trajectory:
    return exact(frozen(incline), np.linspace(0, 0.5, 51), 1.0)


def still_view(run: Trajectory, pixels: tuple[int, int]) -> View:
    """Return the view of the film of a motion without charts and marks, below its title.

    It shows 1.9 radii around its can.
    """
    plane = -run.scene.can.length / run.scene.can.radius * RADIUS / 2
    return follow(run, "fixed", plane, pixels).view(0.0)


Colours = Callable[[float, float, float], np.ndarray]
"""Returns the colour on a can's open end, at x and z in radii on axes that are turned by a tilt
[rad]."""


def seen(scene: Scene, phis: np.ndarray, rolls: np.ndarray) -> list[Colours]:
    """What is seen of a scene at some angles phi of the load and roll of the can [rad]."""
    times = np.arange(len(phis), dtype=float)
    rest = np.zeros(len(phis))
    u = scene.can.radius * rolls
    still = Trajectory(
        scene=scene,
        phi0=phis[0],
        phi_dot0=0.0,
        time=times,
        u=u,
        phi=phis,
        roll=rolls,
        lift=rest,
        u_dot=rest,
        phi_dot=rest,
        roll_dot=rest,
        lift_dot=rest,
    )
    top = round(HEADER * Sheet(*SIZE).unit)
    view = still_view(still, (SIZE[0], SIZE[1] - top))

    def at(picture: np.ndarray, along: float, x: float, z: float, tilt: float) -> np.ndarray:
        cosine = math.cos(tilt)
        sine = math.sin(tilt)
        turned = np.array([x * cosine + z * sine, z * cosine - x * sine])
        right, up = on_incline(scene, along * scale(scene), RADIUS) + RADIUS * turned
        column, row = view.pixel(np.array([right, view.eye[1] + view.distance, up]))
        return picture[int(row) + top, int(column)].astype(int)

    pictures = MotionFilm(lambda: still, FIXED, speed=1.0).plan().draw(times, *SIZE)
    return [partial(at, picture, along) for picture, along in zip(pictures, u, strict=True)]


@pytest.mark.draws
@pytest.mark.parametrize("fill", [0.25, 0.5, 0.8])
def test_the_end_shows_a_circular_segment_of_beer(fill: float) -> None:
    """Points on the can's open end have the beer's colour below the chord of eq. (32) only.


    The foam, which one sees over the chord, is cream.
    """
    scene = sliding(0.3, fill=fill)
    phis = np.array([0.0, 1.0, 3.0, -2.0])
    chord = 2 * fill - 1
    points = np.random.default_rng(1).uniform(-0.95, 0.95, (500, 2))
    points = [(x, z) for x, z in points if np.hypot(x, z) < 0.95 and abs(z - chord) > 0.05]
    assert 20 < sum(z < chord for _, z in points) < len(points) - 20
    for phi, colour in zip(phis, seen(scene, phis, phis + 0.1), strict=True):
        tilt = phi + scene.incline
        assert is_amber(colour(0, -segment(fill).offset, tilt))
        for x, z in points:
            assert is_amber(colour(x, z, tilt)) == (z < chord), (phi, x, z)


def is_amber(colour: np.ndarray) -> bool:
    """Return whether a colour is that of beer, and not that of foam, metal or a mark."""
    return bool(colour[0] > 1.2 * colour[1] > 1.8 * colour[2])


@pytest.mark.draws
@pytest.mark.parametrize("make", [sliding, frozen])
def test_the_mark_turns_with_the_can(make: Callable[[float], Scene]) -> None:
    scene = make(0.3)
    rolls = np.linspace(0, 2 * np.pi, 9)[:-1]
    phis = rolls if make is frozen else np.ones(8)
    for roll, colour in zip(rolls, seen(scene, phis, rolls), strict=True):
        tilt = roll + scene.incline
        assert is_red(colour(0, 1.03, tilt)), roll
        assert not is_red(colour(0, -1.03, tilt)), roll


def is_red(colour: np.ndarray) -> bool:
    return bool(colour[0] > 2 * colour[1] and colour[0] > 2 * colour[2])


@pytest.mark.draws
def test_every_picture_of_a_run_that_is_not_trusted_says_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A run to a tolerance has no note, even if its can leaves the incline.

    A race names the can.
    """
    plates: list[tuple[str, ...]] = []

    def keep(_: Sheet, place: np.ndarray, lines: Sequence[str], *others: Any, **more: Any) -> None:
        plates.append(tuple(lines))

    monkeypatch.setattr(Sheet, "plate", keep)
    rolls_off = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    assert rolls_off.rolling_warnings
    wrong = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    vars(wrong)["solver_warnings"] = ("it is off by 3 rad",)
    heading = "Not to be relied on"

    def warnings(film: Film) -> list[tuple[str, ...]]:
        """Draw two pictures, and return the warnings in them."""
        plates.clear()
        assert len(list(film.plan().draw(np.array([0.1, 0.2]), *SIZE))) == 2
        return [lines for lines in plates if heading in lines]

    assert warnings(MotionFilm(lambda: rolls_off, FIXED, speed=1.0)) == []
    expected = (heading, "it is off by 3 rad")
    assert warnings(MotionFilm(lambda: wrong, FIXED, speed=1.0)) == [expected, expected]
    cans = [Runner("one", rolls_off, (1.0, 0.0, 0.0)), Runner("other", wrong, (0.0, 0.0, 1.0))]
    race = Race("a race", lambda: cans, 0.3, 0.5, speed=1.0)
    expected = (heading, "other: it is off by 3 rad")
    assert warnings(race) == [expected, expected]


@pytest.mark.draws
def test_before_a_still_camera_nothing_is_left_of_earlier_pictures() -> None:
    moved = motion()
    display = Display([moved.scene])
    view = still_view(moved, SIZE)
    pictures = []
    for still in (False, True):
        sheet = Sheet(*SIZE)
        with closing(Painter(display, SIZE, still)) as painter:
            for u in (0.0, 0.01):
                painter.paint(sheet, view, np.array([[u, 0.5, 0.5, 0.002]]))
        pictures.append(sheet.picture())
    assert np.array_equal(*pictures)
    assert np.ptp(pictures[0]) > 200


@pytest.mark.draws
@pytest.mark.parametrize("incline", [-60.0, -5.0, 0.0, 10.0, 80.0])
def test_the_scenery_is_what_opengl_would_draw(incline: float) -> None:
    """Across the can's axis and from above; on edges and far away, textures are blurred."""
    scene = sliding(math.radians(incline))
    display = Display([scene])
    display.pose(np.zeros((1, 4)))
    model = display.model
    flat = [model.geom(name).id for name in ("wall", "board")]
    model.geom_group[:] = 5
    model.geom_group[flat] = 0
    ends = [display.outline(0, np.array([u, 0.0, 0.0, 0.0])) for u in (-0.2, 0.4)]
    points = np.reshape(ends, (-1, 3))
    eye = points.mean(axis=0) + np.array([0.0, -2.4, 1.6])
    above = View.towards(eye, points, (400, 200), 0, 0.01)
    for view in (still_view(motion(scene.incline), (400, 200)), above):
        sheet = Sheet(*view.pixels)
        display.draw_empty(sheet, view)
        with closing(Painter(display, view.pixels)) as painter:
            drawn = painter._draw(view, 0)
        assert (drawn[..., 3] == 255).all()
        difference = np.abs(sheet.picture().astype(int) - drawn[..., :3]).max(axis=2)
        assert difference.mean() < 2
        assert (difference > 25).mean() < 0.01


def test_motion_between_samples_is_of_fourth_order() -> None:
    """Half the distance between samples, a sixteenth of the error: the cubic's order."""
    times = np.linspace(0, 1, 1001)
    true = exact(frozen(), times, 2.0)
    errors = []
    for samples in (101, 201):
        coarse = exact(frozen(), np.linspace(0, 1, samples), 2.0)
        errors.append(np.abs(coordinates(coarse, times)[:, 1] - true.phi).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.3)


@pytest.mark.draws
@pytest.mark.parametrize("size", [(2, 2), (400, 40), (60, 400)])
def test_a_picture_of_any_shape_can_be_drawn_and_graphics_memory_is_freed(
    size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also if drawing stops early."""
    closed: list[Painter] = []
    close = Painter.close

    def keep(painter: Painter) -> None:
        closed.append(painter)
        close(painter)

    monkeypatch.setattr(Painter, "close", keep)
    drawing = MotionFilm(motion, speed=1.0).plan().draw(np.linspace(0, 0.4, 5), *size)
    assert next(drawing).shape == (size[1], size[0], 3)
    assert closed == []
    drawing.close()
    assert len(closed) == 1


@pytest.mark.draws
@pytest.mark.parametrize(
    "moved",
    [
        simulate(frozen(gravity=0.0), 0.5, 1.0, 1.0, rolling="contact"),
        exact(sliding(), np.linspace(0, 0.5, 51), 1.0, 1e4),
        exact(frozen(), np.linspace(0, 1e-9, 20), 1.0),
        exact(frozen(), np.linspace(0, 1e5, 2000), 1.0),
        exact(frozen(), np.linspace(1, 2, 20), 1.0),
        exact(frozen(), np.array([0.0]), 1.0),
    ],
    ids=["weightless", "fast", "short", "long", "late", "one sample"],
)
def test_a_motion_of_any_kind_can_be_drawn(moved: Trajectory) -> None:
    middle = moved.time[[len(moved.time) // 2]]
    (drawn,) = MotionFilm(lambda: moved, speed=1.0).plan().draw(middle, 320, 180)
    assert np.ptp(drawn) > 200
