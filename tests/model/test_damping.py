"""Models of scenes with damping and drag: the forces of theory, and dampers in no other model."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from mjbeer import Scene, build, exact, pendulum, sliding
from mjbeer.model import state
from mjbeer.model.build import compose
from mjbeer.model.present import farthest
from mjbeer.model.setting import INTEGRATORS, ROLLINGS, MujocoIntegrator, Rolling, Setting, supported
from mjbeer.model.state import places, read
from mjbeer.theory.equations import accelerations
from mjbeer.theory.liquid import Damping
from tests.support.scenes import METAL, SCENES, scenes

DAMPER = int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
# Sums of a few products, some of which cancel in part on a random scene; they are compared with their largest term.
ROUNDING = 1e-11


@st.composite
def damped(draw: st.DrawFn) -> Scene:
    """A random scene with all three coefficients of damping, over twelve decades, and with drag."""
    scene = draw(scenes())
    assume(scene.attachment == "sliding")
    natural = scene.oscillator.base * math.sqrt(scene.gravity / scene.can.radius)
    linear, quadratic, cubic, drag = (10 ** draw(st.floats(-9, 3)) for _ in range(4))
    law = Damping(natural * linear, scene.oscillator.base * quadratic, scene.oscillator.base * cubic)
    return replace(scene, damping=law, drag=scene.mass / scene.can.radius * drag)


def moving(scene: Scene, rolling: Rolling, state: tuple[float, float, float]) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return a model and its data in a state of rolling phi, phi_dot, u_dot, with a torque and forces computed."""
    model, radius = build(scene, rolling), scene.can.radius
    data, joints = mujoco.MjData(model), places(model)
    phi, phi_dot, u_dot = state
    values = {
        "slide": (0.0, u_dot),
        "lift": (-1e-9 * radius, 0.0),
        "roll": (0.0, u_dot / radius),
        "swing": (phi, phi_dot - u_dot / radius),
        "phi": (phi, phi_dot),
    }
    for name, index in joints.items():
        data.qpos[index], data.qvel[index] = values[name]
    mujoco.mj_forward(model, data)
    return model, data


@settings(max_examples=60, deadline=None, derandomize=True)
@given(damped(), st.sampled_from(["reduced", "equality"]), st.floats(-3, 3), st.floats(-5, 5), st.floats(-5, 5))
def test_damped_models_accelerate_as_theory_says(
    scene: Scene, rolling: Rolling, phi: float, swing: float, roll: float
) -> None:
    assume(rolling == "reduced" or scene.can.inertia > 0)
    radius, unit = scene.can.radius, math.sqrt(scene.gravity / scene.can.radius)
    state = phi, swing * unit, roll * unit * radius
    model, data = moving(scene, rolling, state)
    found = read(model, scene, np.concatenate([data.qvel, data.qacc])[None], np.zeros(1))
    u_ddot, phi_ddot = accelerations(scene, *state)
    # The torque alone accelerates the load, and where a constraint rolls the can, first of all the can.
    torque = float(scene.damping_law.torque(abs(roll - swing) * unit)) + scene.drag * state[2] ** 2 * radius
    inertia = scene.oscillator.base if rolling == "reduced" else min(scene.oscillator.base, scene.can.inertia)
    scale = torque / inertia + state[1] ** 2 + unit**2
    assert abs(found.phi_dot[0] - phi_ddot) <= ROUNDING * scale
    assert abs(found.u_dot[0] - u_ddot) <= ROUNDING * scale * radius


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("scene", [sliding(can=METAL), pendulum(wheel_mass=1e-12, load_mass=1e-12)])
def test_dampers_have_the_torque_and_the_drag(scene: Scene, rolling: Rolling) -> None:
    """In contact too, whose solver is left out of it: the torque acts on the load and, against it, on the can."""
    scene = replace(scene, damping=Damping(1e-4, 1e-6, 1e-8), drag=0.2)
    model, data = moving(scene, rolling, (0.3, -2.0, 1.5))
    unit = float(model.body_mass.sum() + model.dof_armature.sum()) / (
        scene.mass + (scene.can.inertia / scene.can.radius**2 if rolling == "reduced" else 0.0)
    )
    torque = unit * float(scene.damping_law.torque(1.5 / scene.can.radius + 2.0))
    drag, joints = unit * 0.2 * 1.5**2, places(model)
    wanted = {"swing": torque} if rolling != "reduced" else {"phi": torque}
    wanted["slide"] = -drag - (torque / scene.can.radius if rolling == "reduced" else 0.0)
    for name, index in joints.items():
        assert data.qfrc_passive[index] == pytest.approx(wanted.get(name, 0.0), rel=1e-14), name


