"""Where a start lies on V, in distances that keep their digits beside the crest and beside the equilibrium."""

import math
from dataclasses import dataclass

from mjbeer.theory.crest import Crest, past_pi, past_zero

EPS = 2.0**-52
ROUNDINGS = 4 * EPS
"""Relative rounding of J, and of slope over depth: up to nine roundings of half an eps each, never all of one sign."""
_LARGEST_TOP = 2000 * math.pi
"""Largest angle [rad] an eps of which puts a start at rest on the top: a thousand turns. Where doubles are farther
apart than there, 1e-12 rad, none of them is meant as the top."""


@dataclass(frozen=True)
class Place:
    """An angle, less the whole turns that bring it to the turn of a crest, from equilibrium to equilibrium."""

    past: float
    """Distance past that crest [rad], from -well to 2 pi - well."""
    from_rest: float
    """Distance past the equilibrium of the well that holds the angle [rad], from well - 2 pi to well."""

    @classmethod
    def of(cls, crest: Crest, angle: float) -> "Place":
        """Return the place of an `angle` phi [rad] of any size."""
        past, from_rest = _wrapped(past_pi(angle) - crest.offset), _wrapped(past_zero(angle) - crest.rest)
        if crest.well > 0 and abs(from_rest) < abs(past):
            return cls(_past_crest(crest, from_rest), from_rest)
        if past < -crest.well:
            past += 2 * math.pi
        return cls(past, _past_rest(crest, past))

    @classmethod
    def beside_rest(cls, crest: Crest, from_rest: float) -> "Place":
        """Return the place at a distance `from_rest` [rad] past the equilibrium, in its well."""
        return cls(past_pi(from_rest) + 2 * crest.lean, from_rest)

    def moved(self, crest: Crest, by: float) -> "Place":
        """Return the place that is `by` [rad] further downhill, maybe in the next well or turn."""
        past, from_rest = self.past + by, self.from_rest + by
        if (past < 0) != (self.past < 0):
            return Place(past, _past_rest(crest, past))
        if (from_rest < 0) != (self.from_rest < 0):
            return Place(_past_crest(crest, from_rest), from_rest)
        return Place(past, from_rest)

    def below_ahead(self, crest: Crest) -> float:
        """Return by how much V is below its value at the next crest downhill [J]."""
        past = self.past if self.past < 0 else self.from_rest - crest.well
        if abs(past) <= abs(self.past):
            return float(crest.below(past))
        return float(crest.below(self.past)) - crest.step

    def below_behind(self, crest: Crest) -> float:
        """Return by how much V is below its value at the last crest uphill [J]."""
        return float(crest.below(self.past)) + (crest.step if self.past < 0 else 0)

    def rounding(self, crest: Crest) -> float:
        """Return by how much rounding of the scene may put the crest elsewhere, and so falsify this place [rad].

        On level ground the crest is at an odd multiple of pi, and how far a double is from that is known to an eps.
        """
        steep = crest.ramp / crest.curvature if crest.curvature > 0 else 0.0
        return ROUNDINGS * (abs(crest.bottom) + crest.lean + steep) + EPS * abs(self.past)

    def on_top(self, angle: float) -> bool:
        """Return whether doubles cannot tell this place, which is that of `angle` [rad], from the crest.

        Whoever writes an odd multiple of pi means the top of level ground; it is up to 0.64 eps of itself off. The top
        of a slope is pi less an angle, and in doubles up to an eps of pi off.
        """
        nearest = min(abs(self.past), abs(2 * math.pi - self.past))
        return nearest <= EPS * min(max(abs(angle), math.pi), _LARGEST_TOP)


def _past_crest(crest: Crest, from_rest: float) -> float:
    """Return the distance past the crest of its turn [rad] of a place by that from the equilibrium of its well."""
    return from_rest - crest.well if from_rest >= 0 else from_rest + (2 * math.pi - crest.well)


def _past_rest(crest: Crest, past: float) -> float:
    """Return the distance past the equilibrium of its well [rad] of a place by that from the crest of its turn."""
    return past + crest.well if past < 0 else past - (2 * math.pi - crest.well)


def _wrapped(angle: float) -> float:
    """Return `angle` [rad] less the whole turns that bring it between -pi and pi."""
    return angle if abs(angle) <= math.pi else math.remainder(angle, 2 * math.pi)
