"""Models as built: the same equations of motion as theory, and nothing in them that a scene does not need."""

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Can, Load, Scene, build, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.model.build import compose
from mjbeer.model.setting import INTEGRATORS, ROLLINGS, Setting
from mjbeer.model.state import read, start
from mjbeer.theory.equations import accelerations
from tests.support.scenes import MASSIVE, METAL, SCENES, scenes

# Sums of a few products each, some of which cancel in part on a random scene.
ROUNDING = 1e-11


def forward(model: mujoco.MjModel, scene: Scene, phi: float, phi_dot: float) -> tuple[float, float]:
    """u_ddot and phi_ddot of MuJoCo's forward dynamics."""
    state = start(model, scene, phi, phi_dot)
    data = mujoco.MjData(model)
    data.qpos, data.qvel = np.split(state, 2)
    mujoco.mj_forward(model, data)
    moved = read(model, scene, np.concatenate([data.qvel, data.qacc])[None], times=np.zeros(1))
    return float(moved.u_dot[0]), float(moved.phi_dot[0])


@pytest.mark.slow
@settings(max_examples=200, deadline=None, derandomize=True)
@given(scenes(), st.floats(-3, 3), st.floats(-5, 5))
def test_reduced_accelerates_as_theory_says(scene: Scene, phi: float, swing: float) -> None:
    rate = swing * math.sqrt(scene.gravity / scene.can.radius)
    expected = [float(each) for each in accelerations(scene, np.float64(phi), np.float64(rate), 0.0)]
    u_ddot, phi_ddot = forward(build(scene), scene, phi, rate)
    scale = abs(expected[1]) + abs(expected[0]) / scene.can.radius + rate**2 + scene.gravity / scene.can.radius
    assert abs(phi_ddot - expected[1]) <= ROUNDING * scale
    assert abs(u_ddot - expected[0]) <= ROUNDING * scale * scene.can.radius


@pytest.mark.parametrize(
    "scene",
    [
        pendulum(),
        hoop(),
        *(each(fill=fill) for each in (sliding, frozen) for fill in (1e-2, 1 - 1e-6, 1 - 1e-12, 1.0)),
        *(each(fill=1e-6, can=METAL) for each in (sliding, frozen)),
        frozen(fill=1e-6),
        *(pendulum(wheel_mass=mass) for mass in (1e-7, 1e5)),
        *(hoop(hoop_mass=mass) for mass in (2e-7, 2e5)),
        *(each(can=Can.massless(size, size)) for each in (sliding, frozen) for size in (1e-6, 100.0)),
    ],
)
def test_reduced_extremes_accelerate_as_theory_says(scene: Scene) -> None:
    """Point loads, balanced ones, thin ones, cans 1e-6 and 1e6 of the load's mass, of 1 um and of 100 m."""
    expected = accelerations(scene, np.float64(0.7), np.float64(2.0), 0.0)
    assert forward(build(scene), scene, 0.7, 2.0) == pytest.approx([float(each) for each in expected], rel=ROUNDING)


def test_a_twin_with_another_chord_is_found_out() -> None:
    scene = frozen()
    wrong = build(scene)
    wrong.tendon_armature[:] *= 1 + 1e-9
    expected = accelerations(scene, np.float64(1.0), np.float64(2.0), 0.0)[1]
    assert abs(forward(wrong, scene, 1.0, 2.0)[1] / expected - 1) > ROUNDING


@pytest.mark.parametrize("name", MASSIVE)
@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_constrained_models_have_the_scene_s_mass_matrix(name: str, rolling: str) -> None:
    """Kinetic energy and weight of any state, slipping and lifting too, are those of can and load."""
    scene = SCENES[name]
    model = build(scene, rolling)
    data = mujoco.MjData(model)
    state = start(model, scene, 0.6, 1.7) * np.linspace(1, 2, model.nq + model.nv)
    data.qpos, data.qvel = np.split(state, 2)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    mujoco.mj_forward(model, data)
    moved = read(model, scene, state[None], times=np.zeros(1))
    can, load = scene.can, scene.load
    along = moved.u_dot - load.offset * np.cos(moved.phi) * moved.phi_dot
    across = moved.lift_dot + load.offset * np.sin(moved.phi) * moved.phi_dot
    kinetic = can.mass * (moved.u_dot**2 + moved.lift_dot**2) + can.inertia * moved.roll_dot**2
    kinetic += load.mass * (along**2 + across**2) + load.inertia * moved.phi_dot**2
    assert data.energy[1] == pytest.approx(kinetic[0] / 2, rel=1e-13)  # a dozen products


@pytest.mark.parametrize("name", SCENES)
def test_stepped_models_carry_nothing_they_do_not_need(name: str) -> None:
    model = build(SCENES[name])
    assert (model.ngeom, model.ncam, model.nlight, model.nmesh, model.nsensor, model.neq, model.nkey) == (0,) * 7
    assert model.nbody == 2
    for flag in ("CONTACT", "CONSTRAINT", "SENSOR", "AUTORESET"):
        assert model.opt.disableflags & getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")


