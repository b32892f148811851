"""The README of the models says what is in them: names, counts and numbers are read from the compiled models."""

import math
import re
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer.model import looks

FOLDER = looks.folder()
TEXT = (FOLDER / "README.md").read_text()
NAMES = ("sliding", "frozen", "pendulum", "hoop")
MODELS = {name: mujoco.MjModel.from_xml_path(str(FOLDER / f"{name}.xml")) for name in NAMES}
TYPES = {mujoco.mjtJoint.mjJNT_SLIDE: "slide", mujoco.mjtJoint.mjJNT_HINGE: "hinge"}
MODES = {mujoco.mjtCamLight.mjCAMLIGHT_FIXED: "fixed", mujoco.mjtCamLight.mjCAMLIGHT_TRACK: "track"}
# Numbers are written as in the templates, with 13 digits.
WRITTEN = 1e-12


def table(heading: str) -> list[list[str]]:
    """Return the rows of the first table under a heading, without its head."""
    section = TEXT.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def quoted(cell: str) -> list[str]:
    return re.findall("`([^`]*)`", cell)


def named(cell: str) -> list[str]:
    """Return the models that a cell names."""
    return list(NAMES) if cell == "all" else quoted(cell)


def constraint(model: mujoco.MjModel, kind: str) -> float:
    array = getattr(model, f"eq_{kind}") if model.neq else getattr(model, f"pair_{kind}")
    return float(array[0, 0])


def tilt(model: mujoco.MjModel) -> float:
    return math.degrees(2 * math.asin(model.body("incline").quat[2]))


def vertices(model: mujoco.MjModel, name: str) -> np.ndarray:
    mesh = model.mesh(name)
    return model.mesh_vert[mesh.vertadr[0] : mesh.vertadr[0] + mesh.vertnum[0]]


VALUES: dict[str, Callable[[mujoco.MjModel], float]] = {
    "incline [degrees]": tilt,
    "gravity [m/s²]": lambda model: -float(model.opt.gravity[2]),
    "radius of the can, a [m]": lambda model: float(model.body("can").pos[2]),
    "length of the can, l [m]": lambda model: float(np.ptp(vertices(model, "can"), axis=0).max()),
    "mass of the can [kg]": lambda model: float(model.body("can").mass[0]),
    "inertia of the can [kg m²]": lambda model: float(model.body("can").inertia[1]),
    "mass of the load [kg]": lambda model: float(model.body("load").mass[0]),
    "depth of the load, b [m]": lambda model: -float(model.body("load").ipos[2]),
    "inertia of the load [kg m²]": lambda model: float(model.body("load").inertia[1]),
    "timestep [s]": lambda model: model.opt.timestep,
    "time constant of rolling [s]": lambda model: constraint(model, "solref"),
    "impedance of rolling": lambda model: constraint(model, "solimp"),
    "impratio": lambda model: model.opt.impratio,
    "friction coefficient": lambda model: float(model.pair_friction[0, 0]) if model.npair else math.nan,
}


def test_every_number_is_that_of_the_model_and_has_a_source() -> None:
    rows = table("The numbers")
    assert [row[0] for row in rows] == list(VALUES)
    for quantity, *written, source in rows:
        assert source
        for name, number in zip(NAMES, written, strict=True):
            found = VALUES[quantity](MODELS[name])
            # Vertices of meshes are in single precision.
            tolerance = 1e-6 if quantity.startswith("length") else WRITTEN
            expected = float(number) if number else math.nan
            assert found == pytest.approx(expected, rel=tolerance, abs=1e-15, nan_ok=True), (quantity, name)


def test_joints_are_those_of_the_models() -> None:
    rows = table("Joints")
    for name, model in MODELS.items():
        told = {quoted(joint)[0]: kind for joint, kind, _, models in rows if name in named(models)}
        assert told == {model.joint(i).name: TYPES[mujoco.mjtJoint(model.jnt_type[i])] for i in range(model.njnt)}, name


def test_cameras_are_those_of_every_model() -> None:
    told = {quoted(camera)[0]: mode for camera, mode, _ in table("Cameras")}
    for model in MODELS.values():
        assert told == {model.camera(i).name: MODES[mujoco.mjtCamLight(model.cam_mode[i])] for i in range(model.ncam)}


def test_what_is_drawn_is_what_the_models_have() -> None:
    rows = table("What is drawn")
    for name, model in MODELS.items():
        told = {quoted(geom)[0]: quoted(material)[0] for geom, material, _, models in rows if name in named(models)}
        geoms = [geom for geom in map(model.geom, range(model.ngeom)) if geom.group[0] == 2]
        assert told == {geom.name: model.mat(int(geom.matid[0])).name for geom in geoms}, name


def test_numbers_of_what_is_drawn_are_those_that_it_is_drawn_with() -> None:
    section = TEXT.split("\n## What is drawn\n")[1].split("\n## ")[0]
    assert f"{100 * looks.FOAM:g} % of the radius thick" in section
    assert f"{100 * looks.WALL:g} % of a radius lower" in section
    assert set(re.findall("`(\\w+)`", section.split("turned: no")[1])) == set(looks.TURNING)


def test_keyframes_are_those_of_the_models_and_start_there() -> None:
    told = [
        (quoted(model)[0], quoted(key)[0], float(phi), float(rate)) for model, key, phi, rate, _ in table("Keyframes")
    ]
    found = []
    for name, model in MODELS.items():
        data = mujoco.MjData(model)
        for key in range(model.nkey):
            mujoco.mj_resetDataKeyframe(model, data, key)
            mujoco.mj_forward(model, data)
            values = float(data.sensor("phi").data[0]), float(data.sensor("phi_dot").data[0])
            found.append((name, model.key(key).name, *values))
    assert [each[:2] for each in told] == [each[:2] for each in found]
    for one, other in zip(told, found, strict=True):
        assert one[2:] == pytest.approx(other[2:], rel=1e-5, abs=1e-12), one  # written with six digits


def test_sensors_are_those_of_the_models() -> None:
    rows = table("Sensors")
    for name, model in MODELS.items():
        told = {sensor for sensors, _, models in rows if name in named(models) for sensor in quoted(sensors)}
        assert told == {model.sensor(i).name for i in range(model.nsensor)}, name


def test_the_options_that_are_explained_are_those_that_are_set() -> None:
    """Those that differ from MuJoCo's defaults, apart from the timestep, which is among the numbers."""
    section = TEXT.split("\n## The options, and why\n")[1].split("\n## ")[0]
    told = set(re.findall(r'`(\w+)="(\w+)"`', section))
    found = set()
    for path in FOLDER.glob("*.xml"):
        for option in re.findall(r"<(?:option|flag) ([^>]*?)/?>", path.read_text()):
            found |= set(re.findall(r'(\w+)="(\w+)"', option))
    assert told == found


def test_mujoco_is_as_new_as_is_required() -> None:
    (required,) = re.findall(r"Requires MuJoCo (\d+)\.(\d+) or later", TEXT)
    assert tuple(map(int, required)) <= tuple(map(int, mujoco.__version__.split(".")[:2]))
    pyproject = (FOLDER.parent / "pyproject.toml").read_text()
    assert f'"mujoco>={required[0]}"' in pyproject


def test_every_model_is_there_and_has_a_picture() -> None:
    assert {path.stem for path in FOLDER.glob("*.xml")} == {*NAMES, "shared", "incline"}
    for name in NAMES:
        assert f"(../renders/{name}.webp)" in TEXT
        assert f"`{name}.xml`" in TEXT
