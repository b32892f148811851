"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions.

A step predicts phi from the sums and the last accelerations, evaluates the acceleration there, and corrects phi with
it. The acceleration of the corrected phi then follows from the evaluated one and from theory's derivatives of it: the
correction is so small that theirs is the effect of a second evaluation (PECE), which makes the method stable at
timesteps that are several times as large. States are read off two steps later, with accelerations on both sides, where
the formula errs far less.

A run begins in the middle of its first steps, the start: the six steps before it and the six after it are those that
agree with the accelerations in all of them, found by iteration.

Steps may last as long as sqrt(J) is large. They are then even in a time s with t' = sqrt(J / J(phi0)), in which phi has
the acceleration -V'(phi) / J(phi0): that of a pendulum, however light the wheel. Of a sliding load, the axis less its
swing, u - (m b / M) sin(phi), is integrated in time, in which it hardly needs any steps. All of these come from the
accelerations of MuJoCo.

O. Montenbruck and E. Gill, Satellite Orbits, section 4.2; M. M. Berry and L. M. Healy, Implementation of Gauss-Jackson
integration for orbit propagation, J. Astronaut. Sci. 52 (2004), and The generalized Sundman transformation for
propagation of high-eccentricity elliptical orbits, Adv. Astronaut. Sci. 112 (2002).
"""

import math

import mujoco
import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.setting import GAUSS_JACKSON
from mjbeer.simulation.kernels import (
    BLOCK_END,
    DONE,
    NOT_FINITE,
    Dynamics,
    SmoothRecorder,
    compiled,
    copy,
    drive,
    inner,
    see,
    slope,
)
from mjbeer.simulation.multistep import BLOCK, COUNT, LAG, Form, add, form, read_off, weighted, weights
from mjbeer.simulation.stepping import LARGEST
from mjbeer.theory.scene import Scene

_MIDDLE = COUNT // 2
_ITERATIONS = 30
"""Largest number of iterations of the first steps; a timestep that is not too long takes five to eight."""
_STARTED = 1e-9
"""Largest change of the first accelerations in the last iteration, over the largest of them."""
_PREDICT_RATE, _PREDICT = weights(1, -1), weights(2, -1)
_CORRECT_RATE, _CORRECT = weights(1, 0), weights(2, 0)
_FIRST_RATE, _FIRST_PLACE = (np.stack([weights(power, back) for back in range(COUNT - 1, -1, -1)]) for power in (1, 2))
_MIDDLE_RATE, _MIDDLE_PLACE = _FIRST_RATE[_MIDDLE].copy(), _FIRST_PLACE[_MIDDLE].copy()
_FIRST_PLACE -= _MIDDLE_PLACE + np.arange(-_MIDDLE, _MIDDLE + 1)[:, None] * _MIDDLE_RATE
_FIRST_RATE -= _MIDDLE_RATE
"""Weights of the first accelerations in how rates and places differ from those at the start, in a row for each step."""
_CONSTRAINT, _DAMPER = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT), int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
_NO_RECORD = (0.0,) * 20, np.empty(0)


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model of a scene, often run.

    A step is one evaluation, where DOP853 has twelve and steps three times as large. A damping or a constraint that
    decays within a few timesteps would make it unstable. The `dynamics` are the model's, if they are there already.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(self, model: mujoco.MjModel, scene: Scene, dynamics: Dynamics | None = None) -> None:
        if not model.opt.disableflags & _CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        if not model.opt.disableflags & _DAMPER:
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._dynamics, self._scene, self.size = dynamics or Dynamics(model), scene, model.nv
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float,
        recorder: SmoothRecorder | None = None,
        uneven: Form | None = None,
        push: float = 0.0,
        limit: float = math.inf,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        All steps last a `timestep` [s]. With the form of `uneven` ones they are even in the method's own time, and the
        first one lasts about as long. Six steps are taken before the start, and two more than the times need. A `push`
        [rad/s^2] is added to phi_ddot.

        Raises:
          DivergenceError: if the motion stops being finite, or there are `limit` evaluations.
        """
        size, samples = self.size, np.empty((len(times), 2 * self.size))
        history, sums = np.empty((2, COUNT + BLOCK)), np.empty((2, 5))
        kernel, record = self._dynamics.kernel, recorder.kernel if recorder else _NO_RECORD
        work = np.empty((2, COUNT + 2)), np.empty((3, 2 * size)), np.empty(3)
        fixed = *kernel, uneven or form(self._scene), push, start, sums, history, work, times, samples, record
        self.evaluations = drive(GAUSS_JACKSON, _advance, fixed, (0.0, 0, timestep, 0), limit, None)
        return samples