def test_contact_has_two_geoms_and_one_pair() -> None:
    model = build(frozen(), "contact")
    assert (model.ngeom, model.npair, model.neq) == (2, 1, 0)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
@pytest.mark.parametrize("integrator", [*INTEGRATORS, "DOP853"])
def test_constraints_are_as_stiff_as_asked_for(rolling: str, integrator: str) -> None:
    """MuJoCo clamps a time constant under two timesteps unless refsafe is off."""
    model = compose(frozen(), Setting(rolling, integrator, timestep=2e-3)).compile()
    solref = model.eq_solref[0] if rolling == "equality" else model.pair_solref[0]
    stiff = 1e-3 if rolling == "equality" else 2e-3
    assert solref[0] == (stiff if integrator in ("RK4", "discrete", "DOP853") else 4e-3)
    assert model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_REFSAFE
    assert model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_DIAGEXACT


@pytest.mark.parametrize("name", MASSIVE)
def test_the_equality_is_rigid(name: str) -> None:
    """The accelerations are the theory's, which knows no softness, and those of the reduced model."""
    scene = SCENES[name]
    expected = accelerations(scene, np.float64(0.7), np.float64(2.0), 0.0)
    found = forward(build(scene, "equality"), scene, 0.7, 2.0)
    assert found == pytest.approx([float(each) for each in expected], rel=ROUNDING)


def test_the_equality_as_compiled_is_soft() -> None:
    """What the test above would say of solimp 0.9999: off by 1e-4 of the force."""
    scene = frozen()
    expected = accelerations(scene, np.float64(0.7), np.float64(2.0), 0.0)[1]
    soft = forward(compose(scene, Setting("equality")).compile(), scene, 0.7, 2.0)[1]
    assert 1e-5 < abs(soft / expected - 1) < 1e-3


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("rolling", ["reduced", "equality", "contact"])
def test_visuals_change_no_motion(name: str, rolling: str) -> None:
    """With geoms to look at and the incline tilted instead of gravity, accelerations agree to rounding."""
    scene = SCENES[name]
    if rolling != "reduced" and name not in MASSIVE:
        return
    bare, drawn = (forward(build(scene, rolling, visuals=each), scene, 0.8, 1.5) for each in (False, True))
    # A contact's normal comes from the tilt by a quaternion, and acts through a stiffness of 1e8 or so.
    assert drawn == pytest.approx(bare, rel=1e-6 if rolling == "contact" else ROUNDING)
    model = build(scene, rolling, visuals=True)
    assert {2, 3} >= set(model.geom_group.tolist()) >= {2}


def test_marks_of_the_can_turn_with_the_can_or_are_not_there() -> None:
    models = {rolling: build(pendulum(), rolling, visuals=True) for rolling in ROLLINGS}
    names = {rolling: {each.geom(i).name for i in range(each.ngeom)} for rolling, each in models.items()}
    assert {rolling: "can_mark" in found for rolling, found in names.items()} == {
        "reduced": False, "equality": True, "contact": True,
    }  # fmt: skip


@pytest.mark.parametrize("rolling", ["equality", "contact"])
@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (sliding(), 'massless can with a sliding load exists only in rolling="reduced"'),
        (Scene(Can(0.1, 0.1, 1.0, 0.0), Load.point(1.0, 0.05)), "can without inertia"),
        (Scene(Can.massless(), Load.point(1.0, 0.01), 0.1, "frozen"), "no inertia about its centre of mass"),
    ],
)
def test_what_mujoco_has_not_is_refused(rolling: str, scene: Scene, reason: str) -> None:
    with pytest.raises(UnsupportedError, match=reason):
        build(scene, rolling)


def test_what_mujoco_does_not_compile_is_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjbeer.model.build.mass_unit", lambda _: 1e-20)
    with pytest.raises(UnsupportedError, match=r"MuJoCo cannot represent this scene: .*mass and inertia"):
        build(frozen())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"rolling": "sliding"}, "rolling must be one of 'reduced', 'equality', 'contact'; got 'sliding'"),
        (
            {"integrator": "RK5"},
            "'Euler', 'implicit', 'implicitfast', 'discrete', 'RK4', 'DOP853', 'GaussJackson'; got 'RK5'",
        ),
        ({"timestep": 0}, r"timestep must be greater than 0 \[s\], got 0"),
        ({"timestep": math.nan}, "timestep must be a finite number"),
        ({"friction": -1}, "friction must be greater than 0, got -1"),
    ],
)
def test_bad_input_says_what_is_allowed(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        build(frozen(), **arguments)


def test_light_scenes_are_scaled_by_a_power_of_two() -> None:
    can = Can.massless(1e-6, 1e-6)
    model = build(Scene(can, Load.segment(1e-6, 1e-6), 0.1, "frozen"))
    assert math.log2(model.actuator_biasprm[0, 0] / (model.opt.gravity[0] * 1e-6)) > 0
    assert model.body_inertia.max() > 1e-12
