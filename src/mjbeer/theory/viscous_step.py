"""One step of a damped motion: Newton's method for all stages of a collocation at once, and what rounding does."""

from dataclasses import dataclass

import numpy as np

from mjbeer.theory.collocation import INTEGRALS, MATRIX, STAGES, WEIGHTS, series
from mjbeer.theory.viscous_equations import ViscousEquations

_ITERATIONS = 12
_QUADRATIC = 1e-9
"""Relative size of a correction after which one more leaves only rounding, as each squares the error."""
_TINY = np.finfo(float).tiny
_EYE = np.eye(STAGES)
_UNIT = np.eye(3)


@dataclass(frozen=True)
class State:
    """Where a damped motion is, in numbers that keep their digits."""

    phi: float
    """phi less whole turns [rad]."""
    phi_dot: float
    """Rate of phi [rad/s]."""
    slip: float
    """Slip rate w [rad/s]."""


@dataclass(frozen=True)
class Step:
    """A step that satisfies the equations at all of its stages."""

    length: float
    """Duration [s]."""
    stages: np.ndarray
    """phi_dot and w [rad/s] at the stages, of shape (2, stages)."""
    series: np.ndarray
    """phi_dot and w as sums of Legendre polynomials over the step, of shape (stages + 1, 2)."""
    ends: np.ndarray
    """The increases of phi, phi_dot, w and roll over the step."""
    slopes: np.ndarray
    """Derivatives of phi_ddot and w_dot by phi, phi_dot and w at the stages, of shape (2, 3, stages)."""
    matrix: np.ndarray
    """The last of Newton's matrices, with its rows and columns scaled."""
    rows: np.ndarray
    """The scales of its rows."""
    columns: np.ndarray
    """The scales of its columns."""

    def transfer(self) -> np.ndarray:
        """Return the derivatives of phi, phi_dot, w and roll at the end by those at the start, of shape (4, 4)."""
        s, h = STAGES, self.length
        given = np.zeros((2 * s, 3))
        given[:s, 0], given[s:, 0] = h * MATRIX @ self.slopes[0, 0], h * MATRIX @ self.slopes[1, 0]
        given[:s, 1], given[s:, 2] = 1, 1
        by_start = np.linalg.solve(self.matrix, self.rows * given) * self.columns
        result = np.zeros((4, 4))
        result[0, :3] = _UNIT[0] + h * WEIGHTS @ by_start[:s]
        result[1, :3], result[2, :3] = by_start[s - 1], by_start[2 * s - 1]
        result[3, :3] = h * WEIGHTS @ (by_start[:s] + by_start[s:])
        result[3, 3] = 1
        return result

    def angles(self) -> np.ndarray:
        """Return how far phi and roll have turned [rad] as sums of Legendre polynomials, (stages + 1, 2)."""
        turned = INTEGRALS @ self.stages[0]
        return self.length * np.stack([turned, turned + INTEGRALS @ self.stages[1]], axis=1)


def attempt(
    equations: ViscousEquations,
    start: State,
    length: float,
    sides: tuple[float, float],
    guess: np.ndarray,
    scales: np.ndarray,
) -> Step | None:
    """Return the step of so many seconds from a start; None if Newton's method does not find it.

    `guess` has phi_dot and w at the stages, `scales` the rates [rad/s] beside which their corrections are small.
    """
    s, reach = STAGES, length * MATRIX
    begin, stages, last = np.array([[start.phi_dot], [start.slip]]), guess, np.inf
    matrix, rows, columns = np.empty((2 * s, 2 * s)), np.ones((2 * s, 1)), np.ones((2 * s, 1))
    # Strong damping makes w small and its slopes large: scaled, the equations of all stages are of about one size.
    columns[s:] = scales[1] / scales[0] if scales[1] > 0 else 1.0
    for _ in range(_ITERATIONS):
        rates, slopes = equations.rates(start.phi + reach @ stages[0], stages[0], stages[1], sides)
        through_phi = (reach[np.newaxis] * slopes[:, :1]) @ reach
        matrix[:s, :s] = _EYE - reach * slopes[0, 1] - through_phi[0]
        matrix[:s, s:] = -reach * slopes[0, 2]
        matrix[s:, :s] = -reach * slopes[1, 1] - through_phi[1]
        matrix[s:, s:] = _EYE - reach * slopes[1, 2]
        with np.errstate(all="ignore"):  # what is not finite becomes a step that is not found
            matrix *= columns.T
            rows = 1 / np.abs(matrix).max(axis=1, keepdims=True)
            matrix *= rows
        missing = (begin + rates @ reach.T - stages).reshape(-1, 1)
        try:
            change = (columns * np.linalg.solve(matrix, rows * missing)).reshape(2, s)
        except np.linalg.LinAlgError:
            return None
        stages = stages + change
        sizes = np.maximum(scales, np.abs(stages).max(axis=1)) + _TINY
        size = float((np.abs(change).max(axis=1) / sizes).max())
        if not size < 1e6:
            return None
        if last < _QUADRATIC:
            return _step(equations, start, length, sides, stages, (matrix, rows, columns))
        last = size
    return None


def _step(
    equations: ViscousEquations,
    start: State,
    length: float,
    sides: tuple[float, float],
    stages: np.ndarray,
    scaled: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> Step:
    rates, slopes = equations.rates(start.phi + length * MATRIX @ stages[0], stages[0], stages[1], sides)
    turned = length * (stages @ WEIGHTS)
    ends = np.array([turned[0], length * rates[0] @ WEIGHTS, stages[1, -1] - start.slip, turned.sum()])
    return Step(
        length,
        stages,
        series(np.array([start.phi_dot, start.slip]), stages.T),
        ends,
        slopes,
        *scaled,
    )
