"""The pictures show what theory says: where beer, can and mark are, at any size and before every camera."""

import math
from collections.abc import Callable
from contextlib import closing
from functools import partial

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, simulate, sliding
from mjbeer.drawing.camera import View, follow, on_incline, scale
from mjbeer.drawing.film import Film, MotionFilm, Race, Runner
from mjbeer.drawing.overlay import HEADER, Look
from mjbeer.drawing.scene import Display, Painter, coordinates
from mjbeer.drawing.sheet import Sheet
from mjbeer.theory.can import RADIUS
from mjbeer.theory.segment import segment

pytestmark = pytest.mark.slow

FIXED = Look("a title", strips=(), marks=(), camera="fixed")
SIZE = (640, 360)


def motion(incline: float = 0.2) -> Trajectory:
    return exact(frozen(incline), np.linspace(0, 0.5, 51), 1.0)


def still_view(run: Trajectory, pixels: tuple[int, int]) -> View:
    """Return the view of the film of a motion without charts and marks, below its title: 1.9 radii around its can."""
    plane = -run.scene.can.length / run.scene.can.radius * RADIUS / 2
    return follow(run, "fixed", plane, pixels)[0](0.0)


def look(scene: Scene, phis: np.ndarray, rolls: np.ndarray) -> list[Callable[[float, float, float], np.ndarray]]:
    """What is seen of a scene with the load at some angles phi and the can at some angles of roll [rad].

    That is the colour on the can's open end, at x and z in radii on axes that are turned by a tilt [rad].
    """
    times, rest, u = np.arange(len(phis), dtype=float), np.zeros(len(phis)), scene.can.radius * rolls
    places = {"u": u, "phi": phis, "roll": rolls, "lift": rest}
    rates = dict.fromkeys(("u_dot", "phi_dot", "roll_dot", "lift_dot"), rest)
    still = Trajectory(scene=scene, phi0=phis[0], phi_dot0=0.0, time=times, **places, **rates)
    top = round(HEADER * Sheet(*SIZE).unit)
    view = still_view(still, (SIZE[0], SIZE[1] - top))

    def at(picture: np.ndarray, along: float, x: float, z: float, tilt: float) -> np.ndarray:
        turned = np.array([x * math.cos(tilt) + z * math.sin(tilt), z * math.cos(tilt) - x * math.sin(tilt)])
        right, up = on_incline(scene, along * scale(scene), RADIUS) + RADIUS * turned
        column, row = view.pixel(np.array([right, view.eye[1] + view.distance, up]))
        return picture[int(row) + top, int(column)].astype(int)

    drawn = MotionFilm(lambda: still, FIXED, speed=1.0).plan().draw(times, *SIZE)
    return [partial(at, *of) for of in zip(drawn, u, strict=True)]


@pytest.mark.draws
@pytest.mark.parametrize("fill", [0.25, 0.5, 0.8])
def test_the_end_shows_a_circular_segment_of_beer(fill: float) -> None:
    """Points on the can's open end: the beer's colour under the chord of eq. (32), another one over it.

    The foam, which one sees over the chord, is cream.
    """
    scene = sliding(0.3, fill=fill)
    phis = np.array([0.0, 1.0, 3.0, -2.0])
    chord = 2 * fill - 1
    for phi, seen in zip(phis, look(scene, phis, phis + 0.1), strict=True):
        tilt = phi + scene.incline
        assert is_amber(seen(0, -segment(fill).offset, tilt))
        there = {True: 0, False: 0}
        for x, z in np.random.default_rng(1).uniform(-0.95, 0.95, (500, 2)):
            if np.hypot(x, z) < 0.95 and abs(z - chord) > 0.05:
                amber = is_amber(seen(x, z, tilt))
                assert amber == (z < chord), (phi, x, z)
                there[amber] += 1
        assert min(there.values()) > 20


def is_amber(colour: np.ndarray) -> bool:
    """Return whether a colour is that of beer, and not that of foam, metal or a mark."""
    return bool(colour[0] > 1.2 * colour[1] > 1.8 * colour[2])


@pytest.mark.draws
@pytest.mark.parametrize("make", [sliding, frozen])
def test_the_mark_turns_with_the_can(make: Callable[[float], Scene]) -> None:
    scene = make(0.3)
    rolls = np.linspace(0, 2 * np.pi, 9)[:-1]
    for roll, seen in zip(rolls, look(scene, rolls if make is frozen else np.ones(8), rolls), strict=True):
        marks = [seen(0, side * 1.03, roll + scene.incline) for side in (1, -1)]
        reds = [colour[0] > 2 * colour[1] and colour[0] > 2 * colour[2] for colour in marks]
        assert reds == [True, False], roll


@pytest.mark.draws
def test_every_picture_of_a_run_that_is_not_trusted_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run to a tolerance has no note, even if its can leaves the incline, and a race names the can."""
    said: list[tuple[str, ...]] = []
    monkeypatch.setattr(Sheet, "plate", lambda _, place, lines, *others, **more: said.append(tuple(lines)))
    rolls_off = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    assert rolls_off.rolling_warnings
    wrong = simulate(frozen(), 0.9, math.pi, tolerance=1e-6)
    vars(wrong)["solver_warnings"] = ("it is off by 3 rad",)
    told = "Not to be relied on"

    def notes(film: Film) -> list[tuple[str, ...]]:
        del said[:]
        assert len(list(film.plan().draw(np.array([0.1, 0.2]), *SIZE))) == 2
        return [lines for lines in said if told in lines]

    assert notes(MotionFilm(lambda: rolls_off, FIXED, speed=1.0)) == []
    assert notes(MotionFilm(lambda: wrong, FIXED, speed=1.0)) == 2 * [(told, "it is off by 3 rad")]
    cans = [Runner("one", rolls_off, (1.0, 0.0, 0.0)), Runner("other", wrong, (0.0, 0.0, 1.0))]
    race = Race("a race", lambda: cans, 0.3, 0.5, speed=1.0)
    assert notes(race) == 2 * [(told, "other: it is off by 3 rad")]


@pytest.mark.draws
def test_before_a_still_camera_nothing_is_left_of_earlier_pictures() -> None:
    moved = motion()
    display, view = Display([moved.scene]), still_view(moved, SIZE)
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
    points = np.concatenate([display.outline(0, np.array([u, 0.0, 0.0, 0.0])).reshape(-1, 3) for u in (-0.2, 0.4)])
    above = View.towards(points.mean(axis=0) + np.array([0.0, -2.4, 1.6]), points, (400, 200), 0, 0.01)
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
    closed, real = [], Painter.close
    monkeypatch.setattr(Painter, "close", lambda painter: (closed.append(painter), real(painter)))
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
