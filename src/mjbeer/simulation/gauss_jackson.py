"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions.

A step predicts the state from the sums and the last accelerations, evaluates the acceleration there, corrects the state
with it, and evaluates once more (PECE): that makes the method stable at timesteps that are several times as large.
States are read off two steps later, with accelerations on both sides, where the formula errs far less.

The weights with which accelerations are added up come from rational arithmetic. With the backward difference z
(z a_n = a_n - a_(n-1)) and a step h, the time derivative is -ln(1 - z)/h, so that the velocity is h/(-ln(1 - z)) and
the position h^2/ln(1 - z)^2 times the acceleration. Their leading terms, 1/z and 1/z^2, are the first and the second
sum of all accelerations; the rest are differences of the last ones, and so weights for them. A factor (1 - z)^back
gives the value that many steps before the last acceleration: -1 predicts the next step.

O. Montenbruck and E. Gill, Satellite Orbits, section 4.2; M. M. Berry and L. M. Healy, Implementation of Gauss-Jackson
integration for orbit propagation, J. Astronaut. Sci. 52 (2004).
"""

import math
from fractions import Fraction

import mujoco
import numpy as np
from numba import njit
from numpy.polynomial import polynomial

from mjbeer.exceptions import DivergenceError, UnsupportedError
from mjbeer.model.engine import quiet, untimed
from mjbeer.model.setting import GAUSS_JACKSON
from mjbeer.simulation.dop853 import Integrator, slope
from mjbeer.simulation.stepping import BLOCK_END, DONE, LARGEST, NOT_FINITE, Watcher, drive

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""
BLOCK = 4096
"""Steps between two returns to Python, so that a long run can be interrupted."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_STARTING = 2
"""Timestep of DOP853, which starts a run, over the timestep: the error is at most a quarter more than at one, and at
three up to ten times as large (measured down to 1e-12 rad)."""
_SHARE = 0.046
"""Timestep for an error of 1e-6 rad over the shortest regular step of DOP853 at a local tolerance of 1. It is smaller
than needed in three of four random motions."""
_POWER = 0.07
"""By which power of the tolerance the timestep falls (measured from 1e-6 to 1e-12; at order 12 it is 1/13 to 1/12)."""
_LOOSEST = 1e-6
"""Largest tolerance [rad] for which a timestep is chosen: with larger steps the method's order does not show."""
_GROWTH = 1.5
"""Largest factor from one regular step of DOP853 to the next; a run begins with steps that grow more."""
_FEWEST = 4
"""Smallest number of regular steps that say how long steps may be."""
_START = 7 * COUNT + 2 * COUNT
"""Evaluations before the first step of its own: six and a half a step for DOP853 with samples, and one a state."""


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model, set up once and run often.

    A step is two evaluations, where DOP853 has twelve and steps three times as large. A damping or a constraint that
    decays within a few timesteps would make it unstable. The `starter` is the DOP853 integrator of the model.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(self, model: mujoco.MjModel, starter: Integrator | None = None) -> None:
        if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        damping = model.dof_damping, model.dof_dampingpoly, model.tendon_damping, model.tendon_dampingpoly
        if any(coefficients.any() for coefficients in damping):
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._starter, self._size = Integrator(model) if starter is None else starter, model.nv
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(self, start: np.ndarray, times: np.ndarray, timestep: float, watch: Watcher | None = None) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        The first twelve steps of `timestep` [s] are DOP853's, and two more are taken than the times need. Between steps
        the states are those of the polynomial through the accelerations around.

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        size, dynamics = self._size, self._starter.dynamics
        first = timestep * np.arange(COUNT)
        begun = int(np.searchsorted(times, first[-1], side="right"))
        along = np.concatenate([first, times[:begun]])
        order, states = np.argsort(along, kind="stable"), np.empty((len(along), 2 * size))
        try:
            states[order] = self._starter.run(start, along[order], _STARTING * timestep)
        except DivergenceError as error:
            raise DivergenceError(f"GaussJackson could not start: {error}") from error
        samples = np.empty((len(times), 2 * size))
        states, samples[:begun] = states[:COUNT], states[COUNT:]
        sums, history = np.empty((4, size)), np.empty((size, COUNT + BLOCK))
        with quiet(), untimed():
            _begin(*dynamics, states, timestep, sums, history)
        if not np.isfinite(sums).all():  # the position over the square of the timestep overflows, or a force does
            raise DivergenceError(f"GaussJackson could not start: its sums are not finite at t = {first[-1]:.6g} s")
        if watch:
            reached = 1 + int(np.searchsorted(first, times[-1]))  # what comes after it is not the run's
            watch(first[:reached], states[:reached])
        rows, place = BLOCK if watch else 0, (first[-1], COUNT - 1, timestep, begun)
        kept = np.empty(rows), np.empty((rows, 2 * size))
        fixed = *dynamics, sums, history, times, samples, kept
        taken = drive(GAUSS_JACKSON, _advance, fixed, place, math.inf, watch)
        self.evaluations = self._starter.evaluations + COUNT + taken
        return samples


