"""The integrator DOP853: an eighth-order Runge-Kutta method around MuJoCo's forward dynamics, in compiled code.

The twelve stages, the error estimate and the seventh-order continuous output are those of E. Hairer, S. P. Norsett and
G. Wanner, Solving Ordinary Differential Equations I, section II.10 (coefficients in dop853.txt).
"""

import math
import pathlib

import mujoco
import numpy as np

from mjbeer.integrators import Observer
from mjbeer.integrators.dynamics import (
    BLOCK_END,
    DONE,
    NOT_FINITE,
    TOO_SMALL,
    Dynamics,
    compiled,
    copy,
    derivative,
    inline,
    inner,
    run_blocks,
    small,
)
from mjbeer.model.mujoco_library import LARGEST, quiet

# SciPy has these numbers too, but to import scipy.integrate takes longer than all other imports together.
_TABLEAU = np.loadtxt(pathlib.Path(__file__).with_suffix(".txt"))
_END = 12
"""Index of the end of the step among the stages: twelve are before it, and three for the continuous output after."""
_ERRORS, _OUTPUT = 16, 18
"""Rows of the tableau after those of the stages: of the two error estimates, and of the continuous output."""
_CAUTION, _SHRINK, _GROW = 0.9, 0.2, 10.0  # step-size control, as in the reference
_MEMORY = 0.04  # beta of the reference, by which the error of the step before counts: saves two of three rejected steps
_LEAST = 1e-4  # smallest error of the step before that counts
_BLOCK = 20_000  # steps between two returns to Python, so that a long run can be interrupted
_HALVINGS = 30  # of a step in which a corner is looked for: to 1e-9 of it
_BESIDE = 1e-6
"""Share of a step that a corner may be from its ends. A torque with the square of the rate is then 1e-12 off there."""
_ROUNDING = 32 * float(np.finfo(float).eps)
"""Size of a sum of rates that may be the rounding of its terms, over these."""


