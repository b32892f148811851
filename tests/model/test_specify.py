"""A specification that is attached to another world by hand."""

import math
import warnings

import mujoco
import numpy as np

from mjbeer import build, exact, frozen, specify
from mjbeer.model.joints import initial_state
from tests.support.scenes import METAL

SCENE = frozen(math.radians(8), can=METAL)


def test_an_attached_can_that_rolls_by_an_equality_moves_as_theory_says_if_its_diagonal_is_exact() -> None:
    """RK4's error at 1 ms is 5e-8 rad; without the flag the equality is softer, 4e-5 rad. Contacts: the example."""
    errors = []
    for further in (["enableflags"], []):
        can, parent = specify(SCENE, "equality", visuals=True), mujoco.MjSpec()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the options that a new parent does not take over
            slope = parent.worldbody.add_frame(quat=[math.cos(SCENE.incline / 2), 0, math.sin(SCENE.incline / 2), 0])
            slope.attach_body(can.body("can"), "own-", "")
            for name in ("timestep", "integrator", "disableflags", *further):
                setattr(parent.option, name, getattr(can.option, name))
            model = parent.compile()
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = np.split(initial_state(build(SCENE, "equality"), SCENE, 2.0, 0.0), 2)
        mujoco.mj_step(model, data, 2000)
        errors.append(abs(float(data.joint("own-roll").qpos[0]) - exact(SCENE, [data.time], 2.0).phi[0]))
    assert errors[0] < 1e-7
    assert errors[1] > 1e-6
