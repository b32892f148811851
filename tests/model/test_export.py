"""Exported MJCF: MuJoCo 4 loads it without mjbeer, as the model that mjbeer builds.

Portable exports are loaded by MuJoCo 3.3, MJX, mujoco_warp and dm_control too. The tests with these
install them in build/others, and run only where MJBEER_OTHERS names the tools:
`MJBEER_OTHERS="MuJoCo 3.3.4" .venv/bin/python -m pytest tests/model/test_export.py` takes half a
minute the first time; MJBEER_OTHERS=all downloads about 1.5 GB and takes half an hour. The names
are those of `tools.portability.OTHERS`.
"""

import math
import os
import pathlib
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import NamedTuple

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Scene, Standing, exact, frozen, pendulum, sliding, standing
from mjbeer.exceptions import OutputError, ParameterError, UnsupportedError
from mjbeer.model import export as export_module
from mjbeer.model.build import add_start, build, rolling_spec
from mjbeer.model.export import export
from mjbeer.model.joints import initial_state
from mjbeer.model.setting import (
    LOOKS,
    MJBEER_INTEGRATORS,
    MUJOCO_INTEGRATORS,
    ROLLINGS,
    Rolling,
    Setting,
    supported,
)
from mjbeer.theory.can import Damping
from mjbeer.theory.equations import Coordinates, kinetic_energy
from tests.support.scenes import METAL, SCENES, coordinates
from tools import portability as others
from tools.portability import BY_NAME, FRICTION, START

# RK4's own error after 1 s at 1 ms, and at 0.25 ms for the hoop, which passes its bottom at 47
# rad/s: 4.2e-8 rad. The joint equality's softness is less. A contact's creeps, 2e-7 rad for the
# hoop; a portable one's impedance of 0.999 misses ten times as much of its force, 1.8e-6 rad.
TOLERANCE = {"reduced": 1e-7, "equality": 1e-7, "contact": 5e-6}
# In single precision each of 1000 to 4000 steps rounds phi and its rate by 6e-8 of their size: 1e-6
# rad in all if the roundings are independent, and 1e-4 rad if they all have the same sign. The
# equality's residual is a difference of two angles, whose rounding the stiffness 4/h^2 multiplies.
# The depth of a contact, 1e-8 m, is the difference of heights of 0.03 m, which are rounded by 2e-9
# m: its force has hardly a digit in each step, and is right on average only.
ALLOWED = {True: TOLERANCE, False: {"reduced": 1e-4, "equality": 1e-3, "contact": 1e-2}}
CASES = [
    (name, rolling)
    for name, scene in SCENES.items()
    for rolling in ROLLINGS
    if supported(scene, rolling)
]
# Sums of a few products of positions and rates.
ROUNDING = 1e-12
TALL = Can.sheet_metal(0.04, 0.2)
# Half a unit in the last of the digits of a number that begins with 1.
DIGITS = 0.5 * 10.0 ** (1 - export_module.DIGITS)
WHAT = """
    body_mass body_inertia body_ipos body_iquat
    jnt_axis dof_armature dof_damping dof_dampingpoly
    tendon_armature tendon_damping tendon_dampingpoly wrap_prm
    actuator_gainprm actuator_biasprm
    eq_data eq_solref eq_solimp
    pair_friction pair_solref pair_solimp
    key_qpos key_qvel
    geom_contype geom_conaffinity geom_condim geom_priority
    geom_friction geom_solref geom_solimp
    mesh_face
"""
"""What an exported model must have as the one that is shown."""
OPTIONS = (
    "timestep",
    "integrator",
    "gravity",
    "cone",
    "impratio",
    "tolerance",
    "enableflags",
    "disableflags",
)
POSES = (
    "geom_xpos",
    "geom_xmat",
    "site_xpos",
    "site_xmat",
    "cam_xpos",
    "cam_xmat",
    "light_xpos",
    "light_xdir",
)


def move(
    path: pathlib.Path, scene: Scene, start: tuple[float, float] = START, duration: float = 1.0
) -> float:
    """Return the error of phi [rad] and u/a after a time [s] of an export."""
    model = mujoco.MjModel.from_xml_path(str(path))
    found = moved(model, scene, start, duration)
    return distance(found, exact(scene, found.time, *start), scene)


