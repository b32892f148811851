"""A scene that is shown opens with a camera that follows the can, and its board does not end within ten seconds."""

import math
import pathlib

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mjbeer import Scene, exact, export, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import NoLibrationError
from mjbeer.model import templates
from mjbeer.model.present import farthest, present
from mjbeer.model.setting import Setting
from tests.support.scenes import METAL, SCENES, scenes

TEN = np.linspace(0, 10, 1001)
TEMPLATES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
STARTS = [(0.0, 0.0), (3.1, 0.0), (1.0, 45.0), (1.0, -45.0)]


def ends(model: mujoco.MjModel, name: str) -> tuple[float, float]:
    middle, half = model.geom(name).pos[0], model.geom(name).size[0]
    return middle - half, middle + half


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_s_board_does_not_end_within_ten_seconds(name: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(templates.folder() / f"{name}.xml"))
    data = mujoco.MjData(model)
    for key in range(-1, model.nkey):
        if key < 0:
            mujoco.mj_resetData(model, data)
        else:
            mujoco.mj_resetDataKeyframe(model, data, key)
        mujoco.mj_forward(model, data)
        truth = exact(TEMPLATES[name], TEN, float(data.sensor("phi").data[0]), float(data.sensor("phi_dot").data[0]))
        low, high = ends(model, "board")
        assert low < truth.u.min() + float(data.sensor("u").data[0]) - truth.u[0]
        assert high > truth.u.max() + float(data.sensor("u").data[0]) - truth.u[0]


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("scene", [*SCENES.values(), frozen(1.2), sliding(-1.2), hoop(0.5), frozen(gravity=0.0)])
def test_the_board_of_a_scene_does_not_end_within_ten_seconds(scene: Scene, start: tuple[float, float]) -> None:
    low, high = ends(present(scene, Setting(), *start).compile(), "board")
    u = exact(scene, TEN, *start).u
    assert low < u.min()
    assert high > u.max()


@pytest.mark.slow
@settings(max_examples=100, deadline=None, derandomize=True)
@given(scenes(), st.floats(-4, 4), st.floats(-5, 5))
def test_no_can_goes_farther_than_the_bound(scene: Scene, phi0: float, swing: float) -> None:
    rate = swing * math.sqrt(scene.gravity / scene.can.radius)
    try:
        u = exact(scene, np.linspace(0, 3, 31), phi0, rate).u
    except NoLibrationError:
        assume(False)
    assert np.abs(u - u[0]).max() <= farthest(scene, phi0, rate, 3.0) * (1 + 1e-9)  # rounding of a few products


def test_a_board_is_not_longer_than_graphics_can_draw() -> None:
    model = present(hoop(1.0, radius=1e-4, length=1e-3), Setting(), 0.0, 0.0).compile()
    assert max(np.abs(ends(model, "board"))) < 1.001e5 * 1e-4


def test_the_camera_is_found_by_its_name(copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """Its number is another one where a camera was added to the world."""
    path = copy / "frozen.xml"
    path.write_text(path.read_text().replace("<worldbody>", '<worldbody><camera name="more" pos="0 0 1"/>'))
    export(frozen(), tmp_path / "model.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    assert model.ncam == 4
    assert model.camera(model.vis.global_.cameraid).name == "side"


@pytest.mark.parametrize("name", TEMPLATES)
def test_templates_open_with_the_camera_that_follows_the_can(name: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(templates.folder() / f"{name}.xml"))
    assert model.camera(model.vis.global_.cameraid).name == "side"
