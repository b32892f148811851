"""Where points are in a picture: a plane across the can's axis is seen as it is, and plumb lines are plumb."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import exact, frozen, hoop, sliding
from mjbeer.drawing.camera import CAMERAS, Camera, CameraPath, View, circle, on_incline, scale
from mjbeer.drawing.scene import coordinates
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

# Rounding of a dozen operations on numbers of the size of the picture.
ROUNDING = 1e-9
CENTRE = np.array([0.3, -0.06, 0.1])
METRES = np.array([0.8, 0.45])
PIXELS = (1600, 900)
VIEW = View.facing(CENTRE, METRES, distance=2.0, above=0.1, pixels=PIXELS)
PLACES = st.floats(-1, 1)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(PLACES, PLACES)
def test_a_plane_across_the_axis_is_a_map_to_scale(x: float, z: float) -> None:
    """2000 pixels for a metre in each direction, whatever the eye's height is."""
    place = VIEW.pixel(CENTRE + np.array([x, 0.0, z]))
    assert place == pytest.approx([800 + 2000 * x, 450 - 2000 * z], abs=ROUNDING * 2000)
    assert VIEW.scale(CENTRE + np.array([x, 0.0, z])) == pytest.approx(2000)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(PLACES, st.floats(-0.5, 2), PLACES, PLACES)
def test_plumb_lines_are_plumb_and_level_lines_level(x: float, y: float, low: float, high: float) -> None:
    plumb = VIEW.pixel(np.array([[x, y, low], [x, y, high]]))
    level = VIEW.pixel(np.array([[low, y, x], [high, y, x]]))
    assert plumb[0, 0] == pytest.approx(plumb[1, 0], abs=ROUNDING * 2000)
    assert level[0, 1] == pytest.approx(level[1, 1], abs=ROUNDING * 2000)


@pytest.mark.parametrize("pixels", [(400, 300), (300, 400), (1200, 100)])
def test_a_view_towards_points_just_holds_them(pixels: tuple[int, int]) -> None:
    points = np.random.default_rng(1).uniform(-1, 1, (50, 3))
    view = View.towards(np.array([0.5, -6.0, 4.0]), points, pixels, margin=0.0)
    places = view.pixel(points)
    assert (places > -1e-6).all()
    assert (places < np.array(pixels) + 1e-6).all()
    assert max(np.ptp(places, axis=0) / pixels) == pytest.approx(1.0)
    assert view.axes @ view.axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(view.axes) == pytest.approx(1.0)  # no mirror
    assert view.axes[0][2] == 0  # upright


WIDE = (1280, 430)
PLANE = -0.06
TIMES = np.linspace(0, 1, 101)
MOTIONS = {
    "rocks": exact(frozen(), TIMES, 0.0),
    "swings downhill": exact(sliding(), TIMES, 1.0),
    "rolls uphill": exact(sliding(-0.3), TIMES, 1.0),
    "stays": exact(frozen(), TIMES, frozen().equilibrium()),
    "loops": exact(hoop(), TIMES, -3.0, 16.0),
}


def shot(motion: Trajectory, camera: Camera) -> CameraPath:
    u, _, _, lift = coordinates(motion, TIMES).T
    return CameraPath.fit(motion.scene, camera, TIMES, u, lift, PLANE, WIDE)


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("name", MOTIONS)
def test_the_can_is_in_the_picture_at_all_times(name: str, camera: Camera) -> None:
    motion = MOTIONS[name]
    taken = shot(motion, camera)
    for time, u in zip(TIMES, motion.u, strict=True):
        centre = on_incline(motion.scene, u * scale(motion.scene), RADIUS)
        rim = np.insert(centre + circle(RADIUS), 1, PLANE, axis=1)
        places = taken.view(time).pixel(rim)
        assert (places > 0).all()
        assert (places < WIDE).all()


def test_a_pan_is_even_and_shows_the_hesitation() -> None:
    """The camera's way has a constant second difference; the can goes to and fro in the picture by what it hesitates.

    The swing's share in the pan is that of fitting a parabola over a little more than two swings.
    """
    motion = MOTIONS["swings downhill"]
    taken = shot(motion, "pan")
    way = taken.way(TIMES)
    assert np.ptp(np.diff(way, 2)) < 1e-12 * np.ptp(way)
    steady = motion.scene.acceleration() * TIMES**2 / 2
    hesitation = np.ptp(motion.u - steady)
    seen = np.ptp(motion.u * scale(motion.scene) - way) / scale(motion.scene)
    assert seen == pytest.approx(hesitation, rel=0.2)


def test_the_camera_pans_where_the_can_would_be_small() -> None:
    still = shot(MOTIONS["rocks"], "auto")
    assert still.still
    assert np.array_equal(still.view(0.0).eye, still.view(1.0).eye)
    assert not shot(MOTIONS["swings downhill"], "auto").still


def test_a_can_at_rest_fills_what_it_may() -> None:
    taken = shot(MOTIONS["stays"], "auto")
    pixels = RADIUS * taken.view(0.0).scale(np.array([0.0, PLANE, 0.0]))
    assert pixels == pytest.approx(WIDE[1] / 3.5, rel=1e-9)
