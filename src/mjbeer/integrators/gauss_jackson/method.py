"""The integrator GaussJackson: a multistep method around MuJoCo's accelerations.

A step predicts phi from the sums of all accelerations and the last thirteen of them, evaluates
MuJoCo's acceleration there, and corrects phi with it. For the small change from the predicted to
the corrected phi, the law that phi nearly obeys says how the acceleration changes; without this the
method would be unstable. States are read off two steps later, with accelerations on both sides,
where the formula errs far less.

Steps are even in Sundman time. If the model has a slide, the *steady slide*, which is the slide
less arm sin(phi), is evenly accelerated, and is integrated in t. The motion is that of MuJoCo's
accelerations alone: with a wrong law the steps must only be shorter.

O. Montenbruck and E. Gill, Satellite Orbits, section 4.2; M. M. Berry and L. M. Healy,
Implementation of Gauss-Jackson integration for orbit propagation, J. Astronaut. Sci. 52 (2004), and
The generalized Sundman transformation for propagation of high-eccentricity elliptical orbits, Adv.
Astronaut. Sci. 112 (2002).
"""

import math
from typing import NamedTuple

import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.integrators import Observer
from mjbeer.integrators.compiling import compiled, inlined, kernel, optimize_for_size
from mjbeer.integrators.dynamics import (
    DONE,
    MORE,
    NOT_FINITE,
    ON_TIME,
    STEP_TOO_LONG,
    Block,
    Dynamics,
    Steps,
    room_for_ends,
    write,
)
from mjbeer.integrators.gauss_jackson.first_steps import (
    MIDDLE,
    History,
    evaluate,
    find_first_steps,
)
from mjbeer.integrators.gauss_jackson.step_curve import (
    Node,
    StepCurve,
    WholeStep,
    end_node,
    find,
    fit,
    whole_duration,
)
from mjbeer.integrators.gauss_jackson.sundman_time import LARGEST_TURN, SundmanTime, dt_ds
from mjbeer.integrators.gauss_jackson.weights import (
    COUNT,
    LAG,
    POSITION_WEIGHTS,
    VELOCITY_WEIGHTS,
    row_of,
    weighted,
)
from mjbeer.model.mujoco_library import MAX_STATE, quiet

BLOCK = 1024
"""Steps between two returns to Python, so that a long run can be interrupted."""
_NEXT = row_of(-1)
_LAST = row_of(0)


class _Totals(NamedTuple):
    """Sums of many terms: each is an array of the sum and of the rounding error it carries."""

    first_sum: np.ndarray  # of the accelerations of phi, in units of the step
    second_sum: np.ndarray  # of these sums
    time: np.ndarray  # at the last state that was read off [s]
    position: np.ndarray  # of the steady slide at that time [m]
    velocity: np.ndarray  # of the steady slide at that time [m/s]


class _Work(NamedTuple):
    """What a run carries on from block to block, and space to work in."""

    history: History
    """It begins with the last accelerations before a block, and has room for those of the block."""
    totals: _Totals
    coefficients: np.ndarray
    """Space for those of a `StepCurve`."""