@compiled(forceinline=True)
def _by_theory(form, sin, cos, rate, turned, sped):
    """Return the second derivative of phi in the method's own time by theory, and its change with phi and its rate.

    Eq. (16) in its general form, J phi_ddot = -V' - J' phi_dot^2 / 2.
    """
    pull, pulled = form.slope + form.along * cos - form.across * sin, -form.along * sin - form.across * cos
    if form.bounds.size > 0:
        return pull / form.scale, pulled / form.scale * turned
    inertia = form.base + form.chord * (1 - cos) / 2 + form.swing * sin * sin
    bend = sin * (form.chord / 2 + 2 * form.swing * cos)
    bent = form.chord / 2 * cos + 2 * form.swing * (cos * cos - sin * sin)
    gain = (pull - bend * rate * rate / 2) / inertia
    return gain, ((pulled - bent * rate * rate / 2 - bend * gain) * turned - bend * rate * sped) / inertia


@inner
def _by_mujoco(pointers, views, form, phi, sin, cos, rate, work):
    """Return the second derivative of phi in the method's own time, and the acceleration of the axis less its swing.

    The state that is evaluated has a slide at rest at its origin, on which nothing depends.
    """
    state, change, last = work[0], work[1], work.shape[1] // 2 - 1
    fast = 1.0
    if form.bounds.size > 0:
        fast = math.sqrt((form.base + form.chord * (1 - cos) / 2 + form.swing * sin * sin) / form.scale)
    speed = rate / fast
    state[0] = state[1 + last] = 0.0
    state[last], state[2 * last + 1] = phi, speed
    slope(pointers, views, state, change)
    gain, drawn = change[2 * last + 1], 0.0
    if last > 0:
        drawn = change[last + 1] - form.share * (cos * gain - sin * speed * speed)
    if form.bounds.size > 0:  # t'^2 phi_ddot + t'' phi_dot, and t'^2 is J over `scale`
        bend = sin * (form.chord / 2 + 2 * form.swing * cos) / form.scale
        gain = fast * fast * gain + bend * speed * speed / 2
    return gain, drawn


