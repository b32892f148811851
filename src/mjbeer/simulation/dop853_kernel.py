"""The compiled loop of DOP853: steps of the eighth-order Dormand-Prince method around MuJoCo's forward dynamics.

The twelve stages, the error estimate and the seventh-order continuous output are those of
E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, section
II.10 (coefficients from scipy.integrate.DOP853). Each evaluation calls functions of the loaded
MuJoCo library through their C symbols, so no Python runs between evaluations.
"""

import ctypes
import math

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from scipy.integrate import DOP853

DONE, BLOCK_END, TOO_SMALL, NOT_FINITE = range(4)
"""The statuses with which a kernel can end."""
LARGEST = 1e10
"""Largest state that MuJoCo does not call diverged (mjMAXVAL)."""
ROWS = 16
"""Number of slopes that are kept: twelve of the stages, one at the end of the step, three of the continuous output."""
_A, _B = DOP853.A[:12, :12].copy(), DOP853.B.copy()
_E3, _E5 = DOP853.E3.copy(), DOP853.E5.copy()
_A_EXTRA, _D = np.asarray(DOP853.A_EXTRA).copy(), np.asarray(DOP853.D).copy()
_STAGES = 12
_CAUTION, _SHRINK, _GROW = 0.9, 0.2, 10.0  # step-size control, as in the reference
_MEMORY = 0.04  # beta of the reference, by which the error of the step before counts: saves two of three rejected steps
_LEAST = 1e-4  # smallest error of the step before that counts
_BLOCK = 20_000  # steps between two returns to Python, so that a long run can be interrupted
KEPT = _BLOCK + 1
"""Largest number of steps of a block that are kept, with the start."""


@intrinsic
def call(typing_context, function, model, data):
    """Call the C function at the address `function` with two pointers; no address is compiled in, so caching works."""

    def generate(context, builder, signature, arguments):
        pointer = ir.IntType(8 * ctypes.sizeof(ctypes.c_void_p))
        function_type = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


def _marked(attribute):
    """Return a function that gives the compiled function that calls it an attribute of LLVM."""

    @intrinsic
    def mark(typing_context):
        def generate(context, builder, signature, arguments):
            builder.function.attributes.add(attribute)
            return context.get_dummy_value()

        return types.void(), generate

    return mark


_for_size = _marked("optsize")  # loops over a few joints gain nothing from more code
_not_inlined = _marked("noinline")  # copies in all callers would take the compiler seconds


@njit(cache=True, error_model="numpy")
def slope(pointers, views, state, out):
    """Write the time derivative of a state to `out`."""
    _for_size()
    functions, model, data = pointers
    qpos, qvel, qacc, needed = views
    n = qpos.size
    for i in range(n):
        qpos[i] = state[i] if needed[i] else 0.0
        qvel[i] = state[n + i]
    for function in functions:
        call(function, model, data)
    for i in range(n):
        out[i] = qvel[i]
        out[n + i] = qacc[i]


@njit(cache=True, error_model="numpy")
def _combine(weights, count, slopes, out):
    """Write the weighted sum of the first `count` slopes to `out`, slope by slope, so that additions can overlap."""
    _for_size()
    for i in range(out.size):
        out[i] = 0.0
    for j in range(count):
        weight = weights[j]
        if weight != 0.0:
            for i in range(out.size):
                out[i] += weight * slopes[j, i]


