"""The time that a multistep method with uneven steps has passed, and the states at times that are asked for.

Steps are even in a time s of the method's own, whose pace, dt/ds, is any positive function of phi. In a step phi is a
polynomial, and what passes of t is integrated by Gauss's formula, without an evaluation of the dynamics.

The weights with which accelerations are added up come from rational arithmetic. With the backward difference z
(z a_n = a_n - a_(n-1)) and a step h, the time derivative is -ln(1 - z)/h, so that the velocity is h/(-ln(1 - z)) and
the position h^2/ln(1 - z)^2 times the acceleration. Their leading terms, 1/z and 1/z^2, are the first and the second
sum of all accelerations; the rest are differences of the last ones, and so weights for them. A factor (1 - z)^back
gives the value that many steps before the last acceleration: -1 predicts the next step.

Functions of compiled code have the method's `own` time, an `OwnTime`; the `line` of phi in a step, a `Line`; and a
share of the step that has `passed`. A `node` is phi, its rate in the method's own time, and the pace.
"""

import functools
import math
from collections import namedtuple
from fractions import Fraction

import numpy as np
from numpy.polynomial import polynomial
from numpy.polynomial.legendre import leggauss

from mjbeer.integrators.dynamics import inline, inner

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""
BLOCK = 1024
"""Steps between two returns to Python, so that a long run can be interrupted."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
_MOST_POINTS, FARTHEST = 12, 4.0
"""Largest number of points over which the time is integrated, and the angle [rad] that phi turns in a step at most."""
_ROUNDEST = 20.0
"""Largest size of the ellipse of `own_time`: with a larger one, points are too few where phi is no line in the step."""
_PUNCTUAL, _ATTEMPTS = 3e-5, 5
"""Distance of a sample from its time, over a step's, which one more attempt cubes; and the most attempts."""

OwnTime = namedtuple("OwnTime", "even uneven turns share lawful law points weights within")
OwnTime.__doc__ = """The pace is dt/ds = sqrt(even + uneven sin^2(turns phi)); see `own_time` for `share` and `law`.

`points` between 0 and 1 and their `weights` are those of Gauss's formula for the time that passes in a step. `within`
has `weights` of places at these points of the step that ends `LAG` steps before the last one.
"""
Line = namedtuple("Line", "curve first second step back")
Line.__doc__ = """Coefficients of phi in a step, both sums, the step [s], and how many steps back it begins."""


def own_time(
    even: float,
    uneven: float,
    turns: float,
    precision: float = 1e-15,
    turned: float = FARTHEST,
    share: float = 0.0,
    law: tuple[float, float, float] | None = None,
) -> OwnTime:
    """Return a method's own time s with dt/ds = sqrt(even + uneven sin^2(turns phi)), which must be positive.

    Whatever the pace, the motion is the same; the nearer its square is to that of the load's inertia, the longer the
    steps may be. If there is a `law`, phi'' is nearly the sum of 1, cos(phi) and sin(phi) with its coefficients in that
    time. The slide less a `share` [m] of sin(phi) must be evenly accelerated: it is integrated to second order only.

    The time that passes in a step in which phi has `turned` by an angle [rad] is known to some `precision`, a share of
    it: the error of Gauss's formula is the size of an ellipse to the power of minus twice the number of points. It has
    both ends of the step as foci, and the complex angle at which the pace vanishes is on it, or farther out.
    """
    height = math.asinh(math.sqrt(even / uneven)) / turns if uneven > 0 else math.inf
    size = min(math.asinh(2 * height / turned) if turned > 0 else math.inf, math.log(_ROUNDEST))
    points = _points(min(_MOST_POINTS, math.ceil(-math.log(precision) / (2 * size))))
    return OwnTime(even, uneven, turns, share, law is not None, law or (0.0, 0.0, 0.0), *points)


