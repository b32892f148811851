"""Which settings are worth their run time."""

import math
from collections.abc import Iterable

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import ROLLINGS, USUAL
from mjbeer.studies.benchmark.curves import Curve
from mjbeer.studies.benchmark.points import Point

LEVELS = tuple(10.0**-k for k in range(2, 13, 2))
"""The errors [rad] for which the cheapest setting is asked."""


def ours(points: Iterable[Point]) -> list[Point]:
    """The points of mjbeer's own models: neither peers nor the usual ways of writing."""
    return [each for each in points if each.way in ROLLINGS]


def front(points: Iterable[Point]) -> list[Point]:
    """The points that no other beats in both error and run time, fastest first."""
    best: list[Point] = []
    for point in sorted(points, key=lambda each: (each.time, each.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def cheapest(points: Iterable[Point], error: float) -> Point | None:
    """The fastest point whose error is at most `error` [rad]; None if there is none."""
    good = [each for each in points if each.error <= error]
    return min(good, key=lambda each: each.time, default=None)


def time_for(points: Iterable[Point], error: float) -> float:
    """Run time [s] for an `error` [rad]: on the front, between two of its points as a power law; infinite beyond it."""
    best = front(points)
    if not best or best[-1].error > error:
        return math.inf
    times, errors = np.log([each.time for each in best]), np.log([each.error for each in best])
    return float(np.exp(np.interp(-math.log(error), -errors, times)))


def error_for(points: Iterable[Point], time: float) -> float:
    """Error [rad] for a run `time` [s]: on the front, as `time_for`; infinite if nothing is that fast."""
    best = front(points)
    if not best or best[0].time > time:
        return math.inf
    times, errors = np.log([each.time for each in best]), np.log([each.error for each in best])
    return float(np.exp(np.interp(math.log(time), times, errors)))


def gain_over_usual(points: list[Point], written: str) -> float | None:
    """How many times less than a usual way of writing the tuned twin errs in the same run time; None if not there."""
    usual = next((each for each in points if each.way == written), None)
    if usual is None:
        return None
    twins = [each for each in points if each.way == USUAL[written].rolling]
    return usual.error / error_for(twins, usual.time)


def advise(points: list[Point], tolerance: float, way: str | None = None) -> Point:
    """The cheapest measured setting of mjbeer's that meets a `tolerance` [rad], in one way of rolling or in any.

    Raises:
      ParameterError: if none does; the message says how far they get.
    """
    candidates = [each for each in ours(points) if way in (None, each.way)]
    found = cheapest(candidates, tolerance)
    if found is None:
        where = "any way of rolling" if way is None else f"rolling {way!r}"
        least = min((each.error for each in candidates), default=math.inf)
        raise ParameterError(
            f"no setting of the study meets a tolerance of {tolerance:g} rad with {where}: the best has {least:.1e} rad"
        )
    return found


def fixed_and_global(points: list[Point], error: float) -> tuple[Point | None, Point | None]:
    """The fastest DOP853 at a fixed timestep with at most this `error` [rad], and the run asked for that tolerance."""
    steps = cheapest((each for each in points if each.curve == Curve("reduced", "DOP853", "timestep")), error)
    asked = [each for each in points if each.curve == Curve("reduced", "DOP853", "tolerance")]
    return steps, next((each for each in asked if math.isclose(each.value, error, rel_tol=1e-9)), None)
