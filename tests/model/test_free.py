"""Cans that are free in space: their masses, sensors, templates and exports.

What the models do is measured in `studies/validation/standing_checks.py`, whose rows are tests too.
"""

import math
import pathlib

import mujoco
import numpy as np
import pytest

from mjbeer import Can, attach, build, exact, export, frozen, sliding, standing, wall_rise
from mjbeer.cli.app import main
from mjbeer.exceptions import ParameterError, TemplateError
from mjbeer.model import beer_mesh, free_numbers, setting
from mjbeer.studies.validation import standing_checks as measured
from tests.support.scenes import METAL


@pytest.mark.parametrize("fill", [0.1, 0.5, 1.0])
def test_a_lying_can_has_the_inertia_of_its_parts(fill: float) -> None:
    """Against a mesh of the beer; and a can's wall and ends against their sum."""
    vertices, faces = beer_mesh.beer(fill, METAL.radius, METAL.length)
    spec = mujoco.MjSpec()
    exactly = mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT
    spec.add_mesh(name="beer", uservert=vertices.ravel(), userface=faces.ravel(), inertia=exactly)
    spec.worldbody.add_body(name="beer").add_geom(
        type=mujoco.mjtGeom.mjGEOM_MESH, meshname="beer", density=1000
    )
    model = spec.compile()
    inertia = free_numbers.lying_parameters(frozen(fill=fill, can=METAL))[
        "inertial load", "diaginertia"
    ]
    # The mesh is a polygon of 256 edges, and short of the circle by 6e-4.
    assert np.sort(inertia) == pytest.approx(np.sort(model.body("beer").inertia), rel=2e-3)
    sheet = 2 * math.pi * METAL.radius * 0.27
    wall = sheet * METAL.length
    end = sheet * METAL.radius / 2
    across = (
        wall * (METAL.radius**2 / 2 + METAL.length**2 / 12)
        + 2 * end * (METAL.radius**2 + METAL.length**2) / 4
    )
    assert free_numbers.transverse_inertia(METAL) == pytest.approx(across, rel=1e-12)
    assert free_numbers.transverse_inertia(Can.hoop()) == pytest.approx(
        Can.hoop().inertia / 2 + 0.05 * 0.12**2 / 12, rel=1e-12
    )


def test_the_sensors_tell_the_slosh() -> None:
    """A can that is held at a tilt: the pendulum is plumb."""
    can = standing()
    tilt = 0.1
    model = build(can, free=False)
    model.body("can").quat = [math.cos(tilt / 2), 0, math.sin(tilt / 2), 0]
    data = mujoco.MjData(model)
    data.joint("slosh1").qpos = [math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0]
    mujoco.mj_forward(model, data)
    # About +y the side at +x goes down.
    assert data.sensor("slosh1_up").data == pytest.approx([-math.sin(tilt), 0, math.cos(tilt)])


@pytest.mark.parametrize("modes", [0, 1, 3])
def test_a_loop_is_told_how_high_the_liquid_rises(modes: int) -> None:
    """By the sensors, in any direction of a can at any place; a solid liquid does not rise."""
    can = standing(modes=modes)
    world = mujoco.MjSpec()
    attach(world, can, pos=[0.1, 0.2, 0.3], quat=[0.7, 0.1, -0.2, 0.5], prefix="a-")
    model = world.compile()
    data = mujoco.MjData(model)
    generator = np.random.default_rng(52)
    around = np.linspace(0, 2 * math.pi, 3601)
    surface = np.zeros_like(around)
    for mode, elevation in enumerate(can.elevations(), start=1):
        # MuJoCo normalizes it.
        data.joint(f"a-slosh{mode}").qpos = 0.1 * generator.normal(size=4) + [1, 0, 0, 0]
        mujoco.mj_forward(model, data)
        x, y, _ = data.sensor(f"a-slosh{mode}_up").data
        surface -= elevation * (x * np.cos(around) + y * np.sin(around))
    # The highest of points that are 2 pi/3600 apart misses the top by 4e-7 of it.
    assert wall_rise(model, data, "a-") == pytest.approx(surface.max(), rel=1e-6)
    assert (wall_rise(model, data, "a-") > 0) == (modes > 0)


