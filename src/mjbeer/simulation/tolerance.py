"""Integration to a tolerance: finer and finer runs, until two of them come close enough.

Every run has two kinds of error. That of its steps falls with their length, by a known power: of
two runs the finer one has much less of it, and their distance is the error of the coarser one.
`SAFETY` times the distance must be within the tolerance, although it is the finer run that is
returned. Rounding does not fall. A run that starts a little aside shows how much the motion
amplifies it: beside a separatrix, where a load hardly passes the top, a millionfold.

The first run, the coarsest, starts aside. Mostly the second one comes close enough to it even so:
then both kinds of error are small enough, and two runs have done. Otherwise a third run, as coarse
as the first but with the right start, tells the two kinds apart, and finer runs follow if that of
the steps is too large.

At order 13 and 8 a factor of 10 in the error costs 1.2 and 1.3 times the steps, so that one factor,
generously chosen, replaces any finer judgement of whether two runs may agree by accident.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol

import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.integrators import Method
from mjbeer.theory.record import Record
from mjbeer.theory.trajectory import largest_angle_error

SAFETY = 10.0
"""Error estimate divided by the distance of two runs."""
ROUNDING = 0.3
"""Estimated effect of all rounding divided by that of the nudge."""
DRIFT = 1.5
"""Error of phi divided by that which the drift of the swing's energy implies: 0.5 for rotations and
small swings. For swings of 2.85 rad it is up to 2; there the distance of the runs is the larger
estimate."""
MOST_COMPARED = 64
"""Largest number of samples at which two runs are compared: to read one off takes as long as an
evaluation."""


class Solution(NamedTuple):
    """The states of a run, and what is known of them."""

    states: np.ndarray
    """At the samples, shape (samples, nq + nv)."""
    record: Record
    """The extremes of all steps."""
    error: float | None
    """Estimate for phi and u/a [rad], relative beyond 1 rad; None if there was no second run."""
    method: str
    """The name of the integrator."""


class RecordingObserver(Protocol):
    """An observer that makes a record of the steps that it is shown."""

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        ...

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""


class Problem(NamedTuple):
    """A motion that is to be known to a tolerance."""

    start: np.ndarray
    """State at time 0, shape (nq + nv,)."""
    nudged_start: np.ndarray
    """The same start, moved by a multiple of rounding."""
    times: np.ndarray
    """Times of the samples [s]."""
    tolerance: float
    """Largest error of phi and u/a [rad], relative beyond 1 rad."""
    angles: np.ndarray
    """Whose product with a state is phi and u/a [rad], shape (nq + nv, 2)."""

    def compared(self) -> slice:
        """Return which samples are compared: at most `MOST_COMPARED`, the last one among them."""
        stride = math.ceil(len(self.times) / MOST_COMPARED)
        first = (len(self.times) - 1) % stride
        return slice(first, None, stride)


class _FullRun(NamedTuple):
    """A run with all samples and the record of its steps."""

    method: Method
    states: np.ndarray
    record: Record

    def solution(self, error: float) -> Solution:
        """Return the run as a solution with this error [rad]."""
        return Solution(self.states, self.record, error, self.method.name)


def solve_to_tolerance(
    methods: Iterable[Method], problem: Problem, make_recorder: Callable[[], RecordingObserver]
) -> Solution:
    """Return the run of the first of these finer and finer `methods` that comes close enough.

    It has to come close to the run of the method before it; there are two methods at least.

    Raises:
      ToleranceError: if none does, or if rounding alone may be more than the tolerance.
    """
    tolerance = problem.tolerance
    compared = problem.compared()
    compared_times = np.ascontiguousarray(problem.times[compared])
    finer_methods = iter(methods)

    def run(method: Method) -> _FullRun:
        recorder = make_recorder()
        states = method.run(problem.start, problem.times, recorder)
        return _FullRun(method, states, recorder.record)

    try:
        # Two runs, the coarser one with a nudged start.
        first_method = next(finer_methods)
        nudged = first_method.run(problem.nudged_start, compared_times)
        fine = run(next(finer_methods))
        error = estimate_error(problem, nudged, fine.states[compared], fine.record)
        if error <= tolerance:
            return fine.solution(error)

        # A third run: is it their steps that part them, or rounding?
        coarse = first_method.run(problem.start, compared_times)
        error = estimate_error(problem, coarse, fine.states[compared], fine.record)
        if error <= tolerance:
            return fine.solution(max(error, estimate_rounding(problem, coarse, nudged)))

        # Their steps: finer and finer runs.
        for method in finer_methods:
            coarser = fine
            coarse = coarser.states[compared]
            fine = run(method)
            error = estimate_error(problem, coarse, fine.states[compared], fine.record)
            if error <= tolerance:
                nudged = coarser.method.run(problem.nudged_start, compared_times)
                return fine.solution(max(error, estimate_rounding(problem, coarse, nudged)))
    except DivergenceError as failure:
        raise not_reached(tolerance, str(failure)) from failure
    raise not_reached(
        tolerance,
        f"the error of the finest run is estimated at {error:.2g} rad: "
        "the motion is not smooth, or rounding decides",
    )


def estimate_error(problem: Problem, coarse: np.ndarray, fine: np.ndarray, record: Record) -> float:
    """Return the error of the finer of two runs [rad], by their distance and by its `record`."""
    distance = largest_distance(problem, coarse, fine)
    return max(SAFETY * distance, DRIFT * record.swing_error, record.axis_error)


def estimate_rounding(problem: Problem, coarse: np.ndarray, nudged: np.ndarray) -> float:
    """Return the effect of all rounding [rad], by the same run with a nudged start.

    Raises:
      ToleranceError: if it is more than the tolerance.
    """
    rounding = ROUNDING * largest_distance(problem, coarse, nudged)
    if rounding > problem.tolerance:
        raise not_reached(
            problem.tolerance, f"the rounding of the start grows to {rounding:.2g} rad"
        )
    return rounding


def largest_distance(problem: Problem, coarse: np.ndarray, fine: np.ndarray) -> float:
    """Return the largest distance of two runs in phi or u/a [rad], relative beyond 1 rad turned."""
    angles = problem.angles
    return largest_angle_error(coarse @ angles, fine @ angles, problem.start @ angles)


def not_reached(tolerance: float, reason: str) -> ToleranceError:
    """Return the error of a tolerance [rad] that is not reached."""
    return ToleranceError(f"tolerance {tolerance:g} rad is not reached: {reason}")
