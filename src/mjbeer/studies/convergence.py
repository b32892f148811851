"""Orders of convergence and floors, read off the errors of runs at ever finer timesteps (a ladder of rungs)."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from mjbeer.model.setting import DOP853, Integrator
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import phi_error
from mjbeer.theory.scene import Scene


def observed_order(steps: np.ndarray, errors: np.ndarray) -> float:
    """Return the observed order of convergence: the slope of log(error) over log(step)."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def ladder(scene: Scene, integrator: Integrator, steps: np.ndarray, duration: float, phi0: float) -> np.ndarray:
    """Simulate a scene with reduced rolling at each of some timesteps [s], and return the errors of phi [rad]."""
    runs = (simulate(scene, duration, phi0, integrator=integrator, timestep=float(h)) for h in steps)
    return np.array([phi_error(run) for run in runs])


def order(scene: Scene, integrator: Integrator) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, over six halvings of the timestep.

    At order 8 the error falls by 14 digits over six halvings, more than a double has. For DOP853 each halving is
    therefore two rungs, and only rungs with an error between 1e-3 rad and 1e-13 rad are fitted.
    """
    if integrator != DOP853:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        return observed_order(steps, ladder(scene, integrator, steps, duration=2.0, phi0=0.3))
    steps = 0.2 / np.sqrt(2) ** np.arange(13)
    errors = ladder(scene, integrator, steps, duration=20.0, phi0=0.3)
    fitted = (errors < 1e-3) & (errors > 1e-13)
    return observed_order(steps[fitted], errors[fitted])


_AGREE = 0.1
"""Largest difference between a local order and the mean of the rungs that are fitted."""
_RUNGS = 4
"""Fewest rungs that are fitted."""
_FLAT = 0.5
"""A rung is at the floor if no later rung has less than this share of its error."""
_NO_FLOOR = 1e-2
"""Errors above this [rad] are not taken for a floor: on a motion that far off, rungs may agree by chance."""
_SURE = 0.05
"""Largest standard error of a fitted order, over the order, where local orders do not agree."""
_MANY, _DECADES = 8, 6
"""Fewest rungs, and fewest decades of errors, of such a fit: by chance no noise falls that far that evenly."""
_CLOSE = 1.5
"""Largest ratio of two timesteps in such a fit. Further apart, the local orders of a method that has one agree."""
_TOO_LARGE = 0.3
"""Errors above this [rad] are too large to be proportional to a power of the timestep."""


@dataclass(frozen=True)
class Convergence:
    """How the errors of a ladder change as its rungs get finer."""

    kind: str
    """"converging", "floored" or "undecided"."""
    order: float | None = None
    """Order fitted to the rungs before the floor if there is one: to the longest run of them whose local orders agree,
    or else to all, if their errors fall by decades along one line."""
    floor: float | None = None
    """The least error at the floor [rad]."""
    since: float | None = None
    """The coarsest timestep [s] or tolerance at the floor."""

    def __str__(self) -> str:
        order = "" if self.order is None else f", order {self.order:.2f}"
        if self.kind == "floored":
            return f"floored at {self.floor:.1e} rad from {self.since:.3g} on{order}"
        return self.kind + order


def convergence(steps: ArrayLike, errors: ArrayLike) -> Convergence:
    """Return order and floor of the errors [rad] of a ladder of decreasing timesteps [s] or tolerances.

    The order is fitted to the longest run of at least four rungs whose local orders, log(e1/e2)/log(h1/h2), are
    within 0.1 of their mean; of two runs of equal length, to the finer. A floor needs two further rungs whose error is
    at least half as large.

    The error of a multistep method is the sum of many terms of either sign, so that the local orders of rungs close to
    each other scatter. Without a run that agrees the order is fitted to all rungs, if they are close, eight or more,
    and over six decades of errors, and the standard error of the order is below a twentieth of it.
    """
    steps, errors = np.asarray(steps, dtype=float), np.asarray(errors, dtype=float)
    finite = np.isfinite(errors) & (errors > 0)
    steps, errors = steps[finite], errors[finite]
    floor = _floor(errors)
    order = _order(steps[: floor + 1], errors[: floor + 1]) if floor is not None else _order(steps, errors)
    if floor is not None:
        return Convergence("floored", order, floor=float(errors[floor:].min()), since=float(steps[floor]))
    return Convergence("converging" if order is not None and order > 0.5 else "undecided", order)


def _floor(errors: np.ndarray) -> int | None:
    """Return the index of the first rung at the floor, or None. At least two rungs must follow it."""
    for rung in range(len(errors) - 2):
        if errors[rung:].min() >= _FLAT * errors[rung] and errors[rung] < _NO_FLOOR:
            return rung
    return None


def _order(steps: np.ndarray, errors: np.ndarray) -> float | None:
    """Return the order fitted to rungs in a row that agree, or else to all; None if neither is an order."""
    best: tuple[int, int, float] | None = None
    for first in range(len(steps)):
        for last in range(first + _RUNGS, len(steps) + 1):
            log_steps, log_errors = np.log(steps[first:last]), np.log(errors[first:last])
            if errors[first] > _TOO_LARGE:
                continue
            local = np.diff(log_errors) / np.diff(log_steps)
            if np.abs(local - local.mean()).max() <= _AGREE:
                slope = float(np.polyfit(log_steps, log_errors, 1)[0])
                if best is None or (last - first, first) >= best[:2]:
                    best = (last - first, first, slope)
    return _overall(steps, errors) if best is None else best[2]


def _overall(steps: np.ndarray, errors: np.ndarray) -> float | None:
    """Return the order fitted to all rungs, or None if they are few, far apart or not along a line."""
    small = errors < _TOO_LARGE
    steps, errors = np.log(steps[small]), np.log(errors[small])
    if len(steps) < _MANY or np.ptp(errors) < _DECADES * math.log(10) or np.diff(steps).min() < -math.log(_CLOSE):
        return None
    (slope, _), covariance = np.polyfit(steps, errors, 1, cov=True)
    return float(slope) if covariance[0, 0] ** 0.5 < _SURE * slope else None
