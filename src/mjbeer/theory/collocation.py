"""Collocation at the Radau points of a step, whose last one is the step's end: the Radau IIA method of order 2s - 1.

It is L-stable: what decays at once, however fast, takes no small steps once it is gone. Polynomials are kept as sums
of Legendre polynomials over the step, x = -1 to 1. See Hairer and Wanner, Solving
Ordinary Differential Equations II, IV.5.
"""

import numpy as np
from numpy.polynomial import legendre

STAGES = 19
"""Number of stages s. The method is of order 37, and a swing takes some five steps a period to rounding."""


def _points() -> np.ndarray:
    """Return the Radau points, the roots of P_s - P_(s-1), of which the last is 1."""
    series = np.zeros(STAGES + 1)
    series[-2:] = -1, 1
    rough = np.sort(legendre.legroots(series).real)
    points = rough - legendre.legval(rough, series) / legendre.legval(rough, legendre.legder(series))
    points[-1] = 1.0
    return points


_POINTS = _points()
FRACTIONS = (1 + _POINTS) / 2
"""Where in the step the stages are, from 0 to 1."""
COEFFICIENTS = np.linalg.inv(legendre.legvander(_POINTS, STAGES - 1))
"""The coefficients P_0 to P_(s-1) of the polynomial through the values at the stages."""
INTEGRALS = legendre.legint(COEFFICIENTS, lbnd=-1) / 2
"""The coefficients P_0 to P_s of the integral of that polynomial, from the start of a step of length 1."""
MATRIX = legendre.legvander(_POINTS, STAGES) @ INTEGRALS
"""That integral at the stages, a_ij of the method."""
WEIGHTS = INTEGRALS.sum(axis=0)
"""That integral at the end of the step, b_j of the method."""
_AT_START = (-1.0) ** np.arange(STAGES)
_VANISHING = np.zeros(STAGES + 1)
_VANISHING[-2:] = np.array([-1, 1]) * (-1) ** STAGES / 2


def series(start: np.ndarray, stages: np.ndarray) -> np.ndarray:
    """Return the coefficients P_0 to P_s of the polynomials through values at the start, (n,), and stages, (s, n)."""
    coefficients = np.zeros((STAGES + 1, stages.shape[1]))
    coefficients[:STAGES] = COEFFICIENTS @ stages
    # A multiple of P_s - P_(s-1), which vanishes at the stages, brings the polynomial to its start.
    return coefficients + np.outer(_VANISHING, start - _AT_START @ coefficients[:STAGES])
