"""The first steps of Gauss-Jackson, and MuJoCo's accelerations in Sundman time, in compiled code.

Before it can take a step, a multistep method needs accelerations: those of the six steps before the
start, of the start itself, and of the six steps after it. They are found by iteration. With any
thirteen accelerations the formulas give angles and rates at all thirteen steps, for which MuJoCo is
asked for better accelerations. The law that phi nearly obeys is iterated first, as it costs next to
nothing.
"""

import math
from typing import NamedTuple

import numpy as np

from mjbeer.integrators.compiling import compiled, inlined, optimize_for_size
from mjbeer.integrators.dynamics import accelerate
from mjbeer.integrators.gauss_jackson.weights import (
    COUNT,
    POSITION_WEIGHTS,
    VELOCITY_WEIGHTS,
    row_of,
    weighted,
)

MIDDLE = COUNT // 2
"""Index of the start among the first steps."""
_ITERATIONS = 30
"""Largest number of iterations.

At a timestep that is not too long the law takes six to twelve, after which MuJoCo changes no more
than rounding."""
_ROUNDING = 1e-16
"""Largest change of an acceleration in an iteration, as a share of the largest one, that is
rounding."""
_SMALL_CHANGE = 1e-9
"""The same, below which iterations that do not improve any more have found the accelerations."""
_NOT_ZERO = 1e-300
"""Least size of the largest acceleration that a change is divided by."""
_START = row_of(MIDDLE)
_ALL = np.int64(COUNT)  # no plain number, as for `row_of`
_OUTWARDS = np.argsort(np.abs(np.arange(COUNT) - MIDDLE), stable=True)
"""The first steps in the order of an iteration: the start, then the step before it and the one
after it..."""


def _since_start() -> tuple[np.ndarray, np.ndarray]:
    """Return the weights that give velocity and position at each first step, since the start.

    These are the velocity less that at the start, and the position less its even motion from there.
    Each has shape (COUNT, COUNT), with a row for each step, the first one first.
    """
    # rows for back = COUNT - 1 down to 0
    velocities = VELOCITY_WEIGHTS[:0:-1]
    velocities_since = velocities - velocities[MIDDLE]
    steps = np.arange(-MIDDLE, MIDDLE + 1)[:, None]
    positions = POSITION_WEIGHTS[:0:-1]
    positions_since = positions - (positions[MIDDLE] + steps * velocities[MIDDLE])
    return velocities_since, positions_since


_VELOCITIES_SINCE, _POSITIONS_SINCE = _since_start()


class Accelerations(NamedTuple):
    """MuJoCo's accelerations in a state."""

    phi_second: float  # second derivative of phi in Sundman time [rad/s^2]
    steady: float  # second derivative of the steady slide in t [m/s^2]


class History(NamedTuple):
    """The last `Accelerations`; the newest `COUNT` of them count."""

    phi_second: np.ndarray
    steady: np.ndarray


class FirstSums(NamedTuple):
    """The two sums of accelerations with which a run begins, and how they were found."""

    found: bool  # whether the iteration has converged; if not, the sums say nothing
    evaluations: int
    first_sum: float  # of the accelerations, up to that of the last of these steps
    second_sum: float


@compiled
def evaluate(dynamics, sundman, phi, rate):
    """Return MuJoCo's `Accelerations` at a phi and its `rate` in Sundman time; the slide rests."""
    last = dynamics.qpos.size - 1
    sin = math.sin(sundman.multiple * phi)
    cos = math.cos(sundman.multiple * phi)
    dt_ds_squared = sundman.constant + sundman.varying * sin * sin
    phi_dot = rate / math.sqrt(dt_ds_squared)
    dynamics.qpos[last] = phi
    dynamics.qvel[last] = phi_dot
    accelerate(dynamics)
    phi_ddot = dynamics.qacc[last]
    # phi' = phi_dot dt/ds, and so phi'' = phi_ddot (dt/ds)^2 + phi_dot^2 d/dphi (dt/ds)^2 / 2.
    half_slope = sundman.varying * sundman.multiple * sin * cos
    in_s = dt_ds_squared * phi_ddot + half_slope * phi_dot * phi_dot
    steady = 0.0
    if last > 0:
        swinging = math.cos(phi) * phi_ddot - math.sin(phi) * phi_dot * phi_dot  # of sin(phi)
        steady = dynamics.qacc[0] - sundman.arm * swinging
    return Accelerations(in_s, steady)


@compiled
def find_first_steps(dynamics, sundman, start, timestep, history):
    """Write the accelerations of the first steps around a node to `history`; return `FirstSums`."""
    optimize_for_size()
    evaluations = 0
    by_law = True
    found = False
    change_before = np.inf
    for _ in range(_ITERATIONS):
        if by_law:
            change = _improve_by_law(sundman.law, start, timestep, history)
        else:
            change = _improve_by_mujoco(dynamics, sundman, start, timestep, history)
            evaluations += COUNT
        stalls = change_before <= change <= _SMALL_CHANGE
        if change <= _ROUNDING or stalls:
            if by_law:
                by_law = False
            else:
                found = True
                break
        change_before = change
    # These are the two formulas of `weights` at the start, solved for the sums.
    first_sum = start.rate / timestep - weighted(VELOCITY_WEIGHTS, _START, history.phi_second, _ALL)
    scaled_phi = start.phi / (timestep * timestep)
    from_history = weighted(POSITION_WEIGHTS, _START, history.phi_second, _ALL)
    second_sum = scaled_phi + (1 + MIDDLE) * first_sum - from_history
    return FirstSums(found, evaluations, first_sum, second_sum)


@inlined
def _phi_at(k, start, timestep, history):
    """Return phi at the first step with index `k` [rad], by the accelerations so far."""
    position_since = timestep * weighted(_POSITIONS_SINCE, k, history.phi_second, _ALL)
    return start.phi + timestep * ((k - MIDDLE) * start.rate + position_since)


@compiled
def _improve_by_law(law, start, timestep, history):
    """Replace the first accelerations by those of a `PendulumLaw` at the angles to which they lead.

    Return the largest change, divided by the largest of them.
    """
    optimize_for_size()
    change = 0.0
    largest = _NOT_ZERO
    for order in range(COUNT):
        k = _OUTWARDS[order]
        phi = _phi_at(k, start, timestep, history)
        acceleration = law.constant + law.cosine * math.cos(phi) + law.sine * math.sin(phi)
        change = max(change, abs(acceleration - history.phi_second[k]))
        largest = max(largest, abs(acceleration))
        history.phi_second[k] = acceleration
    return change / largest


@compiled
def _improve_by_mujoco(dynamics, sundman, start, timestep, history):
    """Replace the first accelerations by MuJoCo's in the states to which they lead.

    Return the largest change, divided by the largest of them.
    """
    optimize_for_size()
    change = 0.0
    largest = _NOT_ZERO
    for order in range(COUNT):
        k = _OUTWARDS[order]
        phi = _phi_at(k, start, timestep, history)
        rate = start.rate + timestep * weighted(_VELOCITIES_SINCE, k, history.phi_second, _ALL)
        evaluated = evaluate(dynamics, sundman, phi, rate)
        change = max(change, abs(evaluated.phi_second - history.phi_second[k]))
        largest = max(largest, abs(evaluated.phi_second))
        history.phi_second[k] = evaluated.phi_second
        history.steady[k] = evaluated.steady
    return change / largest
