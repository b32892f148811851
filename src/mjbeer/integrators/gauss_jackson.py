"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions.

A step predicts phi from the sums and the last accelerations, evaluates MuJoCo's acceleration there, and corrects phi
with it. A second evaluation there (PECE) makes the method stable at timesteps that are several times as large. It is
spared where MuJoCo's accelerations, measured before the first step, follow a law: a constant and a swing in phi, at any
rate. The correction is so small that the slope of the law then has the effect of an evaluation. States are read off two
steps later, with accelerations on both sides, where the formula errs far less.

A run begins in the middle of its first steps, the start: the six steps before it and the six after it are those that
agree with the accelerations in all of them, found by iteration.

Steps are even in a time s with the caller's pace dt/ds, a positive function of phi. Where that is sqrt(J), in which J
is the inertia that phi has, phi is a pendulum in s, however light the wheel. Of a load in a can that slides along, the
slide less a share of sin(phi) is integrated in time, in which it hardly needs any steps; the share is measured, too.
All of these come from the accelerations of MuJoCo: with another pace the steps must be shorter, and the motion is the
same.

O. Montenbruck and E. Gill, Satellite Orbits, section 4.2; M. M. Berry and L. M. Healy, Implementation of Gauss-Jackson
integration for orbit propagation, J. Astronaut. Sci. 52 (2004), and The generalized Sundman transformation for
propagation of high-eccentricity elliptical orbits, Adv. Astronaut. Sci. 112 (2002).
"""

import math

import mujoco
import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.integrators import Observer
from mjbeer.integrators.dynamics import (
    BLOCK_END,
    DONE,
    NOT_FINITE,
    Dynamics,
    compiled,
    copy,
    derivative,
    inline,
    inner,
    run_blocks,
)
from mjbeer.integrators.uneven_time import (
    BLOCK,
    COUNT,
    LAG,
    SPARE,
    OwnTime,
    dense_output,
    kahan_add,
    pace,
    weighted,
    weights,
)
from mjbeer.model.mujoco_library import LARGEST

_MIDDLE = COUNT // 2
_ITERATIONS = 30
"""Largest number of iterations of the first steps; a timestep that is not too long takes five to eight."""
_STARTED = 1e-9
"""Largest change of the first accelerations in the last iteration, over the largest of them."""
_ANGLES, _CHECKS = 5, 3
"""Number of angles in a turn at which the law is measured at rest, and at which it is checked at a rate."""
_FITS = 1e-6
"""Largest difference from the law, over its size, with which it stands for an evaluation of a correction."""
_SPIN = 1e4
"""Rate [rad/s] at which the share of the slide is measured: what pulls at it is then the load's centrifugal force."""
_PREDICT_RATE, _PREDICT = weights(1, -1), weights(2, -1)
_CORRECT_RATE, _CORRECT = weights(1, 0), weights(2, 0)
_FIRST_RATE, _FIRST_PLACE = (np.stack([weights(power, back) for back in range(COUNT - 1, -1, -1)]) for power in (1, 2))
_MIDDLE_RATE, _MIDDLE_PLACE = _FIRST_RATE[_MIDDLE].copy(), _FIRST_PLACE[_MIDDLE].copy()
_FIRST_PLACE -= _MIDDLE_PLACE + np.arange(-_MIDDLE, _MIDDLE + 1)[:, None] * _MIDDLE_RATE
_FIRST_RATE -= _MIDDLE_RATE
"""Weights of the first accelerations in how rates and places differ from those at the start, in a row for each step."""
_CONSTRAINT, _DAMPER = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT), int(mujoco.mjtDisableBit.mjDSBL_DAMPER)


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model, often run.

    The model has the hinge phi, after a slide on which nothing depends, or alone. A step is one evaluation, where
    DOP853 has twelve and steps three times as large. A damping or a constraint that decays within a few timesteps would
    make it unstable. The `dynamics` are the model's, if they are there already.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(self, model: mujoco.MjModel, dynamics: Dynamics | None = None) -> None:
        if not model.opt.disableflags & _CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        if not model.opt.disableflags & _DAMPER:
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._dynamics, self.size = dynamics or Dynamics(model), model.nv
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float,
        own: OwnTime,
        observer: Observer | None = None,
        push: float = 0.0,
        limit: float = math.inf,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        All steps last a `timestep` in the method's `own` time. Six steps are taken before the start, and two more than
        the times need. A `push` [rad/s^2] is added to all accelerations of phi. The `observer` is shown the ends of the
        steps, and states between them where the load turns far in one.

        Raises:
          DivergenceError: if the motion stops being finite, or there are `limit` evaluations.
        """
        size, samples = self.size, np.empty((len(times), 2 * self.size))
        history, sums = np.empty((2, COUNT + BLOCK)), np.empty((2, 5))
        rows = BLOCK + SPARE if observer else 0
        kept = np.empty(rows), np.empty((rows, 2 * size))
        work = np.empty((2, COUNT + 2)), np.empty((2, 2 * size)), np.empty(3), np.empty(5)
        fixed = *self._dynamics.kernel, own, push, start, sums, history, work, times, samples, kept
        self.evaluations = run_blocks("GaussJackson", _advance, fixed, (0.0, 0, timestep, 0), limit, observer)
        return samples


@inline
def _accelerations(pointers, views, own, share, phi, rate, work):
    """Return the second derivative of phi in the method's own time, and that of the slide less its share in time.

    The state that is evaluated has the slide at rest at its origin.
    """
    state, change, last = work[0], work[1], work.shape[1] // 2 - 1
    sin, cos = math.sin(own.turns * phi), math.cos(own.turns * phi)
    square = own.even + own.uneven * sin * sin
    speed = rate / math.sqrt(square)
    state[0] = state[1 + last] = 0.0
    state[last], state[2 * last + 1] = phi, speed
    derivative(pointers, views, state, change)
    phi_ddot, pulled = change[2 * last + 1], 0.0
    if last > 0:
        pulled = change[last + 1] - share * (math.cos(phi) * phi_ddot - math.sin(phi) * speed * speed)
    return square * phi_ddot + own.uneven * own.turns * sin * cos * speed * speed, pulled


@inner
def _measure(pointers, views, own, law, work):
    """Write the law: the coefficients of 1, cos(phi) and sin(phi) in phi'', the share of the slide, and if it fits."""
    for k in range(5):
        law[k] = 0.0
    law[4], square = 1.0, 1.0
    for k in range(_ANGLES + 2 + _CHECKS):
        # At a quarter turn the slide is pulled by the square of the rate, and not by a change of it.
        phi, rate = 2 * math.pi * k / _ANGLES if k < _ANGLES else math.pi / 2, 0.0
        if k == _ANGLES + 1:
            rate = _SPIN * pace(own, phi)
        elif k > _ANGLES + 1:
            phi, rate = 2 * math.pi * k / _CHECKS + 0.5, math.sqrt(square)
        gain, pulled = _accelerations(pointers, views, own, 0.0, phi, rate, work)
        if k < _ANGLES:
            law[0] += gain / _ANGLES
            law[1] += 2 * gain * math.cos(phi) / _ANGLES
            law[2] += 2 * gain * math.sin(phi) / _ANGLES
        elif k == _ANGLES:
            law[3] = pulled / _SPIN**2
            square = abs(law[0]) + abs(law[1]) + abs(law[2])
            square = square if square > 0 else 1.0
        elif k == _ANGLES + 1:
            law[3] -= pulled / _SPIN**2
        elif not abs(gain - law[0] - law[1] * math.cos(phi) - law[2] * math.sin(phi)) <= _FITS * square:
            law[4] = 0.0


@inner
def _begin(pointers, views, own, law, phi, rate, step, sums, history, work):
    """Fill the history of the first `COUNT` steps, and begin the sums of phi; return the evaluations.

    These are 0 if the iteration does not end. The law's accelerations are iterated first; MuJoCo's are then nearly
    those that agree with one another.
    """
    end = history.shape[1] - BLOCK  # `COUNT`, a constant, would compile `weighted` once more
    by_law, evaluations, before = True, 0, np.inf
    for k in range(COUNT):
        history[0, k] = 0.0
    for _ in range(_ITERATIONS):
        change = largest = 0.0
        for order in range(COUNT):  # outwards: the start, then a step after it and one before it, by turns
            k = _MIDDLE + ((order + 1) // 2 if order % 2 else -order // 2)
            angle = phi + step * ((k - _MIDDLE) * rate + step * weighted(_FIRST_PLACE[k], history[0], end))
            turning = rate + step * weighted(_FIRST_RATE[k], history[0], end)
            if by_law:
                gain = law[0] + law[1] * math.cos(angle) + law[2] * math.sin(angle)
            else:
                gain, history[1, k] = _accelerations(pointers, views, own, law[3], angle, turning, work)
                evaluations += 1
            change, largest = max(change, abs(gain - history[0, k])), max(largest, abs(gain))
            history[0, k] = gain
        if not change < np.inf:
            break
        if change <= 1e-16 * largest or (change >= before and change <= _STARTED * largest):
            if not by_law:
                break
            by_law = False
        before = change
    if by_law or not change <= _STARTED * largest:
        return 0
    sums[0, 0] = rate / step - weighted(_MIDDLE_RATE, history[0], end)
    # The formulas have the sums up to the last acceleration: first = rate, second = place + (1 + back) first.
    sums[0, 1] = phi / step**2 - weighted(_MIDDLE_PLACE, history[0], end) + (1 + _MIDDLE) * sums[0, 0]
    return evaluations


@compiled()
def _advance(pointers, views, own, push, start, sums, history, work, times, samples, kept, place):
    """Take up to a block of steps, and return the status, the new place, and the numbers of evaluations and rows kept.

    `history` has a row for the second derivatives of phi, and one for the accelerations of the slide less its share.
    `sums` has the first and the second sum of the former, and time, place and velocity of the slide less its share at
    the step that was last read off; and what rounding took from each. They are as the block before left them, and so
    are the last parts of `work`, that step's node and the law; the others are space to work in.

    The rows of `samples` whose `times` [s] are passed are filled in, and times and states are `kept`, if that has room.
    `place` is the time [s] that is passed, the number of steps, their length in the method's own time, and the next
    sample.
    """
    _, steps, step, sample = place
    points, states, node, law = work
    size = start.size // 2
    phi, rate, status, taken, evaluations, back, row = start[size - 1], start[-1], BLOCK_END, 0, 0, LAG, 0
    if steps == 0:
        _measure(pointers, views, own, law, states)
        fast = pace(own, phi)
        for k in range(5):
            sums[0, k] = sums[1, k] = 0.0
        if size > 1:
            sums[0, 3] = start[0] - law[3] * math.sin(phi)
            sums[0, 4] = start[size] - law[3] * math.cos(phi) * rate
        rate *= fast
        evaluations = _begin(pointers, views, own, law, phi, rate, step, sums, history, states)
        if evaluations == 0:
            return NOT_FINITE, place, 0, 0
        evaluations += _ANGLES + 2 + _CHECKS
        steps, back, node[0], node[1], node[2] = _MIDDLE, _MIDDLE, phi, rate, fast
        if times[0] == 0.0:
            copy(start, samples[0])
            sample = 1
        if kept[0].size > 0:
            kept[0][0] = 0.0
            copy(start, kept[1][0])
            row = 1
    while True:
        end = COUNT + taken
        if back > LAG:  # the first steps are there already
            back -= 1
        else:
            phi = step**2 * (sums[0, 1] + weighted(_PREDICT, history[0], end))
            rate = step * (sums[0, 0] + weighted(_PREDICT_RATE, history[0], end))
            corrected = phi
            for correction in range(2):
                gain, history[1, end] = _accelerations(pointers, views, own, law[3], corrected, rate, states)
                history[0, end] = gain
                if correction > 0:
                    evaluations += 1
                    break
                corrected = step**2 * (sums[0, 1] + weighted(_CORRECT, history[0], end + 1))
                if law[4] > 0:
                    history[0, end] += (law[2] * math.cos(phi) - law[1] * math.sin(phi)) * (corrected - phi)
                    break
                rate = step * (sums[0, 0] + gain + weighted(_CORRECT_RATE, history[0], end + 1))
            history[0, end] += push
            kahan_add(sums, 0, history[0, end])
            kahan_add(sums, 1, sums[0, 0])
            steps, taken, end = steps + 1, taken + 1, end + 1
            if not max(abs(phi), abs(rate), abs(history[0, end - 1])) < np.inf or max(abs(phi), abs(rate)) > LARGEST:
                status = NOT_FINITE
                break
        time = sums[0, 2]
        sample, row = dense_output(
            own, law[3], sums, node, history, end, back, step, points, times, sample, samples, kept, row
        )
        if not sums[0, 2] < np.inf:
            status, sums[0, 2] = NOT_FINITE, time
        elif sample == times.size:
            status = DONE
        if status != BLOCK_END or taken == BLOCK or (kept[0].size > 0 and row > kept[0].size - SPARE):
            break
    for i in range(2):
        for k in range(COUNT):
            history[i, k] = history[i, taken + k]
    return status, (sums[0, 2], steps, step, sample), evaluations + taken, row
