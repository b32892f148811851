"""Orders of convergence and floors, read off the errors of runs at ever finer timesteps (a ladder of rungs)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

_AGREE = 0.1
"""Largest difference between a local order and the mean of the rungs that are fitted."""
_RUNGS = 4
"""Fewest rungs that are fitted."""
_TOO_LARGE = 0.3
"""Errors above this [rad] are too large to be proportional to a power of the timestep."""
_FLAT = 0.5
"""A rung is at the floor if no later rung has less than this share of its error."""
_NO_FLOOR = 1e-2
"""Errors above this [rad] are not taken for a floor: on a motion that far off, rungs may agree by chance."""


def observed_order(steps: np.ndarray, errors: np.ndarray) -> float:
    """Return the observed order of convergence: the slope of log(error) over log(step)."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


@dataclass(frozen=True)
class Convergence:
    """How the errors of a ladder change as its rungs get finer."""

    order: float | None
    """Order of the longest run of rungs before the floor whose local orders agree; None if there is none."""
    floor: float | None = None
    """The least error at the floor [rad]; None if the errors fall to the last rung."""
    since: float | None = None
    """The coarsest timestep [s] or tolerance at the floor."""


def convergence(steps: ArrayLike, errors: ArrayLike) -> Convergence:
    """Return order and floor of the errors [rad] of a ladder of decreasing timesteps [s] or tolerances.

    The order is fitted to the longest run of at least four rungs whose local orders, log(e1/e2)/log(h1/h2), are
    within 0.1 of their mean; of two runs of equal length, to the finer. A floor needs two further rungs whose error is
    at least half as large. Rungs that failed, of which the error is 0 or not finite, are left out.
    """
    steps, errors = np.asarray(steps, dtype=float), np.asarray(errors, dtype=float)
    usable = np.isfinite(errors) & (errors > 0)
    steps, errors = steps[usable], errors[usable]
    for rung in range(len(errors) - 2):
        if errors[rung:].min() >= _FLAT * errors[rung] and errors[rung] < _NO_FLOOR:
            order = _order(steps[: rung + 1], errors[: rung + 1])
            return Convergence(order, float(errors[rung:].min()), float(steps[rung]))
    return Convergence(_order(steps, errors))


def _order(steps: np.ndarray, errors: np.ndarray) -> float | None:
    """Return the order fitted to the longest run of rungs that agree, or None."""
    best = 0, None
    for first in np.flatnonzero(errors <= _TOO_LARGE):
        for last in range(first + max(_RUNGS, best[0]), len(steps) + 1):
            local = np.diff(np.log(errors[first:last])) / np.diff(np.log(steps[first:last]))
            if np.abs(local - local.mean()).max() <= _AGREE:
                best = last - first, observed_order(steps[first:last], errors[first:last])
    return best[1]
