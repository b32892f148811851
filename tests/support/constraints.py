"""What MuJoCo's solver lets through of a constraint's force, and by how much it mistakes an equality's diagonal."""

import mujoco
import numpy as np

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


def diagonal_excess(model: mujoco.MjModel, radius: float) -> float:
    """Return the factor by which MuJoCo overestimates the diagonal of the equality u = a roll, at phi = 0.

    It adds the inverse inertias of the two joints, the diagonal of M^-1, without regard to metres and radians. The true
    diagonal is J M^-1 J^T with J = (1, -a).
    """
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    inverse, row = np.linalg.inv(mass)[:2, :2], np.array([1.0, -radius])
    return float(np.trace(inverse) / (row @ inverse @ row))
