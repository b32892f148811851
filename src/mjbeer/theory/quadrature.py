"""Time along a motion by quadrature, and the inverse: where the motion is at a time.

A motion is given by the positive, smooth function dt/dpsi of a phase psi that grows
along it. The function is cut into panels on which a Chebyshev series of fixed degree
reproduces it to rounding error; the series are integrated exactly and inverted by
Newton's method. There are no timesteps, so no error accumulates but rounding.
(L. N. Trefethen, Approximation Theory and Approximation Practice, chapters 3 and 19.)
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from mjbeer.exceptions import ToleranceError

_DEGREE = 24
# The angle of cos(k (2j + 1) pi / 2n) is reduced in integers: rounding it would show in every series.
_ODD, _TURN = 2 * np.arange(_DEGREE + 1) + 1, 4 * (_DEGREE + 1)
_COSINES = np.cos(2 * np.pi * (np.outer(_ODD, np.arange(_DEGREE + 1)) % _TURN) / _TURN)
_NODES = _COSINES[:, 1]
_TO_SERIES = 2 / (_DEGREE + 1) * _COSINES
_TO_SERIES[:, 0] /= 2
_TO_INTEGRAL = np.stack([np.append(chebyshev.chebint(row, lbnd=-1), 0)[: _DEGREE + 2] for row in np.eye(_DEGREE + 1)])
_WEIGHTS = _TO_SERIES @ _TO_INTEGRAL.sum(axis=1)

_RESOLVED = 3e-15
"""Largest last coefficient of a resolved series, relative to its largest: a few roundings."""
_NOISE = 16 * float(np.finfo(float).eps)
"""Relative noise of dt/dpsi in a panel as wide as psi is large. The rounding of psi changes dt/dpsi by as many times
that as the panel is narrower, for panels are as wide as dt/dpsi takes to change by itself."""
_FALLING = 0.1
"""Noise shows as small coefficients that have stopped falling: the last ones exceed this times those before."""
_MOST_PANELS = 5000
"""Most panels of one motion: an ordinary one takes 10, and one that hardly passes a barrier 100."""
_MOST_STEPS = 60
"""Most steps of Newton's method: it takes 5, and if only bisection helps, 53 use up the digits of a double."""
_QUADRATIC = 1e-10
"""A step of Newton's method this small, in half-widths of a panel, leaves an error of its square, below rounding."""
Rate = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Panels:
    """Intervals of a phase psi."""

    lows: np.ndarray
    """Where the intervals begin, of shape (panels,)."""
    halves: np.ndarray
    """Half their lengths, of the same shape."""

    @property
    def nodes(self) -> np.ndarray:
        """Return the psi at which dt/dpsi is to be known, of shape (panels, nodes)."""
        return self.lows[:, None] + self.halves[:, None] * (1 + _NODES)

    @property
    def weights(self) -> np.ndarray:
        """Return by what to multiply a function at the nodes so that the sum is its integral, of the nodes' shape."""
        return self.halves[:, None] * _WEIGHTS

    def index(self, psi: float) -> int:
        """Return the number of the interval that holds `psi`, or is nearest to it."""
        return max(0, int(np.searchsorted(self.lows, psi, side="right")) - 1)

    def phase(self, panel: np.ndarray, rates: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return psi when so much `time` [s] has been spent in each `panel`, by dt/dpsi at its nodes."""
        halves = self.halves[panel]
        return self.lows[panel] + halves * _invert(rates @ _TO_SERIES, time / halves)


def resolve(rate: Rate, *edges: float) -> Panels:
    """Return panels that cover the intervals between the `edges`, and on which a series reproduces `rate`.

    Raises:
      ToleranceError: if no panels do: `rate` is not finite, or it is rougher than the rounding of psi explains.
    """
    lows, ends = np.array(edges[:-1]), np.array(edges[1:])
    panels: list[tuple[np.ndarray, np.ndarray]] = []
    tried = 0
    while len(lows):
        trial = Panels(lows, (ends - lows) / 2)
        rates, middles = rate(trial.nodes), lows + trial.halves
        tried += len(lows)
        if tried > _MOST_PANELS or not np.isfinite(rates).all() or not ((lows < middles) & (middles < ends)).all():
            raise ToleranceError(
                "the time along this motion is beyond doubles: sizes, masses, gravity or speeds are of too many "
                "different orders of magnitude"
            )
        resolved = _resolved(rates, trial)
        panels.append((lows[resolved], trial.halves[resolved]))
        lows, middles, ends = lows[~resolved], middles[~resolved], ends[~resolved]
        lows, ends = np.concatenate([lows, middles]), np.concatenate([middles, ends])
    starts, halves = (np.concatenate(parts) for parts in zip(*panels, strict=True))
    order = np.argsort(starts)
    return Panels(starts[order], halves[order])


def _resolved(rates: np.ndarray, panels: Panels) -> np.ndarray:
    """Return which of the panels reproduce `rates` by a series, as far as the rounding of psi lets them."""
    coefficients = np.abs(rates @ _TO_SERIES)
    size, tail = coefficients.max(axis=1), coefficients[:, -3:].max(axis=1)
    stalled = tail >= _FALLING * coefficients[:, -12:-3].max(axis=1)
    noise = _NOISE * (1 + (np.abs(panels.lows) + panels.halves) / panels.halves)
    return (tail <= _RESOLVED * size) | (stalled & (tail <= noise * size))


class Clock:
    """The time t(psi) along a motion from the first panel's beginning, and its inverse psi(t).

    The panels follow each other in time. Where one ends, psi may jump to where the next begins.
    """

    def __init__(self, panels: Panels, rates: np.ndarray) -> None:
        """Set up the clock of a motion whose dt/dpsi at the nodes is `rates`, of shape (panels, nodes)."""
        self._panels, self._rates = panels, rates
        self._times = np.concatenate([[0.0], np.cumsum((panels.weights * rates).sum(axis=1))])

    @classmethod
    def over(cls, rate: Rate, *edges: float) -> "Clock":
        """Return the clock of a motion with dt/dpsi = `rate` from the first to the last of the `edges`.

        Raises:
          ToleranceError: if `rate` cannot be resolved; see `resolve`.
        """
        panels = resolve(rate, *edges)
        return cls(panels, rate(panels.nodes))

    @property
    def duration(self) -> float:
        """Return the time that the motion takes through all panels [s]."""
        return float(self._times[-1])

    def time(self, psi: float, panel: int | None = None) -> float:
        """Return the time [s] at which the motion is at `psi`, in a `panel` if its number is given."""
        panel = self._panels.index(psi) if panel is None else panel
        half = self._panels.halves[panel]
        x = (psi - self._panels.lows[panel]) / half - 1
        return float(self._times[panel] + half * chebyshev.chebval(x, self._rates[panel] @ _TO_SERIES @ _TO_INTEGRAL))

    def panel(self, time: np.ndarray) -> np.ndarray:
        """Return the numbers of the panels in which the motion is at the times `time` [s]."""
        return np.clip(np.searchsorted(self._times, time, side="right") - 1, 0, len(self._rates) - 1)

    def phase(self, time: np.ndarray) -> np.ndarray:
        """Return psi at the times `time` [s]; before the first panel and after the last it stays where it is."""
        panel = self.panel(time)
        return self._panels.phase(panel, self._rates[panel], time - self._times[panel])


def _invert(series: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Return the x from 0 to 2 at which the integral of each series from -1 to x - 1 reaches its `target`.

    `series` has the shape (samples, coefficients); each is positive from -1 to 1.
    """
    values, integral = series.T, (series @ _TO_INTEGRAL).T
    low, high = -np.ones_like(target), np.ones_like(target)
    x = np.clip(2 * target / integral.sum(axis=0) - 1, -1, 1)
    for _ in range(_MOST_STEPS):
        excess = chebyshev.chebval(x, integral, tensor=False) - target
        low, high = np.where(excess <= 0, x, low), np.where(excess >= 0, x, high)
        newton = x - excess / chebyshev.chebval(x, values, tensor=False)
        # Newton's method leaves the bracket by rounding, or where dt/dpsi is steep: bisect there.
        converged = np.abs(newton - x) <= _QUADRATIC
        x = np.where(converged | ((newton >= low) & (newton <= high)), newton, (low + high) / 2)
        if converged.all():
            break
    return np.clip(1 + x, 0, 2)
