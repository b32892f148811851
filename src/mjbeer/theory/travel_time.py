"""The time that a motion takes along a path, and where on the path it is at a given time.

A path has a parameter psi, which grows along it. dt/dpsi, which is smooth and positive, is known.
What is wanted is the integral

    t(psi) = integral of dt/dpsi from the beginning of the path to psi,

and its inverse psi(t), both to rounding. The path is cut into panels. On each of them x runs from
-1 to 1, and dt/dpsi is a Chebyshev series in x,

    dt/dpsi = sum of c_k T_k(x),    psi = low + half (1 + x),    half = half the width of the panel.

The c_k follow from the values at 25 Chebyshev nodes by a constant matrix. A panel is halved until
the last c_k are only rounding. The series is then integrated exactly, by a second constant matrix.
To invert t(psi), the sums of the panels' times tell on which panel the motion is, and Newton's
method, guarded by bisection, finds x there. (L. N. Trefethen, Approximation Theory and
Approximation Practice, chapters 3 and 19.)
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from mjbeer.exceptions import ToleranceError

EPS = 2.0**-52
"""Distance from 1 to the next double."""

_DEGREE = 24
"""Degree of the series on a panel."""
_NODES = chebyshev.chebpts1(_DEGREE + 1)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, _DEGREE)).T
"""Values at the nodes, times this matrix, are the coefficients of the series through them."""
_TO_INTEGRAL = chebyshev.chebint(np.eye(_DEGREE + 1), lbnd=-1).T
"""Coefficients of a series, times this matrix, are those of its integral over x from -1 on."""
_MOST_PANELS = 5000
"""An ordinary path takes 10 panels, and one that hardly passes a barrier 100."""
_TAIL = slice(-3, None)
"""The last three of the 25 coefficients, which tell whether a series is resolved.

Every other one vanishes for an even or odd dt/dpsi, but never all three."""
_BEFORE_TAIL = slice(-12, -3)
"""The nine before them. The tail is noise if it has not fallen to `_FALL` of these."""
_FALL = 0.1
_RESOLVED = 3e-15
"""Largest tail of a resolved series, relative to its largest coefficient.

It is 13.5 eps, found in trials."""
_PANEL_NOISE = 16 * EPS
"""Largest tail of noise, relative to the largest coefficient, if psi had no rounding.

Found in trials."""


class Panels(NamedTuple):
    """The panels of a path, in the order of psi."""

    lows: np.ndarray
    """psi at their beginning, of shape (panels,)."""
    halves: np.ndarray
    """Half their width, of shape (panels,)."""
    values: np.ndarray
    """dt/dpsi [s] at their nodes, of shape (panels, passages, nodes)."""


class TravelTime:
    """The time t(psi) along a path from its beginning, and its inverse psi(t).

    A path may be passed several times in a row, each time with another dt/dpsi: these are its
    passages.
    """

    def __init__(self, dt_dpsi: Callable[[np.ndarray], np.ndarray], *edges: float) -> None:
        """Set up a path with `dt_dpsi` [s] from the first to the last of the `edges`.

        Panels begin and end at all edges. For psi of shape (panels, nodes) it returns (panels,
        nodes), or (passages, panels, nodes) if there are several passages; the first of them has
        the roughest of them.

        Raises:
          ToleranceError: if dt/dpsi is too rough, or no number.
        """
        panels = _resolve(dt_dpsi, edges)
        passages = panels.values.shape[1]
        self._count = len(panels.lows)
        # From here on a panel has a row for each passage, in the order of time.
        self._lows = np.tile(panels.lows, passages)
        self._halves = np.tile(panels.halves, passages)
        self._series = panels.values.swapaxes(0, 1).reshape(-1, len(_NODES)) @ _TO_SERIES
        # At the end of a panel, x = 1 and each T_k is 1: a series is the sum of its coefficients.
        durations = self._series @ _TO_INTEGRAL.sum(axis=1) * self._halves
        self._starts = np.concatenate([[0.0], np.cumsum(durations)])  # the last is the path's end
        self.duration = float(self._starts[-1])  # of all passages together [s]

    def time_at(self, psi: float, passage: int = 0) -> float:
        """Return the time [s] at which the motion is at `psi` in a `passage`; the first is 0."""
        panel = int(np.searchsorted(self._lows[: self._count], psi, side="right")) - 1
        row = max(0, panel) + passage * self._count
        half = self._halves[row]
        x = (psi - self._lows[row]) / half - 1
        integral = self._series[row] @ _TO_INTEGRAL
        return float(self._starts[row] + half * chebyshev.chebval(x, integral))

    def psi_at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return psi at times [s], and in which passage that is; the motion stays at either end."""
        row = np.searchsorted(self._starts, time, side="right") - 1
        row = np.clip(row, 0, len(self._series) - 1)
        half = self._halves[row]
        since = time - self._starts[row]
        duration = self._starts[row + 1] - self._starts[row]
        # If dt/dpsi were constant, x would be this:
        guess = np.clip(2 * since / duration - 1, -1, 1)
        x = _invert(self._series[row], since / half, guess)
        return self._lows[row] + half * np.clip(1 + x, 0, 2), row // self._count


