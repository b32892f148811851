"""The state at the end of a step of Gauss-Jackson, the time that passes in the step, and the states within it.

In a step phi is a polynomial of s: the one by which the method itself adds up accelerations. What passes of t is the
integral of dt/ds, by Gauss's formula, without an evaluation of the dynamics. All of it is compiled code.
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
"""Distance of a sample from its time, as a share of the step's duration, after which one more improvement leaves
nothing but rounding: it cubes the distance."""


class Node(NamedTuple):
    """A point of the motion."""

    phi: float  # [rad]
    rate: float  # dphi/ds [rad/s]
    dt_ds: float


class WholeStep(NamedTuple):
    """What a step has led to."""

    before: Node  # at its start
    after: Node  # at its end
    duration: float  # [s]
    steady: float  # mean acceleration of the slide less arm sin(phi) [m/s^2]


class StepCurve(NamedTuple):
    """phi in a step, by the formulas of `weights`: both sums, and a polynomial of the last accelerations."""

    coefficients: np.ndarray  # of the polynomial, the highest power first, shape (COUNT + 2,)
    first_sum: float
    second_sum: float
    timestep: float  # in Sundman time [s]
    back: int  # how many steps before the last acceleration the step begins


@inlined
def end_node(sundman, curve, accelerations, end):
    """Return the node at the end of the step, by the accelerations before index `end`."""
    row = curve.back  # that of one step less back, as `row_of` says
    scaled_phi = curve.second_sum - curve.back * curve.first_sum  # phi/h^2
    scaled_phi += weighted(POSITION_WEIGHTS, row, accelerations, end)
    rate = curve.first_sum + weighted(VELOCITY_WEIGHTS, row, accelerations, end)
    phi = curve.timestep * curve.timestep * scaled_phi
    return Node(phi, curve.timestep * rate, dt_ds(sundman, phi))


@inlined
def whole_duration(sundman, curve, accelerations, end):
    """Return the time [s] that passes in the step, by the accelerations before index `end`."""
    count = sundman.points.size
    first_row = (curve.back - 1 - LAG) * count
    mean = 0.0
    for point in range(count):
        scaled_phi = curve.second_sum - (1 + curve.back - sundman.points[point]) * curve.first_sum
        scaled_phi += weighted(sundman.places, first_row + point, accelerations, end)
        mean += sundman.weights[point] * dt_ds(sundman, curve.timestep * curve.timestep * scaled_phi)
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
    """Return the node after a share of the step in s, between 0 and 1, if the curve is fitted."""
    back = curve.back - s_share
    x = back - CENTRE
    value = 0.0
    slope = 0.0
    for k in range(COUNT + 2):
        slope = slope * x + value
        value = value * x + curve.coefficients[k]
    phi = curve.timestep * curve.timestep * (curve.second_sum - (1 + back) * curve.first_sum + value)
    rate = curve.timestep * (curve.first_sum - slope)  # `back` counts against time
    return Node(phi, rate, dt_ds(sundman, phi))


@inlined
def duration(sundman, curve, s_share):
    """Return the time [s] that passes in the first share of the step in s, if the curve is fitted."""
    mean = 0.0
    for point in range(sundman.points.size):
        back = curve.back - s_share * sundman.points[point]
        x = back - CENTRE
        value = 0.0
        for k in range(COUNT + 2):
            value = value * x + curve.coefficients[k]
        scaled_phi = curve.second_sum - (1 + back) * curve.first_sum + value
        mean += sundman.weights[point] * dt_ds(sundman, curve.timestep * curve.timestep * scaled_phi)
    return curve.timestep * s_share * mean


@compiled
def find(sundman, curve, step, since):
    """Return the node `since` [s] after the start of a `WholeStep`, if the curve is fitted."""
    optimize_for_size()
    # First the cubic in t that has the right value and slope, ds/dt, at both ends of the step.
    t_share = since / step.duration
    first_slope = step.duration / (curve.timestep * step.before.dt_ds)
    last_slope = step.duration / (curve.timestep * step.after.dt_ds)
    square_term = 3 - 2 * first_slope - last_slope
    cubic_term = first_slope + last_slope - 2
    s_share = t_share * (first_slope + t_share * (square_term + t_share * cubic_term))
    for _ in range(_ATTEMPTS):
        node = node_at(sundman, curve, s_share)
        time_left = since - duration(sundman, curve, s_share)
        # Newton's step in s, and a second term for the `growth` of dt/ds, its derivative in s divided by itself.
        growth = sundman.varying * sundman.multiple * math.sin(2 * sundman.multiple * node.phi)
        growth *= node.rate / (2 * node.dt_ds * node.dt_ds)
        ahead = time_left / node.dt_ds
        s_share += ahead * (1 - growth * ahead / 2) / curve.timestep
        if abs(time_left) <= _PUNCTUAL * step.duration:
            break
    return node_at(sundman, curve, s_share)