class _Place(NamedTuple):
    """Where a run is between two blocks."""

    is_first: bool  # whether no block has been taken yet
    back: int  # how many steps before the last acceleration the last state was read off
    sample: int  # index of the next sample
    node: Node  # the last state that was read off


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model.

    The model has the hinge phi alone, or after a slide on which no acceleration depends. All steps
    last a `timestep` [s] in `sundman_time`. A step is one evaluation. DOP853 has twelve or more in
    a step that is about as long. A damping or a constraint that decays fast would make the method
    unstable.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(self, dynamics: Dynamics, timestep: float, sundman_time: SundmanTime) -> None:
        if dynamics.constrained:
            raise UnsupportedError(
                "GaussJackson integrates smooth motions only, and this model has constraints"
            )
        if dynamics.damped:
            raise UnsupportedError(
                "GaussJackson integrates undamped motions only, and this model has damping"
            )
        self.name = "GaussJackson"
        self._dynamics = dynamics
        self._timestep = timestep
        self._sundman_time = sundman_time

    @quiet()
    def run(
        self, start: np.ndarray, times: np.ndarray, observer: Observer | None = None
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv).

        The motion begins at time 0 with the state `start`.

        Raises:
          DivergenceError: if the motion stops being finite, the timestep is too long, or there are
            too many evaluations.
        """
        dynamics = self._dynamics
        sundman = self._sundman_time
        samples = Steps(times, np.empty((len(times), len(start))))
        at_start = int(times[0] == 0)  # samples that are there already
        samples.states[:at_start] = start
        dynamics.data.qpos[:] = 0.0
        dynamics.data.qvel[:] = 0.0
        work = _Work(
            history=History(np.zeros(COUNT + BLOCK), np.zeros(COUNT + BLOCK)),
            totals=_totals_at(start, sundman.arm),
            coefficients=np.empty(COUNT + 2),
        )
        dynamics.run_blocks(
            self.name,
            _advance,
            (dynamics.kernel_view, sundman, self._timestep, work, samples),
            _Place(is_first=True, back=MIDDLE, sample=at_start, node=_node_at(start, sundman)),
            room_for_ends(start, BLOCK + COUNT if observer else 0),
            observer,
        )
        return samples.states


def _node_at(start: np.ndarray, sundman: SundmanTime) -> Node:
    """Return the node at the start of a run."""
    phi = float(start[len(start) // 2 - 1])
    phi_dot = float(start[-1])
    dt_ds_there = dt_ds.py_func(sundman, phi)
    return Node(phi, phi_dot * dt_ds_there, dt_ds_there)


def _totals_at(start: np.ndarray, arm: float) -> _Totals:
    """Return the totals at the start of a run; the first steps give both sums of accelerations."""
    totals = _Totals(*np.zeros((5, 2)))
    joints = len(start) // 2
    if joints > 1:
        phi = float(start[joints - 1])
        totals.position[0] = float(start[0]) - arm * math.sin(phi)
        totals.velocity[0] = float(start[joints]) - arm * math.cos(phi) * float(start[-1])
    return totals


@kernel
def _advance(dynamics, sundman, timestep, work, samples, ends, place):
    """Take up to a block of steps, and return the `Block`.

    `dynamics` is a `ForwardDynamics`. The rows of `samples` whose times are passed are filled in,
    and the ends of steps are written to `ends`, if that has room.
    """
    optimize_for_size()
    history = work.history
    totals = work.totals
    back = place.back
    sample = place.sample
    node = place.node
    status = MORE
    evaluations = 0
    row = 0
    end = history.phi_second.size - BLOCK  # the accelerations before this index are there

    if place.is_first:
        row = 1  # the row before has the start
        begin = find_first_steps(dynamics, sundman, node, timestep, history)
        evaluations = begin.evaluations
        totals.first_sum[0] = begin.first_sum
        totals.second_sum[0] = begin.second_sum
        if not begin.found:
            status = STEP_TOO_LONG
        elif sample == samples.times.size:
            status = DONE

    while status == MORE and end < history.phi_second.size:
        # Have accelerations `LAG` steps ahead of the next state: the first steps reach further.
        if back > LAG:
            back -= 1
        else:
            _take_step(dynamics, sundman, timestep, work, end)
            end += 1
            evaluations += 1

        # Read off that state, and the time that passes until then.
        first_sum = totals.first_sum[0]
        second_sum = totals.second_sum[0]
        curve = StepCurve(work.coefficients, first_sum, second_sum, timestep, back + 1)
        after = end_node(sundman, curve, history.phi_second, end)
        if not abs(after.phi) < MAX_STATE:  # it may also be NaN
            status = NOT_FINITE
            break
        if not timestep * abs(after.rate) < LARGEST_TURN:
            status = STEP_TOO_LONG
            break
        duration = whole_duration(sundman, curve, history.phi_second, end)
        end_time = totals.time[0] + duration
        steady = _mean_steady(history, end - 1 - back, node, after)
        step = WholeStep(node, after, duration, end_time * (1 + ON_TIME), steady)

        # Write the samples in the step, and its end.
        if samples.times[sample] <= step.end_time:
            fit(curve, history.phi_second, end)
            sample = _write_samples(sundman, curve, step, totals, samples, sample)
            if sample == samples.times.size:
                status = DONE
        if row < ends.times.size:
            if status == DONE:  # the run ends with its last sample, within this step
                ends.times[row] = samples.times[sample - 1]
                write(samples.states[sample - 1], ends.states[row])
            else:
                ends.times[row] = end_time
                _write(sundman, after, step, totals, duration, ends.states, row)
            row += 1

        # Go on from its end.
        _add(totals.time, duration)
        _add(totals.position, duration * (totals.velocity[0] + duration * steady / 2))
        _add(totals.velocity, duration * steady)
        node = after

    for k in range(COUNT):  # the next block begins with the last accelerations of this one
        history.phi_second[k] = history.phi_second[end - COUNT + k]
        history.steady[k] = history.steady[end - COUNT + k]
    return Block(status, totals.time[0], evaluations, row, _Place(False, back, sample, node))


@inlined
def _take_step(dynamics, sundman, timestep, work, end):
    """Predict, evaluate and correct the next step; its accelerations get the index `end`."""
    history = work.history
    totals = work.totals
    square = timestep * timestep
    first_sum = totals.first_sum[0]
    second_sum = totals.second_sum[0]
    from_history = weighted(POSITION_WEIGHTS, _NEXT, history.phi_second, end)
    predicted = square * (second_sum + from_history)
    rate = timestep * (first_sum + weighted(VELOCITY_WEIGHTS, _NEXT, history.phi_second, end))
    evaluated = evaluate(dynamics, sundman, predicted, rate)
    history.phi_second[end] = evaluated.phi_second
    history.steady[end] = evaluated.steady
    from_history = weighted(POSITION_WEIGHTS, _LAST, history.phi_second, end + 1)
    corrected = square * (second_sum + from_history)
    law = sundman.law
    slope = law.sine * math.cos(predicted) - law.cosine * math.sin(predicted)
    acceleration = evaluated.phi_second + slope * (corrected - predicted)
    history.phi_second[end] = acceleration
    _add(totals.first_sum, acceleration)
    _add(totals.second_sum, totals.first_sum[0])


@inlined
def _mean_steady(history, index, before, after):
    """Return the mean acceleration of the steady slide in a step [m/s^2].

    The step ends at an `index` of the history, and its nodes are `before` and `after`. The
    acceleration would be constant but for rounding. Rounding is largest where the load is fastest,
    and there dt/ds, its weight in the mean, is least.
    """
    weighted_sum = before.dt_ds * history.steady[index - 1] + after.dt_ds * history.steady[index]
    return weighted_sum / (before.dt_ds + after.dt_ds)


@compiled
def _write_samples(sundman, curve, step, totals, samples, sample):
    """Write the samples within a step, from an index on, and return the index of the next one."""
    optimize_for_size()
    while sample < samples.times.size and samples.times[sample] <= step.end_time:
        since = samples.times[sample] - totals.time[0]
        node = find(sundman, curve, step, since)
        _write(sundman, node, step, totals, since, samples.states, sample)
        sample += 1
    return sample


@compiled
def _write(sundman, node, step, totals, since, states, row):
    """Write the state at a node to a row of `states`.

    The node is `since` [s] after the start of a step, where the `totals` hold.
    """
    optimize_for_size()
    last = states.shape[1] // 2 - 1
    phi_dot = node.rate / node.dt_ds
    states[row, last] = node.phi
    states[row, 2 * last + 1] = phi_dot
    if last > 0:
        velocity = totals.velocity[0]
        moved = since * (velocity + since * step.steady / 2)
        swinging = sundman.arm * math.cos(node.phi) * phi_dot
        states[row, 0] = totals.position[0] + moved + sundman.arm * math.sin(node.phi)
        states[row, 1 + last] = velocity + since * step.steady + swinging


@inlined
def _add(total, term):
    """Add a term to one of the totals, less the rounding error that it carries (Kahan's sum)."""
    value = total[0]
    term -= total[1]
    total[0] = value + term
    total[1] = (total[0] - value) - term
