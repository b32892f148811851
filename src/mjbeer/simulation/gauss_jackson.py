"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions.

A step predicts the state from the sums and the last accelerations, evaluates the acceleration there, and corrects the
state with it. The acceleration of the corrected state then follows from the evaluated one and from theory's derivatives
of it: the correction is so small that theirs is the effect of a second evaluation (PECE), which makes the method stable
at timesteps that are several times as large. States are read off two steps later, with accelerations on both sides,
where the formula errs far less.

A run begins in the middle of its first steps, the start: the six steps before it and the six after it are those that
agree with the accelerations in all of them, found by iteration.

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

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import GAUSS_JACKSON
from mjbeer.simulation.stepping import BLOCK_END, DONE, LARGEST, NOT_FINITE, Dynamics, Watcher, copy, drive, slope
from mjbeer.theory.scene import Scene

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""
BLOCK = 1024
"""Steps between two returns to Python, so that a long run can be interrupted. Their states fit into a fast cache."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_MIDDLE = COUNT // 2
_ITERATIONS = 30
"""Largest number of iterations of the first steps; a timestep that is not too long takes five to eight."""
_STARTED = 1e-9
"""Largest change of the first accelerations in the last iteration, over the largest of them."""


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model of a scene, often run.

    A step is one evaluation, where DOP853 has twelve and steps three times as large. A damping or a constraint that
    decays within a few timesteps would make it unstable. The `dynamics` are the model's, if they are there already.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(self, model: mujoco.MjModel, scene: Scene, dynamics: Dynamics | None = None) -> None:
        if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        damping = model.dof_damping, model.dof_dampingpoly, model.tendon_damping, model.tendon_dampingpoly
        if any(coefficients.any() for coefficients in damping):
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._dynamics, self.size = dynamics or Dynamics(model), model.nv
        form, share = scene.oscillator, scene.load.moment / scene.effective_mass
        depth = form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)
        self._form = form.base, form.chord, form.swing, *depth, share  # what theory's derivatives need
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self, start: np.ndarray, times: np.ndarray, timestep: float, watch: Watcher | None = None, push: float = 0.0
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        Six steps of `timestep` [s] are taken before the start, and two more than the times need. Between steps the
        states are those of the polynomial through the accelerations around. A `push` [rad/s^2] is added to phi_ddot.

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        size, rows = self.size, BLOCK + COUNT if watch else 0
        samples, sums, history = np.empty((len(times), 2 * size)), np.empty((4, size)), np.empty((size, COUNT + BLOCK))
        kept = np.empty(rows), np.empty((rows, 2 * size))
        fixed = *self._dynamics.kernel, (*self._form, push), start, sums, history, times, samples, kept
        self.evaluations = drive(GAUSS_JACKSON, _advance, fixed, (0.0, 0, timestep, 0), math.inf, watch)
        return samples


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
    """Return `weights` as polynomials of `back` - `LAG` - 1/2, the highest power first, shape (terms, COUNT)."""
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
    return ordinates[::-1].copy()


_PREDICT_RATE, _PREDICT = weights(1, -1), weights(2, -1)
_CORRECT_RATE, _CORRECT = weights(1, 0), weights(2, 0)
_READ = np.concatenate([weights(1, LAG), weights(2, LAG)])
_BETWEEN = np.concatenate([_between(1), _between(2)], axis=1)
_FIRST_RATE, _FIRST_PLACE = (np.stack([weights(power, back) for back in range(COUNT - 1, -1, -1)]) for power in (1, 2))
_MIDDLE_RATE, _MIDDLE_PLACE = _FIRST_RATE[_MIDDLE].copy(), _FIRST_PLACE[_MIDDLE].copy()
_FIRST_PLACE -= _MIDDLE_PLACE + np.arange(-_MIDDLE, _MIDDLE + 1)[:, None] * _MIDDLE_RATE
_FIRST_RATE -= _MIDDLE_RATE
"""Weights of the first accelerations in how rates and places differ from those at the start, in a row for each step."""


@njit(cache=True, error_model="numpy")
def _begin(pointers, views, start, step, sums, history):
    """Fill the history with the accelerations at the first `COUNT` steps, and begin the sums; return the evaluations.

    These are 0 if the iteration does not end. `history` has a row for each degree of freedom; `sums`, of shape (4, nv),
    the first and the second sum of its accelerations, and what rounding took from each.
    """
    size, end = sums.shape[1], history.shape[1] - BLOCK  # `COUNT`, a constant, would compile `_sum` once more
    state, derivative = np.empty(2 * size), np.empty(2 * size)
    slope(pointers, views, start, derivative)
    for i in range(size):
        for k in range(COUNT):
            history[i, k] = derivative[size + i]
    before = np.inf
    evaluations = 1
    for _ in range(_ITERATIONS):
        change = largest = 0.0
        evaluations += COUNT - 1
        for place in range(1, COUNT):  # outwards: a step after the start and one before it, by turns
            k = _MIDDLE + ((place + 1) // 2 if place % 2 else -place // 2)
            for i in range(size):
                rate, moved = _sum(_FIRST_RATE[k], history[i], end), _sum(_FIRST_PLACE[k], history[i], end)
                state[i] = start[i] + step * ((k - _MIDDLE) * start[size + i] + step * moved)
                state[size + i] = start[size + i] + step * rate
            slope(pointers, views, state, derivative)
            for i in range(size):
                change = max(change, abs(derivative[size + i] - history[i, k]))
                largest = max(largest, abs(derivative[size + i]))
                history[i, k] = derivative[size + i]
        if not change < np.inf or change <= 1e-16 * largest or (change >= before and change <= _STARTED * largest):
            break
        before = change
    if not change <= _STARTED * largest:
        return 0
    for i in range(size):
        first = start[size + i] / step - _sum(_MIDDLE_RATE, history[i], end)
        # The formulas have the sums up to the last acceleration: first = rate, second = place + (1 + back) first.
        second = start[i] / step**2 - _sum(_MIDDLE_PLACE, history[i], end) + (1 + _MIDDLE) * first
        sums[0, i], sums[1, i], sums[2, i], sums[3, i] = first, second, 0.0, 0.0
    return evaluations


@njit(cache=True, fastmath={"reassoc", "contract"})
def _sum(weights, accelerations, end):
    """Return the weighted sum of the `COUNT` accelerations before index `end`, in any order, so that terms overlap."""
    last, total = accelerations[end - COUNT : end], 0.0
    for k in range(COUNT):
        total += weights[k] * last[k]
    return total


@njit(cache=True)
def _add(sums, row, i, term):
    """Add a term to a sum, and the rounding of the addition before (Kahan)."""
    term -= sums[row + 2, i]
    total = sums[row, i] + term
    sums[row + 2, i] = (total - sums[row, i]) - term
    sums[row, i] = total


@njit(cache=True, nogil=True, error_model="numpy")
def _advance(pointers, views, form, start, sums, history, times, samples, kept, place):
    """Take up to a block of steps, and return the status, the new place and the numbers of evaluations and rows kept.

    `form` has what theory's derivatives of an acceleration need, and the push. `sums` and `history` are as `_begin` or
    the block before left them. The rows of `samples` whose `times` [s] are passed are filled in. `place` is time [s]
    and number of the last step, the timestep [s] and the next sample. `kept` takes times and states at the steps that
    are read off: it has room for `COUNT` more than a `BLOCK` of them, or for none.
    """
    _, steps, step, sample = place
    kept_times, kept_states = kept
    size = sums.shape[1]
    state, moved, derivative = np.empty(2 * size), np.empty(2 * size), np.empty(2 * size)
    chosen = np.empty(2 * COUNT)
    status, taken, row, evaluations = BLOCK_END, 0, 0, 0
    if steps == 0:
        evaluations = _begin(pointers, views, start, step, sums, history)
        if evaluations == 0:
            return NOT_FINITE, place, 0, 0
        steps = _MIDDLE
        if times[0] == 0.0:
            copy(start, samples[0])
            sample = 1
        if kept_times.size > 0:
            row = _keep_first(start, sums, history, step, times[-1], chosen, kept)
    while True:
        end = COUNT + taken
        while sample < times.size and times[sample] <= (steps - LAG) * step * (1 + 1e-14):
            back = steps - times[sample] / step
            _read(sums, history, end, back, step, chosen, samples[sample])
            sample += 1
        if sample == times.size:
            status = DONE
            break
        if taken == BLOCK:
            break
        for i in range(size):
            state[i] = step**2 * (sums[1, i] + _sum(_PREDICT, history[i], end))
            state[size + i] = step * (sums[0, i] + _sum(_PREDICT_RATE, history[i], end))
        slope(pointers, views, state, derivative)
        for i in range(size):
            history[i, end] = derivative[size + i]
            moved[i] = step**2 * (sums[1, i] + _sum(_CORRECT, history[i], end + 1)) - state[i]
            rate = sums[0, i] + history[i, end] + _sum(_CORRECT_RATE, history[i], end + 1)
            moved[size + i] = step * rate - state[size + i]
        _correct(form, state, moved, derivative, history, end)
        finite = True
        for i in range(size):
            _add(sums, 0, i, history[i, end])
            _add(sums, 1, i, sums[0, i])
            finite = finite and abs(state[i]) < LARGEST and abs(state[size + i]) < LARGEST
            finite = finite and math.isfinite(history[i, end])
        steps += 1
        if not finite:
            status = NOT_FINITE
            break
        taken += 1
        if kept_times.size > 0:
            kept_times[row] = min((steps - LAG) * step, times[-1])  # the last step may go beyond the last sample
            back = max(float(LAG), steps - times[-1] / step)
            _read(sums, history, end + 1, back, step, chosen, kept_states[row])
            row += 1
    for i in range(size):
        for k in range(COUNT):
            history[i, k] = history[i, taken + k]
    return status, (steps * step, steps, step, sample), evaluations + taken, row


@njit(cache=True, error_model="numpy")
def _correct(form, state, moved, derivative, history, end):
    """Change the accelerations that end the history, evaluated at a state, to those where that has `moved` a little.

    The derivatives are those of `Oscillator.acceleration` and of eq. (46).
    """
    base, chord, swing, along, across, share, push = form
    phi = history.shape[0] - 1
    sin, cos, rate, gain = math.sin(state[phi]), math.cos(state[phi]), state[2 * phi + 1], derivative[2 * phi + 1]
    square = rate * rate
    inertia = base + chord * (1 - cos) / 2 + swing * sin * sin
    bend, bent = sin * (chord / 2 + 2 * swing * cos), chord / 2 * cos + 2 * swing * (cos * cos - sin * sin)
    pull = along * sin + across * cos + bent * square / 2 + bend * gain
    change = -(pull * moved[phi] + bend * rate * moved[2 * phi + 1]) / inertia
    history[phi, end] += change + push
    if phi > 0:
        turned = (sin * gain + cos * square) * moved[phi] + 2 * sin * rate * moved[2 * phi + 1]
        history[0, end] += share * (cos * change - turned)


@njit(cache=True)
def _keep_first(start, sums, history, step, last, chosen, kept):
    """Keep the states at the first steps, from the start to the last one that can be read off or to the `last` time."""
    times, states = kept
    end = history.shape[1] - BLOCK
    copy(start, states[0])
    times[0], row = 0.0, 1
    while row <= _MIDDLE - LAG and times[row - 1] < last:
        times[row] = min(row * step, last)
        _read(sums, history, end, max(float(_MIDDLE - row), _MIDDLE - last / step), step, chosen, states[row])
        row += 1
    return row


@njit(cache=True, fastmath={"contract"})
def _read(sums, history, end, back, step, chosen, out):
    """Write the state `back` steps before the last acceleration to `out`, with `back` from `LAG` to `_MIDDLE`.

    The weights that are `chosen` for rate and place are work space, of shape (2 COUNT,).
    """
    if back == LAG:
        for k in range(2 * COUNT):
            chosen[k] = _READ[k]
    else:
        x = back - LAG - 0.5
        for k in range(2 * COUNT):
            chosen[k] = 0.0
        for row in range(COUNT + 2):
            for k in range(2 * COUNT):
                chosen[k] = chosen[k] * x + _BETWEEN[row, k]
    size = sums.shape[1]
    for i in range(size):
        place = _sum(chosen[COUNT:], history[i], end) - (1 + back) * sums[0, i]
        out[i] = step**2 * (sums[1, i] + place)
        out[size + i] = step * (sums[0, i] + _sum(chosen[:COUNT], history[i], end))
