"""The two turning points of a swing, each measured from the nearer of crest and equilibrium."""

import math
from dataclasses import dataclass

from mjbeer.theory.crest import Crest, root
from mjbeer.theory.place import Place


@dataclass(frozen=True)
class End:
    """A turning point of a swing."""

    from_rest: float
    """Distance past the equilibrium [rad]."""
    from_crest: float
    """Distance past the nearest crest [rad]: negative at the upper turning point, positive at the lower one."""

    def distance(self, place: Place) -> float:
        """Return how far a place in the same well is from here [rad]."""
        if (place.past < 0) == (self.from_crest < 0) and abs(self.from_crest) < abs(self.from_rest):
            return abs(place.past - self.from_crest)
        return abs(place.from_rest - self.from_rest)


def ends(crest: Crest, place: Place, kinetic: float) -> tuple[End, End]:
    """Return the lower and the upper turning point of the swing that passes a `place` with `kinetic` energy [J]."""
    energy = kinetic + float(crest.above(place.from_rest))
    low = high = End(place.from_rest, place.past)
    if kinetic > 0 or place.from_rest < 0:
        ahead = place.below_ahead(crest) - kinetic
        high = _end(crest, sign=1, well=crest.well, energy=energy, missing=ahead)
    if kinetic > 0 or place.from_rest > 0:
        behind = place.below_behind(crest) - kinetic
        low = _end(crest, sign=-1, well=2 * math.pi - crest.well, energy=energy, missing=behind)
    return low, high


def _end(crest: Crest, sign: int, well: float, energy: float, missing: float) -> End:
    """Return the end of a swing that has so much `energy` above the equilibrium, and misses the crest by `missing` [J].

    The crest is `well` [rad] away from the equilibrium, downhill if `sign` is 1, and uphill if it is -1. The end is
    sought from the nearer of the two. V rises from the equilibrium as it falls on this side of the crest.
    """

    def height(distance: float) -> float:
        return float(crest.above(sign * distance))

    from_rest = height(well / 2) >= energy
    wanted = energy if from_rest else missing
    scale = 2 * math.asin(math.sqrt(min(1.0, wanted / crest.curvature / 2)))  # of the order of the distance
    distance = scale * root(lambda share: height(scale * share) - wanted, 0, well / 2 / scale)
    if from_rest:
        return End(sign * distance, sign * (distance - well))
    return End(sign * (well - distance), -sign * distance)
