"""Exported MJCF: MuJoCo 4 loads it without mjbeer, it is the model that mjbeer builds, and moves as the paper says."""

import math
import os
import pathlib
import re
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer import Can, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import OutputError, ParameterError, UnsupportedError
from mjbeer.model import state
from mjbeer.model.build import compose
from mjbeer.model.engine import library
from mjbeer.model.export import export
from mjbeer.model.setting import INTEGRATORS, OWN, Setting
from mjbeer.theory.liquid import Damping
from tests.support.scenes import METAL, SCENES

pytestmark = pytest.mark.slow

START = 1.0, 0.5
FRICTION = 10.0
TIMESTEP = 1e-4
# RK4's own error after 1 s, in phi and u/a: 2e-9 rad for the hoop, which passes its bottom at 47 rad/s; the
# others are below 2e-12.
REDUCED = 1e-8
# The joint equality's softness is less than that: 2e-10 rad for the pendulum.
EQUALITY = 1e-8
# The contact's softness and the creep of its friction: 2e-7 rad for the hoop, 4e-9 for the others.
CONTACT = 1e-6
TOLERANCE = {"reduced": REDUCED, "equality": EQUALITY, "contact": CONTACT}
CASES = [
    (name, rolling)
    for name, scene in SCENES.items()
    for rolling in TOLERANCE
    if rolling == "reduced" or scene.can.mass > 0 or scene.attachment == "frozen"
]
PHYSICAL = (
    "body_mass", "body_inertia", "body_ipos", "body_pos", "body_parentid", "jnt_type", "jnt_axis", "jnt_bodyid",
    "dof_armature", "dof_damping", "dof_dampingpoly", "dof_frictionloss",
    "actuator_gainprm", "actuator_biasprm", "actuator_biastype",
    "eq_type", "eq_data", "eq_obj1id", "eq_obj2id", "eq_solref", "eq_solimp", "pair_dim", "pair_geom1", "pair_geom2",
    "pair_friction", "pair_solref", "pair_solimp", "pair_margin", "geom_contype", "geom_conaffinity",
)  # fmt: skip
OPTIONS = ("timestep", "integrator", "gravity", "cone", "solver", "impratio", "disableflags")
TENDONS = ("tendon_armature", "tendon_stiffness", "tendon_damping", "tendon_dampingpoly", "tendon_frictionloss")
ENERGY = int(mujoco.mjtEnableBit.mjENBL_ENERGY)
# MuJoCo normalizes quaternions whenever it compiles, which rounds once more.
QUATERNION = 2 * np.finfo(float).eps