def moved(
    model: mujoco.MjModel, scene: Scene, start: tuple[float, float], duration: float
) -> Coordinates:
    """Return the state after a time [s] of nothing but mj_step from the keyframe."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    state = np.concatenate([data.qpos, data.qvel])
    assert np.allclose(state, initial_state(model, scene, *start), rtol=DIGITS, atol=0)
    mujoco.mj_step(model, data, round(duration / model.opt.timestep))
    assert not any(warning.number for warning in data.warning)
    return coordinates(model, data, scene)


def distance(one: Coordinates, other: Coordinates, scene: Scene) -> float:
    """Return how far two states are apart in phi [rad] or u/a."""
    return max(abs(one.phi[0] - other.phi[0]), abs(one.u[0] - other.u[0]) / scene.can.radius)


def assert_same(shown: mujoco.MjModel, path: pathlib.Path) -> None:
    """Check that an export has the numbers of the model that is shown, to its own digits.

    All is at the same places, also after a move.

    MuJoCo leaves out a number that is within 2e-16 of its default, as a force of 1e-16 N.
    """
    read = mujoco.MjModel.from_xml_path(str(path))
    for name in WHAT.split():
        found = getattr(read, name)
        assert np.allclose(found, getattr(shown, name), rtol=DIGITS, atol=1e-15), name
    for name in OPTIONS:
        found = getattr(read.opt, name)
        assert np.allclose(found, getattr(shown.opt, name), rtol=DIGITS, atol=1e-15), name
    after_export = moved_aside(read)
    as_shown = moved_aside(shown)
    # Places of up to 0.3 m, and five rotations by quaternions of rounded numbers. Axes of a mesh
    # that is round may be any: its vertices are compared.
    meshless = shown.geom_type != mujoco.mjtGeom.mjGEOM_MESH
    for name in POSES:
        difference = getattr(after_export, name) - getattr(as_shown, name)
        compared = difference[meshless] if name.startswith("geom") else difference
        assert np.abs(compared).max(initial=0.0) < 20 * DIGITS, name
    difference = vertices(read, after_export) - vertices(shown, as_shown)
    # Six digits of numbers below 0.1 m, which grow with the can, in single precision.
    size = shown.geom_rbound[~meshless].max(initial=0.0)
    assert np.abs(difference).max(initial=0.0) < 1e-5 * size


def vertices(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """Return where the vertices of all meshes are drawn, shape (vertices, 3)."""
    places = [np.empty((0, 3))]
    for geom in range(model.ngeom):
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
            mesh = model.mesh(model.geom_dataid[geom])
            first = mesh.vertadr[0]
            shape = model.mesh_vert[first : first + mesh.vertnum[0]]
            places.append(shape @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    return np.concatenate(places)


def moved_aside(model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qpos += 0.5
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return data


class Exported(NamedTuple):
    """An export: its file, the model that MuJoCo reads from it, and what it is an export of."""

    path: pathlib.Path
    model: mujoco.MjModel
    scene: Scene
    rolling: Rolling
    timestep: float

    def end(self) -> Coordinates:
        """Return the state after a second."""
        return moved(self.model, self.scene, START, 1.0)


@pytest.fixture
def exported(name: str, rolling: Rolling, portable: bool, tmp_path: pathlib.Path) -> Exported:
    """Export a scene, portably and plainly or in full."""
    scene = SCENES[name]
    path = tmp_path / "model.xml"
    timestep = others.timestep(name)
    how = {"timestep": timestep, "friction": FRICTION, "portable": portable}
    export(scene, path, *START, rolling, **how, looks="plain" if portable else "full")
    return Exported(path, mujoco.MjModel.from_xml_path(str(path)), scene, rolling, timestep)


each_case = pytest.mark.parametrize(("name", "rolling"), CASES)
portable_or_not = pytest.mark.parametrize("portable", [False, True])
portable_only = pytest.mark.parametrize("portable", [True])
full_only = pytest.mark.parametrize("portable", [False])


@portable_or_not
@each_case
def test_an_export_is_one_file_and_says_what_wrote_it(exported: Exported) -> None:
    text = exported.path.read_text()

    assert not re.search(r"\b(file|\w+dir)=|<include", text)
    assert f"Written by mjbeer: rolling={exported.rolling!r}" in text


@pytest.mark.slow
@portable_or_not
@each_case
def test_an_export_moves_as_exact_theory(exported: Exported) -> None:
    end = exported.end()

    truth = exact(exported.scene, end.time, *START)
    assert distance(end, truth, exported.scene) < TOLERANCE[exported.rolling]


@pytest.mark.slow
@full_only
@each_case
def test_a_full_export_is_the_model_that_is_shown_and_moves_as_it_does(exported: Exported) -> None:
    """They are apart by a hundredth of what RK4 misses, 4e-8 rad, at most."""
    setting = Setting(exported.rolling, timestep=exported.timestep, friction=FRICTION)
    spec = rolling_spec(exported.scene, setting, visuals=True)
    add_start(spec, exported.scene, *START)

    shown = spec.compile()

    assert_same(shown, exported.path)
    end = moved(shown, exported.scene, START, 1.0)
    assert distance(exported.end(), end, exported.scene) < 4e-10


@portable_only
@each_case
def test_a_portable_export_has_the_cameras_of_the_model_that_is_shown(exported: Exported) -> None:
    """In that model they are in a frame."""
    shown = rolling_spec(exported.scene, Setting(exported.rolling), visuals=True).compile()

    for camera in ("side", "quarter"):
        sight = exported.model.cam_mat0[exported.model.camera(camera).id]
        expected = shown.cam_mat0[shown.camera(camera).id]
        assert np.allclose(sight, expected, rtol=0, atol=1e-12)  # products of five rotations


@portable_only
@each_case
def test_a_portable_export_has_nothing_that_older_readers_do_not_know(exported: Exported) -> None:
    root = ET.parse(exported.path).getroot()

    assert not re.search(r"diagexact|colorspace|<frame", exported.path.read_text())
    assert not [light for light in root.iter("light") if "type" in light.attrib]


@portable_only
@each_case
def test_each_body_of_a_portable_export_has_a_mass_inertias_and_a_joint(exported: Exported) -> None:
    for body in ET.parse(exported.path).getroot().iter("body"):
        inertial = body.find("inertial")
        assert inertial is not None
        numbers = [inertial.attrib["mass"], *inertial.attrib["diaginertia"].split()]
        assert min(map(float, numbers)) > 0
        assert body.find("joint") is not None


@pytest.mark.parametrize("rolling", ROLLINGS)
def test_a_portable_export_has_damping_as_one_number(
    rolling: Rolling, tmp_path: pathlib.Path
) -> None:
    """MuJoCo 3.3 takes no more than that."""
    path = tmp_path / "model.xml"

    export(sliding(can=METAL, damping=1 / 3), path, *START, rolling, portable=True)

    damper = "fixed[@name='damper']" if rolling == "reduced" else "joint[@name='swing']"
    (element,) = ET.parse(path).getroot().iterfind(f".//{damper}")
    assert float(element.attrib["damping"]) == pytest.approx(1 / 3, rel=DIGITS)


class BothLooks(NamedTuple):
    """A plain and a full export of a scene."""

    folder: pathlib.Path
    plain: mujoco.MjModel
    full: mujoco.MjModel


@pytest.fixture
def both_looks(scene: Scene | Standing, tmp_path: pathlib.Path) -> BothLooks:
    models = {}
    for looks in LOOKS:
        path = tmp_path / f"{looks}.xml"
        export(scene, path, looks=looks)
        models[looks] = mujoco.MjModel.from_xml_path(str(path))
    return BothLooks(tmp_path, **models)


each_shape = pytest.mark.parametrize(
    "scene",
    [*SCENES.values(), standing(modes=5), frozen(fill=1.0), sliding(fill=0.01), standing(fill=0.9)],
    ids=repr,
)


@each_shape
@pytest.mark.parametrize("looks", LOOKS)
def test_the_numbers_of_an_export_have_the_same_digits(looks: str, both_looks: BothLooks) -> None:
    comment, rest = (both_looks.folder / f"{looks}.xml").read_text().split("-->")

    numbers = re.findall(r"[\d.]+", rest)

    digits = [len(number.replace(".", "").lstrip("0")) for number in numbers]
    assert "Written by mjbeer" in comment
    assert max(digits) == export_module.DIGITS


@each_shape
def test_a_plain_export_is_short(both_looks: BothLooks) -> None:
    """Its size was 398 kB, of which 390 kB were meshes."""
    path = both_looks.folder / "plain.xml"

    assert path.stat().st_size < 12e3
    # A 1e-17 would be the rounding of 0.
    assert not re.search(r"e-1[6-9]", path.read_text())
    assert both_looks.plain.nmesh <= 1
    assert both_looks.full.nmesh > both_looks.plain.nmesh


@each_shape
def test_a_plain_export_has_the_mechanics_of_a_full_one(both_looks: BothLooks) -> None:
    for name in set(WHAT.split()) - {"mesh_face"}:
        if not name.startswith("geom"):
            plain = getattr(both_looks.plain, name)
            assert np.array_equal(plain, getattr(both_looks.full, name)), name


@each_shape
def test_what_touches_is_the_same_in_a_plain_and_a_full_export(both_looks: BothLooks) -> None:
    touching_in_plain = both_looks.plain.geom_contype > 0
    touching_in_full = both_looks.full.geom_contype > 0

    for name in ("geom_size", "geom_pos", "geom_quat", "geom_friction"):
        plain = getattr(both_looks.plain, name)[touching_in_plain]
        full = getattr(both_looks.full, name)[touching_in_full]
        assert np.array_equal(plain, full), name


class Drawn(NamedTuple):
    """A tall can in a plain export, and which axis of its body is the can's."""

    model: mujoco.MjModel
    data: mujoco.MjData
    along: np.ndarray
    """The direction of the can's axis."""


