"""The fastest settings: for an error, for a run time, and those that no other setting beats in both."""

import math
from collections.abc import Iterable

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import ROLLINGS
from mjbeer.studies.benchmark.curves import CHOSEN, TIMESTEP, TOLERANCE, USUAL, Curve
from mjbeer.studies.benchmark.peers.whole_call import NAME as WHOLE
from mjbeer.studies.benchmark.points import Point

LEVELS = tuple(10.0**-k for k in range(2, 13, 2))
"""The errors [rad] for which tables and plots have the fastest setting."""


def ours(points: Iterable[Point]) -> list[Point]:
    """Return the points of mjbeer's own models: not of other tools, nor of models as people usually write them."""
    return [point for point in points if point.way in ROLLINGS]


def drawn(points: Iterable[Point]) -> list[Point]:
    """Return the points that plots show: not those of whole calls, which lie beside those of the runs alone."""
    return [point for point in points if point.way != WHOLE]


def front(points: Iterable[Point]) -> list[Point]:
    """Return the points than which no other has both less error and less run time, fastest first."""
    best: list[Point] = []
    for point in sorted(points, key=lambda point: (point.time, point.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def cheapest(points: Iterable[Point], error: float) -> Point | None:
    """Return the fastest point whose error is at most `error` [rad]; None if there is none."""
    accurate = [point for point in points if point.error <= error]
    return min(accurate, key=lambda point: point.time, default=None)


def time_for(points: Iterable[Point], error: float) -> float:
    """Return the run time [s] for an `error` [rad], interpolated on the front as a power law, or infinity."""
    best = front(points)
    if not best or best[-1].error > error:
        return math.inf
    times, errors = np.log([point.time for point in best]), np.log([point.error for point in best])
    return float(np.exp(np.interp(-math.log(error), -errors, times)))


def error_for(points: Iterable[Point], time: float) -> float:
    """Return the error [rad] for a run `time` [s], interpolated as in `time_for`; infinite if no point is that fast."""
    best = front(points)
    if not best or best[0].time > time:
        return math.inf
    times, errors = np.log([point.time for point in best]), np.log([point.error for point in best])
    return float(np.exp(np.interp(math.log(time), times, errors)))


def gain_over_usual(points: list[Point], written: str) -> float | None:
    """Return the error of a model as people usually write it over that of the tuned model in the same run time.

    `written` is one of USUAL; if it was not measured, None comes back.
    """
    usual = next((point for point in points if point.way == written), None)
    if usual is None:
        return None
    tuned = [point for point in points if point.way == USUAL[written].rolling]
    return usual.error / error_for(tuned, usual.time)


def advise(points: list[Point], tolerance: float, way: str | None = None) -> Point:
    """Return the fastest point that meets a `tolerance` [rad], of one way of rolling or of any.

    Raises:
      ParameterError: if no point does; the message has the least error.
    """
    candidates = [point for point in ours(points) if way in (None, point.way)]
    best = cheapest(candidates, tolerance)
    if best is None:
        where = "any way of rolling" if way is None else f"rolling {way!r}"
        least = min((point.error for point in candidates), default=math.inf)
        raise ParameterError(
            f"no setting of the study meets a tolerance of {tolerance:g} rad with {where}: the best has {least:.1e} rad"
        )
    return best


def fixed_and_global(points: list[Point], error: float) -> tuple[Point | None, Point | None]:
    """Return two points: the fastest fixed timestep of any integrator for an `error` [rad], and the run to it."""
    fixed = cheapest([point for point in points if point.way == "reduced" and point.knob == TIMESTEP], error)
    return fixed, at(points, Curve("reduced", CHOSEN, TOLERANCE), error)


def at(points: list[Point], curve: Curve, value: float) -> Point | None:
    """Return the point of a curve at a value of its knob; None if there is none."""
    on_curve = (point for point in points if point.curve == curve)
    return next((point for point in on_curve if math.isclose(point.value, value, rel_tol=1e-9)), None)