def plan(ends: np.ndarray, tolerance: float, local: float) -> tuple[float, float]:
    """Return a timestep [s] that should reach a tolerance [rad], and the number of evaluations that it takes.

    `ends` has the times [s] at the start and at the ends of the steps that DOP853 chose with a `local` tolerance. If
    these are too few to tell, the number of evaluations is infinite.
    """
    steps = np.diff(ends)
    settled = np.flatnonzero(steps[1:] <= _GROWTH * steps[:-1])
    regular = steps[settled[0] : -1] if len(settled) else steps[:0]  # the last step is cut at the end of the run
    if len(regular) < _FEWEST:
        return math.nan, math.inf
    share = _SHARE * min(1.0, tolerance / _LOOSEST) ** _POWER
    timestep = share * float(regular.min()) / local ** (1 / 8)
    return timestep, _START + 2 * float(ends[-1]) / timestep


def series(power: int, back: int, terms: int) -> list[Fraction]:
    """Return the first coefficients of (z/(-ln(1 - z)))^power (1 - z)^back in powers of z.

    A `power` of 1 is for velocities, one of 2 for positions.
    """
    logarithm = [Fraction(1, j + 1) for j in range(terms)]  # -ln(1 - z)/z
    inverse, product = [Fraction(1)], [Fraction(1)]
    for k in range(1, terms):
        inverse.append(-sum((logarithm[k - j] * inverse[j] for j in range(k)), Fraction(0)))
        product.append(product[-1] * (k - 1 - back) / k)
    for _ in range(power):
        product = [sum((product[j] * inverse[k - j] for j in range(k + 1)), Fraction(0)) for k in range(terms)]
    return product


def weights(power: int, back: int) -> np.ndarray:
    """Return the weights of the last `COUNT` accelerations, the oldest first, shape (COUNT,).

    The velocity `back` steps before the last one is h times the first sum and the accelerations with the weights of
    `power` 1. The position is h^2 times the second sum, less 1 + `back` times the first sum, and the accelerations with
    the weights of `power` 2. Both sums include the last acceleration.
    """
    differences = series(power, back, COUNT + power)[power:]
    ordinates = [
        (-1) ** k * sum((math.comb(j, k) * differences[j] for j in range(k, COUNT)), Fraction(0)) for k in range(COUNT)
    ]
    return np.array([float(weight) for weight in reversed(ordinates)])


def _between(power: int) -> np.ndarray:
    """Return `weights` as polynomials of `back` - `LAG` - 1/2, the lowest power first, shape (terms, COUNT)."""
    inverse = [float(term) for term in series(power, 0, COUNT + power)]
    shifts: list[np.ndarray] = [np.ones(1)]
    for j in range(1, COUNT + power):
        shifts.append(polynomial.polymul(shifts[-1], [(j - 1.5 - LAG) / j, -1 / j]))
    ordinates = np.zeros((COUNT + 2, COUNT))
    for j in range(COUNT):
        difference = np.zeros(COUNT + 2)
        for k in range(j + power + 1):
            difference[: k + 1] += inverse[j + power - k] * shifts[k]
        for k in range(j + 1):
            ordinates[:, COUNT - 1 - k] += (-1) ** k * math.comb(j, k) * difference
    return ordinates


_PREDICT_RATE, _PREDICT = weights(1, -1), weights(2, -1)
_CORRECT_RATE, _CORRECT = weights(1, 0), weights(2, 0)
_MIDDLE = COUNT // 2
_MIDDLE_RATE, _MIDDLE_PLACE = weights(1, _MIDDLE), weights(2, _MIDDLE)
_READ_RATE, _READ_PLACE = weights(1, LAG), weights(2, LAG)
_BETWEEN_RATE, _BETWEEN_PLACE = _between(1), _between(2)


