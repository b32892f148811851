"""The compiled loop of the Gauss-Jackson method: two evaluations of MuJoCo's forward dynamics a step.

A step predicts the state from the sums and the last accelerations, evaluates the acceleration there, corrects the
state with it, and evaluates once more (PECE). The second evaluation costs as much as the first, and makes the method
stable at timesteps that are several times as large; forces that depend on velocities need it most.

What a run returns is read off two steps later, when there are accelerations on both sides of it: the formula errs far
less there than at the end of the accelerations. Velocities gain a digit, for four evaluations a run.
"""

import math

import numpy as np
from numba import njit

from mjbeer.simulation.dop853_kernel import _slope
from mjbeer.simulation.gauss_jackson_weights import COUNT, series, weights

DONE, BLOCK_END, NOT_FINITE = range(3)
"""The statuses with which `advance` can end."""
BLOCK = 4096
"""Steps between two returns to Python, so that a long run can be interrupted."""
_PREDICT_RATE, _PREDICT = weights(1, -1), weights(2, -1)
_CORRECT_RATE, _CORRECT = weights(1, 0), weights(2, 0)
_MIDDLE = COUNT // 2
_MIDDLE_RATE, _MIDDLE_PLACE = weights(1, _MIDDLE), weights(2, _MIDDLE)
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_READ_RATE, _READ_PLACE = weights(1, LAG), weights(2, LAG)
_RATES = np.array([float(term) for term in series(1, 0, COUNT + 1)])
_PLACES = np.array([float(term) for term in series(2, 0, COUNT + 2)])
_LARGEST = 1e10  # mjMAXVAL: MuJoCo calls a larger state diverged


@njit(cache=True, error_model="numpy")
def begin(pointers, views, states, step, sums, history):
    """Fill the history with the accelerations at the first `COUNT` states, and begin the sums.

    The sums are those that give the state in the middle of the first ones, where the formulas err least.

    Args:
      pointers: addresses of functions, model and data, as in `dop853_kernel.advance`.
      views: arrays of that data, as in `dop853_kernel.advance`.
      states: the first states, one timestep apart, shape (COUNT, states).
      step: the timestep [s].
      sums: the first and the second sum of the accelerations, and what rounding took from each, shape (4, nv).
      history: accelerations, shape (nv, COUNT + BLOCK); the first `COUNT` columns are filled in.
    """
    size = sums.shape[1]
    slope = np.empty(2 * size)
    for k in range(COUNT):
        _slope(pointers, views, states[k], slope)
        for i in range(size):
            history[i, k] = slope[size + i]
    middle = states[COUNT - 1 - _MIDDLE]
    for i in range(size):
        rate = middle[size + i] / step - _sum(_MIDDLE_RATE, history[i], COUNT)
        place = middle[i] / step**2 - _sum(_MIDDLE_PLACE, history[i], COUNT)
        # The formulas have the sums up to the last acceleration: first = rate, second = place + (1 + back) first.
        sums[0, i], sums[1, i] = rate, place + (1 + _MIDDLE) * rate
        sums[2, i] = sums[3, i] = 0.0


@njit(cache=True)
def _sum(weights, accelerations, end):
    """Return the weighted sum of the `COUNT` accelerations before index `end`, in four parts that can overlap."""
    first = end - COUNT
    a = b = c = d = 0.0
    for k in range(0, COUNT - 3, 4):
        a += weights[k] * accelerations[first + k]
        b += weights[k + 1] * accelerations[first + k + 1]
        c += weights[k + 2] * accelerations[first + k + 2]
        d += weights[k + 3] * accelerations[first + k + 3]
    for k in range(COUNT - COUNT % 4, COUNT):
        a += weights[k] * accelerations[first + k]
    return (a + b) + (c + d)


@njit(cache=True)
def _add(sums, row, i, term):
    """Add a term to a sum, and the rounding of the addition before (Kahan)."""
    term -= sums[row + 2, i]
    total = sums[row, i] + term
    sums[row + 2, i] = (total - sums[row, i]) - term
    sums[row, i] = total