@inner
def _begin(pointers, views, form, phi, rate, step, sums, history, work):
    """Fill the history of the first `COUNT` steps, and begin the sums of phi; return the evaluations.

    These are 0 if the iteration does not end. Theory's accelerations are iterated first; MuJoCo's are then nearly those
    that agree with one another.
    """
    end = history.shape[1] - BLOCK  # `COUNT`, a constant, would compile `weighted` once more
    theory, evaluations, before = True, 0, np.inf
    for k in range(COUNT):
        history[0, k] = 0.0
    for _ in range(_ITERATIONS):
        change = largest = 0.0
        for order in range(COUNT):  # outwards: the start, then a step after it and one before it, by turns
            k = _MIDDLE + ((order + 1) // 2 if order % 2 else -order // 2)
            angle = phi + step * ((k - _MIDDLE) * rate + step * weighted(_FIRST_PLACE[k], history[0], end))
            turning = rate + step * weighted(_FIRST_RATE[k], history[0], end)
            sin, cos = math.sin(angle), math.cos(angle)
            if theory:
                gain, _ = _by_theory(form, sin, cos, turning, 0.0, 0.0)
            else:
                gain, history[1, k] = _by_mujoco(pointers, views, form, angle, sin, cos, turning, work)
                evaluations += 1
            change, largest = max(change, abs(gain - history[0, k])), max(largest, abs(gain))
            history[0, k] = gain
        if not change < np.inf:
            break
        if change <= 1e-16 * largest or (change >= before and change <= _STARTED * largest):
            if not theory:
                break
            theory = False
        before = change
    if theory or not change <= _STARTED * largest:
        return 0
    sums[0, 0] = rate / step - weighted(_MIDDLE_RATE, history[0], end)
    # The formulas have the sums up to the last acceleration: first = rate, second = place + (1 + back) first.
    sums[0, 1] = phi / step**2 - weighted(_MIDDLE_PLACE, history[0], end) + (1 + _MIDDLE) * sums[0, 0]
    return evaluations


@compiled()
def _advance(pointers, views, form, push, start, sums, history, work, times, samples, record, place):
    """Take up to a block of steps, and return the status, the new place, the number of evaluations, and 0.

    `history` has a row for the second derivatives of phi, and one for the accelerations of the axis less its swing.
    `sums` has the first and the second sum of the former, and time, place and velocity of the axis less its swing at
    the step that was last read off; and what rounding took from each. They are as the block before left them, and so is
    the last part of `work`, which otherwise is space to work in.

    The rows of `samples` whose `times` [s] are passed are filled in, and the `record` goes on. `place` is the time [s]
    that is passed, the number of steps, their length in the method's own time, and the next sample.
    """
    _, steps, step, sample = place
    points, states, node = work
    size = start.size // 2
    phi, rate, status, taken, evaluations, back = start[size - 1], start[-1], BLOCK_END, 0, 0, LAG
    if steps == 0:
        for k in range(5):
            sums[0, k] = sums[1, k] = 0.0
        if size > 1:
            sums[0, 3] = start[0] - form.share * math.sin(phi)
            sums[0, 4] = start[size] - form.share * math.cos(phi) * rate
        evaluations = _begin(pointers, views, form, phi, rate, step, sums, history, states)
        if evaluations == 0:
            return NOT_FINITE, place, 0, 0
        steps, back, node[0], node[1], node[2] = _MIDDLE, _MIDDLE, phi, rate, 1.0
        if times[0] == 0.0:
            copy(start, samples[0])
            sample = 1
        if record[1].size > 0:
            see(record[0], record[1], 0.0, start)
    while True:
        end = COUNT + taken
        if back > LAG:  # the first steps are there already
            back -= 1
        else:
            phi = step**2 * (sums[0, 1] + weighted(_PREDICT, history[0], end))
            rate = step * (sums[0, 0] + weighted(_PREDICT_RATE, history[0], end))
            sin, cos = math.sin(phi), math.cos(phi)
            gain, history[1, end] = _by_mujoco(pointers, views, form, phi, sin, cos, rate, states)
            history[0, end] = gain
            turned = step**2 * (sums[0, 1] + weighted(_CORRECT, history[0], end + 1)) - phi
            sped = step * (sums[0, 0] + gain + weighted(_CORRECT_RATE, history[0], end + 1)) - rate
            history[0, end] += _by_theory(form, sin, cos, rate, turned, sped)[1] + push
            add(sums, 0, history[0, end])
            add(sums, 1, sums[0, 0])
            steps, taken, end = steps + 1, taken + 1, end + 1
            if not max(abs(phi), abs(rate), abs(history[0, end - 1])) < np.inf or max(abs(phi), abs(rate)) > LARGEST:
                status = NOT_FINITE
                break
        time = sums[0, 2]
        sample = read_off(form, sums, node, history, end, back, step, points, states[2], times, sample, samples, record)
        if not sums[0, 2] < np.inf:
            status, sums[0, 2] = NOT_FINITE, time
        elif sample == times.size:
            status = DONE
        if status != BLOCK_END or taken == BLOCK:
            break
    for i in range(2):
        for k in range(COUNT):
            history[i, k] = history[i, taken + k]
    return status, (sums[0, 2], steps, step, sample), evaluations + taken, 0