class DOP853:
    """The DOP853 method around the forward dynamics of a model of slides and hinges, set up once and run often.

    A damping with the square of a rate, v |v|, has a corner where that rate passes zero. Steps of variable length end
    there, as the method's order holds on either side only.
    """

    def __init__(self, model: mujoco.MjModel, dynamics: Dynamics | None = None) -> None:
        self._size, self._dynamics = model.nq + model.nv, dynamics or Dynamics(model)
        self._corners = _corners(model)
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""
        self.longest = 0.0
        """Longest step of the last run [s]."""

    @quiet()
    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float | None = None,
        tolerance: float = 1e-10,
        scale: np.ndarray | None = None,
        limit: float = math.inf,
        longest: float = math.inf,
        observer: Observer | None = None,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        With a `timestep` [s] the step is fixed. Without it each step keeps its local error below `tolerance` times
        (`scale` + |state|), with `scale` of shape (nq + nv,), and lasts no longer than `longest` [s]. The run is given
        up after `limit` evaluations.

        Raises:
          DivergenceError: if the motion stops being finite, no step is small enough, or the limit is reached.
        """
        scale, slope = np.ones(self._size) if scale is None else scale, self._dynamics.rates(start)
        pace = float(np.abs(slope / (scale + np.abs(start))).max())
        # It depends on the tolerance, as two runs that are compared must not have the same steps. NaN stays NaN.
        step = timestep or min(tolerance ** (1 / 8) / max(pace, 1 / times[-1] if times[-1] else 1.0), longest)
        samples, stages, work = (np.zeros((rows, self._size)) for rows in (len(times), _ERRORS, 10))
        stages[0], work[0], sample = slope, start, int(times[0] == 0)
        samples[:sample] = start
        size = _BLOCK + 1 if observer else 0
        kept = np.zeros(size), np.empty((size, self._size))
        kept[1][:1] = start
        control = timestep is not None, tolerance, scale, longest, self._corners
        fixed = *self._dynamics.kernel, _TABLEAU, *work[:3], stages, work[3:], times, samples, control, kept
        place = 0.0, step, sample, 0, 1.0, 0.0
        evaluations, place = run_blocks("DOP853", _advance, fixed, place, limit, observer)
        self.evaluations, self.longest = evaluations + 1, place[-1]
        return samples


def _corners(model: mujoco.MjModel) -> np.ndarray:
    """Return the sums of the state whose squares damp it, each with its sign, as rows of shape (nq + nv,).

    They are the rates of joints, and of tendons that are sums of joints.
    """
    rows = [*np.eye(model.nv)[model.dof_dampingpoly[:, 0] > 0]]
    for tendon in np.flatnonzero(model.tendon_dampingpoly[:, 0] > 0):
        parts = slice(model.tendon_adr[tendon], model.tendon_adr[tendon] + model.tendon_num[tendon])
        row = np.zeros(model.nv)
        row[model.jnt_dofadr[model.wrap_objid[parts]]] = model.wrap_prm[parts]
        rows.append(row)
    return np.pad(np.reshape(rows, (len(rows), model.nv)), ((0, 0), (model.nq, 0)))


@inline
def _evaluate(pointers, views, tableau, state, step, stage, stages, out):
    """Evaluate the derivative at a `stage` of a step from `state`, and leave the state there in `out`."""
    for i in range(out.size):
        out[i] = 0.0
    for j in range(stage):  # stage by stage, so that additions can overlap
        weight = tableau[stage, j]
        if weight != 0.0:
            for i in range(out.size):
                out[i] += weight * stages[j, i]
    for i in range(out.size):
        out[i] = state[i] + step * out[i]
    derivative(pointers, views, out, stages[stage])


@compiled
def _advance(pointers, views, tableau, state, new, work, stages, output, times, samples, control, kept, place):
    """Take up to a block of steps, and return the status, the new place and the numbers of evaluations and rows kept.

    `pointers` and `views` are those of `derivative`. The `tableau` is an argument, as a compiler takes seconds to
    unroll all loops over numbers that it knows. `state` is moved on. `stages` come with the derivative there in their
    first row; `new`, `work` and `output` are space to work in. The rows of `samples` whose `times` [s] are passed are
    filled in.

    `control` says whether the step is fixed, and has the tolerance, scale, longest step and corners of a variable one.
    `place` is the time, the step, the next sample, the number of steps, the error of the last one and the longest one.
    `kept` takes times and states at the ends of steps, after the start in the first block, or has no room.
    """
    small()
    time, step, sample, steps, before, reached = place
    fixed, tolerance, scale, longest, corners = control
    kept_times, kept_states = kept
    status, evaluations, row, error = BLOCK_END, 0, int(steps == 0), 0.0
    for _ in range(_BLOCK):
        if sample == times.size:
            status = DONE
            break
        for stage in range(1, _END + 1):
            _evaluate(pointers, views, tableau, state, step, stage, stages, new)
        evaluations += _END
        finite = True
        for i in range(new.size):
            finite = finite and abs(new[i]) < LARGEST
        if fixed and not finite:
            status = NOT_FINITE
            break
        if not fixed:
            error = _error(tableau, state, new, stages, step, tolerance, scale) if finite else np.inf
            if not error < 1.0:
                step *= max(_SHRINK, _CAUTION * error ** (-1 / 8)) if finite else _SHRINK
                if not step > 4e-16 * max(time, 1e-300) or step < 1e-200:
                    status = TOO_SMALL if finite else NOT_FINITE
                    break
                continue
        prepared = not fixed and _passes(corners, state, new)
        if prepared:
            evaluations += _prepare(pointers, views, tableau, state, new, step, stages, work, output)
            part = _corner(corners, state, output, work)
            if part < 1.0:
                step *= part
                continue
        steps += 1
        end = steps * step if fixed else time + step
        last = end * (1 + 1e-14)
        while sample < times.size and times[sample] <= last:
            part = (times[sample] - time) / (end - time)
            if part > 1 - 1e-12:
                copy(new, samples[sample])
            else:
                if not prepared:
                    evaluations += _prepare(pointers, views, tableau, state, new, step, stages, work, output)
                    prepared = True
                _interpolate(state, output, part, samples[sample])
            sample += 1
        time = end
        copy(new, state)
        copy(stages[_END], stages[0])
        if row < kept_times.size:
            kept_times[row] = min(time, times[-1])  # a fixed step may go beyond the last sample, which is there by now
            copy(samples[times.size - 1] if time > times[-1] else state, kept_states[row])
            row += 1
        reached = max(reached, step)
        if not fixed:
            growth = _CAUTION * max(error, 1e-12) ** (0.75 * _MEMORY - 1 / 8) * before**_MEMORY
            step = min(longest, step * min(_GROW, max(_SHRINK, growth)))
            before = max(error, _LEAST)
            if time < times[-1]:  # a motion at rest would take steps without bound
                step = min(step, times[-1] - time)
    return status, (time, step, sample, steps, before, reached), evaluations, row


@inner
def _passes(corners, state, new):
    """Return whether a sum that the `corners` name, and that is not rounding, changes its sign in a step."""
    small()
    for row in range(len(corners)):
        first = second = rounding = 0.0
        for i in range(state.size):
            first += corners[row, i] * state[i]
            second += corners[row, i] * new[i]
            rounding += abs(corners[row, i]) * max(abs(state[i]), abs(new[i]))
        if first * second < 0 and min(abs(first), abs(second)) > _ROUNDING * rounding:
            return True
    return False


@inner
def _corner(corners, state, output, work):
    """Return the share of a step after which the first of the sums changes its sign; 1 if only at one of its ends."""
    small()
    first = 1.0
    for row in range(len(corners)):
        low, high, sign = 0.0, first, 0.0
        for i in range(state.size):
            sign += corners[row, i] * state[i]
        for _ in range(_HALVINGS):
            middle, value = (low + high) / 2, 0.0
            _interpolate(state, output, middle, work)
            for i in range(state.size):
                value += corners[row, i] * work[i]
            if value * sign > 0:
                low = middle
            else:
                high = middle
        if _BESIDE < high < 1 - _BESIDE:
            first = high
    return first


@inner
def _error(tableau, state, new, stages, step, tolerance, scale):
    """Return the estimated error of a step over the tolerated one."""
    small()
    fifth = third = 0.0
    for i in range(state.size):
        weight, five, three = tolerance * (scale[i] + max(abs(state[i]), abs(new[i]))), 0.0, 0.0
        for j in range(len(stages)):
            three += tableau[_ERRORS, j] * stages[j, i]
            five += tableau[_ERRORS + 1, j] * stages[j, i]
        fifth += five / weight * (five / weight)  # a power would be compiled a twentieth of a second
        third += three / weight * (three / weight)
    size = math.sqrt((fifth + 0.01 * third) * state.size)
    return abs(step) * fifth / size if size > 0 else 0.0


@inner
def _prepare(pointers, views, tableau, state, new, step, stages, work, output):
    """Write the coefficients of the continuous output over a step, and return the number of evaluations."""
    small()
    for stage in range(_END + 1, _ERRORS):
        _evaluate(pointers, views, tableau, state, step, stage, stages, work)
    for i in range(state.size):
        change = new[i] - state[i]
        output[0, i] = change
        output[1, i] = step * stages[0, i] - change
        output[2, i] = 2 * change - step * (stages[_END, i] + stages[0, i])
        for k in range(3, len(output)):
            output[k, i] = 0.0
            for j in range(len(stages)):
                output[k, i] += step * tableau[_OUTPUT - 3 + k, j] * stages[j, i]
    return _ERRORS - _END - 1


@inner
def _interpolate(state, output, part, out):
    """Write the state after the fraction `part` of a step from `state` to `out`."""
    small()
    for i in range(state.size):
        value = 0.0
        for k in range(6, -1, -1):
            value += output[k, i]
            value *= part if k % 2 == 0 else 1 - part
        out[i] = state[i] + value
