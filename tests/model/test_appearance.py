"""What is drawn fits every scene's sizes, and is the template where the scene is the template's."""

import math

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Load, Scene, frozen, hoop, pendulum, sliding
from mjbeer.model import appearance, mesh, templates
from mjbeer.model.build import build, compose
from mjbeer.model.setting import Setting
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.segment import segment
from tests.support.scenes import METAL

TEMPLATES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
# Vertices of the .obj files have 8 digits, lengths in the templates 10.
WRITTEN = 1e-7
# What MuJoCo keeps in single precision: vertices.
SINGLE = 1e-6


def written(name: str) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_path(str(templates.folder() / f"{name}.xml"))


def drawn(model: mujoco.MjModel) -> list[str]:
    return [geom.name for geom in map(model.geom, range(model.ngeom)) if geom.group[0] == 2]


def poses(model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return data


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_s_own_scene_is_drawn_as_the_template(name: str) -> None:
    model = written(name)
    built = build(TEMPLATES[name], "contact" if name == "hoop" else "equality", visuals=True)
    assert drawn(model) == drawn(built)
    one, other = poses(model), poses(built)
    for each in drawn(model):
        assert np.allclose(one.geom(each).xpos, other.geom(each).xpos, atol=WRITTEN * RADIUS), each
        assert np.allclose(np.abs(one.geom(each).xmat), np.abs(other.geom(each).xmat), atol=1e-5), each
        assert np.allclose(model.geom(each).size, built.geom(each).size, atol=WRITTEN), each
        assert model.geom(each).matid == built.geom(each).matid
    for each in ("side", "quarter", "overview"):
        assert np.allclose(one.camera(each).xpos, other.camera(each).xpos, atol=WRITTEN)
        assert np.allclose(one.camera(each).xmat, other.camera(each).xmat, atol=WRITTEN)


@pytest.mark.parametrize(
    ("asset", "shape"),
    [
        ("beer_half", mesh.beer(0.5, RADIUS, LENGTH)),
        ("can", mesh.tube(RADIUS, RADIUS * (1 + appearance.WALL), LENGTH)),
    ],
)
def test_assets_are_the_meshes(asset: str, shape: mesh.Mesh) -> None:
    """The files were written from these calls, "v" with three times "%.8g" and "f" with indices from 1."""
    lines = [line.split() for line in (templates.folder() / "assets" / f"{asset}.obj").read_text().splitlines()]
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], float)
    faces = np.array([line[1:] for line in lines if line[0] == "f"], int)
    assert np.allclose(vertices, shape[0], rtol=WRITTEN, atol=1e-16)
    assert np.array_equal(faces - 1, shape[1])


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize("name", TEMPLATES)
def test_all_grows_with_the_can(name: str, radius: float) -> None:
    times, can = radius / RADIUS, TEMPLATES[name].can
    load = TEMPLATES[name].load
    grown = Scene(
        Can(radius, can.length * times, 1.0, radius**2),
        Load(1.0, load.offset * times, radius**2, load.fill),
        TEMPLATES[name].incline,
        TEMPLATES[name].attachment,
    )
    one, other = build(TEMPLATES[name], "contact", visuals=True), build(grown, "contact", visuals=True)
    small, large = poses(one), poses(other)
    for each in drawn(one):
        if one.geom(each).type != mujoco.mjtGeom.mjGEOM_MESH:  # a mesh's frame depends on what it is taken for
            assert np.allclose(large.geom(each).xpos / times, small.geom(each).xpos, rtol=1e-9, atol=1e-12), each
            assert np.allclose(other.geom(each).size / times, one.geom(each).size, rtol=1e-9, atol=1e-12), each
    assert np.allclose(vertices(other, large) / times, vertices(one, small), atol=SINGLE * LENGTH)
    for each in ("side", "quarter", "overview"):
        assert np.allclose(large.camera(each).xpos / times, small.camera(each).xpos, rtol=1e-9, atol=1e-12)
    assert other.stat.extent / times == pytest.approx(one.stat.extent, rel=1e-12)
    assert other.mat("grid").texrepeat * times == pytest.approx(one.mat("grid").texrepeat, rel=1e-6)


