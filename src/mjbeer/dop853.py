"""Eighth-order Dormand-Prince integration around MuJoCo's own forward dynamics, in compiled code.

The twelve stages, the error estimate and the seventh-order continuous output are those of
E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, section
II.10 (coefficients from scipy.integrate.DOP853). Each evaluation calls `mj_forward` of the
loaded MuJoCo library through its C symbol, so no Python runs between evaluations.
"""

import ctypes
import math

import mujoco
import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from scipy.integrate import DOP853

from mjbeer.exceptions import DivergenceError
from mjbeer.library import address
from mjbeer.quiet import quiet

_A, _B = DOP853.A[:12, :12].copy(), DOP853.B.copy()
_E3, _E5 = DOP853.E3.copy(), DOP853.E5.copy()
_A_EXTRA, _D = np.asarray(DOP853.A_EXTRA).copy(), np.asarray(DOP853.D).copy()
_STAGES, _ROWS = 12, 16  # stages of a step; with the new slope and three more, those of the continuous output
_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 10.0  # step-size control, as in the reference
_BLOCK = 20_000  # steps between two returns to Python, so that a long run can be interrupted
_DONE, _BLOCK_END, _TOO_SMALL, _NOT_FINITE = range(4)
_LARGEST = 1e10  # mjMAXVAL: what MuJoCo itself calls a diverged state


def integrate(
    model: mujoco.MjModel,
    start: np.ndarray,
    times: np.ndarray,
    timestep: float | None = None,
    tolerance: float = 1e-10,
    scale: np.ndarray | None = None,
    limit: float = math.inf,
) -> np.ndarray:
    """States at the increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

    A `timestep` [s] fixes the step. Otherwise each step keeps its local error below `tolerance` times
    (`scale` + |state|), with `scale` of shape (nq + nv,); more than `limit` evaluations are given up.

    Raises:
      DivergenceError: if the motion stops being finite, the step vanishes, or the limit is reached.
    """
    if model.nq != model.nv:
        raise ValueError("only slide and hinge joints can be integrated component by component")
    size, data = model.nq + model.nv, mujoco.MjData(model)
    pointers = (address("mj_forward"), model._address, data._address)
    views = (data.qpos, data.qvel, data.qacc)
    state, slopes, samples = start.copy(), np.zeros((_ROWS, size)), np.empty((len(times), size))
    scale = np.ones(size) if scale is None else scale
    time, step, sample, steps, evaluations, status = 0.0, timestep or 0.0, 0, 0, 0, _BLOCK_END
    with quiet():
        while status == _BLOCK_END:
            status, time, step, sample, steps, spent = _advance(
                pointers, views, state, slopes, times, samples, time, step, sample, steps,
                timestep is not None, tolerance, scale, _A, _B, _E3, _E5, _A_EXTRA, _D,
            )  # fmt: skip
            evaluations += spent
            if status == _BLOCK_END and evaluations > limit:
                raise DivergenceError(
                    f"the DOP853 run was given up at t = {time:.6g} s after {evaluations} evaluations"
                )
    if status != _DONE:
        cause = "its state is no longer finite" if status == _NOT_FINITE else "no step is small enough for it"
        raise DivergenceError(f"the DOP853 run diverged at t = {time:.6g} s: {cause}")
    return samples


@intrinsic
def _call(typing_context, function, model, data):
    """Call the C function at an address with two pointers; compiled code can be cached, as no address is in it."""

    def generate(context, builder, signature, arguments):
        pointer = ir.IntType(8 * ctypes.sizeof(ctypes.c_void_p))
        function_type = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@njit(cache=True)
def _slope(pointers, views, state, out):
    qpos, qvel, qacc = views
    n = qpos.size
    for i in range(n):
        qpos[i] = state[i]
        qvel[i] = state[n + i]
    _call(pointers[0], pointers[1], pointers[2])
    for i in range(n):
        out[i] = qvel[i]
        out[n + i] = qacc[i]


