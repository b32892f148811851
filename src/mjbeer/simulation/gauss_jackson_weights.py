"""The weights with which the Gauss-Jackson method adds up accelerations, in rational arithmetic.

With the backward difference z (z a_n = a_n - a_(n-1)) and a step h, the time derivative is -ln(1 - z)/h, so that the
velocity is h/(-ln(1 - z)) and the position h^2/ln(1 - z)^2 times the acceleration. Their leading terms, 1/z and 1/z^2,
are the first and the second sum of all accelerations; the rest are differences of the last ones, and so weights for
them. A factor (1 - z)^back gives the value that many steps before the last acceleration: -1 predicts the next step.

O. Montenbruck and E. Gill, Satellite Orbits, section 4.2; M. M. Berry and L. M. Healy, Implementation of Gauss-Jackson
integration for orbit propagation, J. Astronaut. Sci. 52 (2004).
"""

import math
from fractions import Fraction

import numpy as np

COUNT = 13
"""Number of accelerations that are kept: the method has differences up to the twelfth."""


def series(power: int, back: int, terms: int) -> list[Fraction]:
    """Return the first coefficients of (z/(-ln(1 - z)))^power (1 - z)^back in powers of z.

    A `power` of 1 is for velocities, one of 2 for positions.
    """
    logarithm = [Fraction(1, j + 1) for j in range(terms)]  # -ln(1 - z)/z
    inverse = [Fraction(1)]
    for k in range(1, terms):
        inverse.append(-sum((logarithm[k - j] * inverse[j] for j in range(k)), Fraction(0)))
    product = shift(back, terms)
    for _ in range(power):
        product = [sum((product[j] * inverse[k - j] for j in range(k + 1)), Fraction(0)) for k in range(terms)]
    return product


def shift(back: int, terms: int) -> list[Fraction]:
    """Return the first coefficients of (1 - z)^back in powers of z."""
    coefficients = [Fraction(1)]
    for j in range(1, terms):
        coefficients.append(coefficients[-1] * (j - 1 - back) / j)
    return coefficients


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
