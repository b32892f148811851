"""Cans that are free in space: how one is attached to another world, what it says of it, and what is refused.

What the models do is measured in `studies/validation/standing.py`, whose rows are tests too.
"""

import math
import pathlib
import warnings

import mujoco
import numpy as np
import pytest

from mjbeer import (
    Can,
    Load,
    Scene,
    UntrustedWarning,
    attach,
    build,
    exact,
    export,
    frozen,
    pendulum,
    sliding,
    specify,
    standing,
)
from mjbeer.cli.app import main
from mjbeer.drawing.viewer import Player
from mjbeer.exceptions import MjbeerError, ParameterError, TemplateError, UnsupportedError
from mjbeer.model import free, looks
from mjbeer.model.export import present_standing
from mjbeer.model.setting import Setting
from mjbeer.studies.validation import standing_checks as measured
from tests.support.scenes import METAL

PLANE = mujoco.mjtGeom.mjGEOM_PLANE
BOX = Can.sheet_metal(0.1, 0.3, 1e-3)


def world(**options: object) -> mujoco.MjSpec:
    """A level floor."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_geom(name="floor", type=PLANE, size=[0, 0, 1])
    for name, value in options.items():
        setattr(spec.option, name, value)
    return spec


def settled(spec: mujoco.MjSpec, duration: float = 1.0) -> mujoco.MjData:
    """The state after a while."""
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, round(duration / model.opt.timestep))
    assert not any(warning.number for warning in data.warning)
    return data


@pytest.mark.parametrize("fill", [0.1, 0.5, 1.0])
def test_a_lying_can_has_the_inertia_of_its_parts(fill: float) -> None:
    """Against a mesh of the beer; and a can's wall and ends against their sum."""
    vertices, faces = looks.beer(fill, METAL.radius, METAL.length)
    spec = mujoco.MjSpec()
    exactly = mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT
    spec.add_mesh(name="beer", uservert=vertices.ravel(), userface=faces.ravel(), inertia=exactly)
    spec.worldbody.add_body(name="beer").add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="beer", density=1000)
    spec.worldbody.add_body(name="can").add_body(name="load")
    free.lie(spec.body("can"), spec.body("load"), frozen(fill=fill, can=METAL))
    model = spec.compile()
    # The mesh is a polygon of 256 edges, and short of the circle by 6e-4.
    assert np.sort(model.body("load").inertia) == pytest.approx(np.sort(model.body("beer").inertia), rel=2e-3)
    sheet = 2 * math.pi * METAL.radius * 0.27
    wall, end = sheet * METAL.length, sheet * METAL.radius / 2
    across = wall * (METAL.radius**2 / 2 + METAL.length**2 / 12) + 2 * end * (METAL.radius**2 + METAL.length**2) / 4
    assert free.transverse_inertia(METAL) == pytest.approx(across, rel=1e-12)
    assert free.transverse_inertia(Can.hoop()) == pytest.approx(Can.hoop().inertia / 2 + 0.05 * 0.12**2 / 12, rel=1e-12)


def test_cans_are_attached_and_stand_and_lie() -> None:
    """On a plane and on a box, with nothing to be said about the parent, and under names of their own."""
    spec = world()
    spec.worldbody.add_geom(name="table", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.1], pos=[1, 0, 0.1])
    with pytest.raises(ParameterError, match="has a can of this prefix already"):
        attach(twice := world(), standing()), attach(twice, standing())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert attach(spec, standing(modes=2)).name == "can-can"
        attach(spec, standing("honey", damping_ratio=0.3), [1, 0, 0.2], prefix="honey-")
        attach(spec, sliding(can=METAL), [-0.5, 0, METAL.radius], prefix="lying-")
        data = settled(spec)
    # MuJoCo's default contact lets a can sink by some 0.4 mm, and a hard one by nothing.
    for name, place, depth in (
        ("can", [0, 0, 0], 1e-3),
        ("honey", [1, 0, 0.2], 1e-3),
        ("lying", [-0.5, 0, 0.033], 1e-6),
    ):
        assert data.body(f"{name}-can").xpos == pytest.approx(place, abs=depth)
        assert abs(data.body(f"{name}-can").xmat[8] - 1) < 1e-6
    assert data.sensor("can-slosh2_up").data == pytest.approx([0, 0, 1], abs=1e-6)
    assert data.sensor("can-slosh1_rise").data[:2] == pytest.approx([0, 0], abs=1e-6)


def test_the_sensors_tell_the_slosh() -> None:
    """A can that is held at a tilt: the pendulum is plumb, and the surface rises where it goes down."""
    can, tilt = standing(), 0.1
    model = build(can, free=False)
    model.body("can").quat = [math.cos(tilt / 2), 0, math.sin(tilt / 2), 0]
    data = mujoco.MjData(model)
    data.joint("slosh1").qpos = [math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0]
    mujoco.mj_forward(model, data)
    # About +y the side at +x goes down, and there the level surface is nearer to the rim.
    assert data.sensor("slosh1_up").data == pytest.approx([-math.sin(tilt), 0, math.cos(tilt)])
    assert data.sensor("slosh1_rise").data[:2] == pytest.approx([can.elevations()[0] * math.sin(tilt), 0])


