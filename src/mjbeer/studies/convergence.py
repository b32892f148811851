"""What a ladder of errors shows: an order, a floor, or nothing yet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from mjbeer.model.setting import DOP853
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import phi_error
from mjbeer.theory.scene import Scene


def observed_order(steps: np.ndarray, errors: np.ndarray) -> float:
    """Return the slope of log(error) over log(step)."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def ladder(scene: Scene, integrator: str, steps: np.ndarray, duration: float, phi0: float) -> np.ndarray:
    """Simulate a scene, reduced, at each of a ladder of timesteps [s], and return the errors of phi [rad]."""
    runs = (simulate(scene, duration, phi0, integrator=integrator, timestep=float(h)) for h in steps)
    return np.array([phi_error(run) for run in runs])


def order(scene: Scene, integrator: str) -> float:
    """Return the observed order of an integrator on a swing of 0.3 rad, over six halvings of the timestep.

    At order eight six halvings span 14 digits, more than a double has: there the slope is over those
    rungs of the six halvings, at ratio sqrt(2), whose error is between 1e-3 rad and 1e-13 rad.
    """
    if integrator != DOP853:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        return observed_order(steps, ladder(scene, integrator, steps, 2.0, 0.3))
    steps = 0.2 / np.sqrt(2) ** np.arange(13)
    errors = ladder(scene, integrator, steps, 20.0, 0.3)
    clear = (errors < 1e-3) & (errors > 1e-13)
    return observed_order(steps[clear], errors[clear])


_AGREE = 0.1
"""How far local orders of one fit may be from their mean."""
_RUNGS = 4
"""Fewest rungs of a fit."""
_FLAT = 0.5
"""A floor is where no later rung has less than this share of the error."""
_NO_FLOOR = 1e-2
"""Errors above this [rad] are no floor, whatever a few rungs say: a motion that is off may be so by chance."""
_TOO_LARGE = 0.3
"""Errors above this [rad] are no longer proportional to anything."""


@dataclass(frozen=True)
class Convergence:
    """What the errors of a ladder do as it gets finer."""

    kind: str
    """"converging", "floored" or "undecided"."""
    order: float | None = None
    """The order of the longest stretch of rungs whose local orders agree, before a floor if there is one."""
    floor: float | None = None
    """The error that it does not get below [rad]."""
    since: float | None = None
    """The setting from which on it does not."""

    def __str__(self) -> str:
        order = "" if self.order is None else f", order {self.order:.2f}"
        if self.kind == "floored":
            return f"floored at {self.floor:.1e} rad from {self.since:.3g} on{order}"
        return self.kind + order


def convergence(steps: ArrayLike, errors: ArrayLike) -> Convergence:
    """Return what the errors [rad] of a ladder of decreasing timesteps or tolerances show.

    An order is fitted to the longest stretch of at least four rungs whose local orders, log(e1/e2)/log(h1/h2), are
    within 0.1 of their mean; of two as long, to the finer one. A floor needs two rungs that bring nothing.
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
    """The first of three or more rungs of which no later one has less than half of the error before it."""
    for rung in range(len(errors) - 2):
        if errors[rung:].min() >= _FLAT * errors[rung] and errors[rung] < _NO_FLOOR:
            return rung
    return None


def _order(steps: np.ndarray, errors: np.ndarray) -> float | None:
    best: tuple[int, int, float] | None = None
    for first in range(len(steps)):
        for last in range(first + _RUNGS, len(steps) + 1):
            part, error = steps[first:last], errors[first:last]
            if error[0] > _TOO_LARGE:
                continue
            local = np.diff(np.log(error)) / np.diff(np.log(part))
            if np.abs(local - local.mean()).max() <= _AGREE:
                slope = float(np.polyfit(np.log(part), np.log(error), 1)[0])
                if best is None or (last - first, first) >= best[:2]:
                    best = (last - first, first, slope)
    return None if best is None else best[2]
