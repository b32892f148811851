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
)
from mjbeer.model.mujoco_library import LARGEST

_ROWS = 16
"""Number of derivatives that are kept: of twelve stages, of the end of the step, three for the continuous output."""
_SPACE = 10
"""Number of rows beside them to work in: for a state, two sums, and seven of the continuous output."""
# SciPy has these numbers too, but to import scipy.integrate takes longer than all other imports together.
_TABLEAU = np.loadtxt(pathlib.Path(__file__).with_suffix(".txt"))
_A, _B, _E3, _E5 = _TABLEAU[:12, :12].copy(), *_TABLEAU[12:15, :13].copy()
_A_EXTRA, _D = _TABLEAU[15:18].copy(), _TABLEAU[18:].copy()
_STAGES = len(_A)
_CAUTION, _SHRINK, _GROW = 0.9, 0.2, 10.0  # step-size control, as in the reference
_MEMORY = 0.04  # beta of the reference, by which the error of the step before counts: saves two of three rejected steps
_LEAST = 1e-4  # smallest error of the step before that counts
_BLOCK = 20_000  # steps between two returns to Python, so that a long run can be interrupted
_HALVINGS = 30  # of a step in which a corner is looked for: to 1e-9 of it
_BESIDE = 1e-6
"""Share of a step that a corner may be from its ends. A torque with the square of the rate is then 1e-12 off there."""
_ROUNDING = 32 * float(np.finfo(float).eps)
"""Size of a sum of rates that may be the rounding of its terms, over these."""
_KEPT = _BLOCK + 1
"""Largest number of steps of a block that are kept, with the start."""


class Dop853:
    """The DOP853 method around the forward dynamics of a model of slides and hinges, set up once and run often.

    The `dynamics` are the model's, if they are there already. A damping with the square of a rate, v |v|, has a corner
    where that rate passes zero: steps of variable length end there, as the method's order holds on either side only.
    """

    def __init__(self, model: mujoco.MjModel, dynamics: Dynamics | None = None) -> None:
        self._size, self._dynamics = model.nq + model.nv, dynamics or Dynamics(model)
        self._corners = _corners(model)
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""
        self.longest = 0.0
        """Longest step of the last run [s]."""

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
        state, samples = start.copy(), np.empty((len(times), self._size))
        stages = np.zeros((_ROWS + _SPACE, self._size))
        scale = np.ones(self._size) if scale is None else scale
        rows, place, found = _KEPT if observer else 0, (0.0, timestep or 0.0, 0, 0, 1.0), np.zeros(1)
        kept = np.empty(rows), np.empty((rows, self._size))
        control = timestep is not None, tolerance, scale, longest, self._corners, found
        fixed = *self._dynamics.kernel, state, stages, times, samples, control, kept
        self.evaluations = run_blocks("DOP853", _advance, fixed, place, limit, observer)
        self.longest = float(found[0])
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
def _combine(weights, count, stages, out):
    """Write the weighted sum of the first `count` stages to `out`, stage by stage, so that additions can overlap."""
    for i in range(out.size):
        out[i] = 0.0
    for j in range(count):
        weight = weights[j]
        if weight != 0.0:
            for i in range(out.size):
                out[i] += weight * stages[j, i]


@compiled()
def _advance(pointers, views, state, stages, times, samples, control, kept, place):
    """Take up to a block of steps, and return the status, the new place and the numbers of evaluations and rows kept.

    `pointers` are addresses of the functions that compute an acceleration, of the model and of its data; `views` are
    qpos, qvel and acceleration in that data, and the mask of the components of qpos that are needed. `state` is moved
    on. `stages`, of shape (_ROWS + _SPACE, states), comes with the derivative at `state` in its first row, except in
    the first block, and ends with space to work in. The rows of `samples` whose `times` [s] the steps pass are filled
    in.

    `control` says whether the step is fixed; otherwise its error is kept below a tolerance times (scale + |state|) in
    each component, and it lasts no longer than `longest` and ends at `corners`; its last part takes the longest step.
    `place` is the time, the step, the index of the next sample, the number of steps and the error of the last step.
    `kept` takes times and states at the start of the run and at the ends of this block's steps: it has room for `_KEPT`
    of them, or for none.
    """
    time, step, sample, steps, before = place
    fixed, tolerance, scale, longest, corners, found = control
    kept_times, kept_states = kept
    count = _A.shape[0]  # for a constant, numba would compile `_combine` once more
    size = state.size
    new, work, total, weights, stages = stages[-1], stages[-2], stages[-3], stages[_ROWS:-3], stages[:_ROWS]
    status, evaluations, row = BLOCK_END, 0, 0
    if steps == 0:
        derivative(pointers, views, state, stages[0])
        evaluations += 1
        if not fixed:
            step = _first_step(pointers, views, state, stages, tolerance, scale, work)
            step = longest if step > longest else step  # which keeps what is no number
            evaluations += 1
        if kept_times.size > 0:
            kept_times[row] = time
            copy(state, kept_states[row])
            row += 1
    for _ in range(_BLOCK):
        while sample < times.size and times[sample] <= time:
            copy(state, samples[sample])
            sample += 1
        if sample == times.size:
            status = DONE
            break
        for s in range(1, _STAGES):
            _combine(_A[s], s, stages, total)
            for i in range(size):
                work[i] = state[i] + step * total[i]
            derivative(pointers, views, work, stages[s])
        _combine(_B, count, stages, total)
        finite = True
        for i in range(size):
            new[i] = state[i] + step * total[i]
            finite = finite and abs(new[i]) < LARGEST
        evaluations += _STAGES - 1
        if fixed and not finite:
            status = NOT_FINITE
            break
        if not fixed:
            error = np.inf
            if finite:
                error = _error(state, new, stages, step, tolerance, scale, work, total)
            if not error < 1.0:
                step *= max(_SHRINK, _CAUTION * error ** (-1 / 8)) if finite else _SHRINK
                if not step > 4e-16 * max(time, 1e-300) or step < 1e-200:
                    status = TOO_SMALL if finite else NOT_FINITE
                    break
                continue
        derivative(pointers, views, new, stages[_STAGES])
        evaluations += 1
        prepared = False
        if not fixed and _passes(corners, state, new):
            _prepare(pointers, views, state, new, stages, step, work, weights)
            evaluations += 3
            prepared = True
            part = _corner(corners, state, new, weights, work)
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
                    _prepare(pointers, views, state, new, stages, step, work, weights)
                    evaluations += 3
                    prepared = True
                _interpolate(state, weights, part, samples[sample])
            sample += 1
        time = end
        copy(new, state)
        copy(stages[_STAGES], stages[0])
        if kept_times.size > 0:
            kept_times[row] = min(time, times[-1])  # a fixed step may go beyond the last sample, which is there by now
            copy(samples[times.size - 1] if time > times[-1] else state, kept_states[row])
            row += 1
        found[0] = max(found[0], step)
        if not fixed:
            growth = _CAUTION * max(error, 1e-12) ** (0.75 * _MEMORY - 1 / 8) * before**_MEMORY
            step = min(longest, step * min(_GROW, max(_SHRINK, growth)))
            before = max(error, _LEAST)
            if time < times[-1]:  # a motion at rest would take steps without bound
                step = min(step, times[-1] - time)
    return status, (time, step, sample, steps, before), evaluations, row


