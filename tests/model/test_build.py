"""Models as built: the same equations of motion as theory, and nothing in them that a scene does
not need."""

import math
from dataclasses import replace
from typing import get_args

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import mjbeer
from mjbeer import Can, Load, Scene, build, frozen, hoop, pendulum, simulate, sliding
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.model.build import rolling_spec
from mjbeer.model.compiled import compiled_model, parameter_views, write_numbers
from mjbeer.model.joints import joint_addresses, to_coordinates
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import (
    MUJOCO_INTEGRATORS,
    ROLLINGS,
    MujocoIntegrator,
    Rolling,
    Setting,
    supported,
)
from mjbeer.theory.can import Damping
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL, SCENES, coordinates, scenes

# Sums of a few products each, some of which cancel in part on a random scene; compared with their
# largest term.
ROUNDING = 1e-11
EXTREMES = {
    "sliding, little beer": sliding(fill=1e-2),
    "sliding, nearly full": sliding(fill=1 - 1e-6),
    "sliding, full": sliding(fill=1.0),
    "frozen, little beer": frozen(fill=1e-2),
    "frozen, nearly full": frozen(fill=1 - 1e-6),
    "frozen, full": frozen(fill=1.0),
    "light wheel": pendulum(wheel_mass=1e-4),
    "heavy wheel": pendulum(wheel_mass=1e2),
    "light hoop": hoop(hoop_mass=2e-4),
    "heavy hoop": hoop(hoop_mass=2e2),
    "sliding, 1 mm": sliding(can=Can.massless(1e-3, 1e-3)),
    "sliding, 1 m": sliding(can=Can.massless(1.0, 1.0)),
    "frozen, 1 mm": frozen(can=Can.massless(1e-3, 1e-3)),
    "frozen, 1 m": frozen(can=Can.massless(1.0, 1.0)),
    "balanced load": Scene(Can(0.03, 0.1, 0.1, 9e-5), Load(0.2, 0.0, 1e-4), 0.2),
    "heavy can": Scene(Can(0.03, 0.1, 1e2, 0.09), Load(0.2, 0.01, 1e-4), 0.2),
}


@st.composite
def any_scene(draw: st.DrawFn) -> Scene:
    """A random scene; half of the sliding ones have all three coefficients of damping, over many
    decades, and drag."""
    scene = draw(scenes())
    if scene.attachment == "frozen" or draw(st.booleans()):
        return scene

    def coefficient(unit: float) -> float:
        return draw(st.sampled_from([0, 1, 1])) * 10 ** draw(st.floats(-9, 2)) * unit

    base = scene.oscillator.base
    pace = math.sqrt(scene.gravity / scene.can.radius)
    law = Damping(coefficient(base * pace), coefficient(base), coefficient(base))
    return replace(scene, damping=law, drag=coefficient(scene.mass / scene.can.radius))


def forward(
    model: mujoco.MjModel, scene: Scene, phi: float, phi_dot: float, u_dot: float
) -> tuple[float, float]:
    """u_ddot and phi_ddot of MuJoCo's forward dynamics in a state of rolling."""
    radius = scene.can.radius
    roll_dot = u_dot / radius
    roll = phi if scene.attachment == "frozen" else 0.0
    depth = 1e-9 * radius  # of a contact at its start
    positions = {"slide": radius * roll, "lift": -depth, "roll": roll, "swing": phi, "phi": phi}
    rates = {
        "slide": u_dot,
        "lift": 0.0,
        "roll": roll_dot,
        "swing": phi_dot - roll_dot,
        "phi": phi_dot,
    }
    data = mujoco.MjData(model)
    for name in joint_addresses(model):
        data.joint(name).qpos = positions[name]
        data.joint(name).qvel = rates[name]
    mujoco.mj_forward(model, data)
    # The rates of the rates are read as if they were those of positions.
    rates_as_states = np.concatenate([data.qvel, data.qacc])[None]
    moved = to_coordinates(model, scene, rates_as_states, times=np.zeros(1))
    return float(moved.u_dot[0]), float(moved.phi_dot[0])


def assert_theory(
    model: mujoco.MjModel, scene: Scene, phi: float, phi_dot: float, u_dot: float
) -> None:
    u_ddot, phi_ddot = forward(model, scene, phi, phi_dot, u_dot)
    expected_u_ddot, expected_phi_ddot = accelerations(scene, phi, phi_dot, u_dot)
    radius = scene.can.radius
    base = scene.oscillator.base
    # A torque alone accelerates the load, and where a constraint rolls the can, first of all the
    # can.
    least = base if "roll" not in joint_addresses(model) else min(base, scene.can.inertia or base)
    drag_torque = scene.drag * u_dot**2 * radius
    torque = abs(scene.damping_law.torque(u_dot / radius - phi_dot)) + drag_torque
    terms = [
        torque / least,
        phi_dot**2,
        scene.gravity / radius,
        abs(expected_phi_ddot),
        abs(expected_u_ddot) / radius,
    ]
    allowed = ROUNDING * float(sum(terms))
    if model.neq:  # the constraint pulls back the rounding of roll - u/a, in half a timestep
        allowed += (2 / model.opt.timestep) ** 2 * np.spacing(1 + abs(phi))
    assert abs(phi_ddot - expected_phi_ddot) <= allowed
    assert abs(u_ddot - expected_u_ddot) <= allowed * radius


