"""A step of Gauss-Jackson: the state at its end, the time that it takes, and the states within it.

In a step phi is a polynomial of s: the one by which the method itself adds up accelerations. What
passes of t is the integral of dt/ds, by Gauss's formula, without an evaluation of the dynamics. All
of it is compiled code.
"""

import math
from typing import NamedTuple

import numpy as np

from mjbeer.integrators.compiling import compiled, inlined, optimize_for_size
from mjbeer.integrators.gauss_jackson.sundman_time import dt_ds
from mjbeer.integrators.gauss_jackson.weights import (
    CENTRE,
    COUNT,
    LAG,
    POSITION_POLYNOMIALS,
    POSITION_WEIGHTS,
    VELOCITY_WEIGHTS,
    weighted,
)

_ATTEMPTS = 5
"""Largest number of improvements of `s_share`, the place of a sample in its step."""
_PUNCTUAL = 3e-5
"""Distance of a sample from its time, as a share of the step's duration, after which one more
improvement leaves nothing but rounding: it cubes the distance."""


class Node(NamedTuple):
    """A point of the motion."""

    phi: float  # [rad]
    rate: float  # dphi/ds [rad/s]
    dt_ds: float


class WholeStep(NamedTuple):
    """A step between two nodes."""

    before: Node
    after: Node
    duration: float  # [s]
    end_time: float  # and a little more: up to this time samples are in the step [s]
    steady: float  # mean acceleration of the steady slide [m/s^2]


class StepCurve(NamedTuple):
    """phi in a step, by the formulas of `weights`: both sums, and what the last accelerations add.

    What they add is a polynomial of `back` - `CENTRE`, whose coefficients `fit` writes.
    """

    coefficients: np.ndarray  # the highest power first, shape (COUNT + 2,)
    first_sum: float
    second_sum: float
    timestep: float  # in Sundman time [s]
    back: int  # how many steps before the last acceleration the step begins


@inlined
def _phi(curve, back, added):
    """Return phi [rad] so many steps `back` from the last acceleration.

    It is the formula for a position in the head of `weights`. There, the last accelerations have
    `added` so much to both sums.
    """
    scaled_phi = curve.second_sum - (1 + back) * curve.first_sum + added
    return curve.timestep * curve.timestep * scaled_phi


@inlined
def end_node(sundman, curve, accelerations, end):
    """Return the node at the end of the step, by the accelerations before index `end`."""
    back = curve.back - 1  # a step later than its start
    row = 1 + back  # of the weights there, as in `row_of`
    phi = _phi(curve, float(back), weighted(POSITION_WEIGHTS, row, accelerations, end))
    scaled_rate = curve.first_sum + weighted(VELOCITY_WEIGHTS, row, accelerations, end)
    return Node(phi, curve.timestep * scaled_rate, dt_ds(sundman, phi))


@inlined
def whole_duration(sundman, curve, accelerations, end):
    """Return the time [s] that passes in the step, by the accelerations before index `end`."""
    count = sundman.points.size
    first_row = (curve.back - 1 - LAG) * count
    mean = 0.0
    for point in range(count):
        back = curve.back - sundman.points[point]
        row = first_row + point
        phi = _phi(curve, back, weighted(sundman.position_weights, row, accelerations, end))
        mean += sundman.weights[point] * dt_ds(sundman, phi)
    return curve.timestep * mean


@compiled
def fit(curve, accelerations, end):
    """Write the coefficients of a curve, by the accelerations before index `end`."""
    coefficients = curve.coefficients
    for k in range(COUNT + 2):
        coefficients[k] = 0.0
    for row in range(COUNT):
        for k in range(COUNT + 2):
            coefficients[k] += POSITION_POLYNOMIALS[row, k] * accelerations[end - COUNT + row]


@inlined
def node_at(sundman, curve, s_share):
    """Return the node after a share of the step in s, between 0 and 1; the curve is fitted."""
    back = curve.back - s_share
    x = back - CENTRE
    value = 0.0
    slope = 0.0
    for k in range(COUNT + 2):
        slope = slope * x + value
        value = value * x + curve.coefficients[k]
    phi = _phi(curve, back, value)
    rate = curve.timestep * (curve.first_sum - slope)  # `back` counts against time
    return Node(phi, rate, dt_ds(sundman, phi))


@inlined
def duration(sundman, curve, s_share):
    """Return the time [s] that passes in a first share of the step in s; the curve is fitted."""
    mean = 0.0
    for point in range(sundman.points.size):
        back = curve.back - s_share * sundman.points[point]
        x = back - CENTRE
        value = 0.0
        for k in range(COUNT + 2):
            value = value * x + curve.coefficients[k]
        mean += sundman.weights[point] * dt_ds(sundman, _phi(curve, back, value))
    return curve.timestep * s_share * mean


@compiled
def find(sundman, curve, step, since):
    """Return the node `since` [s] after the start of a `WholeStep`; the curve is fitted."""
    optimize_for_size()
    # The first guess is a cubic in t: it has the right value and slope, ds/dt, at both ends.
    t_share = since / step.duration
    first_slope = step.duration / (curve.timestep * step.before.dt_ds)
    last_slope = step.duration / (curve.timestep * step.after.dt_ds)
    square_term = 3 - 2 * first_slope - last_slope
    cubic_term = first_slope + last_slope - 2
    s_share = t_share * (first_slope + t_share * (square_term + t_share * cubic_term))
    for _ in range(_ATTEMPTS):
        node = node_at(sundman, curve, s_share)
        time_left = since - duration(sundman, curve, s_share)
        newton_step = time_left / node.dt_ds  # in s
        # The next term of that series has the growth of dt/ds: its slope in s, divided by dt/ds.
        growth = sundman.varying * sundman.multiple * math.sin(2 * sundman.multiple * node.phi)
        growth *= node.rate / (2 * node.dt_ds * node.dt_ds)
        s_share += newton_step * (1 - growth * newton_step / 2) / curve.timestep
        if abs(time_left) <= _PUNCTUAL * step.duration:
            break
    return node_at(sundman, curve, s_share)