def test_a_can_may_be_fixed_to_a_body() -> None:
    spec = world()
    spec.worldbody.add_body(name="gripper", pos=[0, 0, 1]).add_geom(size=[0.01] * 3)
    attach(spec, standing(), [0, 0, -0.5], prefix="held-", free=False, body="gripper")
    model = spec.compile()
    assert [model.joint(place).name for place in range(model.njnt)] == ["held-slosh1"]
    assert build(standing(), free=False).njnt == 1
    assert specify(standing(modes=0), visuals=True).body("slosh1") is None


@pytest.mark.parametrize(
    ("can", "options", "reason"),
    [
        (standing(), {"timestep": 0.05}, r"the timestep of 0\.05 s is coarse: the fastest mode turns by 1\.2 rad"),
        (standing(), {"gravity": [0, 0, -1.62]}, r"gravity is 1\.62 m/s\^2, and the can is made for 9\.81"),
        (standing(), {"disableflags": int(mujoco.mjtDisableBit.mjDSBL_CONTACT)}, "contact disabled it touches nothing"),
        (frozen(can=METAL), {"integrator": mujoco.mjtIntegrator.mjINT_IMPLICITFAST}, "another integrator than RK4"),
    ],
)
def test_what_the_parent_spoils_is_said(can: Scene, options: dict[str, object], reason: str) -> None:
    spec = world(**options)
    with pytest.warns(UntrustedWarning, match=f"the parent's options spoil the can: .*{reason}"):
        attach(spec, can)
    for name, value in options.items():  # and left as it is
        assert np.array_equal(getattr(spec.option, name), value)


@pytest.mark.parametrize(
    ("can", "arguments", "error", "message"),
    [
        ("can", {}, ParameterError, "can must be a Standing, got 'can'"),
        (standing(), {"body": "hand"}, ParameterError, "body must be one of 'world'; got 'hand'"),
        (standing(), {"body": "hand", "free": False}, ParameterError, "body must be one of 'world'; got 'hand'"),
        (standing(), {"pos": [0, 0]}, ParameterError, "pos must have 3 numbers, got"),
        (standing(), {"quat": [0, 0, 0, 0]}, ParameterError, "quat must have 4 numbers, not all 0, got"),
        (standing(), {"prefix": ""}, ParameterError, "prefix must be a text that is not empty"),
        (sliding(), {}, UnsupportedError, "without mass and inertia around a sliding load"),
        (pendulum(), {}, UnsupportedError, "has beer in it, got a load without a fill"),
        (sliding(can=METAL, drag=0.1), {}, UnsupportedError, "no drag of the air"),
    ],
)
def test_what_cannot_be_attached_is_refused(
    can: object, arguments: dict[str, object], error: type[MjbeerError], message: str
) -> None:
    with pytest.raises(error, match=message):
        attach(world(), can, **arguments)


@pytest.mark.parametrize(("name", "value"), [("rolling", "contact"), ("friction", 0.5), ("phi0", 1.0)])
def test_a_standing_can_does_not_roll(name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=f"a standing can has no {name}, got"):
        build(standing(), **{name: value})


def test_a_massless_frozen_can_and_other_sizes_move_too() -> None:
    light = Scene(Can(), Load.segment(), 0.0, "frozen")
    spec = world()
    attach(spec, light, [0, 0, Can().radius])
    attach(spec, standing(can=BOX, fill=0.3, modes=5), [1, 0, 0], prefix="large-")
    data = settled(spec, 0.3)
    assert data.body("can-can").xpos[2] == pytest.approx(Can().radius, abs=1e-6)
    for depth in (0.06, 3.0, 40.0):  # what MuJoCo cannot move it refuses
        for ratio in (0.0, 1.0):
            build(standing("water", 0.5, Can.sheet_metal(length=0.066 * depth), 5, ratio))


def test_a_template_that_lacks_something_is_named(copy: pathlib.Path) -> None:
    path = copy / "standing.xml"
    path.write_text(path.read_text().replace('name="beer_top"', ""))
    with pytest.raises(TemplateError, match=r"standing\.xml has no geom named 'beer_top'"):
        build(standing(), visuals=True)


# Templates and exports

ARRAYS = (
    "body_mass",
    "body_inertia",
    "body_ipos",
    "body_pos",
    "dof_damping",
    "dof_dampingpoly",
    "key_qpos",
    "site_pos",
)
GEOMS = ("can", "beer", "beer_top")
WRITTEN = 1e-12
"""Numbers in the templates have 13 digits."""


