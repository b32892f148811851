"""A specification is that of the model that is built; in another world it needs the options that it loses there."""

import math
import warnings

import mujoco
import numpy as np

from mjbeer import build, exact, frozen, specify
from mjbeer.model.joints import initial_state
from tests.support.scenes import METAL

LOST = "timestep", "integrator", "impratio", "cone", "tolerance", "enableflags", "disableflags", "gravity"
"""The options that `mjcf/README.md` tells of."""
OTHERS = "solver", "iterations", "jacobian", "noslip_iterations", "density", "viscosity", "wind", "disableactuator"
SCENE = frozen(math.radians(8), can=METAL)
WEAK = frozen(math.radians(8), can=METAL, gravity=1.6)


def attached(can: mujoco.MjSpec, merge: bool = False) -> mujoco.MjSpec:
    """A new parent with a can in a frame."""
    parent = mujoco.MjSpec()
    if merge:
        parent.compiler.conflict = mujoco.mjtConflict.mjCONFLICT_MERGE
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the options that are lost
        parent.worldbody.add_frame(name="slope").attach_body(can.body("can"), "own-", "")
    return parent


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


def test_a_new_parent_keeps_its_own_options_and_one_that_merges_adopts_all() -> None:
    needed = specify(WEAK, "contact", visuals=True).compile().opt
    kept, merged = (compiled(attached(specify(WEAK, "contact", visuals=True), each)).opt for each in (False, True))
    fresh = mujoco.MjSpec().option
    for name in (*LOST, *OTHERS):
        assert np.array_equal(getattr(kept, name), getattr(fresh, name)), name
        assert np.array_equal(getattr(merged, name), getattr(needed, name)), name
        assert np.array_equal(getattr(fresh, name), getattr(needed, name)) == (name in OTHERS), name


def test_an_attached_can_that_rolls_by_an_equality_moves_as_theory_says_if_its_diagonal_is_exact() -> None:
    """RK4's error at 1 ms is 5e-8 rad; without the flag the equality is softer, 4e-5 rad. Contacts: the example."""
    errors = []
    for further in (["enableflags"], []):
        can = specify(SCENE, "equality", visuals=True)
        parent = attached(can)
        for name in ("timestep", "integrator", "disableflags", *further):
            setattr(parent.option, name, getattr(can.option, name))
        parent.frame("slope").quat = [math.cos(SCENE.incline / 2), 0, math.sin(SCENE.incline / 2), 0]
        model = compiled(parent)
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = np.split(initial_state(build(SCENE, "equality"), SCENE, 2.0, 0.0), 2)
        mujoco.mj_step(model, data, 2000)
        errors.append(abs(float(data.joint("own-roll").qpos[0]) - exact(SCENE, [data.time], 2.0).phi[0]))
    assert errors[0] < 1e-7
    assert errors[1] > 1e-6