@pytest.fixture(params=["standing", "frozen"])
def drawn(request: pytest.FixtureRequest, tmp_path: pathlib.Path) -> Drawn:
    path = tmp_path / "can.xml"
    if request.param == "standing":
        export(standing(can=TALL), path)
        axis = 2
    else:
        export(frozen(can=TALL), path, rolling="contact")
        axis = 1
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return Drawn(model, data, data.body("can").xmat.reshape(3, 3)[:, axis])


def test_a_plain_export_draws_the_wall_where_the_can_is(drawn: Drawn) -> None:
    wall = drawn.data.geom("can_wall")

    assert np.allclose(wall.xpos, drawn.data.geom("can").xpos, atol=1e-12)
    assert abs(wall.xmat.reshape(3, 3)[:, 2] @ drawn.along) == pytest.approx(1)


def test_a_plain_export_draws_the_wall_around_the_can(drawn: Drawn) -> None:
    width, half_length, _ = drawn.model.geom("can_wall").size

    assert TALL.radius < width < 1.1 * TALL.radius
    assert TALL.length / 2 < half_length < 1.1 * TALL.length / 2


def test_a_plain_export_draws_one_end_of_the_can(drawn: Drawn) -> None:
    """It is the bottom of a can that stands, and the far end of one that lies."""
    _, half_length, _ = drawn.model.geom("can_wall").size
    stands = abs(drawn.along[2]) > 0.9

    end = drawn.data.geom("can_end").xpos - drawn.data.geom("can_wall").xpos

    away = -half_length if stands else half_length
    assert end @ drawn.along == pytest.approx(away, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("radius", [1e-3, 1.0])
@pytest.mark.parametrize("make", [sliding, frozen])
def test_cans_of_every_size(
    make: Callable[..., Scene], radius: float, rolling: Rolling, tmp_path: pathlib.Path
) -> None:
    """Time goes as the root of the size, as do timestep and duration that are as hard to simulate.

    With the joints of a portable equality in the other order a row reaches 1 % of its force for a
    can of 1 mm.
    """
    scene = make(can=Can.sheet_metal(radius, 4 * radius, radius / 300))
    pace = math.sqrt(radius / 0.033)
    path = tmp_path / "model.xml"
    start = (START[0], START[1] / pace)

    export(scene, path, *start, rolling, timestep=1e-3 * pace, friction=FRICTION, portable=True)

    assert move(path, scene, start, 0.3 * pace) < TOLERANCE[rolling]


@pytest.mark.slow
@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("integrator", MUJOCO_INTEGRATORS)
def test_what_was_asked_for_arrives(
    integrator: str, rolling: Rolling, tmp_path: pathlib.Path
) -> None:
    scene = pendulum(-0.7, gravity=1.62)

    export(scene, tmp_path / "model.xml", 2.0, -3.0, rolling, integrator, 7.3e-4, 0.37)

    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    assert model.opt.integrator == getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    assert model.opt.timestep == 7.3e-4
    assert np.linalg.norm(model.opt.gravity) == scene.gravity
    assert all(model.pair_friction[:, 0] == 0.37)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (
            {"integrator": MJBEER_INTEGRATORS[0]},
            ParameterError,
            f"integrator must be one of 'Euler', .*; got '{MJBEER_INTEGRATORS[0]}'",
        ),
        (
            {"path": "x.XML"},
            ParameterError,
            r"the name of the MJCF file must end in \.xml, got 'x\.XML'",
        ),
        ({"path": "file/model.xml"}, OutputError, r"cannot write .*model\.xml"),
        (
            {"integrator": "discrete", "portable": True},
            ParameterError,
            "'Euler', 'implicitfast', 'RK4'; got 'discrete'",
        ),
        (
            {"scene": sliding(drag=0.1), "portable": True},
            UnsupportedError,
            "damping in proportion to the slip rate only",
        ),
        (
            {"scene": sliding(damping=Damping(cubic=1.0)), "portable": True},
            UnsupportedError,
            "damping in proportion to the slip rate only",
        ),
    ],
)
def test_what_cannot_be_written_is_refused(
    arguments: dict[str, object], error: type[Exception], message: str, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "file").touch()
    given = {"scene": frozen(), "path": "model.xml"} | arguments
    given["path"] = tmp_path / str(given["path"])

    with pytest.raises(error, match=message):
        export(**given)

    assert os.listdir(tmp_path) == ["file"]


