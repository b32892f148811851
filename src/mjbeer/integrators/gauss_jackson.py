"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions.

A step predicts phi from the sums and the last accelerations, evaluates MuJoCo's acceleration there, and corrects phi
with it. A second evaluation (PECE) makes the method stable at timesteps several times as large. The slope of a law that
phi nearly obeys, if the caller gives one, has the same effect. States are read off two steps later, with accelerations
on both sides, where the formula errs far less. The six steps before the start and the six after it are found by
iteration.

Steps are even in a time s with the caller's pace dt/ds, a positive function of phi. Where that is sqrt(J), in which J
is the inertia that phi has, phi is a pendulum in s, however light the wheel. Of a load in a can that slides along, the
slide less a share of sin(phi), which is evenly accelerated, is integrated in time. The motion comes from the
accelerations of MuJoCo alone: with another pace only the steps must be shorter.

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
    accelerate,
    compiled,
    inner,
    run_blocks,
    small,
)
from mjbeer.integrators.uneven_time import (
    BLOCK,
    COUNT,
    FARTHEST,
    LAG,
    Line,
    OwnTime,
    dt_ds,
    duration,
    find,
    fit_phi,
    kahan_add,
    node,
    weighted,
    weights,
    whole,
)
from mjbeer.model.mujoco_library import LARGEST, quiet

