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
    """Return the points of mjbeer's own models: neither peers nor the usual ways of writing."""
    return [point for point in points if point.way in ROLLINGS]


def front(points: Iterable[Point]) -> list[Point]:
    """Return the points that no other beats in both error and run time, fastest first."""
    best: list[Point] = []
    for point in sorted(points, key=lambda point: (point.time, point.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def cheapest(points: Iterable[Point], error: float) -> Point | None:
    """Return the fastest point whose error is at most `error` [rad]; None if there is none."""
    good = [point for point in points if point.error <= error]
    return min(good, key=lambda point: point.time, default=None)


def time_for(points: Iterable[Point], error: float) -> float:
    """Return the run time [s] for an `error` [rad]: on the front, between points as a power law; infinite beyond it."""
    best = front(points)
    if not best or best[-1].error > error:
        return math.inf
    times, errors = np.log([point.time for point in best]), np.log([point.error for point in best])
    return float(np.exp(np.interp(-math.log(error), -errors, times)))


def error_for(points: Iterable[Point], time: float) -> float:
    """Return the error [rad] for a run `time` [s]: on the front, as `time_for`; infinite if nothing is that fast."""
    best = front(points)
    if not best or best[0].time > time:
        return math.inf
    times, errors = np.log([point.time for point in best]), np.log([point.error for point in best])
    return float(np.exp(np.interp(math.log(time), times, errors)))


def gain_over_usual(points: list[Point], written: str) -> float | None:
    """Return by what factor the tuned twin of a usual way of writing errs less in the same run time; None without."""
    usual = next((point for point in points if point.way == written), None)
    if usual is None:
        return None
    twins = [point for point in points if point.way == USUAL[written].rolling]
    return usual.error / error_for(twins, usual.time)


def advise(points: list[Point], tolerance: float, way: str | None = None) -> Point:
    """Return the cheapest measured setting that meets a `tolerance` [rad], in one way of rolling or in any.

    Raises:
      ParameterError: if none does; the message says how far they get.
    """
    candidates = [point for point in ours(points) if way in (None, point.way)]
    found = cheapest(candidates, tolerance)
    if found is None:
        where = "any way of rolling" if way is None else f"rolling {way!r}"
        least = min((point.error for point in candidates), default=math.inf)
        raise ParameterError(
            f"no setting of the study meets a tolerance of {tolerance:g} rad with {where}: the best has {least:.1e} rad"
        )
    return found


def fixed_and_global(points: list[Point], error: float) -> tuple[Point | None, Point | None]:
    """Return the fastest DOP853 at a fixed timestep with at most an `error` [rad], and the run to that tolerance."""
    steps = cheapest([point for point in points if point.curve == Curve("reduced", "DOP853", "timestep")], error)
    asked = [point for point in points if point.curve == Curve("reduced", "DOP853", "tolerance")]
    return steps, next((point for point in asked if math.isclose(point.value, error, rel_tol=1e-9)), None)