# What the viewer shows


@pytest.mark.slow
@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_sensors_have_the_values_of_the_letters(name: str, rolling: Rolling) -> None:
    """So has the kinetic energy, which is left out where a constant force stands for a weight."""
    scene = SCENES[name]
    phi = 1.1
    phi_dot = -7.0
    model = rolling_spec(scene, Setting(rolling), visuals=True).compile()
    u, u_dot = scene.initial_axis(phi, phi_dot)
    data = mujoco.MjData(model)
    start = initial_state(model, scene, phi, phi_dot)
    data.qpos[:] = start[: model.nq]
    data.qvel[:] = start[model.nq :]

    mujoco.mj_forward(model, data)
    found = {model.sensor(i).name: float(data.sensor(i).data[0]) for i in range(model.nsensor)}
    if model.opt.enableflags & int(mujoco.mjtEnableBit.mjENBL_ENERGY):
        found["kinetic_energy"] = float(data.energy[1])

    expected = {"u": u, "phi": phi, "u_dot": u_dot, "phi_dot": phi_dot}
    if rolling != "reduced":
        expected["slip"] = 0.0
    if rolling == "contact":
        expected["lift"] = -1e-9 * scene.can.radius
    if (scene.attachment, rolling) != ("frozen", "reduced"):
        expected["kinetic_energy"] = float(
            kinetic_energy(scene, exact(scene, [0.0], phi, phi_dot))[0]
        )
    assert found.keys() == expected.keys()
    scale = max(abs(value) for value in expected.values())
    # A can in contact starts 1e-9 radii deep.
    allowed = 1e-8 if rolling == "contact" else ROUNDING
    assert found == pytest.approx(expected, rel=ROUNDING, abs=allowed * scale)