def written(scene: Scene, setting: Setting) -> mujoco.MjModel:
    """A skeleton that had the numbers of other scenes before."""
    made = ModelNumbers(scene, setting)
    model = compiled_model(made)
    data = mujoco.MjData(model)
    views = parameter_views(model, made.parameters)
    another = replace(scene, incline=0.1)
    if scene.dissipates:
        another = replace(scene, drag=scene.drag + 1.0, gravity=5.0)
    for before in (scene, another, scene):
        numbers = ModelNumbers(before, setting)
        if numbers.structure == made.structure:
            write_numbers(model, data, numbers, views)
    return model


@pytest.mark.slow
@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    any_scene(),
    st.sampled_from(["reduced", "equality"]),
    st.floats(-3, 3),
    st.floats(-5, 5),
    st.floats(-5, 5),
)
def test_skeletons_accelerate_as_theory_says(
    scene: Scene, rolling: Rolling, phi: float, swing: float, roll: float
) -> None:
    assume(rolling == "reduced" or scene.attachment == "frozen" or scene.can.inertia > 0)
    unit = math.sqrt(scene.gravity / scene.can.radius)
    u_dot = scene.can.radius * unit * (swing if scene.attachment == "frozen" else roll)
    assert_theory(written(scene, Setting(rolling)), scene, phi, swing * unit, u_dot)


@pytest.mark.parametrize("scene", EXTREMES.values(), ids=EXTREMES)
def test_extreme_skeletons_accelerate_as_theory_says(scene: Scene) -> None:
    u_dot = 2.0 * scene.can.radius if scene.attachment == "frozen" else 0.3
    assert_theory(written(scene, Setting()), scene, 0.7, 2.0, u_dot)


def test_a_wrong_model_is_found_out() -> None:
    """Another chord; and the equality as MuJoCo compiles it, whose impedance of 0.9999 lacks 1e-4
    of the force."""
    chord = build(frozen())
    soft = rolling_spec(frozen(), Setting("equality")).compile()
    chord.tendon_armature[:] *= 1 + 1e-9
    for wrong in (chord, soft):
        with pytest.raises(AssertionError):
            assert_theory(wrong, frozen(), 1.0, 20.0, 20.0 * frozen().can.radius)


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize(
    "scene", [*SCENES.values(), sliding(can=METAL, damping=Damping(1e-4, 1e-6, 1e-8), drag=0.2)]
)
def test_a_skeleton_is_the_model_that_is_compiled_for_its_scene(
    scene: Scene, rolling: Rolling
) -> None:
    """Softness too, which accelerations do not show; the steps have the same bits. And the other
    scenes are gone."""
    if not supported(scene, rolling):
        return
    how = {"rolling": rolling, "integrator": "implicit", "timestep": 2e-4, "friction": 0.7}
    ways = []
    for model in (written(scene, Setting(**how)), build(scene, **how)):
        data = mujoco.MjData(model)
        mjbeer.reset(model, data, scene, 0.7, 3.0)
        for _ in range(20):
            mujoco.mj_step(model, data)
        ways.append(data.qpos.tobytes() + data.qvel.tobytes())
    assert ways[0] == ways[1]


