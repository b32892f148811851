"""What the camera does: it stands still and shows the whole way, or pans evenly, or goes along."""

import numpy as np
import pytest

from mjbeer import exact, frozen, hoop, sliding
from mjbeer.drawing.world.cameras import CAMERAS, Camera
from mjbeer.drawing.world.display import on_incline, scale
from mjbeer.drawing.world.positions import coordinates
from mjbeer.drawing.world.shot import Shot
from mjbeer.drawing.world.view import circle
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

PIXELS = (1280, 430)
PLANE = -0.06
TIMES = np.linspace(0, 1, 101)
MOTIONS = {
    "rocks": exact(frozen(), TIMES, 0.0),
    "swings downhill": exact(sliding(), TIMES, 1.0),
    "rolls uphill": exact(sliding(-0.3), TIMES, 1.0),
    "stays": exact(frozen(), TIMES, frozen().equilibrium()),
    "loops": exact(hoop(), TIMES, -3.0, 16.0),
}


def shot(motion: Trajectory, camera: Camera) -> Shot:
    u, _, _, lift = coordinates(motion, TIMES).T
    return Shot.fit(motion.scene, camera, TIMES, u, lift, PLANE, PIXELS)


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
        assert (places < PIXELS).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_a_fixed_camera_does_not_move(name: str) -> None:
    taken = shot(MOTIONS[name], "fixed")
    assert taken.still
    assert np.array_equal(taken.view(0.0).eye, taken.view(1.0).eye)


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


def test_a_close_camera_goes_along() -> None:
    motion = MOTIONS["swings downhill"]
    taken = shot(motion, "close")
    assert taken.way(TIMES) == pytest.approx(motion.u * scale(motion.scene), abs=1e-12)


def test_the_camera_pans_where_the_can_would_be_small() -> None:
    assert shot(MOTIONS["rocks"], "auto").still
    assert not shot(MOTIONS["swings downhill"], "auto").still


def test_a_can_at_rest_fills_what_it_may() -> None:
    taken = shot(MOTIONS["stays"], "auto")
    pixels = RADIUS * taken.view(0.0).scale(np.array([0.0, PLANE, 0.0]))
    assert pixels == pytest.approx(0.22 * PIXELS[1], rel=1e-9)
