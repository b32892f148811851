"""The integrator DOP853: an eighth-order Runge-Kutta method around MuJoCo's accelerations.

The twelve stages, the error estimate and the seventh-order continuous output are those of
E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, section II.10.
Their coefficients are in dop853.txt, and everything that takes steps is compiled code.
"""

import math
import pathlib
from typing import NamedTuple

import numpy as np

from mjbeer.integrators import Observer
from mjbeer.integrators.compiling import compiled, inlined, kernel, optimize_for_size
from mjbeer.integrators.dynamics import (
    DONE,
    MORE,
    NOT_FINITE,
    ON_TIME,
    STEP_TOO_SMALL,
    Block,
    Dynamics,
    Steps,
    room_for_ends,
    write,
    write_derivative,
)
from mjbeer.model.mujoco_library import MAX_STATE, quiet

# SciPy has these numbers, too, but its import takes longer than all others together.
_TABLEAU = np.loadtxt(pathlib.Path(__file__).with_suffix(".txt"))
_END = 12
"""Index of the stage at the end of the step: twelve come before it, and after it three for the
continuous output."""
_STAGES = 16
_THIRD_ORDER_ERROR = 16
"""Row of the tableau with the error by the embedded formula of third order."""
_FIFTH_ORDER_ERROR = 17
_OUTPUT = 18
"""First row of the tableau for the continuous output."""
_COEFFICIENTS = 7
"""Number of coefficients of the continuous output, for each component of the state."""

_CAUTION = 0.9
"""The next step divided by the one whose error would just be tolerated.

This and the next four numbers are those of Hairer's DOPRI5."""
_SHRINK = 0.2
"""Least ratio of a step to the one before."""
_GROW = 10.0
"""Largest ratio of a step to the one before."""
_MEMORY = 0.04
"""Power (beta) of the error of the step before in the next one: it saves two of three rejected
steps."""
_LEAST_ERROR = 1e-4
"""Smallest error of the step before that counts."""
_LEAST_NEW_ERROR = 1e-12
"""Smallest error of the step itself that counts: without any error the next step would be infinite.
At this error it is already about `_GROW` times as long."""
_SHORTEST = 4e-16
"""Shortest step divided by the time that has passed: with a shorter one time stands still."""
_SHORTEST_AT_START = 1e-200
"""Shortest step [s] where no time has passed yet: far below what any motion needs."""
_IS_AT_END = 1e-12
"""Share of a step within which a sample is at its end: what the two times differ by is rounding."""
_BLOCK = 20_000
"""Steps between two returns to Python, so that a long run can be interrupted."""
_HALVINGS = 30
"""Halvings of a step in which a corner is looked for: to 1e-9 of it."""
_AT_AN_END = 1e-6
"""Share of a step within which a corner is at its end. A torque with the square of the rate is then
1e-12 off there."""
_ROUNDING = 32 * float(np.finfo(float).eps)
"""Size of a sum of rates that may be the rounding of its terms, divided by the sum of their
sizes."""


class _Control(NamedTuple):
    """How steps are chosen."""

    fixed: bool  # whether all steps are equal; if so, the rest does not count
    tolerance: float  # largest error of a step divided by `scale` + |state|
    scale: np.ndarray  # shape (nq + nv,)
    longest: float  # [s]
    corners: np.ndarray  # rates at whose zeros steps end, as weights of the state's components


class _Work(NamedTuple):
    """The step that is being taken, and space to work in; the states have shape (nq + nv,)."""

    state: np.ndarray  # at the start of the step
    carry: np.ndarray  # by how much rounding has made that state too large
    end: np.ndarray  # the state at the end of the step
    end_carry: np.ndarray  # by how much rounding has made it too large
    stages: np.ndarray  # derivatives at the stages, the begin's first
    output: np.ndarray  # coefficients of the continuous output
    spare: np.ndarray  # a state in between


