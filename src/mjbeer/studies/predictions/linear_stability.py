"""The linear theory of integrators: for which timesteps a small motion stays bounded, and for which accurate.

An integrator turns linear equations q'' = -k q - b q' into x_{n+1} = G x_n for x = (q, h q'), with a matrix G of
K = k h^2 and B = b h alone. A motion is bounded if no eigenvalue of G lies outside the unit circle. For a Runge-Kutta
method G = R(h L), where R is the polynomial of its tableau and L the matrix of the equations as x' = L x (E. Hairer,
G. Wanner, Solving Ordinary Differential Equations II, section IV.2). MuJoCo's "Euler", "implicit", "implicitfast" and
"discrete" are all the same semi-implicit Euler for forces like gravity, whose stiffness none of them treats
implicitly.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import DOP853
from scipy.optimize import brentq

RUNGE_KUTTA = ("RK4", "DOP853")
"""The integrators that are Runge-Kutta methods; MuJoCo's others are semi-implicit Euler. GaussJackson is a
multistep method, and nothing here is about it."""
PERIODS = 200
"""Number of periods over which a stable swing must stay bounded."""
GROWTH = 100.0
"""Largest factor by which a bounded swing may grow over `PERIODS`. Half a per cent below the limit of semi-implicit
Euler a swing grows to 10 times its size, half a per cent above it to far more than this."""
ACCURATE_PERIODS = 10
"""Number of periods over which an accurate swing must stay accurate."""
ACCURACY = 1e-2
"""Largest error of an accurate swing: a distance in the plane of (phi, phi_dot/omega), over the amplitude."""
_CLASSICAL = np.array([[0, 0, 0, 0], [1 / 2, 0, 0, 0], [0, 1 / 2, 0, 0], [0, 0, 1, 0]]), np.array([1, 2, 2, 1]) / 6
_TABLEAUS = {"RK4": _CLASSICAL, "DOP853": (np.asarray(DOP853.A[:12, :12]), np.asarray(DOP853.B))}
_RATIO = 1.02
"""Ratio of two successive values in the search for the first one that fails."""


def polynomial(integrator: str) -> np.ndarray:
    """Return the coefficients of R(z) = 1 + sum_j z^j b A^(j-1) 1 of a Runge-Kutta method, the constant first."""
    stages, weights = _TABLEAUS[integrator]
    powers, coefficients = np.ones(len(weights)), [1.0]
    for _ in weights:
        coefficients.append(float(weights @ powers))
        powers = stages @ powers
    return np.array(coefficients)


def amplification(integrator: str, stiffness: ArrayLike, damping: ArrayLike = 0.0) -> np.ndarray:
    """Return the matrix G of one step of q'' = -k q - b q', with `stiffness` K = k h^2 and `damping` B = b h.

    K and B are numbers for one coordinate, or matrices of shape (n, n) for n coordinates; G has shape (2n, 2n).
    Semi-implicit Euler, v += h a(q, v), q += h v, has G = ((1 - K, 1 - B), (-K, 1 - B)).
    """
    k = np.atleast_2d(np.asarray(stiffness, dtype=float))
    b, one = np.broadcast_to(np.asarray(damping, dtype=float), k.shape), np.eye(len(k))
    if integrator not in RUNGE_KUTTA:
        return np.block([[one - k, one - b], [-k, one - b]])
    slopes = np.block([[np.zeros_like(k), one], [-k, -b]])
    matrix = np.zeros_like(slopes)
    for coefficient in polynomial(integrator)[::-1]:  # Horner's scheme
        matrix = slopes @ matrix + coefficient * np.eye(len(slopes))
    return matrix


def spectral_radius(matrix: np.ndarray) -> float:
    """Return the largest magnitude of an eigenvalue."""
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def motion(matrix: np.ndarray, start: np.ndarray, steps: int) -> np.ndarray:
    """Return the states G^n `start` for n = 0 to `steps`, shape (steps + 1, len(start)); not finite on overflow."""
    states, power = np.array([start], dtype=float), np.array(matrix)
    with np.errstate(over="ignore", invalid="ignore"):
        while len(states) <= steps:
            states = np.concatenate([states, states @ power.T])
            power = power @ power
    return states[: steps + 1]


def growth(integrator: str, swing: float) -> float:
    """Return the logarithm of the factor by which a swing with omega h = `swing` grows over `PERIODS` periods."""
    steps = PERIODS * 2 * math.pi / swing
    return steps * math.log(spectral_radius(amplification(integrator, swing**2)))


def error(integrator: str, swing: float) -> float:
    """Return the largest error, as in `ACCURACY`, of a swing from rest with omega h = `swing` over `ACCURATE_PERIODS`.

    For small h it is omega h/2 under semi-implicit Euler, whose ellipse in the phase plane leans, and (omega h)^4/120 a
    radian under RK4.
    """
    steps = math.floor(ACCURATE_PERIODS * 2 * math.pi / swing)
    states = motion(amplification(integrator, swing**2), np.array([1.0, 0.0]), steps)
    angles = swing * np.arange(steps + 1)
    return float(np.hypot(states[:, 0] - np.cos(angles), states[:, 1] / swing + np.sin(angles)).max())


def stable_limit(integrator: str) -> float:
    """Return the largest omega h with a bounded swing: 2 for semi-implicit Euler, 2 sqrt(2) for RK4, 5.97 for DOP853.

    For RK4 it is 0.15 % more, as an instability needs time to grow.
    """
    return first(lambda swing: growth(integrator, swing) - math.log(GROWTH), 0.05, 20.0)


def accurate_limit(integrator: str) -> float:
    """Return the largest omega h with an accurate swing."""
    return first(lambda swing: error(integrator, swing) - ACCURACY, 5e-3, stable_limit(integrator))


def first(excess: Callable[[float], float], low: float, high: float) -> float:
    """Return the smallest value from `low` to `high`, both positive, from which on `excess` is positive, or `high`.

    Raises:
      ValueError: if `excess` is positive at `low`.
    """
    if excess(low) > 0:
        raise ValueError(f"the limit is exceeded already at {low!r}")
    while low < high:
        above = low * _RATIO
        if excess(above) > 0:
            return float(brentq(lambda x: math.copysign(1, excess(x)), low, above, xtol=1e-9 * low, rtol=1e-12))
        low = above
    return high
