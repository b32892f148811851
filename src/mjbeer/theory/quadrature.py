"""Time along a path by quadrature, and the inverse: where the motion is at a time.

A path is given by the positive, smooth function dt/dpsi of a phase psi that grows along it. It is cut into panels on
which a Chebyshev series of fixed degree reproduces it to rounding; the series are integrated exactly and inverted by
Newton's method. (L. N. Trefethen, Approximation Theory and Approximation Practice, chapters 3 and 19.)
"""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from mjbeer.exceptions import ToleranceError

_NODES = chebyshev.chebpts1(25)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, 24)).T
_TO_INTEGRAL = chebyshev.chebint(np.eye(25), lbnd=-1).T


class TravelTime:
    """The time t(psi) along a path from its beginning, and its inverse psi(t)."""

    def __init__(self, rate: Callable[[np.ndarray], np.ndarray], *edges: float) -> None:
        """Set up a path with dt/dpsi = `rate` [s] from the first to the last of the `edges`.

        For psi of shape (panels, nodes) `rate` returns (panels, nodes), or (passages, panels, nodes) if the path is
        passed so often in a row, the first time with the roughest rate. A `ToleranceError` says that it is too rough.
        """
        lows, ends = np.array(edges[:-1]), np.array(edges[1:])
        panels: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        tried = 0
        while len(lows):
            halves = (ends - lows) / 2
            middles, rates = lows + halves, rate(lows[:, None] + halves[:, None] * (1 + _NODES))
            rates = rates.reshape(-1, *rates.shape[-2:])
            tried += len(lows)  # an ordinary path takes 10 panels, and one that hardly passes a barrier 100
            if tried > 5000 or not np.isfinite(rates).all() or not ((lows < middles) & (middles < ends)).all():
                raise ToleranceError(
                    "the time along this motion is beyond doubles: sizes, masses, gravity or speeds are of too many "
                    "different orders of magnitude"
                )
            done = _are_resolved(rates[0], lows, halves)
            panels.append((lows[done], halves[done], rates[:, done]))
            lows, middles, ends = lows[~done], middles[~done], ends[~done]
            lows, ends = np.concatenate([lows, middles]), np.concatenate([middles, ends])
        starts, halves, rates = (
            np.concatenate(parts, axis=-min(parts[0].ndim, 2)) for parts in zip(*panels, strict=True)
        )
        order = np.argsort(starts)
        self._size, passages = len(order), len(rates)
        self._series = rates[:, order].reshape(-1, len(_NODES)) @ _TO_SERIES
        self._lows, self._halves = np.tile(starts[order], passages), np.tile(halves[order], passages)
        self._times = np.concatenate([[0.0], np.cumsum(self._series @ _TO_INTEGRAL.sum(axis=1) * self._halves)])
        self.duration = float(self._times[-1])  # of all passages together [s]

    def time(self, psi: float, passage: int = 0) -> float:
        """Return the time [s] at which the motion is at `psi` in a `passage`, of which the first one is 0."""
        panel = max(0, int(np.searchsorted(self._lows[: self._size], psi, side="right")) - 1) + passage * self._size
        half = self._halves[panel]
        x = (psi - self._lows[panel]) / half - 1
        return float(self._times[panel] + half * chebyshev.chebval(x, self._series[panel] @ _TO_INTEGRAL))

    def phase(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return psi at the times `time` [s], and in which passage that is; beyond both ends the motion stays there."""
        panel = np.clip(np.searchsorted(self._times, time, side="right") - 1, 0, len(self._series) - 1)
        half, elapsed = self._halves[panel], time - self._times[panel]
        guess = 2 * elapsed / (self._times[panel + 1] - self._times[panel]) - 1
        x = _inverse_integral(self._series[panel], elapsed / half, guess)
        return self._lows[panel] + half * x, panel // self._size


def _are_resolved(rates: np.ndarray, lows: np.ndarray, halves: np.ndarray) -> np.ndarray:
    """Return which of the panels reproduce `rates` by a series, as far as the rounding of psi lets them."""
    coefficients = np.abs(rates @ _TO_SERIES)
    size, tail = coefficients.max(axis=1), coefficients[:, -3:].max(axis=1)
    # Noise shows as small coefficients that have stopped falling. Rounding of psi changes dt/dpsi by some eps as often
    # as the panel is narrower than psi, for panels are as wide as dt/dpsi takes to change by itself.
    stalled = tail >= 0.1 * coefficients[:, -12:-3].max(axis=1)
    noise = 16 * np.finfo(float).eps * (1 + (np.abs(lows) + halves) / halves)
    return (tail <= 3e-15 * size) | (stalled & (tail <= noise * size))


def _inverse_integral(series: np.ndarray, target: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """Return the x from 0 to 2 at which the integral of each positive series from -1 to x - 1 reaches its `target`."""
    values, integral = series.T, (series @ _TO_INTEGRAL).T
    low, high = -np.ones_like(target), np.ones_like(target)
    x = np.clip(guess, -1, 1)
    for _ in range(60):  # if only bisection helps, 53 use up the digits of a double
        excess = chebyshev.chebval(x, integral, tensor=False) - target
        low, high = np.where(excess <= 0, x, low), np.where(excess >= 0, x, high)
        newton = x - excess / chebyshev.chebval(x, values, tensor=False)
        # Newton's method leaves the bracket by rounding, or where dt/dpsi is steep: bisect there. A step of 1e-10
        # leaves an error of its square.
        converged = np.abs(newton - x) <= 1e-10
        x = np.where(converged | ((newton >= low) & (newton <= high)), newton, (low + high) / 2)
        if converged.all():
            break
    return np.clip(1 + x, 0, 2)
