"""Where points are seen: a plane across the can's axis as it is, and plumb lines plumb."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import exact, frozen, hoop, sliding
from mjbeer.drawing.camera import (
    AROUND,
    BELOW,
    CAMERAS,
    Camera,
    CameraPath,
    View,
    circle,
    follow,
    on_incline,
    scale,
)
from mjbeer.theory.can import RADIUS

# Rounding of a dozen operations on places of up to 2000 pixels.
ROUNDING = 2e-6
CENTRE = np.array([0.3, -0.06, 0.1])
METRES = np.array([0.8, 0.45])
VIEW = View.facing(CENTRE, METRES, (1600, 900))
PLACES = st.floats(-1, 1)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(PLACES, PLACES, st.floats(-0.5, 2), PLACES)
def test_across_the_axis_all_is_seen_to_scale_and_nothing_leans(
    x: float, z: float, y: float, other: float
) -> None:
    """A metre has 2000 pixels in each direction, whatever the eye's height is.

    Plumb lines are plumb at any depth.
    """
    point = CENTRE + np.array([x, 0.0, z])

    place = VIEW.pixel(point)
    corner = VIEW.pixel(np.array([x, y, z]))
    above = VIEW.pixel(np.array([x, y, other]))
    beside = VIEW.pixel(np.array([other, y, z]))

    assert place == pytest.approx([800 + 2000 * x, 450 - 2000 * z], abs=ROUNDING)
    assert VIEW.scale(point) == pytest.approx(2000)
    assert above[0] == pytest.approx(corner[0], abs=ROUNDING)
    assert beside[1] == pytest.approx(corner[1], abs=ROUNDING)


@pytest.mark.parametrize("pixels", [(400, 300), (300, 400), (1200, 100)])
def test_a_view_towards_points_just_holds_them(pixels: tuple[int, int]) -> None:
    points = np.random.default_rng(1).uniform(-1, 1, (50, 3))

    view = View.towards(np.array([0.5, -6.0, 4.0]), points, pixels, top=20, margin=0.0)

    places = view.pixel(points) - [0, 20]
    # The picture is filled in one direction, and nothing is outside.
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


def followed(name: str, camera: Camera) -> CameraPath:
    return follow(MOTIONS[name], camera, PLANE, WIDE)


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("name", MOTIONS)
def test_the_can_is_in_the_picture_at_all_times(name: str, camera: Camera) -> None:
    motion = MOTIONS[name]

    path = followed(name, camera)

    for time, u in zip(TIMES, motion.u, strict=True):
        centre = on_incline(motion.scene, u * scale(motion.scene), RADIUS)
        rim = np.insert(centre + circle(RADIUS), 1, PLANE, axis=1)
        places = path.view(time).pixel(rim)
        assert (places > 0).all()
        assert (places < WIDE).all()


@pytest.mark.parametrize(
    ("name", "stands"), [("rocks", True), ("swings downhill", False), ("stays", True)]
)
def test_the_camera_pans_where_the_can_would_be_small(name: str, stands: bool) -> None:
    path = followed(name, "auto")

    moves = not np.array_equal(path.view(0.0).eye, path.view(1.0).eye)
    assert path.still is stands
    assert moves is not stands


def test_a_can_that_stays_fills_the_picture_but_for_the_room_around_it() -> None:
    view = followed("stays", "auto").view(0.0)

    radius = RADIUS * view.scale(np.array([0.0, PLANE, 0.0]))
    assert radius == pytest.approx(WIDE[1] / (AROUND + BELOW), rel=1e-9)
