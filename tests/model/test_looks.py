"""What is drawn fits every scene's sizes, and is the template where the scene is the template's."""

import math

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Load, Scene, frozen, hoop, pendulum, sliding
from mjbeer.model import looks
from mjbeer.model.build import rolling_spec
from mjbeer.model.setting import ROLLINGS, Setting, mjcf_folder
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.segment import segment
from tests.support.scenes import METAL

TEMPLATES = {
    "sliding": sliding(can=METAL),
    "frozen": frozen(),
    "pendulum": pendulum(),
    "hoop": hoop(),
}
# Vertices of the .obj files have 6 digits, lengths in the templates 10.
WRITTEN = 5e-6
# What MuJoCo keeps in single precision: vertices.
SINGLE = 1e-6
CAMERAS = "side", "quarter", "overview"


def shown(scene: Scene, rolling: str = "contact") -> tuple[mujoco.MjModel, mujoco.MjData]:
    return posed(rolling_spec(scene, Setting(rolling), visuals=True).compile())


def written(name: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    return posed(mujoco.MjModel.from_xml_path(str(mjcf_folder() / f"{name}.xml")))


def posed(model: mujoco.MjModel) -> tuple[mujoco.MjModel, mujoco.MjData]:
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return model, data


def drawn(model: mujoco.MjModel) -> list[str]:
    return [geom.name for geom in map(model.geom, range(model.ngeom)) if geom.group[0] == 2]


def vertices(model: mujoco.MjModel, data: mujoco.MjData, name: str | None = None) -> np.ndarray:
    """All vertices of meshes, or those of one geom, in the world."""
    found = []
    for geom in map(model.geom, range(model.ngeom)):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH and name in (None, geom.name):
            shape = model.mesh(int(geom.dataid[0]))
            pose = data.geom(geom.name)
            local = model.mesh_vert[shape.vertadr[0] : shape.vertadr[0] + shape.vertnum[0]]
            found.append(local @ pose.xmat.reshape(3, 3).T + pose.xpos)
    return np.concatenate(found)


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_s_own_scene_is_drawn_as_the_template(name: str) -> None:
    model, data = written(name)
    built, built_data = shown(TEMPLATES[name], "contact" if name == "hoop" else "equality")
    assert drawn(model) == drawn(built)
    for element in drawn(model):
        geom = model.geom(element)
        expected = built.geom(element)
        assert geom.matid == expected.matid, element
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            # Its axes are arbitrary if it is symmetric, and so its vertices are compared.
            apart = vertices(model, data, element) - vertices(built, built_data, element)
            assert np.abs(apart).max() < WRITTEN * LENGTH, element
        else:
            pose = data.geom(element)
            expected_pose = built_data.geom(element)
            assert np.allclose(pose.xpos, expected_pose.xpos, atol=WRITTEN * RADIUS), element
            assert np.allclose(pose.xmat, expected_pose.xmat, atol=WRITTEN), element
            assert np.allclose(geom.size, expected.size, atol=WRITTEN), element
    for camera in CAMERAS:
        pose = data.camera(camera)
        expected_pose = built_data.camera(camera)
        assert np.allclose(pose.xpos, expected_pose.xpos, atol=WRITTEN), camera
        assert np.allclose(pose.xmat, expected_pose.xmat, atol=WRITTEN), camera
    # The drawn wall is outside of the radius, so the board is lower than the surface by as much.
    board = model.geom("board")
    assert board.pos[2] + board.size[2] == pytest.approx(-looks.WALL * RADIUS, rel=1e-9)


@pytest.mark.parametrize("fill", [0.01, 0.5, 1 - 1e-6, 1.0])
@pytest.mark.parametrize("radius", [1e-3, 100.0])
def test_every_fill_can_be_drawn(fill: float, radius: float) -> None:
    can = Can(radius, radius, 1.0, radius**2)
    load = Load(1.0, radius * segment(fill).offset, radius**2, fill)
    heights = vertices(*shown(Scene(can, load, 0.0), "reduced"))[:, 2] / radius
    assert heights.min() == pytest.approx(-looks.WALL, abs=1e-3)
    # The mark is a hair above the wall.
    assert heights.max() == pytest.approx(2 + looks.WALL, abs=0.01)


@pytest.mark.parametrize("fill", [0.01, 0.02, 0.1, 0.5, 0.9, 0.999])
def test_the_load_is_the_true_segment_with_foam_on_it(fill: float) -> None:
    """A vertex is on the circle; the surface is as wide and as high as eq. (32) has it; so is the
    centroid."""
    model, data = shown(sliding(0.0, fill=fill), "reduced")
    there = vertices(model, data, "load") - data.body("can").xpos
    assert np.allclose(np.hypot(there[:, 0], there[:, 2]), RADIUS, rtol=SINGLE)
    assert there[:, 2].max() == pytest.approx(RADIUS * (2 * fill - 1), abs=SINGLE * RADIUS)
    assert np.ptp(there[:, 1]) == pytest.approx(LENGTH, rel=SINGLE)
    foam = vertices(model, data, "foam") - data.body("can").xpos
    assert foam[:, 2].min() == pytest.approx(there[:, 2].max(), abs=SINGLE * RADIUS)
    thickness = np.ptp(foam[:, 2]) / RADIUS
    assert thickness == pytest.approx(min(looks.FOAM, 0.5 * fill, 0.5 * (1 - fill)), abs=SINGLE)
    assert np.hypot(foam[:, 0], foam[:, 2]).max() <= RADIUS * (1 + SINGLE)


@pytest.mark.parametrize("radius", [RADIUS, 0.1])
def test_a_stripe_of_the_board_is_a_quarter_turn(radius: float) -> None:
    """And one begins at u = 0: so the can's mark comes round every four. The board has 10,000 radii
    each way."""
    model, _ = shown(frozen(can=Can.sheet_metal(radius)))
    middle = model.geom("board").pos[0]
    half = model.geom("board").size[0]
    assert half - abs(middle) > 1e4 * radius
    stripe = half / model.mat("planks").texrepeat[0]  # two to a repeat of the checkered texture
    assert stripe == pytest.approx(math.pi / 2 * radius, rel=1e-6)
    start = (middle - half) / (2 * stripe)
    assert start == pytest.approx(round(start), abs=1e-6)


def test_marks_turn_with_the_can_or_are_not_there_and_ice_has_no_foam() -> None:
    found = {rolling: "can_mark" in drawn(shown(pendulum(), rolling)[0]) for rolling in ROLLINGS}
    assert found == {"reduced": False, "equality": True, "contact": True}

    def material(model: mujoco.MjModel) -> str:
        return model.mat(int(model.geom("load").matid[0])).name

    beer, _ = shown(TEMPLATES["sliding"])
    ice, _ = shown(TEMPLATES["frozen"])
    assert "foam" in drawn(beer)
    assert "foam" not in drawn(ice)
    assert material(beer) == "beer"
    assert material(ice) == "ice"
    assert set(looks.TURNING) <= {*drawn(beer), "can_spokes"}