@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_a_model_that_is_not_shown_has_no_sensors(name: str, rolling: Rolling) -> None:
    assert build(SCENES[name], rolling).nsensor == 0


# What others make of portable exports


def test_the_oldest_mujoco_that_is_promised_is_the_one_that_is_tried() -> None:
    """3.3.1 to 3.3.3 do not know "cameraid" of the element global."""
    page = (others.CHECKOUT / "docs" / "portability.md").read_text()
    promised = re.findall(r"MuJoCo (?:from )?(3\.\d\.\d)", f"{page} {export.__doc__}")
    assert set(promised) == {others.OLDEST}
    assert f"mujoco=={others.OLDEST}" in BY_NAME[f"MuJoCo {others.OLDEST}"].requirements


@pytest.mark.costly
@pytest.mark.parametrize("name", BY_NAME)
def test_others_load_portable_exports_and_move_them_exactly(name: str) -> None:
    other = wanted_or_skip(name)
    found = others.errors(other)
    assert list(found) == others.cases()
    allowed = ALLOWED[other.precise]
    wrong = {
        case: error
        for case, error in found.items()
        if isinstance(error, str) or not error < allowed[case[1]]
    }
    assert not wrong


def wanted_or_skip(name: str) -> others.Other:
    """Return a tool that MJBEER_OTHERS names and that is here, or skip the test."""
    if name not in others.wanted():
        pytest.skip(f'MJBEER_OTHERS="{name}" or MJBEER_OTHERS=all in the environment runs this')
    try:
        BY_NAME[name].python()
    except others.AbsentError as error:
        pytest.skip(str(error))
    return BY_NAME[name]