@inner
def _passes(corners, state, new):
    """Return whether one of the sums that the `corners` name changes its sign between two states.

    A sum that is rounding has no sign.
    """
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
def _corner(corners, state, new, weights, work):
    """Return the share of a step after which the first of the sums changes its sign; 1 if only at one of its ends."""
    first = 1.0
    for row in range(len(corners)):
        low, high, sign = 0.0, first, 0.0
        for i in range(state.size):
            sign += corners[row, i] * state[i]
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            _interpolate(state, weights, middle, work)
            value = 0.0
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
def _first_step(pointers, views, state, stages, tolerance, scale, work):
    """Return the first step [s], by Hairer's algorithm in section II.4.

    Unlike there it always depends on the tolerance: two runs that are compared must not have the same steps.
    """
    size = state.size
    d0 = d1 = 0.0
    for i in range(size):
        weight = tolerance * (scale[i] + abs(state[i]))
        d0 += (state[i] / weight) ** 2
        d1 += (stages[0, i] / weight) ** 2
    d0, d1 = math.sqrt(d0 / size), math.sqrt(d1 / size)
    guess = 1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1
    for i in range(size):
        work[i] = state[i] + guess * stages[0, i]
    derivative(pointers, views, work, stages[1])
    d2 = 0.0
    for i in range(size):
        d2 += ((stages[1, i] - stages[0, i]) / (tolerance * (scale[i] + abs(state[i])))) ** 2
    d2 = math.sqrt(d2 / size) / guess
    if max(d1, d2) <= 1e-15:
        return max(1e-6, guess * 1e-3)
    return min(100 * guess * tolerance ** (1 / 8), (0.01 / max(d1, d2)) ** (1 / 8))


@inner
def _error(state, new, stages, step, tolerance, scale, five, three):
    """Return the estimated error of a step over the tolerated one."""
    fifth, third, count = 0.0, 0.0, _A.shape[0]
    _combine(_E5, count, stages, five)
    _combine(_E3, count, stages, three)
    for i in range(state.size):
        weight = tolerance * (scale[i] + max(abs(state[i]), abs(new[i])))
        fifth += (five[i] / weight) ** 2
        third += (three[i] / weight) ** 2
    size = math.sqrt((fifth + 0.01 * third) * state.size)
    return abs(step) * fifth / size if size > 0 else 0.0


@inner
def _prepare(pointers, views, state, new, stages, step, work, weights):
    """Write the coefficients of the continuous output over the last step to `weights`."""
    for row in range(3):
        _combine(_A_EXTRA[row], _STAGES + 1 + row, stages, work)
        for i in range(state.size):
            work[i] = state[i] + step * work[i]
        derivative(pointers, views, work, stages[_STAGES + 1 + row])
    for i in range(state.size):
        change = new[i] - state[i]
        weights[0, i] = change
        weights[1, i] = step * stages[0, i] - change
        weights[2, i] = 2 * change - step * (stages[_STAGES, i] + stages[0, i])
    for k in range(4):
        _combine(_D[k], stages.shape[0], stages, weights[3 + k])
        for i in range(state.size):
            weights[3 + k, i] *= step


@inner
def _interpolate(state, weights, part, out):
    """Write the state after the fraction `part` of a step from `state` to `out`."""
    for i in range(state.size):
        value = 0.0
        for k in range(6, -1, -1):
            value += weights[k, i]
            value *= part if k % 2 == 0 else 1 - part
        out[i] = state[i] + value