def test_a_tilted_can_has_a_level_surface() -> None:
    """It rises by the sine of the tilt if all modes move: the sum of 2/(xi^2 - 1) is 1."""
    can = standing(modes=5)
    tilt = 0.2
    model = build(can, free=False)
    data = mujoco.MjData(model)
    for mode in range(1, 6):
        data.joint(f"slosh{mode}").qpos = [math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0]
    left_out = 1 - can.elevations(5).sum()
    assert 0 < left_out < 0.05
    assert wall_rise(model, data, "") == pytest.approx((1 - left_out) * math.sin(tilt), rel=1e-12)
    assert can.elevations(4000).sum() == pytest.approx(1, abs=1e-4)


def test_a_can_that_does_not_stand_has_no_rise() -> None:
    model = build(frozen())
    with pytest.raises(ParameterError, match="no standing can under the prefix ''"):
        wall_rise(model, mujoco.MjData(model), "")
    stands = build(standing())
    with pytest.raises(
        ParameterError, match="must be those of the model, of 11, got 1 coordinates"
    ):
        wall_rise(stands, mujoco.MjData(model), "")


@pytest.mark.filterwarnings("ignore::mjbeer.LiquidWarning")
@pytest.mark.parametrize(
    ("liquid", "fill", "modes", "ratio"),
    [
        ("honey", 0.02, 3, None),  # over-damped: it had 1.35 of its mass
        ("honey", 0.05, 1, None),
        ("glycerol", 0.016, 3, None),
        ("water", 0.014, 1, 1.0),
        (
            "water",
            0.014,
            1,
            0.99,
        ),  # damped so much that its bob, to be stable, would outweigh the liquid
        ("water", 0.1, 5, 0.99),
        ("honey", 0.5, 5, None),
    ],
)
def test_a_thick_liquid_has_its_mass(
    liquid: str, fill: float, modes: int, ratio: float | None
) -> None:
    """And its centre of mass, as theory has the model; and a fixed part, which is a body that
    MuJoCo can move."""
    can = standing(liquid, fill, modes=modes, damping_ratio=ratio)
    model = build(can)
    masses, heights = liquid_parts(model)
    mass, first, _ = can.total_moments()
    assert masses.sum() == pytest.approx(can.mass, rel=1e-12)  # sums of a few numbers
    assert mass == pytest.approx(can.mass, rel=1e-12)
    assert masses @ (heights - can.height / 2) == pytest.approx(
        first, rel=1e-9, abs=1e-12 * can.mass * can.height
    )
    assert model.body("liquid").mass[0] > 0.02 * can.mass
    assert model.body_inertia[1:].min() > 0


