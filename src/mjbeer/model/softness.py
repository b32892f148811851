"""The softness that MuJoCo's solver gives a constraint, read back from a compiled model."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.model.engine import quiet


@dataclass(frozen=True)
class EffectiveSoftness:
    """The softness of a constraint, as asked for and as the solver used it."""

    timeconst: float
    """Time constant that solref asks for [s]."""
    effective_timeconst: float
    """Time constant that the solver used [s]: `refsafe` raises one below two timesteps."""
    impedance: float
    """d of solimp: the share of its reference acceleration that a row with the exact diagonal would reach."""
    effective_impedance: float
    """The share that the row reached, with the regularizer that the solver used and the exact diagonal."""

    @property
    def changed(self) -> bool:
        """Return whether the solver used another time constant than solref asks for."""
        return abs(self.effective_timeconst / self.timeconst - 1) > 1e-9


def effective_softness(model: mujoco.MjModel, state: np.ndarray) -> EffectiveSoftness | None:
    """Return the softness of the rolling constraint at a `state`, shape (nq + nv,); None if no constraint is active.

    The time constant comes from the stiffness K = 1/(d tau)^2 (damping ratio 1) of MuJoCo's reference acceleration, and
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
    return EffectiveSoftness(
        timeconst=float(solref[0, 0]),
        effective_timeconst=1 / (float(solimp[0, 1]) * stiffness**0.5),
        impedance=impedance,
        effective_impedance=share,
    )