@pytest.mark.parametrize("rolling", ROLLINGS)
@pytest.mark.parametrize("name", SCENES)
def test_only_damped_models_have_dampers(name: str, rolling: Rolling) -> None:
    scene = SCENES[name]
    if not supported(scene, rolling):
        return
    model = build(scene, rolling)
    assert model.opt.disableflags & DAMPER
    assert not any(getattr(model, each).any() for each in vars_of_damping(model))
    assert "damper" not in {model.tendon(i).name for i in range(model.ntendon)}
    if scene.attachment == "sliding":
        for dissipating in (replace(scene, damping=1e-3), replace(scene, drag=1e-3)):
            model = build(dissipating, rolling)
            assert not model.opt.disableflags & DAMPER
            assert any(getattr(model, each).any() for each in vars_of_damping(model))


def vars_of_damping(model: mujoco.MjModel) -> list[str]:
    return [name for name in dir(model) if name.startswith(("dof_damping", "tendon_damping"))]


@pytest.mark.parametrize("rolling", ROLLINGS)
def test_no_damping_is_the_scene_without_it(rolling: Rolling) -> None:
    scene = sliding(can=METAL)
    texts = {compose(each, Setting(rolling)).to_xml() for each in (scene, replace(scene, damping=Damping(), drag=0.0))}
    assert len(texts) == 1
    assert "damping" not in texts.pop()


@settings(max_examples=30, deadline=None, derandomize=True)
@given(damped(), st.floats(-4, 4), st.floats(-5, 5))
def test_no_damped_can_goes_farther_than_the_bound(scene: Scene, phi0: float, swing: float) -> None:
    rate = swing * math.sqrt(scene.gravity / scene.can.radius)

    def slope(_: float, y: np.ndarray) -> list[float]:
        u_ddot, phi_ddot = accelerations(scene, y[1], y[3], y[2])
        return [y[2], y[3], float(u_ddot), float(phi_ddot)]

    u, u_dot = scene.start(phi0, rate)
    way = solve_ivp(slope, (0, 3), [u, phi0, u_dot, rate], "LSODA", rtol=1e-6, atol=1e-9)
    assert way.success
    assert np.abs(way.y[0] - u).max() <= farthest(scene, phi0, rate, 3.0) * (1 + 1e-4)  # the errors of LSODA add up


def test_the_bound_is_reached_where_all_energy_is_the_can_s() -> None:
    """A load passes the bottom without moving along: the can has all energy, and for a moment nothing brakes it."""
    scene, time = replace(pendulum(0.0, gravity=0.0), damping=1e-9), 1e-6
    assert farthest(scene, 0.0, 3.0, time) == pytest.approx(scene.start(0.0, 3.0)[1] * time, rel=1e-9)


def test_the_bound_counts_the_energy_of_a_load_at_the_top() -> None:
    scene = sliding(0.0, can=METAL, damping=1e-6)
    found = np.ptp(exact(scene, np.linspace(0, 0.5, 51), math.pi - 0.1).u)
    assert found > scene.can.radius / 10
    assert found < farthest(scene, math.pi - 0.1, 0.0, 0.5)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("rolling", ["reduced", "equality"])  # a contact is soft
def test_no_force_is_too_small_to_move_a_damped_load(rolling: Rolling, integrator: MujocoIntegrator) -> None:
    """Let go beside the top, on level ground. After a step the rate is that of the acceleration, less its damping."""
    scene, timestep = sliding(0.0, can=METAL, damping=1e-4), 1e-4
    for aside in (1e-4, 1e-9, 1e-13):
        model = build(scene, rolling, integrator=integrator, timestep=timestep)
        data = mujoco.MjData(model)
        begin = state.settle(model, state.start(model, scene, math.pi - aside, 0.0))
        data.qpos[:], data.qvel[:] = begin[: model.nq], begin[model.nq :]
        mujoco.mj_step(model, data)
        found = read(model, scene, np.concatenate([data.qpos, data.qvel])[None], np.zeros(1)).phi_dot[0]
        _, phi_ddot = accelerations(scene, math.pi - aside, 0.0, 0.0)
        assert found == pytest.approx(float(phi_ddot) * timestep, rel=0.01, abs=0)