def _resolve(dt_dpsi: Callable[[np.ndarray], np.ndarray], edges: tuple[float, ...]) -> Panels:
    """Return panels on which series reproduce dt/dpsi, each as wide as that allows."""
    finished: list[Panels] = []
    tried = 0
    lows = np.array(edges[:-1])
    ends = np.array(edges[1:])
    while len(lows):
        halves = (ends - lows) / 2
        middles = lows + halves
        values = dt_dpsi(lows[:, None] + halves[:, None] * (1 + _NODES))
        values = values.reshape(-1, *values.shape[-2:]).swapaxes(0, 1)  # (panels, passages, nodes)
        tried += len(lows)
        can_be_halved = (lows < middles) & (middles < ends)
        if tried > _MOST_PANELS or not np.isfinite(values).all() or not can_be_halved.all():
            raise ToleranceError(
                "the time along this motion is beyond doubles: sizes, masses, gravity or speeds "
                "are of too many different orders of magnitude"
            )
        done = _are_resolved(values[:, 0], lows, halves)
        finished.append(Panels(lows[done], halves[done], values[done]))
        # The others are halved: first come all lower halves, then all upper ones.
        rest = ~done
        ends = np.concatenate([middles[rest], ends[rest]])
        lows = np.concatenate([lows[rest], middles[rest]])
    lows, halves, values = (np.concatenate(parts) for parts in zip(*finished, strict=True))
    order = np.argsort(lows)
    return Panels(lows[order], halves[order], values[order])


def _are_resolved(values: np.ndarray, lows: np.ndarray, halves: np.ndarray) -> np.ndarray:
    """Return which panels reproduce `values` by a series, as well as rounding of psi lets them."""
    coefficients = np.abs(values @ _TO_SERIES)
    size = coefficients.max(axis=1)
    tail = coefficients[:, _TAIL].max(axis=1)
    # Noise shows as small coefficients that have stopped falling. Panels are so wide that dt/dpsi
    # changes by about itself on one of them. Rounding moves psi by eps psi, which is the share
    # eps psi / half of a panel, and changes dt/dpsi by about that share of itself.
    has_stalled = tail >= _FALL * coefficients[:, _BEFORE_TAIL].max(axis=1)
    noise = _PANEL_NOISE * (1 + (np.abs(lows) + halves) / halves)
    return (tail <= _RESOLVED * size) | (has_stalled & (tail <= noise * size))


def _invert(series: np.ndarray, target: np.ndarray, guess: np.ndarray) -> np.ndarray:
    """Return the x up to which the integral of each series, from -1 on, is its `target`.

    A row of `series` has the coefficients of one of them. The integral grows with x, so that it has
    one solution, which Newton's method approaches from the `guess`. The brackets `low` and `high`
    hold it; where Newton's method leaves them, because dt/dpsi is steep or by rounding, they are
    bisected instead.
    """
    slopes = series.T
    integrals = (series @ _TO_INTEGRAL).T
    x = guess
    low = -np.ones_like(x)
    high = np.ones_like(x)
    for _ in range(60):  # if only bisection helps, 53 use up the digits of a double
        excess = chebyshev.chebval(x, integrals, tensor=False) - target
        low = np.where(excess <= 0, x, low)
        high = np.where(excess >= 0, x, high)
        newton = x - excess / chebyshev.chebval(x, slopes, tensor=False)
        has_converged = np.abs(newton - x) <= 1e-10  # the error that is left is about its square
        is_inside = (newton >= low) & (newton <= high)
        x = np.where(has_converged | is_inside, newton, (low + high) / 2)
        if has_converged.all():
            break
    return x
