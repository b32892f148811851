"""Whatever made a trajectory, the display model shows can and load where theory has them."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Can, Scene, exact, frozen, hoop, simulate, sliding
from mjbeer.drawing.camera import View
from mjbeer.drawing.display import display_model, pose, scale
from mjbeer.theory.can import RADIUS
from tests.support.scenes import METAL, SCENES, scenes

# Rounding of a few products, relative to the distances in play.
ROUNDING = 1e-12
ROLLINGS = ("reduced", "equality", "contact")
MOTIONS = [
    *((name, rolling) for name in SCENES for rolling in ROLLINGS if not (name == "sliding" and rolling != "reduced")),
    *((name, "exact") for name in SCENES),
]


def in_incline(scene: Scene, point: np.ndarray) -> tuple[float, float]:
    """Distance down the incline and height over it, in the scene's metres, of a point of the drawn world."""
    sine, cosine = math.sin(scene.incline), math.cos(scene.incline)
    x, _, z = point / scale(scene)
    return x * cosine - z * sine, x * sine + z * cosine


def check(scene: Scene, model: mujoco.MjModel, u: float, phi: float, roll: float, lift: float) -> None:
    data = mujoco.MjData(model)
    pose(model, data, scene, u, phi, roll, lift)
    a, b = scene.can.radius, scene.load.offset
    close = pytest.approx
    tolerance = ROUNDING * (abs(u) + abs(lift) + a) * (1 + abs(phi))
    # Paper's Fig. 3: the axis at (u, 0), the load's centre of mass at (u - b sin phi, -b cos phi).
    assert in_incline(scene, data.body("can").xpos) == close((u, a + lift), abs=tolerance)
    load = data.body("load")
    centre = load.xpos + load.xmat.reshape(3, 3) @ [0, 0, -b * scale(scene)]
    assert in_incline(scene, centre) == close((u - b * math.sin(phi), a + lift - b * math.cos(phi)), abs=tolerance)
    # The mark is on top where the can has not rolled, and goes downhill from there.
    spot = data.geom("can_spot").xpos
    out = abs(model.geom("can_spot").pos[2]) / scale(scene)
    expected = u + out * math.sin(roll), a + lift + out * math.cos(roll)
    assert in_incline(scene, spot) == close(expected, abs=tolerance * (1 + abs(roll)))


@pytest.mark.parametrize(("name", "rolling"), MOTIONS)
def test_every_kind_of_trajectory(name: str, rolling: str) -> None:
    scene = SCENES[name]
    if rolling == "exact":
        moved = exact(scene, np.linspace(0, 0.5, 6), 2.0)
    else:
        moved = simulate(scene, 0.5, 2.0, rolling=rolling, times=0.1 * np.arange(6))
    model = display_model(scene)
    for i in range(len(moved.time)):
        check(scene, model, *(float(each[i]) for each in (moved.u, moved.phi, moved.roll, moved.lift)))


@pytest.mark.slow
@settings(max_examples=50, deadline=None, derandomize=True)
@given(scenes(), *(st.floats(-10, 10),) * 4)
def test_any_scene_anywhere(scene: Scene, turns: float, phi: float, roll: float, height: float) -> None:
    a = scene.can.radius
    phi = roll if scene.attachment == "frozen" else phi
    check(scene, display_model(scene), turns * a, phi, roll, height * a)


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 1.0, 100.0])
def test_size_does_not_show(radius: float) -> None:
    """The same geoms and vertices for a can of 1 um as for one of 100 m."""
    one = display_model(sliding(can=Can.massless(0.05, 0.1)), (0, 1.5))
    other = display_model(sliding(can=Can.massless(radius, 2 * radius)), (0, 30 * radius))
    for field in ("geom_pos", "geom_size", "mesh_vert", "mat_texrepeat", "body_pos", "cam_pos"):
        assert np.allclose(getattr(one, field), getattr(other, field), rtol=1e-6, atol=1e-9), field
    assert one.stat.extent == pytest.approx(other.stat.extent)


def test_masses_do_not_matter() -> None:
    """Nor gravity: a massless can, which MuJoCo would not move, and a heavy one on the moon look the same."""
    light, heavy = display_model(sliding()), display_model(sliding(can=METAL, density=1e4, gravity=1.6))
    assert np.array_equal(light.geom_pos, heavy.geom_pos)
    assert np.array_equal(light.body_mass, heavy.body_mass)


@pytest.mark.slow
@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.floats(-80, 80), st.floats(-50, 0), st.floats(0, 50), st.sampled_from([(160, 90), (90, 160), (400, 100)]))
def test_the_overview_shows_the_whole_way(incline: float, low: float, high: float, size: tuple[int, int]) -> None:
    scene = frozen(math.radians(incline))
    model = display_model(scene, (low, high), size[0] / size[1])
    data = mujoco.MjData(model)
    for u in (low, high):
        pose(model, data, scene, u, 0.0, 0.0, 0.0)
        view = View.of(model, data, "overview", *size)
        for edge in ([1, 0], [-1, 0], [0, 1], [0, -1]):
            column, row = view.pixel(data.body("can").xpos + RADIUS * np.array([edge[0], 0, edge[1]]))
            assert 0 < column < size[0]
            assert 0 < row < size[1]


@pytest.mark.parametrize("camera", ["side", "quarter"])
def test_cameras_go_along_and_stay_level(camera: str) -> None:
    scene = frozen(0.5)
    model = display_model(scene, (0, 100))
    data = mujoco.MjData(model)
    pose(model, data, scene, 0.0, 0.0, 0.0, 0.0)
    before = View.of(model, data, camera, 160, 90)
    pose(model, data, scene, 100.0, 7.0, 7.0, 0.0)
    after = View.of(model, data, camera, 160, 90)
    assert np.allclose(after.axes, before.axes, atol=1e-12)
    assert after.axes[0][2] == pytest.approx(0, abs=1e-12)
    assert after.pixel(data.body("can").xpos) == pytest.approx((80, 45), rel=0.1)


def test_cameras_do_not_rise_with_a_hop() -> None:
    model = display_model(hoop())
    data = mujoco.MjData(model)
    seen = []
    for lift in (0.0, 0.03):
        pose(model, data, hoop(), 0.1, 1.0, 1.0, lift)
        seen.append((data.camera("side").xpos.copy(), data.body("can").xpos.copy()))
    assert np.array_equal(seen[0][0], seen[1][0])
    assert seen[1][1] - seen[0][1] == pytest.approx([0, 0, 0.03], abs=1e-15)