@njit(cache=True)
def _advance(
    pointers, views, state, slopes, times, samples, time, step, sample, steps,
    fixed, tolerance, scale, a, b, e3, e5, a_extra, d,
):  # fmt: skip
    size = state.size
    new, work = np.empty(size), np.empty(size)
    weights = np.empty((7, size))
    evaluations = 0
    if steps == 0:
        _slope(pointers, views, state, slopes[0])
        evaluations += 1
        if not fixed:
            step = _first_step(pointers, views, state, slopes, tolerance, scale, work)
            evaluations += 1
    status = _BLOCK_END
    for _ in range(_BLOCK):
        while sample < times.size and times[sample] <= time:
            samples[sample] = state
            sample += 1
        if sample == times.size:
            status = _DONE
            break
        for s in range(1, _STAGES):
            for i in range(size):
                total = 0.0
                for j in range(s):
                    total += a[s, j] * slopes[j, i]
                work[i] = state[i] + step * total
            _slope(pointers, views, work, slopes[s])
        finite = True
        for i in range(size):
            total = 0.0
            for j in range(_STAGES):
                total += b[j] * slopes[j, i]
            new[i] = state[i] + step * total
            finite = finite and abs(new[i]) < _LARGEST
        evaluations += _STAGES - 1
        if not finite and fixed:
            status = _NOT_FINITE
            break
        if not fixed:
            error = np.inf
            if finite:
                error = _error(state, new, slopes, step, tolerance, scale, e3, e5)
            if not error < 1.0:
                step *= max(_SHRINK, _SAFETY * error ** (-1 / 8)) if finite else _SHRINK
                if not step > 4e-16 * max(time, 1e-300) or step < 1e-200:
                    status = _TOO_SMALL if finite else _NOT_FINITE
                    break
                continue
        _slope(pointers, views, new, slopes[_STAGES])
        evaluations += 1
        steps += 1
        end = steps * step if fixed else time + step
        last = end * (1 + 1e-14)
        prepared = False
        while sample < times.size and times[sample] <= last:
            part = (times[sample] - time) / (end - time)
            if part > 1 - 1e-12:
                samples[sample] = new
            else:
                if not prepared:
                    _prepare(pointers, views, state, new, slopes, step, a_extra, d, work, weights)
                    evaluations += 3
                    prepared = True
                _interpolate(state, weights, part, samples[sample])
            sample += 1
        time = end
        for i in range(size):
            state[i] = new[i]
            slopes[0, i] = slopes[_STAGES, i]
        if not fixed:
            step *= min(_GROW, _SAFETY * max(error, 1e-12) ** (-1 / 8))
            if time < times[-1]:  # a motion at rest would take steps without bound
                step = min(step, times[-1] - time)
    return status, time, step, sample, steps, evaluations


@njit(cache=True)
def _first_step(pointers, views, state, slopes, tolerance, scale, work):
    """Starting step size, Hairer's algorithm in section II.4."""
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
    _slope(pointers, views, work, slopes[1])
    d2 = 0.0
    for i in range(size):
        d2 += ((slopes[1, i] - slopes[0, i]) / (tolerance * (scale[i] + abs(state[i])))) ** 2
    d2 = math.sqrt(d2 / size) / guess
    if max(d1, d2) <= 1e-15:
        return max(1e-6, guess * 1e-3)
    return min(100 * guess, (0.01 / max(d1, d2)) ** (1 / 8))


@njit(cache=True)
def _error(state, new, slopes, step, tolerance, scale, e3, e5):
    fifth = third = 0.0
    for i in range(state.size):
        weight = tolerance * (scale[i] + max(abs(state[i]), abs(new[i])))
        five = three = 0.0
        for j in range(_STAGES):
            five += e5[j] * slopes[j, i]
            three += e3[j] * slopes[j, i]
        fifth += (five / weight) ** 2
        third += (three / weight) ** 2
    size = math.sqrt((fifth + 0.01 * third) * state.size)
    return abs(step) * fifth / size if size > 0 else 0.0


@njit(cache=True)
def _prepare(pointers, views, state, new, slopes, step, a_extra, d, work, weights):
    """Polynomial of the continuous output over the step just made."""
    for row in range(3):
        for i in range(state.size):
            total = 0.0
            for j in range(_STAGES + 1 + row):
                total += a_extra[row, j] * slopes[j, i]
            work[i] = state[i] + step * total
        _slope(pointers, views, work, slopes[_STAGES + 1 + row])
    for i in range(state.size):
        change = new[i] - state[i]
        weights[0, i] = change
        weights[1, i] = step * slopes[0, i] - change
        weights[2, i] = 2 * change - step * (slopes[_STAGES, i] + slopes[0, i])
        for k in range(4):
            total = 0.0
            for j in range(_ROWS):
                total += d[k, j] * slopes[j, i]
            weights[3 + k, i] = step * total


@njit(cache=True)
def _interpolate(state, weights, part, out):
    for i in range(state.size):
        value = 0.0
        for k in range(6, -1, -1):
            value += weights[k, i]
            value *= part if k % 2 == 0 else 1 - part
        out[i] = state[i] + value
