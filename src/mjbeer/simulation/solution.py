"""What a run returns: its states, an estimate of their error, and the record of its steps."""

from dataclasses import dataclass

import numpy as np

from mjbeer.theory.record import Record


@dataclass(frozen=True, eq=False)
class Solution:
    """The states of a run and an estimate of their error."""

    states: np.ndarray
    """States, shape (samples, nq + nv)."""
    estimate: float | None = None
    """Estimated error of phi and u/a [rad], relative beyond 1 rad; None if there was no second run."""
    record: Record | None = None
    """The record of all steps, if it was asked for."""
    integrator: str | None = None
    """The name of the integrator, if it was chosen for a tolerance."""