def vertices(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """All vertices of meshes, in the world."""
    found = []
    for geom in map(model.geom, range(model.ngeom)):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            shape, pose = model.mesh(int(geom.dataid[0])), data.geom(geom.name)
            local = model.mesh_vert[shape.vertadr[0] : shape.vertadr[0] + shape.vertnum[0]]
            found.append(local @ pose.xmat.reshape(3, 3).T + pose.xpos)
    return np.concatenate(found)


@pytest.mark.parametrize("length", [1e-4, 0.01, 0.12, 1.0])
def test_ends_stay_ends(length: float) -> None:
    model = build(sliding(can=Can.sheet_metal(length=length)), "equality", visuals=True)
    data = poses(model)

    def y(name: str) -> tuple[float, float]:
        size = model.geom(name).size
        if model.geom(name).type == mujoco.mjtGeom.mjGEOM_CYLINDER:
            size = size[[0, 0, 1]]
        middle, half = float(data.geom(name).xpos[1]), float(np.abs(data.geom(name).xmat[3:6]) @ size)
        return middle - half, middle + half

    assert y("can_end")[1] == pytest.approx(length / 2)
    assert y("can_end")[0] >= 0.49 * length
    assert y("can_spot")[0] < -length / 2
    assert y("can_mark")[0] < -length / 2
    assert y("can_mark")[1] > length / 2
    assert y("board")[1] == pytest.approx(length / 2 + 0.015)
    assert data.camera("side").xpos[1] == pytest.approx(-length / 2 - 0.24)


@pytest.mark.parametrize("length", [1e-4, 0.01, 0.12, 1.0])
def test_a_pendulum_hangs_in_its_wheel(length: float) -> None:
    model = build(pendulum(0.0, length=length), visuals=True)
    for each in ("load", "load_arm"):
        assert -length / 2 < model.geom(each).pos[1] < 0


@pytest.mark.parametrize("fill", [1e-100, 1e-9, 1e-3, 0.02, 0.5, 0.98, 1 - 1e-12, 1.0])
@pytest.mark.parametrize("radius", [1e-6, RADIUS, 100.0])
def test_every_fill_can_be_drawn(fill: float, radius: float) -> None:
    """With masses that MuJoCo can take; those of so little beer it cannot."""
    can = Can(radius, radius, 1.0, radius**2)
    offset = radius * segment(fill).offset
    model = build(Scene(can, Load(1.0, offset, radius**2, fill), 0.0), visuals=True)
    heights = vertices(model, poses(model))[:, 2] / radius
    assert heights.min() == pytest.approx(-appearance.WALL, abs=1e-3)
    assert heights.max() == pytest.approx(2 + appearance.WALL, abs=1e-3)


@pytest.mark.parametrize("fill", [0.1, 0.5, 0.9])
def test_the_load_is_the_true_segment(fill: float) -> None:
    """A vertex is on the circle; the surface is as wide and as high as eq. (32) has it; so is the centroid."""
    model = build(sliding(0.0, fill=fill), visuals=True)
    data = poses(model)
    shape = model.mesh("load")
    local = model.mesh_vert[shape.vertadr[0] : shape.vertadr[0] + shape.vertnum[0]]
    there = local @ data.geom("load").xmat.reshape(3, 3).T + data.geom("load").xpos - data.body("can").xpos
    assert np.allclose(np.hypot(there[:, 0], there[:, 2]), RADIUS, rtol=SINGLE)
    assert there[:, 2].max() == pytest.approx(RADIUS * (2 * fill - 1), abs=SINGLE * RADIUS)
    assert np.ptp(there[:, 1]) == pytest.approx(LENGTH, rel=SINGLE)
    # MuJoCo puts the mesh's frame into its centroid; a polygon of 256 edges misses 6e-4 of the arc (mesh.py).
    centroid = data.geom("load").xpos - data.body("can").xpos
    assert np.allclose(centroid, [0, 0, -RADIUS * segment(fill).offset], rtol=6e-4, atol=1e-9)


@pytest.mark.parametrize(("low", "high"), [(0.0, 0.0), (-50.0, 3.0), (0.0, 300.0)])
def test_the_board_outlasts_the_motion(low: float, high: float) -> None:
    scene = frozen(can=METAL)
    spec = compose(scene, Setting(), visuals=True)
    appearance.extend(spec, scene, low, high, 16 / 9)
    model = spec.compile()
    for each in ("board", "board_side"):
        middle, half = model.geom(each).pos[0], model.geom(each).size[0]
        assert middle - half <= low - 1.5
        assert middle + half >= high + 1.5


@pytest.mark.parametrize("high", [0.0, 300.0])
def test_a_stripe_is_a_quarter_turn(high: float) -> None:
    """And one begins at u = 0: so the can's mark comes round every four stripes."""
    scene = frozen(can=METAL)
    spec = compose(scene, Setting(), visuals=True)
    appearance.extend(spec, scene, 0.0, high, 16 / 9)
    model = spec.compile()
    board = model.geom("board")
    stripe = board.size[0] / model.mat("planks").texrepeat[0]  # two to a repeat of the checkered texture
    assert stripe == pytest.approx(math.pi / 2 * RADIUS, rel=1e-6)
    start = (board.pos[0] - board.size[0]) / (2 * stripe)
    assert start == pytest.approx(round(start), abs=1e-6)


def test_strip_leaves_nothing_drawn() -> None:
    spec = templates.read("hoop")
    appearance.strip(spec)
    model = spec.compile()
    assert model.nbody == 4
    assert not any(
        (model.ngeom, model.nsite, model.nmesh, model.ntex, model.nmat, model.ncam, model.nlight, model.nkey)
    )


@pytest.mark.parametrize("name", TEMPLATES)
def test_the_can_lies_on_the_board(name: str) -> None:
    """Its drawn wall is outside of the radius, so the board is lower than the surface by as much."""
    model = written(name)
    assert model.geom("board").pos[2] == pytest.approx(-appearance.WALL * RADIUS, rel=1e-9)
    assert vertices(model, poses(model))[:, 1].max() == pytest.approx(LENGTH / 2, rel=SINGLE)
