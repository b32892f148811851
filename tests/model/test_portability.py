"""Portable exports: MuJoCo 3.3, MJX, mujoco_warp and dm_control load them, and they move as exact theory says.

The tests with other tools install them in build/others, and run only where MJBEER_OTHERS names the tools:
`MJBEER_OTHERS="MuJoCo 3.3" .venv/bin/python -m pytest tests/model/test_portability.py` takes half a minute the first
time; MJBEER_OTHERS=all downloads about 1.5 GB and takes half an hour. The names are those of `others.OTHERS`.
"""

import math
import pathlib
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjbeer import Can, MjbeerError, Scene, exact, frozen, hoop, pendulum, sliding
from mjbeer.cli.app import main
from mjbeer.exceptions import UnsupportedError
from mjbeer.model import portable, state
from mjbeer.model.export import export
from mjbeer.model.setting import ROLLINGS
from mjbeer.model.softness import effective_softness
from mjbeer.theory.liquid import Damping
from tests.support import others
from tests.support.others import BY_NAME, FRICTION, START
from tests.support.scenes import METAL, SCENES

pytestmark = pytest.mark.slow

DOCUMENT = others.CHECKOUT / "docs" / "portability.md"
# RK4's own error after 1 s: 4.2e-8 rad for the hoop at 0.25 ms, at most 8.4e-9 rad for the others at 1 ms.
REDUCED = 1e-7
# The softness of the equality adds up to 1.2e-8 rad: with an impedance of 0.9999 a row misses 1e-4 of its force, which
# the stiffness 4/h^2 turns into a residual of 1e-4 (g/a) h^2/4 = 1e-8 rad.
EQUALITY = 1e-7
# The contact's softness: its impedance of 0.999 misses ten times as much of its force, which is largest for the hoop,
# 1.8e-6 rad; the others have at most 6.9e-7 rad.
CONTACT = 5e-6
TOLERANCE = {"reduced": REDUCED, "equality": EQUALITY, "contact": CONTACT}
# In single precision each of 1000 to 4000 steps rounds phi and its rate by 6e-8 of their size: 1e-6 rad in all if the
# roundings are independent, and 1e-4 rad if they all have the same sign. The equality's residual is a difference of two
# angles, whose rounding the stiffness 4/h^2 multiplies. The depth of a contact, 1e-8 m, is the difference of heights of
# 0.03 m, which are rounded by 2e-9 m: its force has hardly a digit in each step, and is right on average only.
SINGLE = {"reduced": 1e-4, "equality": 1e-3, "contact": 1e-2}
ALLOWED = {True: TOLERANCE, False: SINGLE}
FAITHFUL = [name for name, other in BY_NAME.items() if other.faithful]