class _Place(NamedTuple):
    """Where a run is between two blocks."""

    time: float  # [s]
    time_carry: float  # by how much rounding has made it too large [s]
    step: float  # length of the next step [s]
    sample: int  # index of the next sample
    steps: int  # taken so far
    error: float  # of the last step divided by the tolerated one
    longest: float  # step so far [s]


class DOP853:
    """The DOP853 method around the forward dynamics of a model of slides and hinges.

    With a `timestep` [s] the step is fixed. Without it each step keeps its local error below
    `local_tolerance` times (`scale` + |state|), with a `scale` of shape (nq + nv,), 1 by default,
    and lasts no longer than `longest_step` [s].

    A damping with the square of a rate, v |v|, has a corner where that rate passes zero. Steps of
    variable length end there, as the method's order holds on either side only.
    """

    def __init__(
        self,
        dynamics: Dynamics,
        timestep: float | None = None,
        local_tolerance: float = 1e-10,
        scale: np.ndarray | None = None,
        longest_step: float = math.inf,
    ) -> None:
        self.name = "DOP853"
        self._dynamics = dynamics
        self._timestep = timestep
        self._control = _Control(
            fixed=timestep is not None,
            tolerance=local_tolerance,
            scale=np.ones(dynamics.model.nq + dynamics.model.nv) if scale is None else scale,
            longest=longest_step,
            corners=dynamics.corners,
        )
        self.longest_step_taken = 0.0
        """Longest step of the last run [s]."""

    @quiet()
    def run(
        self, start: np.ndarray, times: np.ndarray, observer: Observer | None = None
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv).

        The motion begins at time 0 with the state `start`.

        Raises:
          DivergenceError: if the motion stops being finite, no step is small enough, or there are
            too many evaluations.
        """
        size = len(start)
        samples = Steps(times, np.empty((len(times), size)))
        at_start = int(times[0] == 0)  # samples that are there already
        samples.states[:at_start] = start
        slope = self._dynamics.derivative(start)
        work = _Work(
            state=start.copy(),
            carry=np.zeros(size),
            end=np.zeros(size),
            end_carry=np.zeros(size),
            stages=np.zeros((_STAGES, size)),
            output=np.zeros((_COEFFICIENTS, size)),
            spare=np.zeros(size),
        )
        work.stages[0] = slope
        place = _Place(
            time=0.0,
            time_carry=0.0,
            step=self._timestep or self._first_step(start, slope, times[-1]),
            sample=at_start,
            steps=0,
            error=1.0,
            longest=0.0,
        )
        place = self._dynamics.run_blocks(
            self.name,
            _advance,
            (self._dynamics.kernel_view, _TABLEAU, self._control, work, samples),
            place,
            room_for_ends(start, _BLOCK + 1 if observer else 0),
            observer,
        )
        self.longest_step_taken = place.longest
        return samples.states

    def _first_step(self, start: np.ndarray, slope: np.ndarray, duration: float) -> float:
        """Return the first step [s] of variable length: the state changes little in it.

        It depends on the tolerance, as two runs that are compared must not have the same steps.
        """
        control = self._control
        rate = float(np.abs(slope / (control.scale + np.abs(start))).max())  # NaN stays NaN
        slowest = 1 / duration if duration else 1.0
        return min(control.tolerance ** (1 / 8) / max(rate, slowest), control.longest)


@kernel
def _advance(dynamics, tableau, control, work, samples, ends, place):
    """Take up to a block of steps, and return the `Block`.

    `dynamics` is a `ForwardDynamics`. The `tableau` is an argument, as a compiler takes seconds to
    unroll all loops over numbers that it knows. `work` comes with the state and the derivative at
    the start of the first step. The rows of `samples` whose times are passed are filled in, and the
    ends of steps are written to `ends`, if that has room.
    """
    optimize_for_size()
    state = work.state
    end = work.end
    time = place.time
    time_carry = place.time_carry
    step = place.step
    sample = place.sample
    steps = place.steps
    error_before = place.error
    longest = place.longest
    status = MORE
    evaluations = 0
    row = int(steps == 0)  # the first row of the first block is the start
    for _ in range(_BLOCK):
        if sample == samples.times.size:
            status = DONE
            break

        # Take a step.
        for stage in range(1, _END + 1):
            _evaluate(dynamics, tableau, work, step, stage, end)
        evaluations += _END
        _end_step(tableau, work, step)
        finite = _is_finite(end)
        if control.fixed and not finite:
            status = NOT_FINITE
            break

        # If its length is variable, take it again where its error is too large, or to a corner.
        error = 0.0
        has_output = False
        if not control.fixed:
            error = _error(tableau, control, work, step) if finite else np.inf
            if not error < 1.0:
                step *= max(_SHRINK, _CAUTION * error ** (-1 / 8)) if finite else _SHRINK
                if not step > max(_SHORTEST * time, _SHORTEST_AT_START):  # it may also be NaN
                    status = STEP_TOO_SMALL if finite else NOT_FINITE
                    break
                continue
            if _passes_corner(control.corners, state, end):
                evaluations += _prepare_output(dynamics, tableau, work, step)
                has_output = True
                to_corner = _first_corner(control.corners, work)
                if to_corner < 1.0:
                    step *= to_corner
                    continue

        # It stands. Read off the samples in it.
        steps += 1
        added = step - time_carry  # as in `_end_step`
        end_time = steps * step if control.fixed else time + added
        passed = end_time * (1 + ON_TIME)
        while sample < samples.times.size and samples.times[sample] <= passed:
            part = (samples.times[sample] - time) / (end_time - time)
            if part > 1 - _IS_AT_END:
                write(end, samples.states[sample])
            else:
                if not has_output:
                    evaluations += _prepare_output(dynamics, tableau, work, step)
                    has_output = True
                _interpolate(work, part, samples.states[sample])
            sample += 1

        # Go on from its end.
        time_carry = (end_time - time) - added
        time = end_time
        write(end, state)
        write(work.end_carry, work.carry)
        write(work.stages[_END], work.stages[0])
        longest = max(longest, step)
        if row < ends.times.size:
            _write_end(samples, ends, row, time, state)
            row += 1
        if not control.fixed:
            remaining = samples.times[samples.times.size - 1] - time
            step = _next_step(control, step, error, error_before, remaining)
            error_before = max(error, _LEAST_ERROR)
    place = _Place(time, time_carry, step, sample, steps, error_before, longest)
    return Block(status, time, evaluations, row, place)


@inlined
def _evaluate(dynamics, tableau, work, step, stage, out):
    """Evaluate the derivative at a `stage` of the step, and leave the state there in `out`."""
    for i in range(out.size):
        out[i] = 0.0
    for earlier in range(stage):  # stage by stage, so that additions can overlap
        weight = tableau[stage, earlier]
        if weight != 0.0:
            for i in range(out.size):
                out[i] += weight * work.stages[earlier, i]
    for i in range(out.size):
        out[i] = work.state[i] + step * out[i]
    write_derivative(dynamics, out, work.stages[stage])


@inlined
def _end_step(tableau, work, step):
    """Write the state at the end of the step, less what rounding has added (Kahan's sum)."""
    for i in range(work.end.size):
        rate = 0.0
        for stage in range(_END):
            rate += tableau[_END, stage] * work.stages[stage, i]
        change = step * rate - work.carry[i]
        work.end[i] = work.state[i] + change
        work.end_carry[i] = (work.end[i] - work.state[i]) - change


@inlined
def _is_finite(state):
    """Return whether no component of a state is larger than MuJoCo allows."""
    finite = True
    for i in range(state.size):
        finite = finite and abs(state[i]) < MAX_STATE
    return finite


@compiled
def _error(tableau, control, work, step):
    """Return the estimated error of the step divided by the tolerated one."""
    optimize_for_size()
    fifth_squares = 0.0
    third_squares = 0.0
    for i in range(work.state.size):
        fifth = 0.0
        third = 0.0
        for stage in range(_STAGES):
            third += tableau[_THIRD_ORDER_ERROR, stage] * work.stages[stage, i]
            fifth += tableau[_FIFTH_ORDER_ERROR, stage] * work.stages[stage, i]
        largest = max(abs(work.state[i]), abs(work.end[i]))
        tolerated = control.tolerance * (control.scale[i] + largest)
        fifth_squares += fifth / tolerated * (fifth / tolerated)  # a power takes long to compile
        third_squares += third / tolerated * (third / tolerated)
    size = math.sqrt((fifth_squares + 0.01 * third_squares) * work.state.size)
    return step * fifth_squares / size if size > 0 else 0.0


@inlined
def _next_step(control, step, error, error_before, remaining):
    """Return the next step [s] after one with this `error`; `remaining` is left of the run [s]."""
    # exponents as in DOPRI5, for order 8
    power = 0.75 * _MEMORY - 1 / 8
    growth = _CAUTION * max(error, _LEAST_NEW_ERROR) ** power * error_before**_MEMORY
    following = min(control.longest, step * min(_GROW, max(_SHRINK, growth)))
    if remaining > 0:  # a motion at rest would take steps without bound
        following = min(following, remaining)
    return following


@inlined
def _write_end(samples, ends, row, time, state):
    """Write the end of a step to a row of `ends`: at the latest, the last sample."""
    last = samples.times.size - 1
    if time > samples.times[last]:
        ends.times[row] = samples.times[last]
        write(samples.states[last], ends.states[row])
    else:
        ends.times[row] = time
        write(state, ends.states[row])


@compiled
def _prepare_output(dynamics, tableau, work, step):
    """Write the coefficients of the continuous output; return the number of evaluations."""
    optimize_for_size()
    output = work.output
    stages = work.stages
    for stage in range(_END + 1, _STAGES):
        _evaluate(dynamics, tableau, work, step, stage, work.spare)
    for i in range(work.state.size):
        change = work.end[i] - work.state[i]
        output[0, i] = change
        output[1, i] = step * stages[0, i] - change
        output[2, i] = 2 * change - step * (stages[_END, i] + stages[0, i])
        for k in range(3, _COEFFICIENTS):
            output[k, i] = 0.0
            for stage in range(_STAGES):
                output[k, i] += step * tableau[_OUTPUT - 3 + k, stage] * stages[stage, i]
    return _STAGES - _END - 1


@compiled
def _interpolate(work, part, out):
    """Write the state after a `part` of the step, between 0 and 1, to `out`."""
    optimize_for_size()
    for i in range(out.size):
        value = 0.0
        for k in range(_COEFFICIENTS - 1, -1, -1):
            value += work.output[k, i]
            value *= part if k % 2 == 0 else 1 - part
        out[i] = work.state[i] + value


@compiled
def _passes_corner(corners, state, end):
    """Return whether one of the `corners`' rates, if it is no rounding, changes its sign."""
    optimize_for_size()
    for row in range(len(corners)):
        first = 0.0
        last = 0.0
        size = 0.0
        for i in range(state.size):
            first += corners[row, i] * state[i]
            last += corners[row, i] * end[i]
            size += abs(corners[row, i]) * max(abs(state[i]), abs(end[i]))
        if first * last < 0 and min(abs(first), abs(last)) > _ROUNDING * size:
            return True
    return False


@compiled
def _first_corner(corners, work):
    """Return the part of the step after which the first of the rates changes its sign.

    It is 1 if they do so at an end of the step only.
    """
    optimize_for_size()
    first = 1.0
    for row in range(len(corners)):
        at_begin = 0.0
        for i in range(work.state.size):
            at_begin += corners[row, i] * work.state[i]
        low = 0.0
        high = first
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            _interpolate(work, middle, work.spare)
            rate = 0.0
            for i in range(work.state.size):
                rate += corners[row, i] * work.spare[i]
            if rate * at_begin > 0:
                low = middle
            else:
                high = middle
        if _AT_AN_END < high < 1 - _AT_AN_END:
            first = high
    return first
