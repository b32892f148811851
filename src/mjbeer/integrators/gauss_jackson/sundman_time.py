"""The Sundman time s, in which the steps of Gauss-Jackson are even.

A light wheel passes its lowest point in a hundredth of its swing, and steps that are even in t
would all have to be as short as that passage needs. The (generalized) Sundman transformation

    dt/ds = sqrt(J(phi)/unit)

makes the passage as long as the rest of the swing. It also takes J out of the law: with phi' =
dphi/ds, J phi_dot^2 = unit phi'^2, so that unit phi'' = -V'(phi), a pendulum with a constant
inertia.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from mjbeer.integrators.compiling import inlined
from mjbeer.integrators.gauss_jackson.swing_law import SwingLaw
from mjbeer.integrators.gauss_jackson.weights import CENTRE, COUNT, LAG, POSITION_POLYNOMIALS

LARGEST_TURN = 4.0
"""The largest angle by which phi may turn in a step [rad]."""
_MOST_POINTS = 100
"""Largest number of points at which dt/ds is looked at in a step: so many are needed where a wheel
has a thousandth of its load's mass."""
_LARGEST_ELLIPSE = 20.0
"""Largest size of a Bernstein ellipse that `_points_for` assumes: a larger one would give too few
points, as phi is not linear in s within a step."""


class PendulumLaw(NamedTuple):
    """The law phi'' = constant + cosine cos(phi) + sine sin(phi) in Sundman time [1/s^2]."""

    constant: float
    cosine: float
    sine: float


class SundmanTime(NamedTuple):
    """A time s with dt/ds = sqrt(constant + varying sin^2(multiple phi)), which must be positive.

    Whatever dt/ds and `law` are, the motion is the same, as its accelerations are MuJoCo's; the
    nearer they come to the motion's own, the longer the steps may be.
    """

    constant: float
    varying: float
    multiple: float  # 1 for a coupling, 1/2 for a chord
    law: PendulumLaw  # that phi nearly obeys
    arm: float  # of the steady slide, as in `SwingLaw` [m]
    points: np.ndarray  # of Gauss's formula in a step, between 0 and 1
    weights: np.ndarray  # of these points, whose sum is 1
    position_weights: np.ndarray  # of the accelerations, for phi at these points


def sundman_time(
    law: SwingLaw, unit: float, precision: float = 1e-15, largest_turn: float = LARGEST_TURN
) -> SundmanTime:
    """Return the Sundman time of a law, with dt/ds = 1 where J is the `unit` [kg m^2].

    The duration of a step in which phi turns by `largest_turn` [rad] is known to some `precision`,
    a share of it.
    """
    constant = law.base / unit
    varying = law.chord / unit
    multiple = 0.5
    if law.coupling > 0:
        varying = law.coupling / unit
        multiple = 1.0
    count = _points_for(constant, varying, multiple, precision, largest_turn)
    points, weights = _gauss(count)
    return SundmanTime(
        constant=constant,
        varying=varying,
        multiple=multiple,
        law=PendulumLaw(
            constant=law.ramp / unit,
            cosine=law.depth / unit * math.sin(law.bottom),
            sine=-law.depth / unit * math.cos(law.bottom),
        ),
        arm=law.arm,
        points=points,
        weights=weights,
        position_weights=_position_weights(count),
    )


def _points_for(
    constant: float, varying: float, multiple: float, precision: float, largest_turn: float
) -> int:
    """Return the number of points with which Gauss's formula gives a duration to some precision.

    With each point its error falls by the square of the size of a Bernstein ellipse (L. N.
    Trefethen, Approximation Theory and Approximation Practice, chapter 19). The foci of this
    ellipse in the complex plane are the ends of the step, and it passes through the angle at which
    dt/ds vanishes. Its size is the sum of its half-axes, divided by half the distance of its foci.
    """
    logarithm = math.log(_LARGEST_ELLIPSE)  # of the size
    if varying > 0 and largest_turn > 0:
        zero = math.asinh(math.sqrt(constant / varying)) / multiple  # the imaginary angle
        logarithm = min(logarithm, math.asinh(2 * zero / largest_turn))
    return min(_MOST_POINTS, math.ceil(-math.log(precision) / (2 * logarithm)))


@functools.cache
def _gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return so many points of Gauss's formula between 0 and 1, and their weights."""
    points, weights = leggauss(count)
    return (points + 1) / 2, weights / 2


@functools.cache
def _position_weights(count: int) -> np.ndarray:
    """Return the weights of accelerations for phi at points of a step, a row for each point.

    The first rows are those of a step that ends `LAG` steps before the last acceleration, as most
    steps of a run do. The next rows are those of a step that ends one step earlier, and so on, as
    the steps at the beginning of a run do.
    """
    points, _ = _gauss(count)
    ends = np.arange(LAG, COUNT // 2)  # steps before the last acceleration
    back = (ends[:, None] + 1 - points).ravel()
    weights = np.vander(back - CENTRE, COUNT + 2) @ POSITION_POLYNOMIALS.T
    weights.flags.writeable = False  # like all weights, or `weighted` would be compiled once more
    return weights


@inlined
def dt_ds(sundman, phi):
    """Return dt/ds at an angle."""
    sin = math.sin(sundman.multiple * phi)
    return math.sqrt(sundman.constant + sundman.varying * sin * sin)