@functools.cache
def _points(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return so many points of Gauss's formula, their weights, and those of places there, for an `OwnTime`."""
    points, weights = leggauss(count)
    within = np.vander(-points / 2, COUNT + 2) @ _BETWEEN.T
    within.flags.writeable = False  # like all weights, or `weighted` would be compiled once more
    return (points + 1) / 2, weights / 2, within


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


def _between() -> np.ndarray:
    """Return `weights` of places as polynomials of `back` - `LAG` - 1/2, the highest power first, shape (COUNT, terms).

    The velocity is their derivative, with the opposite sign, and the first sum.
    """
    inverse = [float(term) for term in series(2, 0, COUNT + 2)]
    shifts: list[np.ndarray] = [np.ones(1)]
    for j in range(1, COUNT + 2):
        shifts.append(polynomial.polymul(shifts[-1], [(j - 1.5 - LAG) / j, -1 / j]))
    ordinates = np.zeros((COUNT + 2, COUNT))
    for j in range(COUNT):
        difference = np.zeros(COUNT + 2)
        for k in range(j + 3):
            difference[: k + 1] += inverse[j + 2 - k] * shifts[k]
        for k in range(j + 1):
            ordinates[:, COUNT - 1 - k] += (-1) ** k * math.comb(j, k) * difference
    return ordinates[::-1].T.copy()


_BETWEEN = _between()


@inline
def weighted(weights, row, accelerations, end):
    """Return the sum of the `COUNT` accelerations before index `end`, with a row of weights, in four sums that overlap.

    The order is written out: a compiler that may choose it gives other digits where it reads its cache.
    """
    first, second, third, fourth = weights[row, COUNT - 1] * accelerations[end - 1], 0.0, 0.0, 0.0
    for k in range(0, COUNT - 1, 4):
        i = end - COUNT + k
        first += weights[row, k] * accelerations[i]
        second += weights[row, k + 1] * accelerations[i + 1]
        third += weights[row, k + 2] * accelerations[i + 2]
        fourth += weights[row, k + 3] * accelerations[i + 3]
    return (first + second) + (third + fourth)


@inline
def dt_ds(own, phi):
    """Return dt/ds, how fast time passes in the method's own time, at an angle."""
    sin = math.sin(own.turns * phi)
    return math.sqrt(own.even + own.uneven * sin * sin)


@inner
def fit_phi(line, gains, end):
    """Write the coefficients of phi in the step of a `line`, by its second derivatives before index `end`."""
    for row in range(COUNT + 2):
        line.curve[row] = 0.0
    for k in range(COUNT):
        for row in range(COUNT + 2):
            line.curve[row] += _BETWEEN[k, row] * gains[end - COUNT + k]


@inner
def node(own, line, passed):
    """Return the node in a step."""
    x, place, rate = line.back - passed - LAG - 0.5, 0.0, 0.0
    for row in range(COUNT + 2):
        rate = rate * x + place
        place = place * x + line.curve[row]
    phi = line.step * line.step * (place + line.second - (1 + line.back - passed) * line.first)
    return phi, line.step * (line.first - rate), dt_ds(own, phi)


@inline
def whole(own, gains, end, line):
    """Return the time [s] that passes in the step that ends `LAG` steps before the last one."""
    passed = 0.0
    for k in range(own.points.size):
        place = line.second - (LAG + 2 - own.points[k]) * line.first + weighted(own.within, k, gains, end)
        passed += own.weights[k] * dt_ds(own, line.step * line.step * place)
    return line.step * passed


@inner
def duration(own, line, share):
    """Return the time [s] that passes in the first `share` of a step."""
    passed = 0.0
    for k in range(own.points.size):
        x, place = line.back - share * own.points[k] - LAG - 0.5, 0.0
        for row in range(COUNT + 2):
            place = place * x + line.curve[row]
        line.curve[COUNT + 2 + k] = line.second + place - (LAG + 1.5 + x) * line.first
    for k in range(own.points.size):
        passed += own.weights[k] * dt_ds(own, line.step * line.step * line.curve[COUNT + 2 + k])
    return line.step * share * passed


@inner
def find(own, line, before, after, span, since):
    """Return the node `since` [s] after the beginning of a step of some `span` [s] from one node to another.

    The first guess is a cubic; an attempt takes the change of the pace into account.
    """
    share = since / span
    first, last = span / (line.step * before[2]), span / (line.step * after[2])
    passed = share * (first + share * (3 - 2 * first - last + share * (first + last - 2)))
    for _ in range(_ATTEMPTS):
        phi, rate, pace = node(own, line, passed)
        late = since - duration(own, line, passed)
        grows = own.uneven * own.turns * math.sin(2 * own.turns * phi) * rate / (2 * pace * pace)
        ahead = late / pace
        passed += ahead * (1 - grows * ahead / 2) / line.step
        if abs(late) <= _PUNCTUAL * span:
            break
    return node(own, line, passed)


@inline
def kahan_add(total, term):
    """Return a sum and what rounding took from it, both with a further term."""
    term -= total[1]
    new = total[0] + term
    return new, (new - total[0]) - term