def test_the_template_of_a_standing_can_is_the_model() -> None:
    template = mujoco.MjModel.from_xml_path(str(looks.folder() / "standing.xml"))
    made = present_standing(standing(), True, Setting()).compile()
    for name in (*ARRAYS, "geom_size", "geom_pos", "geom_friction", "geom_solref", "geom_priority"):
        if name.startswith("geom"):  # the floor is made last
            pairs = [(getattr(template.geom(each), name[5:]), getattr(made.geom(each), name[5:])) for each in GEOMS]
        else:
            pairs = [(getattr(template, name), getattr(made, name))]
        for written, other in pairs:
            assert np.allclose(written, other, rtol=WRITTEN, atol=1e-15), name
    assert [template.sensor(place).name for place in range(2)] == ["slosh1_up", "slosh1_rise"]


def test_the_template_of_a_lying_can_is_the_model_and_rolls_as_theory_says() -> None:
    template = mujoco.MjModel.from_xml_path(str(looks.folder() / "lying.xml"))
    spec, scene = world(timestep=1e-3), sliding(can=METAL)
    attach(spec, scene)
    made = spec.compile()
    for name in ("mass", "inertia", "ipos"):
        for body in ("can", "load"):
            written, other = getattr(template.body(body), name), getattr(made.body(f"can-{body}"), name)
            assert np.allclose(written, other, rtol=WRITTEN, atol=1e-15), (body, name)
    assert np.allclose(template.geom("can").solref, made.geom("can-can").solref)
    data = mujoco.MjData(template)
    for key, phi0 in (("level", -scene.incline), ("swing", 1.0)):
        mujoco.mj_resetDataKeyframe(template, data, template.key(key).id)
        start = data.joint("free").qpos[:3].copy()
        mujoco.mj_step(template, data, 1500)
        u = exact(scene, [0.0, data.time], phi0).u
        # The promise of the templates, 1e-3 rad.
        assert np.linalg.norm(data.joint("free").qpos[:3] - start) == pytest.approx(
            u[1] - u[0], abs=1e-3 * METAL.radius
        )


@pytest.mark.slow
@pytest.mark.parametrize("portable", [False, True])
def test_a_standing_can_is_exported(portable: bool, tmp_path: pathlib.Path) -> None:
    """The export itself compares what it wrote; portable, it has only what MuJoCo 3.3 knows."""
    export(standing(modes=2), tmp_path / "can.xml", portable=portable, timestep=2e-3, integrator="implicitfast")
    text = (tmp_path / "can.xml").read_text()
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for key, highest in (("start", 1e-3), ("slosh", 1e-3), ("fall", METAL.radius)):
        mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
        mujoco.mj_step(model, data, 1500)
        assert -1e-3 < data.body("can").xpos[2] < highest
        assert (data.body("can").xmat[8] < 0.1) == (key == "fall")
    assert (model.dof_dampingpoly.any(), "frame " in text) == (not portable, not portable)
    export(standing(modes=0), tmp_path / "held.xml", free=False)
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "held.xml")).nq == 0


def test_the_command_line_exports_a_standing_can(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    said, meant = tmp_path / "said.xml", tmp_path / "meant.xml"
    words = "export standing --liquid water --fill 0.3 --length 0.15 --modes 2 --damping-ratio 0.01 --timestep 2e-3"
    assert main([*words.split(), "--portable", "--output", str(said)]) == 0
    can = standing("water", 0.3, Can.sheet_metal(length=0.15), 2, 0.01)
    export(can, meant, timestep=2e-3, portable=True)
    assert said.read_text() == meant.read_text()
    assert main(["simulate", "standing"]) == 2
    assert "the scene after simulate must be one of" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["export", "standing", "--help"])
    assert "--damping-ratio" in capsys.readouterr().out


def test_the_viewer_s_model_of_a_standing_can_starts() -> None:
    player = Player(present_standing(standing(), True, Setting()).compile())
    player.press(32)
    player.advance(0.01)
    assert player.data.time > 0


@pytest.mark.slow
def test_the_rows_find_a_wrong_model(monkeypatch: pytest.MonkeyPatch) -> None:
    """Modes left out at their bobs instead of their pivots, and no breaking waves."""
    can, other = measured.water(2, 0.45), measured.water(2, 0.55)
    # Differences of a step of 1e-4 give the model's stiffness to 1e-8, and errors of 2e-3 to 1e-5 of themselves.
    assert measured.reaction_errors(can) == pytest.approx(measured.left_out(can), rel=1e-4)
    moments = other.fixed_moments()
    monkeypatch.setattr(type(can), "fixed_moments", lambda self: moments - [0, moments[1], 0])
    assert measured.reaction_errors(other) != pytest.approx(measured.left_out(other), rel=0.1)
    monkeypatch.undo()
    monkeypatch.setattr(free, "_BREAKING", 0.0)
    assert measured.thrown(measured.water(3), 5e-3, count=40) > 0