@njit(cache=True, nogil=True)
def advance(pointers, views, sums, history, times, samples, place, kept):
    """Take up to a block of steps, and return the status, the new place and the numbers of steps taken and rows kept.

    Args:
      pointers: addresses of functions, model and data, as in `dop853_kernel.advance`.
      views: arrays of that data, as in `dop853_kernel.advance`.
      sums: the sums and their rounding, as `begin` or the block before left them.
      history: accelerations, as `begin` or the block before left them.
      times: increasing times of the samples [s].
      samples: states at `times`; the rows that the steps pass are filled in.
      place: timestep [s], number of the last step, and index of the next sample.
      kept: times and states at the steps that are read off in this block, beginning with that after the first
        `COUNT`: work space for `BLOCK` of them, or none.
    """
    step, steps, sample = place
    kept_times, kept_states = kept
    size = sums.shape[1]
    work, slope = np.empty(2 * size), np.empty(2 * size)
    status, taken, row = BLOCK_END, 0, 0
    while True:
        end = COUNT + taken
        while sample < times.size and times[sample] <= (steps - LAG) * step * (1 + 1e-14):
            _interpolate(sums, history, end, steps - times[sample] / step, step, samples[sample])
            sample += 1
        if sample == times.size:
            status = DONE
            break
        if taken == BLOCK:
            break
        for i in range(size):
            work[i] = step**2 * (sums[1, i] + _sum(_PREDICT, history[i], end))
            work[size + i] = step * (sums[0, i] + _sum(_PREDICT_RATE, history[i], end))
        _slope(pointers, views, work, slope)
        for i in range(size):
            history[i, end] = slope[size + i]
            work[i] = step**2 * (sums[1, i] + _sum(_CORRECT, history[i], end + 1))
            work[size + i] = step * (sums[0, i] + history[i, end] + _sum(_CORRECT_RATE, history[i], end + 1))
        _slope(pointers, views, work, slope)
        finite = True
        for i in range(size):
            history[i, end] = slope[size + i]
            _add(sums, 0, i, slope[size + i])
            _add(sums, 1, i, sums[0, i])
            finite = finite and abs(work[i]) < _LARGEST and abs(work[size + i]) < _LARGEST
            finite = finite and math.isfinite(slope[size + i])
        steps += 1
        if not finite:
            status = NOT_FINITE
            break
        taken += 1
        if kept_times.size > 0 and steps - LAG >= COUNT:
            kept_times[row] = (steps - LAG) * step
            _interpolate(sums, history, end + 1, float(LAG), step, kept_states[row])
            row += 1
    for i in range(size):
        for k in range(COUNT):
            history[i, k] = history[i, taken + k]
    return status, (step, steps, sample), taken, row


@njit(cache=True)
def _interpolate(sums, history, end, back, step, out):
    """Write the state `back` steps before the last acceleration to `out`: a polynomial of the last ones, twice summed.

    It is the formula of the corrector with the factor (1 - z)^back, whose powers of z are differences here.
    """
    size = sums.shape[1]
    if abs(back - LAG) < 1e-9:
        for i in range(size):
            out[i] = step**2 * (sums[1, i] - (1 + LAG) * sums[0, i] + _sum(_READ_PLACE, history[i], end))
            out[size + i] = step * (sums[0, i] + _sum(_READ_RATE, history[i], end))
        return
    shifts, rates, places = np.empty(COUNT + 2), np.empty(COUNT), np.empty(COUNT)
    differences = np.empty(COUNT)
    shifts[0] = 1.0
    for j in range(1, COUNT + 2):
        shifts[j] = shifts[j - 1] * (j - 1 - back) / j
    for j in range(COUNT):
        rates[j], places[j] = 0.0, shifts[j + 2] * _PLACES[0]
        for k in range(j + 2):
            rates[j] += shifts[k] * _RATES[j + 1 - k]
            places[j] += shifts[k] * _PLACES[j + 2 - k]
    for i in range(size):
        for k in range(COUNT):
            differences[k] = history[i, end - 1 - k]
        rate = place = 0.0
        for j in range(COUNT):
            rate += rates[j] * differences[0]
            place += places[j] * differences[0]
            for k in range(COUNT - 1 - j):
                differences[k] -= differences[k + 1]
        out[i] = step**2 * (sums[1, i] - (1 + back) * sums[0, i] + place)
        out[size + i] = step * (sums[0, i] + rate)
