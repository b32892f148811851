"""What is drawn fits every scene's sizes, and is the template where the scene is the template's."""

import math
from collections import Counter
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Load, Scene, frozen, hoop, pendulum, sliding
from mjbeer.model import appearance, mesh, parts, templates
from mjbeer.model.build import build, compose
from mjbeer.model.setting import Setting
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.load import segment
from tests.support import assets
from tests.support.scenes import METAL

TEMPLATES = {"sliding": sliding(can=METAL), "frozen": frozen(can=METAL), "pendulum": pendulum(), "hoop": hoop()}
# Vertices of the .obj files have 6 digits, lengths in the templates 10.
WRITTEN = 5e-6
# The files are coarser than what is built: a polygon with so many edges is within this of the largest circle [m].
POLYGON = 1.1 * RADIUS * (1 - math.cos(math.pi / assets.COARSE))
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
        if model.geom(each).type == mujoco.mjtGeom.mjGEOM_MESH:  # a mesh's axes are arbitrary if it is symmetric
            corners = [np.array([there.min(0), there.max(0)]) for there in (
                vertices(model, one, each), vertices(built, other, each)
            )]  # fmt: skip
            assert np.allclose(*corners, atol=POLYGON), each
        else:
            assert np.allclose(one.geom(each).xmat, other.geom(each).xmat, atol=WRITTEN), each
            assert np.allclose(model.geom(each).size, built.geom(each).size, atol=WRITTEN), each
        assert model.geom(each).matid == built.geom(each).matid
    for each in ("side", "quarter", "overview"):
        assert np.allclose(one.camera(each).xpos, other.camera(each).xpos, atol=WRITTEN)
        assert np.allclose(one.camera(each).xmat, other.camera(each).xmat, atol=WRITTEN)


@pytest.mark.parametrize("file", assets.SHAPES)
def test_assets_are_the_meshes(file: str) -> None:
    """`python -m tests.support.assets` writes them."""
    shape, lines = assets.SHAPES[file], (templates.folder() / "assets" / file).read_text().splitlines()
    words = [line.replace("/", " ").split() for line in lines]
    vertices, places, faces = (
        np.array([row[1:] for row in words if row[0] == kind], float) for kind in ("v", "vt", "f")
    )
    assert np.allclose(vertices, shape[0], rtol=WRITTEN, atol=1e-15)
    if file in appearance.TEXTURED:
        assert np.allclose(places, mesh.texture(shape[0], RADIUS), rtol=1e-3)  # four digits
        assert np.array_equal(faces[:, ::2], faces[:, 1::2])
        faces = faces[:, ::2]
    assert np.array_equal(faces - 1, shape[1])


def test_there_are_no_other_assets_and_they_are_small() -> None:
    files = list((templates.folder() / "assets").iterdir())
    assert {each.name for each in files} == set(assets.SHAPES)
    assert sum(each.stat().st_size for each in files) < 200_000


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


def vertices(model: mujoco.MjModel, data: mujoco.MjData, name: str | None = None) -> np.ndarray:
    """All vertices of meshes, or those of one geom, in the world."""
    found = []
    for geom in map(model.geom, range(model.ngeom)):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH and name in (None, geom.name):
            shape, pose = model.mesh(int(geom.dataid[0])), data.geom(geom.name)
            local = model.mesh_vert[shape.vertadr[0] : shape.vertadr[0] + shape.vertnum[0]]
            found.append(local @ pose.xmat.reshape(3, 3).T + pose.xpos)
    return np.concatenate(found)


@pytest.mark.parametrize("length", [1e-4, 0.01, 0.12, 1.0])
def test_ends_stay_ends(length: float) -> None:
    model = build(sliding(can=Can.sheet_metal(length=length)), "equality", visuals=True)
    data = poses(model)

    def y(name: str) -> tuple[float, float]:
        if model.geom(name).type == mujoco.mjtGeom.mjGEOM_MESH:
            there = vertices(model, data, name)[:, 1]
            return float(there.min()), float(there.max())
        middle, half = float(data.geom(name).xpos[1]), float(np.abs(data.geom(name).xmat[3:6]) @ model.geom(name).size)
        return middle - half, middle + half

    rounding = SINGLE * RADIUS
    assert y("can_wall") == pytest.approx((-length / 2, length / 2), abs=rounding)
    deepest = length / 2 - 0.25 * min(RADIUS, length)
    for end in ("can_end", "can_tab", "can_mouth"):
        assert y(end)[1] < length / 2
        assert y(end)[0] > deepest
    assert y("can_tab")[0] < y("can_mouth")[0] < y("can_end")[1]
    assert -length / 2 < y("can_label")[0] < 0 < y("can_label")[1] < length / 2
    assert -0.52 * length < y("can_spot")[0] < -length / 2 < y("can_spot")[1] < -0.4 * length
    assert y("can_mark")[0] < y("can_label")[0]
    assert y("can_label")[1] < y("can_mark")[1] < length / 2
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
    assert heights.min() == pytest.approx(-parts.WALL, abs=1e-3)
    assert heights.max() == pytest.approx(2 + parts.WALL, abs=0.01)  # the mark, a hair above the wall


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
    appearance.lengthen(spec, scene, low, high)
    model = spec.compile()
    middle, half = model.geom("board").pos[0], model.geom("board").size[0]
    assert middle - half <= low - 1.5
    assert middle + half >= high + 1.5


