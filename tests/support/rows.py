"""Rows of soft constraints: how much of a force MuJoCo's solver applies, and which are stable at
which timestep."""

import math

import mujoco
import numpy as np

from mjbeer.model.mujoco_library import quiet
from mjbeer.studies.predictions import (
    SoftRow,
    amplification,
    first,
    reached_share,
    spectral_radius,
    spring,
)

BOUNDED = 1 + 1e-9  # largest spectral radius that counts as bounded


def radius(integrator: str, row: SoftRow, timestep: float, excess: float = 1.0) -> float:
    """Return the spectral radius of one step of a single row, whose diagonal MuJoCo overestimates
    by `excess`."""
    row = row.at_end_of_step(timestep) if integrator == "discrete" else row
    share = reached_share(row.impedance, excess)
    return spectral_radius(
        amplification(
            integrator, share * row.stiffness * timestep**2, share * row.damping * timestep
        )
    )


def stable_timestep(integrator: str, row: SoftRow, excess: float = 1.0) -> float:
    """Return the largest timestep [s] with a bounded row; infinite under "discrete", whatever the
    row."""
    scale = 1 / max(row.damping, math.sqrt(row.stiffness))
    limit = first(
        lambda h: radius(integrator, row, timestep=h, excess=excess) - BOUNDED,
        1e-2 * scale,
        1e6 * scale,
    )
    return math.inf if limit == 1e6 * scale else limit


def stable_ratio(integrator: str, dampratio: float = 1.0) -> float:
    """Return the largest h/timeconst with a bounded row."""
    return stable_timestep(integrator, spring(1.0, dampratio, 1.0))


def applied_share(model: mujoco.MjModel, state: np.ndarray) -> float | None:
    """Return the share of a hard constraint's force that the solver applies at a `state`, shape (nq
    + nv,).

    It is A/(A + R) with the regularizer R and the diagonal A = J M^-1 J^T of the rolling
    constraint's first row; None if no constraint is active.
    """
    data = mujoco.MjData(model)
    data.qpos[:] = state[: model.nq]
    data.qvel[:] = state[model.nq :]
    with quiet():
        mujoco.mj_forward(model, data)
    if data.nefc == 0:
        return None
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    jacobian = np.array(data.efc_J).reshape(-1, model.nv)[0]
    diagonal = float(jacobian @ np.linalg.solve(mass, jacobian))
    return diagonal / (diagonal + float(data.efc_R[0]))
