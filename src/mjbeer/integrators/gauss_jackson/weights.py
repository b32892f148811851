"""The weights with which Gauss-Jackson adds up accelerations, by rational arithmetic.

Let z be the backward difference, z a_n = a_n - a_(n-1), and h the step. By Taylor's theorem the
time derivative is then -ln(1 - z)/h. So the velocity is h/(-ln(1 - z)), and the position h^2/ln(1 -
z)^2, times the acceleration. As series in z they begin with 1/z and 1/z^2, which are the first and
the second sum of all accelerations; the other terms are differences of the last accelerations, and
so weights for these. A factor (1 - z)^back gives the value that many steps before the last
acceleration; a `back` of -1 predicts the next step.

In units of the step, with both sums up to the last acceleration, and the weights of that `back`,

    velocity = first_sum + weights . accelerations,
    position = second_sum - (1 + back) first_sum + weights . accelerations.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from mjbeer.integrators.compiling import inlined

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth.

One more than a multiple of four, as `weighted` adds them up in four sums."""
LAG = 2
"""Steps after which a state is read off; with more of them only the evaluations grow."""
CENTRE = LAG + 0.5
"""How many steps before the last acceleration the middle of the step lies that is read off."""
VELOCITY = 1
"""The power of z/(-ln(1 - z)) for velocities."""
POSITION = 2
"""The power for positions."""


def weights_at(power: int, back: int) -> np.ndarray:
    """Return the weights of the last `COUNT` accelerations, the oldest first, shape (COUNT,).

    They give what the `power` says, `VELOCITY` or `POSITION`, `back` steps before the last
    acceleration.
    """
    shift = [Fraction(1)]  # the series of (1 - z)^back
    for k in range(1, COUNT + power):
        shift.append(shift[-1] * (k - 1 - back) / k)
    series = _product(_integral(power), shift)
    return np.array([float(weight) for weight in _of_ordinates(series[power:])])


def position_polynomials() -> np.ndarray:
    """Return the weights of positions as polynomials of `back` - `CENTRE`.

    The shape is (COUNT, COUNT + 2), with the highest power first.
    """
    back = Polynomial([CENTRE, 1.0])
    shift = [Polynomial([1.0])]
    for k in range(1, COUNT + POSITION):
        shift.append(shift[-1] * (k - 1 - back) / k)
    integral = [float(coefficient) for coefficient in _integral(POSITION)]
    series = _product(integral, shift)
    polynomials = np.zeros((COUNT, COUNT + 2))
    for row, polynomial in enumerate(_of_ordinates(series[POSITION:])):
        polynomials[row, : len(polynomial.coef)] = polynomial.coef
    return polynomials[:, ::-1].copy()


def _integral(power: int) -> list[Fraction]:
    """Return the first `COUNT` + `power` coefficients of (z/(-ln(1 - z)))^power in powers of z."""
    terms = COUNT + power
    logarithm = [Fraction(1, j + 1) for j in range(terms)]  # -ln(1 - z)/z
    inverse = [Fraction(1)]
    for k in range(1, terms):
        inverse.append(-sum((logarithm[k - j] * inverse[j] for j in range(k)), Fraction(0)))
    return inverse if power == VELOCITY else _product(inverse, inverse)


def _product(first: Sequence[Any], second: Sequence[Any]) -> list[Any]:
    """Return the coefficients of the product of two power series, as many as each has."""
    return [sum(first[k - j] * second[j] for j in range(k + 1)) for k in range(len(first))]


def _of_ordinates(differences: Sequence[Any]) -> list[Any]:
    """Return the weights of accelerations, the oldest first, from those of differences.

    The difference z^0 comes first. z^j a_n is the sum over k of (-1)^k binomial(j, k) a_(n-k).
    """
    ordinates = []
    for k in range(COUNT):
        terms = (math.comb(j, k) * differences[j] for j in range(k, COUNT))
        ordinates.append((-1) ** k * sum(terms))
    return ordinates[::-1]


def _rows(power: int) -> np.ndarray:
    """Return the weights for `back` from -1 to `COUNT` - 1, one in a row."""
    return np.stack([weights_at(power, back) for back in range(-1, COUNT)])


VELOCITY_WEIGHTS = _rows(VELOCITY)
"""Weights of velocities, shape (COUNT + 1, COUNT); `row_of` says in which row those of a `back`
are."""
POSITION_WEIGHTS = _rows(POSITION)
"""Weights of positions, in the same rows."""
POSITION_POLYNOMIALS = position_polynomials()
"""Weights of positions as polynomials, for any `back`, shape (COUNT, COUNT + 2)."""


def row_of(back: int) -> np.int64:
    """Return the row of these weights; a plain number would have `weighted` compiled again."""
    return np.int64(back + 1)


@inlined
def weighted(weights, row, accelerations, end):
    """Return the sum of `COUNT` accelerations before index `end`, with a row of weights.

    It is the sum of four sums that overlap. The order of additions is fixed: left to the compiler,
    code loaded from the cache could round differently from code just compiled.
    """
    first = weights[row, COUNT - 1] * accelerations[end - 1]
    second = 0.0
    third = 0.0
    fourth = 0.0
    for k in range(0, COUNT - 1, 4):
        i = end - COUNT + k
        first += weights[row, k] * accelerations[i]
        second += weights[row, k + 1] * accelerations[i + 1]
        third += weights[row, k + 2] * accelerations[i + 2]
        fourth += weights[row, k + 3] * accelerations[i + 3]
    return (first + second) + (third + fourth)