_MIDDLE = COUNT // 2
_ITERATIONS = 30
"""Largest number of iterations of the first steps; a timestep that is not too long takes five to eight."""
_STARTED = 1e-9
"""Largest change of the first accelerations in the last iteration, over the largest of them."""
_RATE, _PLACE = (np.stack([weights(power, back) for back in range(-1, COUNT)]) for power in (1, 2))
_NEXT, _LAST, _READ, _START = np.array([-1, 0, LAG, _MIDDLE]) + 1
"""Rows of these weights, for so many steps back. For each plain number `weighted` would be compiled once more."""
_FIRST_RATE = _RATE[:0:-1] - _RATE[_START]
_FIRST_PLACE = _PLACE[:0:-1] - (_PLACE[_START] + np.arange(-_MIDDLE, _MIDDLE + 1)[:, None] * _RATE[_START])
"""Weights of the first accelerations in how rates and places differ from those at the start, in a row for each step."""
_OUTWARDS = np.argsort(np.abs(np.arange(COUNT) - _MIDDLE), stable=True)
"""The first steps in the order in which an iteration takes them: the start, then one before it and one after it..."""
_CONSTRAINT, _DAMPER = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT), int(mujoco.mjtDisableBit.mjDSBL_DAMPER)


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model, often run.

    The model has the hinge phi, after a slide on which nothing depends, or alone. A step is one evaluation, where
    DOP853 has twelve and steps three times as large. A damping or a constraint that decays fast would make it unstable.

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

    @quiet()
    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float,
        own: OwnTime,
        observer: Observer | None = None,
        forcing: float = 0.0,
        limit: float = math.inf,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        All steps last a `timestep` in the method's `own` time. A `forcing` [rad/s^2] is added to all accelerations of
        phi. The `observer` is shown the ends of the steps.

        Raises:
          DivergenceError: if the motion stops being finite, or there are `limit` evaluations.
        """
        size, samples, rows = self.size, np.empty((len(times), 2 * self.size)), BLOCK + COUNT if observer else 0
        kept, sample = (np.zeros(rows), np.empty((rows, 2 * size))), int(times[0] == 0)
        samples[:sample] = start
        kept[1][:1] = start
        phi, phi_dot = float(start[size - 1]), float(start[-1])
        pace, slide, speed = dt_ds.py_func(own, phi), 0.0, 0.0
        if size > 1:
            slide = float(start[0]) - own.share * math.sin(phi)
            speed = float(start[size]) - own.share * math.cos(phi) * phi_dot
        work = *np.zeros((2, COUNT + BLOCK)), np.empty(COUNT + 14)
        self._dynamics.data.qpos[:] = self._dynamics.data.qvel[:] = 0.0
        sums = tuple((each, 0.0) for each in (0.0, 0.0, 0.0, slide, speed))
        fixed = *self._dynamics.kernel, own, forcing, timestep, work, times, samples, kept
        place = 0.0, _MIDDLE, sample, (phi, phi_dot * pace, pace), sums
        self.evaluations, _ = run_blocks("GaussJackson", _advance, fixed, place, limit, observer)
        return samples


@inner
def _accelerations(pointers, views, own, phi, rate):
    """Return the second derivative of phi in the method's own time, and that of the slide less its share in time.

    `pointers` and `views` are those of `derivative`; the slide is at rest at its origin.
    """
    qpos, qvel, qacc, _ = views
    last = qpos.size - 1
    sin, cos = math.sin(own.turns * phi), math.cos(own.turns * phi)
    square = own.even + own.uneven * sin * sin
    speed = rate / math.sqrt(square)
    qpos[last], qvel[last] = phi, speed
    accelerate(pointers)
    phi_ddot, pulled = qacc[last], 0.0
    if last > 0:
        pulled = qacc[0] - own.share * (math.cos(phi) * phi_ddot - math.sin(phi) * speed * speed)
    return square * phi_ddot + own.uneven * own.turns * sin * cos * speed * speed, pulled


@inner
def _begin(pointers, views, own, start, step, gains, pulls):
    """Find the accelerations of the first `COUNT` steps, and return the evaluations and the two sums of phi.

    There are no evaluations if the iteration does not end. The law's accelerations, iterated first, are nearly right.
    """
    small()
    end = gains.size - BLOCK  # `COUNT`, a constant, would compile `weighted` once more
    by_law, evaluations, before = True, 0, np.inf
    phi, rate, _ = start
    for _ in range(_ITERATIONS):
        error = largest = 0.0
        for order in range(COUNT):
            k = _OUTWARDS[order]
            angle = phi + step * ((k - _MIDDLE) * rate + step * weighted(_FIRST_PLACE, k, gains, end))
            if by_law:
                gain = own.law[0] + own.law[1] * math.cos(angle) + own.law[2] * math.sin(angle)
            else:
                turning = rate + step * weighted(_FIRST_RATE, k, gains, end)
                gain, pulls[k] = _accelerations(pointers, views, own, angle, turning)
                evaluations += 1
            error = max(error, abs(gain - gains[k]))
            largest = max(largest, abs(gain))
            gains[k] = gain
        if error <= 1e-16 * largest or (error >= before and error <= _STARTED * largest):
            if not by_law:
                break
            by_law = False
        before = error
    if by_law or not error <= _STARTED * largest:
        evaluations = 0
    first = rate / step - weighted(_RATE, _START, gains, end)
    # The formulas have the sums up to the last acceleration: first = rate, second = place + (1 + back) first.
    return evaluations, first, phi / (step * step) - weighted(_PLACE, _START, gains, end) + (1 + _MIDDLE) * first


@inner
def _write(own, node, since, slide, speed, pulled, states, row):
    """Write the state at a node, `since` [s] after the begin of its step, to a row of `states`.

    There the slide less its share of sin(phi) was `slide` [m] with its `speed` [m/s]; it is `pulled` [m/s^2] evenly.
    """
    small()
    phi, rate, last = node[0], node[1] / node[2], states.shape[1] // 2 - 1
    states[row, last], states[row, 2 * last + 1] = phi, rate
    if last > 0:
        states[row, 0] = slide + since * (speed + since * pulled / 2) + own.share * math.sin(phi)
        states[row, 1 + last] = speed + since * pulled + own.share * math.cos(phi) * rate


@compiled
def _advance(pointers, views, own, forcing, step, work, times, samples, kept, place):
    """Take up to a block of steps, and return the status, the new place, and the numbers of evaluations and rows kept.

    `work` has the last second derivatives of phi, and the accelerations of the slide less its share, and space for the
    coefficients of phi in a step. The rows of `samples` whose `times` [s] are passed are filled in, and times and
    states at the ends of steps are `kept`, after the start, if that has room.

    `place` is the time [s] that is passed, how many steps back the last step is read off, the next sample, the node
    there, and five sums with what rounding took from each: both sums of the accelerations, and time, place and velocity
    of the slide less its share at the node.
    """
    small()
    _, back, sample, before, (first, second, clock, slide, speed) = place
    gains, pulls, curve = work
    kept_times, kept_states = kept
    status, end, evaluations, row = BLOCK_END, gains.size - BLOCK, 0, 0
    if back == _MIDDLE:
        evaluations, total, double = _begin(pointers, views, own, before, step, gains, pulls)
        first, second, row = (total, 0.0), (double, 0.0), 1
        if evaluations == 0:
            status = NOT_FINITE
        elif sample == times.size:
            status = DONE
    while status == BLOCK_END and end < gains.size:
        if back > LAG:  # the first steps are there already
            back -= 1
        else:
            phi = step * step * (second[0] + weighted(_PLACE, _NEXT, gains, end))
            rate = step * (first[0] + weighted(_RATE, _NEXT, gains, end))
            gain, predicted, end = 0.0, phi, end + 1
            for _ in range(2 - own.lawful):
                predicted = phi
                gain, pulls[end - 1] = _accelerations(pointers, views, own, phi, rate)
                gains[end - 1] = gain
                evaluations += 1
                phi = step * step * (second[0] + weighted(_PLACE, _LAST, gains, end))
                rate = step * (first[0] + gain + weighted(_RATE, _LAST, gains, end))
            if own.lawful:
                gain += (own.law[2] * math.cos(predicted) - own.law[1] * math.sin(predicted)) * (phi - predicted)
            gain += forcing
            gains[end - 1] = gain
            first = kahan_add(first, gain)
            second = kahan_add(second, first[0])
            if not (abs(phi) < LARGEST and abs(rate) * step < FARTHEST):
                status = NOT_FINITE
                break
        line = Line(curve, first[0], second[0], step, back + 1.0)
        if back == LAG:
            phi = step * step * (line.second - line.back * line.first + weighted(_PLACE, _READ, gains, end))
            after = phi, step * (line.first + weighted(_RATE, _READ, gains, end)), dt_ds(own, phi)
            span = whole(own, gains, end, line)
        else:
            fit_phi(line, gains, end)
            after = node(own, line, 1.0)
            span = duration(own, line, 1.0)
        # It hardly changes, but for rounding: most where the load is fastest, and so the pace is slowest.
        pulled = (before[2] * pulls[end - 2 - back] + after[2] * pulls[end - 1 - back]) / (before[2] + after[2])
        last = (clock[0] + span) * (1 + 1e-14)
        if back == LAG and times[sample] <= last:
            fit_phi(line, gains, end)
        while sample < times.size and times[sample] <= last:
            since = times[sample] - clock[0]
            at = find(own, line, before, after, span, since)
            _write(own, at, since, slide[0], speed[0], pulled, samples, sample)
            sample += 1
            if sample == times.size:
                status, after, span = DONE, at, since  # the run ends within this step
        clock = kahan_add(clock, span)
        if row < kept_times.size:
            kept_times[row] = clock[0]
            _write(own, after, span, slide[0], speed[0], pulled, kept_states, row)
            row += 1
        slide = kahan_add(slide, span * (speed[0] + span * pulled / 2))
        speed = kahan_add(speed, span * pulled)
        before = after
    for k in range(COUNT):
        gains[k], pulls[k] = gains[end - COUNT + k], pulls[end - COUNT + k]
    return status, (clock[0], back, sample, before, (first, second, clock, slide, speed)), evaluations, row