@njit(cache=True, error_model="numpy")
def _begin(pointers, views, states, step, sums, history):
    """Fill the history with the accelerations at the first `COUNT` states, and begin the sums.

    The sums are those that give the state in the middle of the first ones, where the formulas err least.

    `pointers` and `views` are `Integrator.dynamics`; `states`, of shape (COUNT, states), are one timestep
    `step` [s] apart. `sums`, of shape (4, nv), has the first and the second sum of the accelerations and what rounding
    took from each; `history` has the accelerations, shape (nv, COUNT + BLOCK).
    """
    size = sums.shape[1]
    derivative = np.empty(2 * size)
    for k in range(COUNT):
        slope(pointers, views, states[k], derivative)
        for i in range(size):
            history[i, k] = derivative[size + i]
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
def _advance(pointers, views, sums, history, times, samples, kept, place):
    """Take up to a block of steps, and return the status, the new place and the numbers of evaluations and rows kept.

    `sums` and `history` are as `_begin` or the block before left them. The rows of `samples` whose `times` [s] are
    passed are filled in. `place` is time [s] and number of the last step, the timestep [s] and the next sample.
    `kept` takes times and states at the steps that are read off, from that after the first `COUNT` on: it has room for
    `BLOCK` of them, or for none.
    """
    _, steps, step, sample = place
    kept_times, kept_states = kept
    size = sums.shape[1]
    work, derivative = np.empty(2 * size), np.empty(2 * size)
    rate_weights, place_weights = np.empty(COUNT), np.empty(COUNT)
    status, taken, row = BLOCK_END, 0, 0
    while True:
        end = COUNT + taken
        while sample < times.size and times[sample] <= (steps - LAG) * step * (1 + 1e-14):
            back = steps - times[sample] / step
            _read(sums, history, end, back, step, rate_weights, place_weights, samples[sample])
            sample += 1
        if sample == times.size:
            status = DONE
            break
        if taken == BLOCK:
            break
        for i in range(size):
            work[i] = step**2 * (sums[1, i] + _sum(_PREDICT, history[i], end))
            work[size + i] = step * (sums[0, i] + _sum(_PREDICT_RATE, history[i], end))
        slope(pointers, views, work, derivative)
        for i in range(size):
            history[i, end] = derivative[size + i]
            work[i] = step**2 * (sums[1, i] + _sum(_CORRECT, history[i], end + 1))
            work[size + i] = step * (sums[0, i] + history[i, end] + _sum(_CORRECT_RATE, history[i], end + 1))
        slope(pointers, views, work, derivative)
        finite = True
        for i in range(size):
            history[i, end] = derivative[size + i]
            _add(sums, 0, i, derivative[size + i])
            _add(sums, 1, i, sums[0, i])
            finite = finite and abs(work[i]) < LARGEST and abs(work[size + i]) < LARGEST
            finite = finite and math.isfinite(derivative[size + i])
        steps += 1
        if not finite:
            status = NOT_FINITE
            break
        taken += 1
        if kept_times.size > 0 and steps - LAG >= COUNT:
            kept_times[row] = (steps - LAG) * step
            _read(sums, history, end + 1, float(LAG), step, rate_weights, place_weights, kept_states[row])
            row += 1
    for i in range(size):
        for k in range(COUNT):
            history[i, k] = history[i, taken + k]
    return status, (steps * step, steps, step, sample), 2 * taken, row


@njit(cache=True)
def _read(sums, history, end, back, step, rate_weights, place_weights, out):
    """Write the state `back` steps before the last acceleration to `out`, with `back` from `LAG` to one more.

    The weights are work space of shape (COUNT,).
    """
    x = back - LAG - 0.5
    if back == LAG:
        rate_weights[:], place_weights[:] = _READ_RATE, _READ_PLACE
    else:
        rate_weights[:] = place_weights[:] = 0.0
        for power in range(COUNT + 1, -1, -1):
            for k in range(COUNT):
                rate_weights[k] = rate_weights[k] * x + _BETWEEN_RATE[power, k]
                place_weights[k] = place_weights[k] * x + _BETWEEN_PLACE[power, k]
    size = sums.shape[1]
    for i in range(size):
        place = _sum(place_weights, history[i], end) - (1 + back) * sums[0, i]
        out[i] = step**2 * (sums[1, i] + place)
        out[size + i] = step * (sums[0, i] + _sum(rate_weights, history[i], end))
