"""Down is down, level is level, and the texts are where they belong."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Scene, frozen, hoop
from mjbeer.drawing import guides
from mjbeer.drawing.camera import View
from mjbeer.drawing.display import display_model, pose
from mjbeer.drawing.frames import CAMERAS

pytestmark = pytest.mark.slow

# Geoms that are drawn are in single precision.
SINGLE = 1e-6


def posed(scene: Scene, camera: str = "side") -> tuple[mujoco.MjModel, mujoco.MjData, View]:
    model = display_model(scene, (0, 1))
    data = mujoco.MjData(model)
    pose(model, data, scene, 0.3, 1.0, 1.0, 0.0)
    return model, data, View.of(model, data, camera, 320, 180)


def added(scene: Scene, camera: str) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """Kind, start and end of what the guides add to a picture."""
    model, data, view = posed(scene, camera)
    picture = mujoco.MjvScene(model, 100)
    guides.draw(picture, scene, view, data.body("can").xpos)
    ends = []
    for geom in picture.geoms[: picture.ngeom]:
        along = geom.mat.reshape(3, 3)[:, 2] * geom.size[2]
        if geom.type == mujoco.mjtGeom.mjGEOM_ARROW:
            ends.append((geom.type, geom.pos, geom.pos + along / 2))
        else:
            ends.append((geom.type, geom.pos - along, geom.pos + along))
    return ends


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("incline", [-80, -10, 0, 1, 10, 80])
def test_the_arrow_points_down(camera: str, incline: float) -> None:
    scene = frozen(math.radians(incline))
    arrows = [each for each in added(scene, camera) if each[0] == mujoco.mjtGeom.mjGEOM_ARROW]
    assert len(arrows) == 1
    _, tail, head = arrows[0]
    down = (head - tail) / np.linalg.norm(head - tail)
    assert down == pytest.approx([0, 0, -1], abs=1e-5)
    _, _, view = posed(scene, camera)
    for end in (tail, head):
        column, row = view.pixel(end)
        assert 160 < column < 320
        assert 0 < row < 90


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("incline", [-80, -10, 1, 10, 80])
def test_a_level_line_and_the_board_make_the_angle(camera: str, incline: float) -> None:
    scene = frozen(math.radians(incline))
    _, *lines = added(scene, camera)
    _, corner, end = lines[0]
    assert (end - corner)[1:] == pytest.approx([0, 0], abs=SINGLE)
    uphill = np.array([-math.cos(scene.incline), 0, math.sin(scene.incline)]) * math.copysign(1, incline)
    assert (end - corner)[0] * uphill[0] > 0
    # The arc begins on the level line and ends on the underside of the board, as far from the corner.
    first, last = lines[1][1] - corner, lines[-1][2] - corner
    assert first[2] == pytest.approx(0, abs=SINGLE)
    assert last / np.linalg.norm(last) == pytest.approx(uphill, abs=1e-4)
    assert np.linalg.norm(first) == pytest.approx(float(np.linalg.norm(last)), rel=1e-5)
    normal = np.array([math.sin(scene.incline), 0, math.cos(scene.incline)])
    model, _, _ = posed(scene)
    side = model.geom("board")
    assert corner @ normal == pytest.approx(side.pos[2] - side.size[2], abs=SINGLE)


def test_on_level_ground_there_is_no_angle() -> None:
    assert len(added(hoop(0.0), "side")) == 1


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 10), st.sampled_from(CAMERAS))
def test_a_place_is_where_its_pixel_is(right: float, up: float, depth: float, camera: str) -> None:
    _, _, view = posed(frozen(), camera)
    point = view.at((right, up), depth)
    assert view.depth(point) == pytest.approx(depth)
    assert view.pixel(point) == pytest.approx((160 + 160 * right, 90 - 90 * up), abs=1e-6)


def test_texts_change_their_own_corner_only() -> None:
    scene = frozen()
    _, data, view = posed(scene)
    empty = np.full((180, 320, 3), 128, np.uint8)
    one, other = (
        guides.write(empty, scene, view, data.body("can").xpos, ("a title", "t = 1 s", phi)) for phi in ("0", "77")
    )
    rows, columns = np.nonzero((one != other).any(axis=2))
    assert len(rows) > 0
    assert rows.max() < 180 / 6
    assert columns.max() < 320 / 2
    assert (empty == 128).all()


def test_angles_are_written_in_degrees() -> None:
    assert guides.degrees(math.pi / 3, ".1f") == "60.0\N{DEGREE SIGN}"
    assert guides.degrees(-math.pi / 18, ".3g") == "-10\N{DEGREE SIGN}"