def liquid_parts(model: mujoco.MjModel) -> tuple[np.ndarray, np.ndarray]:
    """Return mass [kg] and height above the can's bottom [m] of all bodies of the liquid, at
    rest."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    bodies = [
        body for body in range(model.nbody) if model.body(body).name.startswith(("liquid", "slosh"))
    ]
    return model.body_mass[bodies], data.xipos[bodies, 2]


@pytest.mark.parametrize(
    ("name", "value"), [("rolling", "contact"), ("friction", 0.5), ("phi0", 1.0)]
)
def test_a_standing_can_does_not_roll(name: str, value: object) -> None:
    with pytest.raises(
        ParameterError, match=f"does not roll: it has none of .*, got .*{name!r}: {value!r}"
    ):
        build(standing(), **{name: value})


def test_a_number_that_would_be_overwritten_is_named(copy: pathlib.Path) -> None:
    path = copy / "mechanics" / "standing.xml"
    path.write_text(path.read_text().replace('damping="4.0', 'damping="8.0'))
    with pytest.raises(
        TemplateError, match=r"standing\.xml has numbers of its own in joint slosh1 damping, "
    ):
        build(standing())


def test_a_template_that_lacks_something_is_named(copy: pathlib.Path) -> None:
    path = copy / "looks" / "standing.xml"
    path.write_text(path.read_text().replace('name="beer_top"', ""))
    with pytest.raises(TemplateError, match="looks has no geom named 'beer_top'"):
        build(standing(), visuals=True)


# Templates and exports


def test_the_template_of_a_lying_can_is_the_model_and_rolls_as_theory_says() -> None:
    template = mujoco.MjModel.from_xml_path(str(setting.mjcf_folder() / "lying.xml"))
    spec = mujoco.MjSpec()
    scene = sliding(can=METAL)
    spec.option.timestep = 1e-3
    attach(spec, scene)
    made = spec.compile()
    for name in ("solref", "solimp", "solmix", "friction", "condim", "priority"):
        assert np.allclose(
            getattr(template.geom("can"), name), getattr(made.geom("can-can"), name)
        ), name
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
    """Portable, it has only what MuJoCo 3.3 knows."""
    export(
        standing(modes=2),
        tmp_path / "can.xml",
        portable=portable,
        timestep=2e-3,
        integrator="implicitfast",
    )
    text = (tmp_path / "can.xml").read_text()
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for joint, tilt, highest in (("slosh1", 0.12, 1e-3), ("free", 1.0, METAL.radius)):
        mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
        data.joint(joint).qpos[-4:] = [math.cos(tilt / 2), 0, math.sin(tilt / 2), 0]
        data.joint("free").qpos[2] = METAL.radius * math.sin(tilt) * (joint == "free")
        mujoco.mj_step(model, data, 1500)
        assert -1e-3 < data.body("can").xpos[2] < highest
        assert (data.body("can").xmat[8] < 0.1) == (joint == "free")  # it fell, as beyond tipping
    assert model.dof_dampingpoly.any() == (not portable)
    export(standing(modes=0), tmp_path / "held.xml", free=False)
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "held.xml")).nq == 0


def test_the_command_line_exports_a_standing_can(tmp_path: pathlib.Path) -> None:
    said = tmp_path / "said.xml"
    meant = tmp_path / "meant.xml"
    can = "standing --liquid water --fill 0.3 --length 0.15 --modes 2 --damping-ratio 0.01"
    words = f"export {can} --timestep 2e-3 --portable"
    assert main([*words.split(), "--output", str(said)]) == 0
    can = standing("water", 0.3, Can.sheet_metal(length=0.15), 2, 0.01)
    export(can, meant, timestep=2e-3, portable=True)
    assert said.read_text() == meant.read_text()


@pytest.mark.slow
def test_the_rows_find_a_wrong_model(monkeypatch: pytest.MonkeyPatch) -> None:
    """Modes left out at their bobs instead of their pivots, and no breaking waves."""
    can = measured.water(2, 0.45)
    other = measured.water(2, 0.55)
    # Differences of a step of 1e-4 give the model's stiffness to 1e-8, and errors of 2e-3 to 1e-5
    # of themselves.
    predicted = measured.predicted_reaction_errors(can)
    assert measured.reaction_errors(can) == pytest.approx(predicted, rel=1e-4)
    moments = other.total_moments()
    monkeypatch.setattr(type(can), "total_moments", lambda self: moments - [0, moments[1], 0])
    predicted = measured.predicted_reaction_errors(other)
    assert measured.reaction_errors(other) != pytest.approx(predicted, rel=0.1)
    monkeypatch.undo()
    monkeypatch.setattr(free_numbers, "BREAKING", 0.0)
    assert measured.thrown(measured.water(3), 5e-3, count=40) > 0