def load(path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> mujoco.MjModel:
    """Load a file as a stranger to mjbeer would, from some other folder."""
    (path.parent / "elsewhere").mkdir()
    monkeypatch.chdir(path.parent / "elsewhere")
    return mujoco.MjModel.from_xml_path(str(path))


def step(model: mujoco.MjModel, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and states of a model that is stepped from its keyframe with nothing but MuJoCo."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    states = [np.concatenate([data.qpos, data.qvel])]
    for _ in range(round(duration / model.opt.timestep)):
        mujoco.mj_step(model, data)
        states.append(np.concatenate([data.qpos, data.qvel]))
    assert not any(warning.number for warning in data.warning)
    return model.opt.timestep * np.arange(len(states)), np.array(states)


def assert_moves_exactly(scene: Scene, model: mujoco.MjModel, tolerance: float, duration: float = 1.0) -> None:
    times, states = step(model, duration)
    motion, truth = state.read(model, scene, states, times), exact(scene, times, *START)
    assert np.abs(motion.phi - truth.phi).max() < tolerance
    assert np.abs(motion.u - truth.u).max() < tolerance * scene.can.radius


def assert_same_physics(model: mujoco.MjModel, built: mujoco.MjModel) -> None:
    for name in PHYSICAL:
        assert np.array_equal(getattr(model, name), getattr(built, name)), name
    for name in OPTIONS:
        assert np.array_equal(getattr(model.opt, name), getattr(built.opt, name)), name
    assert model.opt.enableflags & ~ENERGY == built.opt.enableflags
    # The tendons of the built model come first; the others only measure.
    for name in TENDONS:
        assert np.array_equal(getattr(model, name)[: built.ntendon], getattr(built, name)), name
        assert not getattr(model, name)[built.ntendon :].any(), name
    for name in ("body_quat", "body_iquat"):
        assert getattr(model, name) == pytest.approx(getattr(built, name), rel=0, abs=QUATERNION), name
    for i in range(built.npair):
        for geom in (int(built.pair_geom1[i]), int(built.pair_geom2[i])):
            for name in ("geom_type", "geom_size", "geom_pos", "geom_quat"):
                assert np.array_equal(getattr(model, name)[geom], getattr(built, name)[geom]), name


@pytest.mark.parametrize(("name", "rolling"), CASES)
def test_an_export_is_the_model_and_moves_exactly(
    name: str, rolling: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, path = SCENES[name], tmp_path / "new" / "model.xml"
    export(scene, path, *START, rolling, timestep=TIMESTEP, friction=FRICTION)
    assert not re.search(r"\b(file|\w+dir)=|<include", path.read_text())
    model = load(path, monkeypatch)
    built = compose(scene, Setting(rolling, timestep=TIMESTEP, friction=FRICTION), visuals=True).compile()
    assert_same_physics(model, built)
    assert [model.key(i).name for i in range(model.nkey)] == ["start"]
    start = state.start(built, scene, *START)
    assert np.array_equal(np.concatenate([model.key("start").qpos, model.key("start").qvel]), start)
    assert_moves_exactly(scene, model, TOLERANCE[rolling])


@pytest.mark.parametrize("rolling", TOLERANCE)
def test_an_export_has_damping_and_drag(rolling: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, path = sliding(can=METAL, damping=Damping(1e-3, 1 / 3, 1e-9), drag=1 / 7), tmp_path / "model.xml"
    export(scene, path, *START, rolling)
    model = load(path, monkeypatch)
    built = compose(scene, Setting(rolling), visuals=True).compile()
    assert_same_physics(model, built)
    assert built.tendon_damping.any() == built.tendon_dampingpoly.any() == (rolling == "reduced")
    assert built.dof_damping.any() == (rolling != "reduced")
    assert built.dof_dampingpoly.any()
    assert np.array_equal(model.wrap_prm[: built.nwrap], built.wrap_prm)
    data = mujoco.MjData(model)
    data.qvel[:] = np.linspace(1, 2, model.nv)
    mujoco.mj_forward(model, data)
    damped = {"slide"} | ({"phi"} if rolling == "reduced" else {"swing"})
    joints = state.places(model)
    assert {name for name in joints if data.qfrc_damper[joints[name]] != 0} == damped


@pytest.mark.parametrize("rolling", TOLERANCE)
@pytest.mark.parametrize("radius", [1e-3, 1.0])
@pytest.mark.parametrize("make", [sliding, frozen])
def test_cans_of_every_size(
    make: Callable[..., Scene], radius: float, rolling: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = make(can=Can.sheet_metal(radius, 4 * radius, radius / 300))
    # Time goes as the root of the size, and so do the timestep and the duration that are as hard to simulate.
    pace = math.sqrt(radius / 0.033)
    path = tmp_path / "model.xml"
    export(scene, path, *START, rolling, timestep=TIMESTEP * pace, friction=FRICTION)
    model = load(path, monkeypatch)
    built = compose(scene, Setting(rolling, timestep=TIMESTEP * pace, friction=FRICTION), visuals=True).compile()
    assert_same_physics(model, built)
    assert_moves_exactly(scene, model, TOLERANCE[rolling], 0.3 * pace)


@pytest.mark.parametrize(
    ("integrator", "incline"), [*((each, -0.7) for each in INTEGRATORS), ("RK4", 1e-17), ("RK4", 1.2)]
)
def test_what_was_asked_for_arrives(integrator: str, incline: float, tmp_path: pathlib.Path) -> None:
    # An incline of 1e-17 needs forces that MuJoCo takes for none and does not write.
    for scene in (sliding(incline, 0.37, METAL), frozen(incline), pendulum(incline, gravity=1.62), hoop(incline)):
        for rolling in TOLERANCE:
            export(scene, tmp_path / "model.xml", 2.0, -3.0, rolling, integrator, 7.3e-4, 0.37)
            model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
            assert model.opt.integrator == getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
            assert model.opt.timestep == 7.3e-4
            assert np.linalg.norm(model.opt.gravity) == scene.gravity
            assert all(model.pair_friction[:, 0] == 0.37)


def test_the_command_line_exports_in_degrees(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    said, meant = tmp_path / "said.xml", tmp_path / "meant.xml"
    words = "export hoop --incline 5 --phi0 30 --phi-dot0 -60 --rolling contact --timestep 2e-4 --friction 0.5"
    assert main([*words.split(), "--output", str(said)]) == 0
    assert capsys.readouterr() == ("", f"wrote {said}\n")
    export(hoop(math.radians(5)), meant, math.radians(30), math.radians(-60), "contact", "RK4", 2e-4, 0.5)
    assert said.read_text() == meant.read_text()


@pytest.mark.parametrize("digits", [6, 11])
def test_the_precision_that_mujoco_writes_with_is_restored(digits: int, tmp_path: pathlib.Path) -> None:
    c = library()
    before = c._mjPRIVATE__get_xml_precision()
    c._mjPRIVATE__set_xml_precision(digits)
    try:
        export(frozen(), tmp_path / "model.xml")
        assert c._mjPRIVATE__get_xml_precision() == digits
    finally:
        c._mjPRIVATE__set_xml_precision(before)


@pytest.mark.parametrize("name", OWN)
def test_an_integrator_of_mjbeer_s_is_refused_by_name(name: str, tmp_path: pathlib.Path) -> None:
    with pytest.raises(
        UnsupportedError, match=f"{name} is mjbeer's integrator, not MuJoCo's; export with one of Euler"
    ):
        export(frozen(), tmp_path / "model.xml", rolling="reduced", integrator=name)
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("name", ["x.urdf", "x.mjcf", "x", "x.XML"])
def test_a_file_of_another_format_is_refused(name: str, tmp_path: pathlib.Path) -> None:
    """MJCF under the name of a URDF would be read as URDF."""
    with pytest.raises(ParameterError, match=rf"MJCF is written: the file's name must end in \.xml, got '{name}'"):
        export(frozen(), tmp_path / name)
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_a_massless_can_around_a_sliding_load_is_refused(rolling: str, tmp_path: pathlib.Path) -> None:
    with pytest.raises(UnsupportedError, match="massless can with a sliding load exists only in rolling="):
        export(sliding(), tmp_path / "model.xml", rolling=rolling)
    assert not os.listdir(tmp_path)


def test_a_file_that_cannot_be_written_is_an_output_error(tmp_path: pathlib.Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=r"cannot write .*model\.xml"):
        export(frozen(), tmp_path / "file" / "model.xml")
    assert os.listdir(tmp_path) == ["file"]


def test_a_number_that_was_lost_on_the_way_is_found(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjbeer.model.export._DIGITS", 6)
    with pytest.raises(Exception, match="the MJCF written is not the model: body_mass is") as caught:
        export(frozen(), tmp_path / "model.xml")
    assert type(caught.value).__name__ == "MjbeerError"
    assert not os.listdir(tmp_path)
