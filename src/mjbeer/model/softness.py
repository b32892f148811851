"""What MuJoCo really does with solref and solimp, read back from a compiled model."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.model.engine import quiet


@dataclass(frozen=True)
class Softness:
    """A constraint's settings, as asked for and as the solver got them."""

    timeconst: float
    """solref's time constant as asked for [s]."""
    effective_timeconst: float
    """The one that the solver got [s]: `refsafe` raises what is under two timesteps."""
    impedance: float
    """The share of the force on an exact row that is let through: d of solimp."""
    effective_impedance: float
    """The share that the row had, with the softness that the solver gave it and the inertia it really has."""

    @property
    def changed(self) -> bool:
        """Whether the solver got another time constant than was asked for."""
        return abs(self.effective_timeconst / self.timeconst - 1) > 1e-9


def softness(model: mujoco.MjModel, state: np.ndarray) -> Softness | None:
    """The softness of a model's rolling constraint at a `state`, shape (nq + nv,); None if nothing touches.

    The time constant comes from the stiffness K = 1/(d tau)^2 (damping ratio 1) of MuJoCo's reference acceleration,
    the impedance from the regularizer R and the diagonal A = J M^-1 J^T of the constraint's first row.
    """
    if not (model.neq or model.npair):
        return None
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
    with quiet():
        mujoco.mj_forward(model, data)
    if data.nefc == 0:
        return None
    solref, solimp = (model.eq_solref, model.eq_solimp) if model.neq else (model.pair_solref, model.pair_solimp)
    stiffness, impedance = float(data.efc_KBIP[0, 0]), float(data.efc_KBIP[0, 2])
    jacobian = np.array(data.efc_J).reshape(-1, model.nv)[0]
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    diagonal = float(jacobian @ np.linalg.solve(mass, jacobian))
    share = diagonal / (diagonal + float(data.efc_R[0]))
    return Softness(float(solref[0, 0]), 1 / (float(solimp[0, 1]) * stiffness**0.5), impedance, share)
