"""Which rows of soft constraints are stable at which timestep, by the amplification of a step of one row alone."""

import math

import numpy as np

from mjbeer.studies.predictions import (
    RUNGE_KUTTA,
    SoftRow,
    amplification,
    first,
    polynomial,
    reached_share,
    spectral_radius,
    spring,
)

BOUNDED = 1 + 1e-9
"""Largest spectral radius that counts as bounded."""


def radius(integrator: str, row: SoftRow, timestep: float, excess: float = 1.0) -> float:
    """Return the spectral radius of one step of a single row, whose diagonal MuJoCo overestimates by `excess`."""
    row = row.at_end_of_step(timestep) if integrator == "discrete" else row
    share = reached_share(row.impedance, excess)
    return spectral_radius(
        amplification(integrator, share * row.stiffness * timestep**2, share * row.damping * timestep)
    )


def stable_timestep(integrator: str, row: SoftRow, excess: float = 1.0) -> float:
    """Return the largest timestep [s] with a bounded row; infinite under "discrete", whatever the row."""
    scale = 1 / max(row.damping, math.sqrt(row.stiffness))
    limit = first(lambda h: radius(integrator, row, timestep=h, excess=excess) - BOUNDED, 1e-2 * scale, 1e6 * scale)
    return math.inf if limit == 1e6 * scale else limit


def stable_ratio(integrator: str, dampratio: float = 1.0) -> float:
    """Return the largest h/timeconst with a bounded row."""
    return stable_timestep(integrator, spring(1.0, dampratio, 1.0))


def stable_slip(integrator: str) -> float:
    """Return the largest h/timeconst with a bounded friction row of impedance 1, which has a damping and no stiffness:
    1 under semi-implicit Euler, half of the limit on the negative real axis under a Runge-Kutta method."""
    if integrator not in RUNGE_KUTTA:
        return math.inf if integrator == "discrete" else 1.0
    coefficients = polynomial(integrator)[::-1]
    return first(lambda rate: abs(float(np.polyval(coefficients, -rate))) - 1, 0.1, 50.0) / 2