@pytest.mark.parametrize("high", [0.0, 300.0])
def test_a_stripe_is_a_quarter_turn(high: float) -> None:
    """And one begins at u = 0: so the can's mark comes round every four stripes."""
    scene = frozen(can=METAL)
    spec = compose(scene, Setting(), visuals=True)
    appearance.lengthen(spec, scene, 0.0, high)
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
    board = model.geom("board")
    assert board.pos[2] + board.size[2] == pytest.approx(-parts.WALL * RADIUS, rel=1e-9)
    assert vertices(model, poses(model))[:, 1].max() == pytest.approx(LENGTH / 2, rel=SINGLE)


@pytest.mark.parametrize(
    "make",
    [
        *parts.PARTS.values(),
        lambda radius, length: mesh.beer(0.3, radius, length),
        lambda radius, length: mesh.layer(0.3, appearance.FOAM, radius, length),
    ],
)
@pytest.mark.parametrize("length", [1e-4, 0.12, 1.0])
def test_shapes_are_closed_and_face_outwards(make: Callable[[float, float], mesh.Mesh], length: float) -> None:
    """Every edge of a face is that of another face, the other way round; and no face is flat."""
    shape = make(RADIUS, length)
    corners = np.round(shape[0] / (1e-9 * length)).astype(int)[shape[1]]
    edges = Counter((tuple(face[i]), tuple(face[(i + 1) % 3])) for face in corners for i in range(3))
    assert all(edges[end, start] == count for (start, end), count in edges.items())
    sides = shape[0][shape[1]]
    areas = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
    assert areas.min() > 1e-7 * RADIUS * min(RADIUS, length)
    assert mesh.volume(shape) > 0


@pytest.mark.parametrize("fill", [1e-6, 1e-3, 0.02, 0.1, 0.5, 0.9, 0.999])
def test_foam_lies_on_the_beer_and_takes_none_of_it(fill: float) -> None:
    model = build(sliding(0.0, fill=fill), visuals=True)
    data = poses(model)
    surface = vertices(model, data, "load")[:, 2].max()
    names = drawn(model)
    assert ("foam" in names) == (fill > 1e-3 / 2)
    if "foam" in names:
        foam = vertices(model, data, "foam")
        assert foam[:, 2].min() == pytest.approx(surface, abs=SINGLE * RADIUS)
        thickness = np.ptp(foam[:, 2]) / RADIUS
        assert thickness <= appearance.FOAM + SINGLE
        assert thickness <= 0.5 * min(fill, 1 - fill) + SINGLE
        assert thickness >= appearance.FOAM - SINGLE or fill not in (0.1, 0.5, 0.9)
        across = foam - data.body("can").xpos
        assert np.hypot(across[:, 0], across[:, 2]).max() <= RADIUS * (1 + SINGLE)


def test_ice_has_no_foam_and_another_colour() -> None:
    models = {each: build(TEMPLATES[each], "equality", visuals=True) for each in ("sliding", "frozen")}
    assert {each: "foam" in drawn(model) for each, model in models.items()} == {"sliding": True, "frozen": False}
    materials = [model.mat(int(model.geom("load").matid[0])).name for model in models.values()]
    assert materials == ["beer", "ice"]


@pytest.mark.parametrize("name", TEMPLATES)
def test_the_marks_lie_on_the_bead_and_hide_no_load(name: str) -> None:
    """Seen from the end: the spot covers the bead, and reaches a hundredth of a radius over the inside."""
    model = build(TEMPLATES[name], "contact", visuals=True)
    data = poses(model)
    for mark in ("can_spot", "can_mark"):
        across = (vertices(model, data, mark) - data.body("can").xpos) / RADIUS
        assert np.hypot(across[:, 0], across[:, 2]).min() > 0.98
        assert np.hypot(across[:, 0], across[:, 2]).max() < 1 + 1.2 * parts.WALL
    ahead = vertices(model, data, "can_spot")[:, 1].min() - vertices(model, data, "can_wall")[:, 1].min()
    assert -0.02 * RADIUS < ahead < 0