def move(path: pathlib.Path, scene: Scene, start: tuple[float, float] = START, duration: float = 1.0) -> float:
    """Return the error of phi [rad] after a time [s] in this MuJoCo."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    steps = round(duration / model.opt.timestep)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    assert not any(warning.number for warning in data.warning)
    times = np.array([0.0, steps * model.opt.timestep])
    last = state.read(model, scene, np.concatenate([data.qpos, data.qvel])[None], times[1:]).phi[0]
    return abs(last - exact(scene, times, *start).phi[-1])


@pytest.mark.parametrize(("name", "rolling"), others.cases())
def test_a_portable_export_does_without_what_others_refuse(name: str, rolling: str, tmp_path: pathlib.Path) -> None:
    path, scene = tmp_path / "model.xml", SCENES[name]
    export(scene, path, *START, rolling, timestep=others.timestep(name), friction=FRICTION, portable=True)
    text, root = path.read_text(), ET.parse(path).getroot()
    assert not re.search(r"diagexact|colorspace|<frame|<include|file=", text)
    assert not [light for light in root.iter("light") if "type" in light.attrib]
    bodies = list(root.iter("body"))
    assert bodies
    for body in bodies:
        inertial = body.find("inertial")
        assert inertial is not None
        assert float(inertial.attrib["mass"]) > 0
        assert all(float(number) > 0 for number in inertial.attrib["diaginertia"].split())
        assert body.find("joint") is not None
    assert text.startswith("<mujoco")
    assert f"Written by mjbeer: rolling={rolling!r}" in text
    assert move(path, scene) < TOLERANCE[rolling]


@pytest.mark.parametrize("name", ["sliding, metal can", "frozen", "pendulum", "hoop"])
def test_a_portable_export_looks_like_an_ordinary_one(name: str, tmp_path: pathlib.Path) -> None:
    ordinary, other = tmp_path / "ordinary.xml", tmp_path / "portable.xml"
    export(SCENES[name], ordinary, *START, "contact")
    export(SCENES[name], other, *START, "contact", portable=True)
    first, second = (mujoco.MjModel.from_xml_path(str(path)) for path in (ordinary, other))
    for array in ("geom_rgba", "geom_matid", "geom_size", "geom_dataid", "mesh_vert", "cam_mode", "light_type"):
        assert np.array_equal(getattr(first, array), getattr(second, array)), array
    pictures = []
    for model in (first, second):
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        pictures.append(np.concatenate([data.geom_xpos.ravel(), data.geom_xmat.ravel(), data.cam_xpos.ravel()]))
    # Poses are multiplied in another order, which rounds them a few times by 1e-16 of up to 4 m.
    assert np.abs(pictures[0] - pictures[1]).max() < 1e-14


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("radius", [1e-3, 1.0, 10.0, 100.0])
@pytest.mark.parametrize("make", [sliding, frozen])
def test_portable_cans_of_every_size(
    make: Callable[..., Scene], radius: float, rolling: str, tmp_path: pathlib.Path
) -> None:
    # Time goes as the root of the size, and so do the timestep and the duration that are as hard to simulate.
    scene, pace = make(can=Can.sheet_metal(radius, 4 * radius, radius / 300)), math.sqrt(radius / 0.033)
    path, start = tmp_path / "model.xml", (START[0], START[1] / pace)
    export(scene, path, *start, rolling, timestep=1e-3 * pace, friction=FRICTION, portable=True)
    assert move(path, scene, start, 0.3 * pace) < TOLERANCE[rolling]


@pytest.mark.parametrize("radius", [1e-3, 0.033, 0.99, 1.0, 100.0])
@pytest.mark.parametrize("make", [sliding, frozen])
def test_a_portable_equality_is_about_as_hard_as_it_can_be(
    make: Callable[..., Scene], radius: float, tmp_path: pathlib.Path
) -> None:
    """With its joints in the other order, a row would reach 1 % of its force for a can of 1 mm, 61 % for 100 m."""
    scene = make(can=Can.sheet_metal(radius, 4 * radius, radius / 300))
    export(scene, tmp_path / "model.xml", *START, "equality", portable=True)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    softness = effective_softness(model, np.concatenate([model.key("start").qpos, model.key("start").qvel]))
    assert softness is not None
    # 1e-4 with the exact diagonal. The sum of the joints' inverse inertias leaves out that the load couples them, a
    # factor of up to 1.9 here.
    assert 1 - softness.effective_impedance < 2e-4


def test_the_check_finds_what_a_portable_export_has_lost(
    tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rewrite = portable.rewrite

    def expect(message: str, lose: Callable[[str], str]) -> None:
        monkeypatch.setattr(portable, "rewrite", lambda text: lose(rewrite(text)))
        with pytest.raises(MjbeerError, match=f"the MJCF written is not the model: {message}"):
            export(frozen(can=METAL), tmp_path / "model.xml", *START, "contact", friction=2.0, portable=True)

    expect("body_mass is", lambda text: re.sub(r'mass="0\.2\d*"', 'mass="0.2"', text))
    expect("geom_xpos is", lambda text: re.sub(r'(name="load"[^>]*) pos="[^"]*"', r'\1 pos="0 0 1"', text))
    expect("geom_xmat is", lambda text: re.sub(r'(name="board"[^>]* quat=")[^"]*"', r'\1 1 0 0 0"', text))
    expect("cam_xpos is", lambda text: re.sub(r'(<camera name="side"[^>]*) pos="[^"]*"', r"\1", text))
    expect("light_xdir is", lambda text: re.sub(r' dir="[^"]*"', "", text))
    expect("pair_friction is", lambda text: text.replace('friction="2 2"', 'friction="3 3"'))
    expect("option timestep is", lambda text: text.replace('timestep="0.001"', 'timestep="0.002"'))
    assert not list(tmp_path.iterdir())


def test_an_edited_template_keeps_its_looks(copy: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """Nested frames, lights and classes in a body without a joint: the export itself compares where everything is."""
    template = copy / "frozen.xml"
    more = """<body name="load" childclass="visual">
          <light dir="1 0 -1" pos="0 1 2"/>
          <site pos="0.01 0 0"/>
          <frame pos="0 0 0.1" euler="10 20 30">
            <geom type="sphere" size="0.01" rgba="1 0 0 1"/>
            <frame euler="0 0 45"><camera pos="0 0 1"/><light/></frame>
          </frame>"""
    template.write_text(template.read_text().replace('<body name="load">', more))
    for rolling in ROLLINGS:
        export(frozen(), tmp_path / "model.xml", *START, rolling, portable=True)
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
        assert (model.nbody, model.nlight, model.ncam) == (2, 3, 4)
        assert not model.geom_contype.any()
        assert move(tmp_path / "model.xml", frozen()) < TOLERANCE[rolling]


@pytest.mark.parametrize("rolling", ROLLINGS)
def test_a_portable_export_has_damping_in_proportion(rolling: str, tmp_path: pathlib.Path) -> None:
    """As one number, which is all that MuJoCo 3.3 takes."""
    scene, path = sliding(can=METAL, damping=1 / 3), tmp_path / "model.xml"
    export(scene, path, *START, rolling, portable=True)
    kind, name = ("fixed", "damper") if rolling == "reduced" else ("joint", "swing")
    (damper,) = (each for each in ET.parse(path).getroot().iter(kind) if each.get("name") == name)
    assert float(damper.attrib["damping"]) == 1 / 3


@pytest.mark.parametrize("scene", [sliding(drag=0.1), sliding(damping=Damping(cubic=1.0))])
def test_what_others_do_not_damp_is_refused(scene: Scene, tmp_path: pathlib.Path) -> None:
    with pytest.raises(UnsupportedError, match="damping in proportion to the slip rate only"):
        export(scene, tmp_path / "model.xml", portable=True)
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize("integrator", ["discrete", "implicit"])
def test_an_integrator_that_others_lack_is_refused(integrator: str, tmp_path: pathlib.Path) -> None:
    with pytest.raises(UnsupportedError, match=f"one of the integrators Euler, implicitfast, RK4, not {integrator}"):
        export(frozen(), tmp_path / "model.xml", integrator=integrator, portable=True)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("integrator", portable.INTEGRATORS)
@pytest.mark.parametrize("rolling", ROLLINGS)
def test_every_integrator_of_a_portable_export_is_stable(integrator: str, rolling: str, tmp_path: pathlib.Path) -> None:
    export(pendulum(), tmp_path / "model.xml", *START, rolling, integrator, friction=FRICTION, portable=True)
    # Semi-implicit Euler's own error at 1 ms is 1e-2 rad after a second; what explodes is off by radians.
    assert move(tmp_path / "model.xml", pendulum()) < (TOLERANCE[rolling] if integrator == "RK4" else 0.05)


def test_the_command_line_exports_what_the_function_does(tmp_path: pathlib.Path) -> None:
    said, meant = tmp_path / "said.xml", tmp_path / "meant.xml"
    assert main(["export", "hoop", "--rolling", "contact", "--portable", "--output", str(said)]) == 0
    export(hoop(), meant, math.radians(60), 0.0, "contact", portable=True)
    assert said.read_text() == meant.read_text()


@pytest.mark.parametrize("name", FAITHFUL)
def test_others_load_portable_exports_and_move_them_exactly(name: str) -> None:
    other = wanted_or_skip(name)
    found = others.errors(other)
    assert list(found) == others.cases()
    wrong = {
        case: error
        for case, error in found.items()
        if isinstance(error, str) or not error < ALLOWED[other.precise][case[1]]
    }
    assert not wrong


def test_mujoco_3_refuses_what_is_not_portable() -> None:
    """Or `--portable` would not be needed."""
    found = others.errors(wanted_or_skip("MuJoCo 3.3"), portable=False)
    for (_, rolling), error in found.items():
        assert (rolling == "reduced") == isinstance(error, float), error
        assert isinstance(error, float) or "diagexact" in str(error)


def wanted_or_skip(name: str) -> others.Other:
    """Return a tool that MJBEER_OTHERS names and that is here, or skip the test."""
    if name not in others.wanted():
        pytest.skip(f'MJBEER_OTHERS="{name}" or MJBEER_OTHERS=all in the environment runs this')
    try:
        BY_NAME[name].python()
    except others.AbsentError as error:
        pytest.skip(str(error))
    return BY_NAME[name]


def test_an_unknown_tool_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MJBEER_OTHERS", "MuJoCo 3.3, MuJoCo 2")
    with pytest.raises(ValueError, match="MJBEER_OTHERS names 'MuJoCo 2'; allowed are all, or some of MuJoCo 4, "):
        others.wanted()


def test_the_table_of_the_document_is_within_these_tolerances() -> None:
    rows = [line.strip("| ").split(" | ") for line in DOCUMENT.read_text().splitlines() if line.startswith("| ")]
    numbers = {row[0]: row[1:7] for row in rows if row[0] in BY_NAME and len(row) > len(ROLLINGS * 2)}
    assert list(numbers) == list(BY_NAME)
    for name in FAITHFUL:
        for rolling, number in zip(ROLLINGS * 2, numbers[name], strict=True):
            assert float(number) < ALLOWED[BY_NAME[name].precise][rolling], (name, rolling)
