"""The matrix of one step of a damped load against the step that MuJoCo takes, for all ways of rolling."""

import math

import mujoco
import numpy as np
import pytest

from mjbeer import Scene, sliding
from mjbeer.model.build import build
from mjbeer.model.joints import initial_state, joint_addresses
from mjbeer.model.mechanics import stiffest
from mjbeer.model.setting import Integrator, Rolling
from mjbeer.studies.predictions import soft_rolling
from mjbeer.studies.predictions.linear_stability import spectral_radius
from mjbeer.studies.predictions.soft_constraint import MAX_IMPEDANCE, spring
from mjbeer.theory.can import Can
from tests.support.constraints import settle

pytestmark = pytest.mark.slow

TIMESTEP = 1e-3
# Differences over 1e-4 are right to 1e-8 of the largest number that they come from. Where the inner stages of a step
# grow, rounding grows with them. Over smaller ones "discrete" stays where it is: its solver sees nothing to improve.
ASIDE, CLOSE = 1e-4, 1e-5


def steady(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """The state of steady rolling, at the depth at which the can in contact is carried."""
    tilt, speed = scene.terminal_tilt(), scene.terminal_speed()
    start = settle(model, initial_state(model, scene, tilt, 0.0))
    joints, turning = joint_addresses(model), speed / scene.can.radius
    for name, rate in {"slide": speed, "roll": turning, "swing": -turning}.items():
        if name in joints:
            start[model.nq + joints[name]] = rate
    return start


def step_of_mujoco(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """The derivatives of the state after a step by the state before it; the can stays within a tenth of its depth."""
    rest, data, size = steady(model, scene), mujoco.MjData(model), model.nq
    asides = np.full(2 * size, ASIDE)
    if (lift := joint_addresses(model).get("lift")) is not None:
        asides[:] = 1e-6  # friction must stay within its cone
        asides[lift] = -rest[lift] / 50
        asides[size + lift] = asides[lift] / model.opt.timestep

    def after(start: np.ndarray) -> np.ndarray:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = start[:size], start[size:]
        mujoco.mj_forward(model, data)
        mujoco.mj_step(model, data)
        return np.concatenate([data.qpos, data.qvel])

    nudges = np.diag(asides)
    columns = [(after(rest + nudge) - after(rest - nudge)) / (2 * nudge.sum()) for nudge in nudges]
    return np.array(columns).T


def step_of_theory(model: mujoco.MjModel, scene: Scene, rolling: Rolling, integrator: Integrator) -> np.ndarray:
    """The same matrix by theory, whose states are (q, h q') and may have the joints in another order."""
    tilt, row = scene.terminal_tilt(), spring(stiffest(integrator, TIMESTEP, rolling == "contact"), 1.0, MAX_IMPEDANCE)
    if rolling == "reduced":
        system = soft_rolling.by_coordinates(scene, tilt)
    elif rolling == "equality":
        system = soft_rolling.by_equality(scene, excess=0.0, angle=tilt)
    else:
        depth = -steady(model, scene)[joint_addresses(model)["lift"]]
        system = soft_rolling.by_contact(scene, depth, 2, float(model.opt.impratio), tilt)
    unit = np.repeat([1.0, TIMESTEP], model.nq)
    joints = joint_addresses(model)
    order = [system.coordinates.index(joint) for joint in sorted(joints, key=joints.__getitem__)]
    both = [*order, *(model.nq + place for place in order)]
    return (system.step(integrator, row, TIMESTEP) * unit / unit[:, None])[np.ix_(both, both)]


@pytest.mark.parametrize("rolling", ["reduced", "equality", "contact"])
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete", "RK4"])
@pytest.mark.parametrize("damping", [1e-3, 1.0])
def test_a_step_is_the_one_that_mujoco_takes(rolling: Rolling, integrator: Integrator, damping: float) -> None:
    """In contact on level ground, where friction is far from its cone's edge."""
    incline = 0.0 if rolling == "contact" else math.radians(10)
    scene = sliding(can=Can.sheet_metal(), damping=damping, incline=incline)
    model = build(scene, rolling, integrator=integrator, timestep=TIMESTEP)
    found, wanted = step_of_mujoco(model, scene), step_of_theory(model, scene, rolling, integrator)
    allowed = CLOSE * max(1.0, spectral_radius(wanted)) * np.abs(wanted).max(axis=0)
    assert (np.abs(found - wanted) <= allowed).all()
