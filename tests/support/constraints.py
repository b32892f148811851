"""What MuJoCo's solver lets through of a constraint's force, and the depth at which a contact carries a can."""

import mujoco
import numpy as np

from mjbeer.model.joints import joint_addresses
from mjbeer.model.mujoco_library import quiet


def applied_share(model: mujoco.MjModel, state: np.ndarray) -> float | None:
    """Return the share of a hard constraint's force that the solver applies at a `state`, shape (nq + nv,).

    It is A/(A + R) with the regularizer R and the diagonal A = J M^-1 J^T of the rolling constraint's first row; None
    if no constraint is active.
    """
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
    with quiet():
        mujoco.mj_forward(model, data)
    if data.nefc == 0:
        return None
    mujoco.mj_fullM(model, data, mass)
    jacobian = np.array(data.efc_J).reshape(-1, model.nv)[0]
    diagonal = float(jacobian @ np.linalg.solve(mass, jacobian))
    return diagonal / (diagonal + float(data.efc_R[0]))


def settle(model: mujoco.MjModel, at: np.ndarray) -> np.ndarray:
    """Return a state, shape (nq + nv,), with the lift at which the can has no acceleration away from the incline.

    A model without a lift gets its state back. The contact force is linear in the depth, so that two trials give the
    wanted depth.
    """
    if "lift" not in (joints := joint_addresses(model)):
        return at
    index = joints["lift"]
    data, balanced = mujoco.MjData(model), at.copy()

    def acceleration(lift: float) -> float:
        data.qpos[:], data.qvel[:] = at[: model.nq], at[model.nq :]
        data.qpos[index], data.qacc_warmstart[:] = lift, 0.0
        mujoco.mj_forward(model, data)
        return float(data.qacc[index])

    trials = -1e-7, -2e-7
    first, second = (acceleration(lift) for lift in trials)
    balanced[index] = trials[0] - first * (trials[1] - trials[0]) / (second - first)
    return balanced