@njit(cache=True, error_model="numpy", nogil=True)
def advance(pointers, views, state, slopes, times, samples, fixed, tolerance, scale, kept, place):
    """Take up to a block of steps, and return the status, the new place and the numbers of evaluations and rows kept.

    `pointers` are addresses of the functions that compute an acceleration, of the model and of its data; `views` are
    qpos, qvel and acceleration in that data, and the mask of the components of qpos that are needed. `state` is moved
    on. `slopes`, of shape (ROWS, states), comes with the slope at `state` in its first row, except in the first block.
    The rows of `samples` whose `times` [s] the steps pass are filled in.

    `place` is the time, the step, the index of the next sample, the number of steps and the error of the last step.
    Unless the step is `fixed`, its error is kept below `tolerance` (`scale` + |state|) in each component.
    `kept` takes times and states at the start of the run and at the ends of this block's steps: it has room for `KEPT`
    of them, or for none.
    """
    _for_size()
    time, step, sample, steps, before = place
    kept_times, kept_states = kept
    stages = _A.shape[0]  # for a constant, numba would compile `_combine` once more
    row = 0
    size = state.size
    new, work, total = np.empty(size), np.empty(size), np.empty(size)
    weights = np.empty((7, size))
    evaluations = 0
    if steps == 0:
        slope(pointers, views, state, slopes[0])
        evaluations += 1
        if not fixed:
            step = _first_step(pointers, views, state, slopes, tolerance, scale, work)
            evaluations += 1
        if kept_times.size > 0:
            kept_times[row], kept_states[row] = time, state
            row += 1
    status = BLOCK_END
    for _ in range(_BLOCK):
        while sample < times.size and times[sample] <= time:
            for i in range(size):
                samples[sample, i] = state[i]
            sample += 1
        if sample == times.size:
            status = DONE
            break
        for s in range(1, _STAGES):
            _combine(_A[s], s, slopes, total)
            for i in range(size):
                work[i] = state[i] + step * total[i]
            slope(pointers, views, work, slopes[s])
        _combine(_B, stages, slopes, total)
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
                error = _error(state, new, slopes, step, tolerance, scale, work, total)
            if not error < 1.0:
                step *= max(_SHRINK, _CAUTION * error ** (-1 / 8)) if finite else _SHRINK
                if not step > 4e-16 * max(time, 1e-300) or step < 1e-200:
                    status = TOO_SMALL if finite else NOT_FINITE
                    break
                continue
        slope(pointers, views, new, slopes[_STAGES])
        evaluations += 1
        steps += 1
        end = steps * step if fixed else time + step
        last = end * (1 + 1e-14)
        prepared = False
        while sample < times.size and times[sample] <= last:
            part = (times[sample] - time) / (end - time)
            if part > 1 - 1e-12:
                for i in range(size):
                    samples[sample, i] = new[i]
            else:
                if not prepared:
                    _prepare(pointers, views, state, new, slopes, step, work, weights)
                    evaluations += 3
                    prepared = True
                _interpolate(state, weights, part, samples[sample])
            sample += 1
        time = end
        for i in range(size):
            state[i] = new[i]
            slopes[0, i] = slopes[_STAGES, i]
        if kept_times.size > 0:
            kept_times[row], kept_states[row] = time, state
            row += 1
        if not fixed:
            growth = _CAUTION * max(error, 1e-12) ** (0.75 * _MEMORY - 1 / 8) * before**_MEMORY
            step *= min(_GROW, max(_SHRINK, growth))
            before = max(error, _LEAST)
            if time < times[-1]:  # a motion at rest would take steps without bound
                step = min(step, times[-1] - time)
    return status, (time, step, sample, steps, before), evaluations, row


@njit(cache=True, error_model="numpy")
def _first_step(pointers, views, state, slopes, tolerance, scale, work):
    """Return the first step [s], by Hairer's algorithm in section II.4.

    Unlike there it always depends on the tolerance: two runs that are compared must not have the same steps.
    """
    _for_size()
    _not_inlined()
    size = state.size
    d0 = d1 = 0.0
    for i in range(size):
        weight = tolerance * (scale[i] + abs(state[i]))
        d0 += (state[i] / weight) ** 2
        d1 += (slopes[0, i] / weight) ** 2
    d0, d1 = math.sqrt(d0 / size), math.sqrt(d1 / size)
    guess = 1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1
    for i in range(size):
        work[i] = state[i] + guess * slopes[0, i]
    slope(pointers, views, work, slopes[1])
    d2 = 0.0
    for i in range(size):
        d2 += ((slopes[1, i] - slopes[0, i]) / (tolerance * (scale[i] + abs(state[i])))) ** 2
    d2 = math.sqrt(d2 / size) / guess
    if max(d1, d2) <= 1e-15:
        return max(1e-6, guess * 1e-3)
    return min(100 * guess * tolerance ** (1 / 8), (0.01 / max(d1, d2)) ** (1 / 8))


@njit(cache=True, error_model="numpy")
def _error(state, new, slopes, step, tolerance, scale, five, three):
    """Return the estimated error of a step over the tolerated one."""
    _for_size()
    _not_inlined()
    fifth, third, stages = 0.0, 0.0, _A.shape[0]
    _combine(_E5, stages, slopes, five)
    _combine(_E3, stages, slopes, three)
    for i in range(state.size):
        weight = tolerance * (scale[i] + max(abs(state[i]), abs(new[i])))
        fifth += (five[i] / weight) ** 2
        third += (three[i] / weight) ** 2
    size = math.sqrt((fifth + 0.01 * third) * state.size)
    return abs(step) * fifth / size if size > 0 else 0.0


@njit(cache=True, error_model="numpy")
def _prepare(pointers, views, state, new, slopes, step, work, weights):
    """Write the coefficients of the continuous output over the last step to `weights`."""
    _for_size()
    _not_inlined()
    for row in range(3):
        _combine(_A_EXTRA[row], _STAGES + 1 + row, slopes, work)
        for i in range(state.size):
            work[i] = state[i] + step * work[i]
        slope(pointers, views, work, slopes[_STAGES + 1 + row])
    for i in range(state.size):
        change = new[i] - state[i]
        weights[0, i] = change
        weights[1, i] = step * slopes[0, i] - change
        weights[2, i] = 2 * change - step * (slopes[_STAGES, i] + slopes[0, i])
    for k in range(4):
        _combine(_D[k], slopes.shape[0], slopes, weights[3 + k])
        for i in range(state.size):
            weights[3 + k, i] *= step


@njit(cache=True, error_model="numpy")
def _interpolate(state, weights, part, out):
    """Write the state after the fraction `part` of a step from `state` to `out`."""
    _for_size()
    _not_inlined()
    for i in range(state.size):
        value = 0.0
        for k in range(6, -1, -1):
            value += weights[k, i]
            value *= part if k % 2 == 0 else 1 - part
        out[i] = state[i] + value
