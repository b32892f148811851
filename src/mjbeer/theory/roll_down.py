"""A load that passes crests: uphill until it cannot pass the next one, and downhill ever after.

The motion is a sequence of parts, each with its own clock: whole turns, many at once (`many_turns`) or one by one
(`turns`), and between uphill and downhill the turn with the turning point. A part tells in which of its turns the
motion is, and how far past the crest of that turn.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.crest import Crest
from mjbeer.theory.many_turns import ABOVE, ManyTurns
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.place import Place
from mjbeer.theory.turning_point import TurningPoint, turning_point
from mjbeer.theory.turns import FewTurns, Lap

Part = TurningPoint | FewTurns | ManyTurns


@dataclass(frozen=True)
class Passage:
    """The start of a motion that passes crests, in the turn of one of them."""

    past: float
    """Distance past that crest [rad]."""
    signed_kinetic: float
    """Kinetic energy, with the sign of phi_dot [J]."""
    level: float
    """E - V at that crest [J]."""
    level_ahead: float
    """E - V at the next crest downhill [J]."""

    @classmethod
    def of(cls, crest: Crest, place: Place, signed_kinetic: float) -> "Passage":
        """Return the start at a `place` with so much kinetic energy [J], with the sign of phi_dot."""
        kinetic = abs(signed_kinetic)
        if not crest.shallow:
            level, level_ahead = kinetic - float(crest.below(place.past)), kinetic - place.below_ahead(crest)
            return cls(place.past, signed_kinetic, level, level_ahead)
        past = place.past if place.past <= math.pi else place.from_rest - crest.well  # from the nearest crest
        level = kinetic - float(crest.below(past))
        if past < 0 and level > crest.rise:
            past, level = past + 2 * math.pi, level - crest.step
        return cls(past, signed_kinetic, level, level + crest.step)

    def nearest_crest(self, oscillator: Oscillator, latest: float) -> float:
        """Return by how little the motion passes or misses a crest until the time `latest` [s], as an energy [J]."""
        step = oscillator.crest.step
        if self.level > oscillator.crest.rise and self.signed_kinetic < 0:
            lowest = self.level - step * _most_turns(oscillator, self.level, latest)
            last = math.fmod(self.level, step)
            return lowest if lowest > step else min(last, step - last)
        return self.level if self.level > 0 else min(-self.level, self.level_ahead)


def roll(oscillator: Oscillator, time: np.ndarray, start: Passage) -> tuple[np.ndarray, np.ndarray]:
    """Return how far phi has turned since the `start` [rad], and phi_dot [rad/s], at the times `time` [s].

    The slope must not be negative, and if it is 0, phi_dot must not be negative either.

    Raises:
      NoLibrationError: if the motion comes to rest on a crest, for ever.
      ToleranceError: if sizes, masses or speeds differ by too many orders of magnitude.
    """
    latest = float(np.max(time, initial=0.0))
    turned, phi_dot = np.empty_like(time), np.empty_like(time)
    begun, ended = None, -math.inf
    for first, part in _parts(oscillator, start, latest):
        begun = -part.begin(start.past, start.signed_kinetic) if begun is None else ended
        now, ended = time >= ended, begun + part.duration
        now &= time < ended
        if now.any():
            turn, x, phi_dot[now] = part.state(time[now] - begun)
            turned[now] = 2 * math.pi * (first + turn) + (x - start.past)
        if ended > latest:
            break
    return turned, phi_dot


def _parts(oscillator: Oscillator, start: Passage, latest: float) -> Iterator[tuple[float, Part]]:
    """Return the parts of the motion with the numbers of their first turns, where 0 is that of the start.

    Parts that are over at the time `latest` [s] are exact; the one that is not may be said to take for ever.
    """
    step, rise = oscillator.crest.step, oscillator.crest.rise
    turn, level, level_ahead = 0.0, start.level, start.level_ahead
    if level > rise and start.signed_kinetic < 0:
        spare = level - rise
        last = math.fmod(spare, step) or step  # what is left in the last turn before the one with the turning point
        lowest = last + rise
        if level < ABOVE * step:
            few = round((spare - last) / step) + 1
        else:
            few = math.ceil(ABOVE - lowest / step)
            many = np.rint((spare - last) / step) + 1 - few
            yield turn, _turns_uphill(oscillator, level, many, latest)
            turn -= many
        yield turn, FewTurns(Lap(oscillator, lowest), lowest, few, uphill=True)
        turn, level, level_ahead = turn - few, lowest - step, lowest
    if level <= rise:
        at_rest = start.signed_kinetic == 0
        yield turn, TurningPoint(oscillator, start.past) if at_rest else turning_point(oscillator, level)
        turn, level = turn + 1, level_ahead
    few = math.ceil(ABOVE - level / step) if level < ABOVE * step else 0
    if few:
        yield turn, FewTurns(Lap(oscillator, level), level, few, uphill=False)
    yield turn + few, ManyTurns(Lap(oscillator, level + few * step), level + few * step, step)


def _turns_uphill(oscillator: Oscillator, level: float, many: float, latest: float) -> ManyTurns:
    """Return many turns uphill from a `level` [J] on, resolved as far as the motion comes until `latest` [s]."""
    step, most = oscillator.crest.step, _most_turns(oscillator, level, latest)
    lowest = max(level - step * min(most, many), (ABOVE - 1) * step)  # the level after the last of them
    return ManyTurns(Lap(oscillator, lowest), level, -step, count=many if many <= most else math.inf)


def _most_turns(oscillator: Oscillator, level: float, latest: float) -> float:
    """Return a bound on the turns uphill from a `level` [J] on until `latest` [s]."""
    crest = oscillator.crest
    fastest = math.sqrt(2 * (level + crest.step + 2 * crest.curvature) / oscillator.base)
    return fastest * latest / (2 * math.pi) + 1
