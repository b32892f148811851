"""A load that passes crests: uphill until it cannot pass the next one, and downhill ever after.

The motion is a sequence of parts, each with its own clock: whole turns from one equilibrium to the next, many at once
(`many_turns`) or one by one (`turns`), and between uphill and downhill the turn with the turning point. A part tells in
which of its turns the motion is, and how far past the crest of that turn.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.crest import root
from mjbeer.theory.many_turns import ABOVE, ManyTurns
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.quadrature import Clock
from mjbeer.theory.turns import FewTurns, Lap, State


@dataclass(frozen=True)
class TurningPoint:
    """The turn in which the motion turns, up to its turning point and down again.

    With x = turning point + psi^2, dt/dpsi = sqrt(2J / chord) is smooth and positive at the turning point too.
    """

    oscillator: Oscillator
    turn: float
    """The turning point's distance past the crest that was not reached [rad]."""

    @property
    def duration(self) -> float:
        """Return the time from the equilibrium through the turning point and back [s]."""
        return 2 * self._clock.duration

    def begin(self, x: float, signed_kinetic: float) -> float:
        """Return the time since the equilibrium [s] at a distance `x` [rad] past the crest.

        `signed_kinetic` is the kinetic energy with the sign of phi_dot [J].
        """
        # psi^2 = x - turn comes from the energy, because the difference may have no digits.
        psi = math.sqrt(abs(signed_kinetic) / float(self.oscillator.crest.chord(self.turn, x - self.turn)))
        return self.duration / 2 + math.copysign(self._clock.time(psi), signed_kinetic)

    def state(self, time: np.ndarray) -> State:
        """Return the state at the times `time` [s]."""
        since = time - self.duration / 2
        psi = self._clock.phase(np.abs(since))
        return np.zeros_like(psi), self.turn + psi**2, np.copysign(2 * psi / self._rate(psi), since)

    @cached_property
    def _clock(self) -> Clock:
        end = 2 * math.pi - self.oscillator.crest.well
        return Clock.over(self._rate, 0.0, math.sqrt(end - self.turn))

    def _rate(self, psi: np.ndarray) -> np.ndarray:
        """Return dt/dpsi [s]."""
        inertia = self.oscillator.inertia_past_crest(self.turn + psi**2)
        return np.sqrt(2 * inertia / self.oscillator.crest.chord(self.turn, psi**2))


ON_SEPARATRIX = "lies exactly on the separatrix: the motion takes for ever to reach the unstable equilibrium"
Part = TurningPoint | FewTurns | ManyTurns


def roll(
    oscillator: Oscillator, time: np.ndarray, past: float, signed_kinetic: float, level: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return how far phi has turned [rad], and phi_dot [rad/s], at the times `time` [s].

    The motion starts at a distance `past` [rad] past a crest, where E - V is `level` [J]; `signed_kinetic` is the
    kinetic energy with the sign of phi_dot [J]. The slope must not be negative, and if it is 0, phi_dot must not be
    negative either.

    Raises:
      NoLibrationError: if the motion comes to rest on a crest, for ever.
      ToleranceError: if sizes, masses or speeds differ by too many orders of magnitude.
    """
    latest = float(np.max(time, initial=0.0))
    turned, phi_dot = np.empty_like(time), np.empty_like(time)
    begun, ended = None, -math.inf
    for first, part in _parts(oscillator, past, signed_kinetic, level, latest):
        begun = -part.begin(past, signed_kinetic) if begun is None else ended
        now, ended = time >= ended, begun + part.duration
        now &= time < ended
        if now.any():
            turn, x, phi_dot[now] = part.state(time[now] - begun)
            turned[now] = 2 * math.pi * (first + turn) + (x - past)
        if ended > latest:
            break
    return turned, phi_dot


def _parts(
    oscillator: Oscillator, past: float, signed_kinetic: float, level: float, latest: float
) -> Iterator[tuple[float, Part]]:
    """Return the parts of the motion with the numbers of their first turns, where 0 is that of the start.

    Parts that are over at the time `latest` [s] are exact; the one that is not may be said to take for ever.
    """
    step, turn = oscillator.crest.step, 0.0
    if level > 0 and signed_kinetic < 0:
        last = math.fmod(level, step) or step  # the last crest that is passed has this level
        if level < ABOVE * step:
            few, many = round((level - last) / step) + 1, 0.0
        else:
            few = math.ceil(ABOVE - last / step)
            many = np.rint((level - last) / step) + 1 - few
            yield turn, _turns_uphill(oscillator, level, many, latest)
        yield turn - many, FewTurns(Lap(oscillator, last), last, few, uphill=True)
        turn, level = turn - many - few, last - step
    if level <= 0:
        yield turn, _turning_point(oscillator, past if signed_kinetic == 0 else None, level)
        turn, level = turn + 1, level + step
    few = math.ceil(ABOVE - level / step) if level < ABOVE * step else 0
    if few:
        yield turn, FewTurns(Lap(oscillator, level), level, few, uphill=False)
    yield turn + few, ManyTurns(Lap(oscillator, level + few * step), level + few * step, step)


def _turns_uphill(oscillator: Oscillator, level: float, many: float, latest: float) -> ManyTurns:
    """Return many turns uphill from a `level` [J] on, resolved as far as the motion comes until `latest` [s]."""
    turns = min(_most_turns(oscillator, level, latest), many - 1)
    return ManyTurns(Lap(oscillator, level - oscillator.crest.step * turns), level, -oscillator.crest.step, many)


def _most_turns(oscillator: Oscillator, level: float, latest: float) -> float:
    """Return a bound on the turns uphill from a `level` [J] on until `latest` [s]."""
    crest = oscillator.crest
    fastest = math.sqrt(2 * (level + crest.step + 2 * crest.curvature) / oscillator.base)
    return fastest * latest / (2 * math.pi) + 1


def nearest_crest(oscillator: Oscillator, signed_kinetic: float, level: float, latest: float) -> float:
    """Return by how little the motion passes or misses a crest [J]: the smallest |E - V| at a crest.

    `signed_kinetic` and `level` [J] are those of its start, as in `roll`, and `latest` is a time [s].
    """
    step = oscillator.crest.step
    if level > 0 and signed_kinetic < 0:
        lowest = level - step * _most_turns(oscillator, level, latest)
        level = lowest if lowest > step else math.fmod(level, step) - step
    return level if level > 0 else min(-level, level + step)


def _turning_point(oscillator: Oscillator, past: float | None, level: float) -> TurningPoint:
    """Return the turn in which a motion turns that misses the crest by -`level` [J], at `past` [rad] if that is known.

    Raises:
      NoLibrationError: if it misses it by nothing.
    """
    crest = oscillator.crest
    if past is None:
        if level == 0 and crest.excess == 0:
            raise NoLibrationError(ON_SEPARATRIX)
        past = root(lambda x: float(crest.below(x)) + level, 2 * math.pi - crest.well)
    return TurningPoint(oscillator, past)
