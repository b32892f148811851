"""The depth at which a soft contact carries its can."""

import mujoco
import numpy as np

from mjbeer.joints import places
from mjbeer.quiet import quiet


def settle(model: mujoco.MjModel, state: np.ndarray) -> np.ndarray:
    """A `state`, shape (nq + nv,), with the lift at which nothing accelerates it; as it is for a model without a lift.

    The force of a row is linear in its depth, so that two trials give the depth. A can that starts at another one
    falls or rises to it, which is a motion that the exact one does not have.
    """
    if "lift" not in (joints := places(model)):
        return state
    at = joints["lift"]
    data, settled = mujoco.MjData(model), state.copy()

    def acceleration(lift: float) -> float:
        data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
        data.qpos[at], data.qacc_warmstart[:] = lift, 0.0
        with quiet():
            mujoco.mj_forward(model, data)
        return float(data.qacc[at])

    trials = -1e-7, -2e-7
    first, second = (acceleration(each) for each in trials)
    settled[at] = trials[0] - first * (trials[1] - trials[0]) / (second - first)
    return settled
