"""The turn in which a motion uphill turns, between a crest that it cannot pass and the next one downhill."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.crest import root
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.quadrature import Clock
from mjbeer.theory.turns import State

ON_SEPARATRIX = "lies exactly on the separatrix: the motion takes for ever to reach the unstable equilibrium"
_BESIDE = 0.1
"""Distance from a turning point below which the energy tells more of it than the angle, over the angle."""


@dataclass(frozen=True)
class TurningPoint:
    """The turn in which the motion turns, up to its turning point and down again.

    With x = turning point + psi^2, dt/dpsi = sqrt(2J / chord) is smooth and positive at the turning point too.
    """

    oscillator: Oscillator
    turn: float
    """The turning point's distance past the crest [rad]."""

    @property
    def duration(self) -> float:
        """Return the time from the end of the turn to the turning point and back [s]."""
        return 2 * self._clock.duration

    def begin(self, x: float, signed_kinetic: float) -> float:
        """Return the time since the end of the turn [s] at a distance `x` [rad] past the crest.

        `signed_kinetic` is the kinetic energy with the sign of phi_dot [J].
        """
        length = x - self.turn
        if length < _BESIDE * abs(self.turn):  # the difference has lost digits, and the energy has not
            length = abs(signed_kinetic) / float(self.oscillator.crest.chord(self.turn, length))
        return self.duration / 2 + math.copysign(self._clock.time(math.sqrt(length)), signed_kinetic)

    def state(self, time: np.ndarray) -> State:
        """Return the state at the times `time` [s] since then."""
        since = time - self.duration / 2
        psi = self._clock.phase(np.abs(since))
        return np.zeros_like(psi), self.turn + psi**2, np.copysign(2 * psi / self._rate(psi), since)

    @cached_property
    def _clock(self) -> Clock:
        end = self.oscillator.crest.turn_begins + 2 * math.pi
        return Clock.over(self._rate, 0.0, math.sqrt(end - self.turn))

    def _rate(self, psi: np.ndarray) -> np.ndarray:
        """Return dt/dpsi [s]."""
        inertia = self.oscillator.inertia_past_crest(self.turn + psi**2)
        return np.sqrt(2 * inertia / self.oscillator.crest.chord(self.turn, psi**2))


def turning_point(oscillator: Oscillator, level: float) -> TurningPoint:
    """Return the turn in which a motion turns with E - V = `level` [J] at the crest.

    Raises:
      NoLibrationError: if it comes to rest on the crest.
    """
    crest = oscillator.crest
    if level == 0 and crest.excess == 0:
        raise NoLibrationError(ON_SEPARATRIX)
    # A load that passes the crest uphill turns behind it, because the well there is shallow.
    lower, upper = (-math.pi, -crest.well) if level > 0 else (0.0, 2 * math.pi + crest.turn_begins)
    return TurningPoint(oscillator, root(lambda x: float(crest.below(x)) + level, lower, upper))