def test_models_with_other_elements_have_another_structure_and_no_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What has one structure is compiled once.

    The flag of a model without dampers says that there are none: a scene written into it would not
    be damped.
    """
    for rolling in ROLLINGS:  # with a constraint, all damping is that of joints
        setting = Setting(rolling)
        free = ModelNumbers(sliding(can=METAL), setting).structure
        damped = ModelNumbers(sliding(can=METAL, damping=1e-3), setting).structure
        dragged = ModelNumbers(sliding(can=METAL, drag=1e-3), setting).structure
        assert free not in (damped, dragged)
        assert (damped == dragged) == (rolling != "reduced")
    settings = [Setting("equality", integrator) for integrator in MUJOCO_INTEGRATORS]
    assert len({ModelNumbers(frozen(), setting).structure for setting in settings}) == 1
    simulate(sliding(), 0.01, 1.0)
    monkeypatch.setattr("mjbeer.model.compiled.rolling_spec", None)
    simulate(sliding(fill=0.3), 0.01, 1.0)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (sliding(), 'massless can with a sliding load exists only in rolling="reduced"'),
        (Scene(Can(0.1, 0.1, 1.0, 0.0), Load.point(1.0, 0.05)), "can without inertia"),
        (
            Scene(Can.massless(), Load.point(1.0, 0.01), 0.1, "frozen"),
            "no inertia about its centre of mass",
        ),
    ],
)
def test_what_mujoco_has_not_is_refused(rolling: Rolling, scene: Scene, reason: str) -> None:
    with pytest.raises(UnsupportedError, match=reason):
        build(scene, rolling)


@pytest.mark.parametrize("integrator", get_args(MujocoIntegrator))
@pytest.mark.parametrize("rolling", ["reduced", "equality"])  # a contact is soft
def test_no_force_is_too_small_to_move_a_damped_load(
    rolling: Rolling, integrator: MujocoIntegrator
) -> None:
    """Let go beside the top, on level ground. After a step the rate is that of the acceleration,
    less its damping."""
    scene = sliding(0.0, can=METAL, damping=1e-4)
    timestep = 1e-4
    for aside, visuals in ((1e-4, False), (1e-9, True), (1e-13, False), (1e-13, True)):
        model = build(scene, rolling, visuals, integrator, timestep)
        data = mujoco.MjData(model)
        mjbeer.reset(model, data, scene, math.pi - aside)
        mujoco.mj_step(model, data)
        _, phi_ddot = accelerations(scene, math.pi - aside, 0.0, 0.0)
        expected = float(phi_ddot) * timestep
        # In the timestep the damping takes 3e-4 of it; the rounding of an equality is 2e-3 of the
        # smallest.
        moved = coordinates(model, data, scene)
        assert moved.phi_dot[0] == pytest.approx(expected, rel=5e-3, abs=0)


@pytest.mark.parametrize("visuals", [False, True])
@pytest.mark.parametrize("rolling", ROLLINGS)
def test_a_model_starts_where_it_is_asked_to_and_rolls(rolling: Rolling, visuals: bool) -> None:
    """By its keyframe, and anew by `reset` after it was moved; a loop of a stranger's own is then
    right."""
    scene = sliding(0.2, can=METAL)
    timestep = 1e-4
    model = build(scene, rolling, visuals, timestep=timestep, phi0=0.7, phi_dot0=2.0)
    data = mujoco.MjData(model)
    again = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_step(model, again, 5)
    mjbeer.reset(model, again, scene, 0.7, 2.0)
    assert again.time == 0
    assert np.array_equal(again.qpos, data.qpos)
    assert np.array_equal(again.qvel, data.qvel)
    assert again.qacc.any()
    upright = -scene.gravity if visuals else -scene.gravity * math.cos(0.2)
    assert model.opt.gravity[2] == pytest.approx(upright, rel=1e-15)
    mujoco.mj_step(model, again, 1000)
    moved = coordinates(model, again, scene)
    truth = mjbeer.exact(scene, [0.1], phi0=0.7, phi_dot0=2.0)
    allowed = 1e-7  # RK4, and the softness of a contact
    assert abs(moved.phi[0] - truth.phi[0]) < allowed
    assert abs(moved.u[0] - truth.u[0]) < allowed * scene.can.radius


def test_reset_finds_the_joints_in_another_world_and_says_where_there_are_none() -> None:
    spec = mjbeer.specify(frozen(can=METAL), "contact", visuals=True)
    ball = spec.worldbody.add_body(name="ball", pos=[0, 9, 0])
    ball.add_freejoint(name="free")
    ball.add_geom(size=[0.1, 0, 0])
    model = spec.compile()
    data = mujoco.MjData(model)
    mjbeer.reset(model, data, frozen(can=METAL), 0.3, -1.0)
    assert (data.joint("roll").qpos[0], data.joint("roll").qvel[0]) == (0.3, -1.0)
    assert data.joint("free").qpos[1] == 9
    empty = mujoco.MjSpec().compile()
    with pytest.raises(ParameterError, match="the model must have the joints of a scene"):
        mjbeer.reset(empty, mujoco.MjData(empty), frozen(), 0.3)


@pytest.mark.parametrize("rolling", ["equality", "contact"])
def test_a_nearly_singular_inertia_is_an_error_and_no_warning(rolling: Rolling) -> None:
    """MuJoCo's compiler only warns of it."""
    can = Can(radius=100.0, length=100.0, mass=10.0, inertia=1e-7)
    load = Load(mass=1e4, offset=68.7, inertia=1e11)
    scene = Scene(can, load, incline=-1.205, gravity=1.0)
    with pytest.raises(UnsupportedError, match="too unequal"):
        simulate(scene, 0.1, rolling=rolling)
