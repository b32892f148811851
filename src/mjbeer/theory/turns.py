"""Whole turns of a load that passes every crest, each with an energy that is one step higher or lower than the last.

A turn leads from one equilibrium to the next, x past the crest between them, and its level is E - V at the crest. So

    dt/dx = sqrt(J / 2(level + below(x))).

J and `below` are the same in every turn, so that the nodes x of one quadrature, a `Lap`, serve all turns. The crest is
at x = 0, where doubles are dense: a load that hardly passes it spends its time there.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.quadrature import Clock, Panels, resolve

State = tuple[np.ndarray, np.ndarray, np.ndarray]
"""At some times: the turn, less the first one; x [rad] past its crest; and phi_dot [rad/s]."""


@dataclass(frozen=True)
class Lap:
    """The nodes of one turn, which serve all levels from a lowest one on."""

    oscillator: Oscillator
    lowest: float
    """The lowest level [J] that they resolve."""

    @cached_property
    def panels(self) -> Panels:
        """Return panels of x that resolve the turn."""
        begins, crest = self.oscillator.crest.turn_begins, self.oscillator.crest
        edges = sorted({begins, 0.0, begins + 2 * math.pi})
        return resolve(lambda x: self._mass(x) / np.sqrt(self.lowest + crest.below(x)), *edges)

    @cached_property
    def below(self) -> np.ndarray:
        """Return how far V is below the crest at the nodes [J]."""
        return self.oscillator.crest.below(self.panels.nodes)

    @cached_property
    def mass(self) -> np.ndarray:
        """Return sqrt(J/2) at the nodes."""
        return self._mass(self.panels.nodes)

    def rates(self, levels: np.ndarray) -> np.ndarray:
        """Return dt/dx [s/rad] at the nodes, of shape (levels, panels, nodes)."""
        return self.mass / np.sqrt(levels[:, None, None] + self.below)

    def speed(self, x: np.ndarray, levels: np.ndarray) -> np.ndarray:
        """Return |phi_dot| [rad/s] at a distance `x` [rad] past the crest, for each of the `levels` [J]."""
        return np.sqrt(levels + self.oscillator.crest.below(x)) / self._mass(x)

    def _mass(self, x: np.ndarray) -> np.ndarray:
        return np.sqrt(self.oscillator.inertia_past_crest(x) / 2)


class FewTurns:
    """Some turns, one by one: downhill from the lowest level up, or uphill, which is the same backwards."""

    def __init__(self, lap: Lap, lowest: float, count: int, uphill: bool) -> None:
        """Set up `count` turns, at the level `lowest` [J] and above it."""
        self._lap, self._uphill = lap, uphill
        self._levels = lowest + lap.oscillator.crest.step * np.arange(count)
        panels = lap.panels
        self._size = len(panels.lows)
        repeated = Panels(np.tile(panels.lows, count), np.tile(panels.halves, count))
        self._clock = Clock(repeated, lap.rates(self._levels).reshape(len(repeated.lows), -1))

    @property
    def duration(self) -> float:
        """Return the time of all turns [s]."""
        return self._clock.duration

    def begin(self, x: float, _: float) -> float:
        """Return the time [s] at which the motion is in the first turn at `x` [rad] past its crest."""
        turn = len(self._levels) - 1 if self._uphill else 0
        since = self._clock.time(x, panel=turn * self._size + self._lap.panels.index(x))
        return self.duration - since if self._uphill else since

    def state(self, time: np.ndarray) -> State:
        """Return the state at the times `time` [s]."""
        time = self.duration - time if self._uphill else time
        level, x = self._clock.panel(time) // self._size, self._clock.phase(time)
        speed = self._lap.speed(x, self._levels[level])
        return (level - len(self._levels) + 1, x, -speed) if self._uphill else (level, x, speed)
