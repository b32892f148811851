"""The start of a motion: where it is on V and how fast it is, which decides whether it swings or passes crests."""

import math
from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.libration import libration_through
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.place import ROUNDINGS, Place
from mjbeer.theory.roll_down import Passage, roll
from mjbeer.theory.turning_point import ON_SEPARATRIX


@dataclass(frozen=True)
class Start:
    """A start on a slope that is not negative; if the slope is 0, phi_dot is not negative either."""

    oscillator: Oscillator
    place: Place
    phi_dot: float
    """Rate of phi [rad/s]."""
    kinetic: float
    """Kinetic energy [J]."""

    @classmethod
    def at(cls, oscillator: Oscillator, phi: float, phi_dot: float) -> "Start":
        """Return the start at `phi` [rad], of any size, with `phi_dot` [rad/s]."""
        # The kinetic energy is that at phi itself: where J has a narrow minimum, rounding of the place would change it.
        kinetic = float(oscillator.inertia(phi)) * phi_dot**2 / 2
        return cls(oscillator, Place.of(oscillator.crest, phi), phi_dot, kinetic)

    @classmethod
    def beside_rest(cls, oscillator: Oscillator, from_rest: float) -> "Start":
        """Return the start at rest `from_rest` [rad] past the equilibrium."""
        return cls(oscillator, Place.beside_rest(oscillator.crest, from_rest), phi_dot=0.0, kinetic=0.0)

    @property
    def signed_kinetic(self) -> float:
        """Return the kinetic energy, with the sign of phi_dot [J]."""
        return math.copysign(self.kinetic, self.phi_dot)

    @property
    def level_ahead(self) -> float:
        """Return E - V at the next crest downhill [J]."""
        return self.kinetic - self.place.below_ahead(self.oscillator.crest)

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a crest."""
        return self.oscillator.crest.well > 0 and self.level_ahead <= 0

    def move(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how far phi has turned [rad], and phi_dot [rad/s], at the times `time` [s].

        Raises:
          NoLibrationError: if the motion comes to rest on a crest, for ever.
          ToleranceError: if sizes, masses or speeds differ by too many orders of magnitude.
        """
        if not self.swings:
            return roll(self.oscillator, time, self._passage)
        if self.level_ahead == 0:
            raise NoLibrationError(ON_SEPARATRIX)
        libration = libration_through(self.oscillator, self.place, self.kinetic)
        if libration is None:
            return self._sway(time)
        from_rest, phi_dot = libration.state(time + libration.begin(self.place, self.signed_kinetic))
        return from_rest - self.place.from_rest, phi_dot

    def rounded(self, sign: int) -> "Start":
        """Return this start, changed by the rounding of all it rests on.

        The change brings the motion nearer to passing the crest if `sign` is 1, and away from that if it is -1.
        """
        crest, depth = self.oscillator.crest, self.oscillator.depth
        slope = self.oscillator.slope * (1 + sign * ROUNDINGS)
        slope = min(slope, math.nextafter(depth, 0)) if crest.well > 0 else max(slope, depth)
        towards = -math.copysign(self.place.rounding(crest), self.place.past)
        return replace(
            self,
            oscillator=replace(self.oscillator, slope=slope),
            place=self.place.moved(crest, sign * towards),
            kinetic=self.kinetic * (1 + sign * ROUNDINGS),
        )

    def nearest_crest(self, latest: float) -> float:
        """Return by how little the motion passes or misses a crest until the time `latest` [s], as an energy [J]."""
        if self.swings:
            return -self.level_ahead
        return self._passage.nearest_crest(self.oscillator, latest)

    @property
    def _passage(self) -> Passage:
        return Passage.of(self.oscillator.crest, self.place, self.signed_kinetic)

    def _sway(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the motion of a swing so small that it is harmonic, like `move`."""
        omega, from_rest = self.oscillator.frequency(), self.place.from_rest
        cos, sin = np.cos(omega * time), np.sin(omega * time)
        turned = from_rest * (cos - 1) + self.phi_dot / omega * sin
        return turned, self.phi_dot * cos - from_rest * omega * sin
