"""A number of whole turns, however large, in a time that does not depend on it.

The time of n turns is a sum of (level + k step + below(x))^(-1/2) over k from 0 to n - 1, integrated over x. The
Euler-Maclaurin formula replaces that sum by its integral, and corrections that involve only its first and last terms.
(F. W. J. Olver, Asymptotics and Special Functions, chapter 8.) No term may be near 0, in steps: see `ABOVE`.
"""

import math

import numpy as np

from mjbeer.theory.quadrature import Clock
from mjbeer.theory.turns import Lap, State

ABOVE = 30
"""Least number of steps from 0 to a level. The first correction that is left out is 1e-16 of a term there, and a step
below, where turns uphill end."""
_CORRECTIONS = (1 / 24, -1 / 384, 1 / 1024, -143 / 163840)
"""B_2k / (2k)! times the derivative of order 2k - 1 of -x^(-1/2) at x = 1, for k = 1, 2, 3 and 4."""
_MOST_STEPS = 100
"""Most steps of Newton's method for the number of turns; it takes 3 to 5."""
_NEAR, _NOISE = 1e-7, 1e-14
"""A step of Newton's method this small, in turns, leaves an error of its square, below rounding. Rounding of the times
alone makes steps of the second number times the number of turns."""
_MOST_NUMBERS = 2**18
"""Most numbers in an array: samples are taken in portions, so that memory does not grow with how many there are."""


class ManyTurns:
    """Turns without end, downhill or uphill, or a number of them uphill."""

    def __init__(self, lap: Lap, first: float, step: float, count: float = math.inf) -> None:
        """Set up `count` turns, the first at the level `first` [J], and each `step` [J] above the one before it.

        If `step` is negative, the motion is uphill, and `lap` must resolve the level after the last turn. It may be
        without end if no time is asked for at which it is below the lowest level of `lap`.
        """
        self._lap, self._first, self._step, self._count = lap, first, step, count
        self._weights = (lap.panels.weights * lap.mass).ravel()
        self._turn = Clock(lap.panels, lap.rates(np.array([first]))[0])

    @property
    def duration(self) -> float:
        """Return the time of all turns [s]."""
        return float(self.elapsed(np.array([self._count]))[0]) if self._count < math.inf else math.inf

    def begin(self, x: float, _: float) -> float:
        """Return the time [s] at which the motion is in the first turn at `x` [rad] past its crest."""
        since = self._turn.time(x)
        return self._turn.duration - since if self._step < 0 else since

    def elapsed(self, turns: np.ndarray) -> np.ndarray:
        """Return the time that so many turns take [s], smooth between whole numbers."""
        below, levels = self._lap.below.ravel(), self._level(turns)[:, None]
        return _sum_of_roots(self._first + below, levels + below, self._step, turns[:, None]) @ self._weights

    def _level(self, turns: np.ndarray) -> np.ndarray:
        """Return the level after so many turns [J]."""
        # Beside more than 1e16 steps a step is below rounding, and the difference might even be negative.
        return np.maximum(self._first + self._step * turns, self._lap.lowest)

    def state(self, time: np.ndarray) -> State:
        """Return the state at the times `time` [s]."""
        portions = np.array_split(time, math.ceil(len(time) * len(self._weights) / _MOST_NUMBERS) or 1)
        states = [self._state(portion) for portion in portions]
        turn, x, phi_dot = (np.concatenate(each) for each in zip(*states, strict=True))
        return turn, x, phi_dot

    def _state(self, time: np.ndarray) -> State:
        turn, since = self._turns(time)
        levels = self._level(turn)
        different, which = np.unique(levels, return_inverse=True)
        panels, rates = self._lap.panels, self._lap.rates(different)
        ends = np.cumsum((rates * panels.weights).sum(axis=2), axis=1)
        since = np.clip(since, 0, ends[which, -1])
        if self._step < 0:
            since = ends[which, -1] - since
        panel = np.minimum((ends[which] <= since[:, None]).sum(axis=1), len(panels.lows) - 1)
        begun = np.where(panel > 0, ends[which, panel - 1], 0.0)
        x = panels.phase(panel, rates[which, panel], since - begun)
        sign = math.copysign(1.0, self._step)
        return sign * turn, x, sign * self._lap.speed(x, levels)

    def _turns(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the number of turns that are over at the times `time` [s], and the time since then [s]."""
        if self._step == 0:
            return np.divmod(time, self._turn.duration)
        # Uniform acceleration from the mean speed of the first turn on is a first estimate.
        total = self._weights.sum()
        root, reach = total / self._turn.duration, time / total
        if self._step < 0:
            reach = np.minimum(reach, -2 * root / self._step)
        turns = np.clip(reach * (root + self._step * reach / 4), 0, self._count)
        for _ in range(_MOST_STEPS):
            pace = (1 / np.sqrt(self._level(turns)[:, None] + self._lap.below.ravel())) @ self._weights
            missing = (time - self.elapsed(turns)) / pace
            turns = np.clip(turns + missing, 0, self._count)
            if (np.abs(missing) <= _NEAR + _NOISE * turns).all():
                break
        turns = np.floor(turns)
        since = time - self.elapsed(turns)
        early = since < 0  # by rounding, at the beginning of a turn
        turns = np.where(early, np.maximum(turns - 1, 0), turns)
        return turns, np.where(early, time - self.elapsed(turns), since)


def _sum_of_roots(first: np.ndarray, last: np.ndarray, step: float, count: np.ndarray) -> np.ndarray:
    """Return the sum of (first + k step)^(-1/2) over k from 0 to count - 1, where first + count step is `last`."""
    near, far = np.sqrt(first), np.sqrt(last)
    result = 2 * count / (near + far) * (1 + step / (4 * near * far))
    near_steps, far_steps = step / first, step / last
    return result + near_steps * _correction(near_steps) / near - far_steps * _correction(far_steps) / far


def _correction(steps: np.ndarray) -> np.ndarray:
    """Return the sum of the Euler-Maclaurin corrections at a level, divided by their first power."""
    square, result = steps**2, np.zeros_like(steps)
    for coefficient in reversed(_CORRECTIONS):
        result = coefficient + square * result
    return result
