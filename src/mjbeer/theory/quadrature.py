"""Time along a motion by quadrature, and the inverse: where the motion is at a time.

A motion is given by the positive, smooth function dt/dpsi of a phase psi that grows
along it. The function is cut into panels on which a Chebyshev series of fixed degree
reproduces it to rounding error; the series are integrated exactly and inverted by
Newton's method. There are no timesteps, so no error accumulates but rounding.
(L. N. Trefethen, Approximation Theory and Approximation Practice, chapters 3 and 19.)
"""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

_DEGREE = 24
# The angle of cos(k (2j + 1) pi / 2n) is reduced in integers: rounding it would show in every series.
_ODD, _TURN = 2 * np.arange(_DEGREE + 1) + 1, 4 * (_DEGREE + 1)
_COSINES = np.cos(2 * np.pi * (np.outer(_ODD, np.arange(_DEGREE + 1)) % _TURN) / _TURN)
_NODES = _COSINES[:, 1]
_TO_SERIES = 2 / (_DEGREE + 1) * _COSINES
_TO_SERIES[:, 0] /= 2
_TO_INTEGRAL = np.stack([np.append(chebyshev.chebint(row, lbnd=-1), 0)[: _DEGREE + 2] for row in np.eye(_DEGREE + 1)])
_RESOLVED = 3e-15  # largest last coefficient of a resolved series, relative to its largest: a few roundings
# The rounding of an angle of up to some 1000 rad makes dt/dpsi noisier than that, most of all near a barrier, and
# the noise in a panel grows as its half-width shrinks. It shows as small coefficients that have stopped falling.
_ANGLE, _FALLING = 1e-12, 0.1
_DEEPEST = 60  # most halvings of one interval: each uses up a bit of its edges
Rate = Callable[[np.ndarray], np.ndarray]


class Clock:
    """The time t(psi) along a motion, with t(start) = 0, and its inverse psi(t)."""

    def __init__(self, rate: Rate, start: float, period: float | None = None, stretch: float = 1.0) -> None:
        """Set up the clock of a motion whose dt/dpsi is `rate`.

        `period` is the period of `rate` in psi. A motion without a period is resolved as far as it is asked for: first
        over a length `stretch` in psi, then over twice as much, and so on.
        """
        self._rate = rate
        self._start = start
        self._phase_period = period
        self._stretch = stretch
        self._edges = np.array([start])
        self._times = np.array([0.0])
        self._series = np.empty((0, _DEGREE + 1))
        if period is not None:
            self._extend(period)

    @property
    def period(self) -> float:
        """Return the time [s] that one period of the phase takes.

        Raises:
          ValueError: if the motion has no period.
        """
        if self._phase_period is None:
            raise ValueError("this motion is not periodic")
        return float(self._times[-1])

    def phase(self, time: np.ndarray) -> np.ndarray:
        """Return psi at the times `time` [s], none of them negative."""
        if self._phase_period is not None:
            turns, time = np.divmod(time, self.period)
            return self._invert(time) + turns * self._phase_period
        while self._times[-1] < np.max(time, initial=0.0):
            self._extend(self._stretch)
            self._stretch *= 2
        return self._invert(time)

    def _extend(self, length: float) -> None:
        edges, series = _panels(self._rate, self._edges[-1], self._edges[-1] + length)
        spans = np.diff(edges) / 2 * (series @ _TO_INTEGRAL).sum(axis=1)
        self._times = np.append(self._times, self._times[-1] + np.cumsum(spans))
        self._edges = np.append(self._edges, edges[1:])
        self._series = np.vstack([self._series, series])

    def _invert(self, time: np.ndarray) -> np.ndarray:
        if len(self._series) == 0:
            return np.full_like(time, self._start)
        panel = np.clip(np.searchsorted(self._times, time, side="right") - 1, 0, len(self._series) - 1)
        half = np.diff(self._edges)[panel] / 2
        target = (time - self._times[panel]) / half
        series = self._series[panel].T
        integral = (self._series @ _TO_INTEGRAL)[panel].T
        low, high = -np.ones_like(time), np.ones_like(time)
        x = np.clip(2 * target / np.diff(self._times)[panel] * half - 1, -1, 1)
        for _ in range(60):
            excess = chebyshev.chebval(x, integral, tensor=False) - target
            low, high = np.where(excess <= 0, x, low), np.where(excess >= 0, x, high)
            newton = x - excess / chebyshev.chebval(x, series, tensor=False)
            # Newton's method leaves the bracket only where dt/dpsi is steep: bisect there.
            better = np.where((newton >= low) & (newton <= high), newton, (low + high) / 2)
            converged = np.abs(better - x) <= 2e-16
            x = better
            if converged.all():
                break
        return self._edges[panel] + half * (1 + x)


def _panels(rate: Rate, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of the panels between two phases, and the Chebyshev series of `rate` on each panel."""
    lows, highs = np.array([start]), np.array([end])
    panels: list[tuple[np.ndarray, np.ndarray]] = []
    for depth in range(_DEEPEST):
        middle, half = (lows + highs) / 2, (highs - lows) / 2
        series = rate(middle[:, None] + half[:, None] * _NODES) @ _TO_SERIES
        size, tail = np.abs(series).max(axis=1), np.abs(series[:, -3:]).max(axis=1)
        stalled = tail >= _FALLING * np.abs(series[:, -12:-3]).max(axis=1)
        resolved = (tail <= _RESOLVED * size) | (stalled & (tail <= _ANGLE * (1 + 1 / half) * size))
        if depth == _DEEPEST - 1:
            resolved[:] = True
        # An interval no wider than the spacing of doubles cannot be halved.
        resolved |= (middle <= lows) | (middle >= highs)
        panels.append((lows[resolved], series[resolved]))
        lows, middle, highs = lows[~resolved], middle[~resolved], highs[~resolved]
        if not len(lows):
            break
        lows, highs = np.concatenate([lows, middle]), np.concatenate([middle, highs])
    starts = np.concatenate([panel_starts for panel_starts, _ in panels])
    order = np.argsort(starts)
    return np.append(starts[order], end), np.concatenate([panel_series for _, panel_series in panels])[order]
