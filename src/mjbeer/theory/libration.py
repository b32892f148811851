"""A swing between two turning points, timed from each of them: beside a separatrix that is where time is spent.

The phase psi from the upper turning point on has phi = high - 2 d sin^2(psi/2), with d half the angle between the
turning points. dt/dpsi = sqrt(J / 2D) is smooth and positive at both, where E - V = D (phi - low) (high - phi). Half a
swing up takes as long as half a swing down.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.theory.crest import sinc, sinc_gap
from mjbeer.theory.ends import End, ends
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.place import Place
from mjbeer.theory.quadrature import Clock

_HARMONIC = 1e-50
"""Amplitude [rad] up to which a swing is harmonic, to far more than rounding. Energies of less might underflow."""


@dataclass(frozen=True)
class Libration:
    """A swing between two turning points."""

    oscillator: Oscillator
    low: End
    """The turning point uphill of the equilibrium."""
    high: End
    """The turning point downhill of it, which has the larger phi."""

    @property
    def half_width(self) -> float:
        """Return d, half of the angle between the turning points [rad]."""
        return (self.high.from_rest - self.low.from_rest) / 2

    def rate(self, above_low: np.ndarray, below_high: np.ndarray) -> np.ndarray:
        """Return dt/dpsi [s] where phi is so much above the lower, and below the higher turning point [rad]."""
        low, high = self._inertia(self.low, above_low), self._inertia(self.high, -below_high)
        return np.sqrt(np.where(above_low < below_high, low, high) / 2 / self.depth(above_low, below_high))

    def depth(self, above_low: np.ndarray | float, below_high: np.ndarray | float) -> np.ndarray:
        """Return D [J/rad^2] where phi is so much above the lower, and below the higher turning point [rad]."""
        # The chord of V from an end gives an accurate D near that end; the weights q^2 (q + 3p) and p^2 (p + 3q), whose
        # sum is 1, blend the two smoothly.
        width = above_low + below_high
        p, q = above_low / width, below_high / width
        from_low = self._chord(self.low, sign=1, length=above_low) * q * (q + 3 * p)
        from_high = self._chord(self.high, sign=-1, length=below_high) * p * (p + 3 * q)
        return (from_low + from_high) / width

    def _inertia(self, end: End, further: np.ndarray) -> np.ndarray:
        """Return J [kg m^2] so much further than an end [rad]."""
        if abs(end.from_crest) < abs(end.from_rest):
            return self.oscillator.inertia_past_crest(end.from_crest + further)
        return self.oscillator.inertia(self.oscillator.crest.rest + end.from_rest + further)

    def _chord(self, end: End, sign: int, length: np.ndarray | float) -> np.ndarray:
        """Return (V(end) - V(end + sign length)) / length [N m], which is smooth through length 0."""
        crest, y = self.oscillator.crest, end.from_rest
        # -V' as a product, and V'': both keep their digits near crest and equilibrium.
        torque = 2 * self.oscillator.depth * math.sin(y / 2) * math.sin(end.from_crest / 2) * -sign
        curvature = crest.curvature * math.cos(y) - crest.ramp * math.sin(y)
        linear = sign * (torque * sinc(length) + crest.slope * sinc_gap(length))
        return linear - curvature * length / 2 * sinc(length / 2) ** 2

    @property
    def period(self) -> float:
        """Return the time of one full swing [s]."""
        return 2 * (self._from_high.duration + self._from_low.duration)

    def begin(self, place: Place, signed_kinetic: float) -> float:
        """Return the time since the upper turning point [s] at a `place`, or the negative time until then.

        `signed_kinetic` is the kinetic energy with the sign of phi_dot [J].
        """
        above_low, below_high = self.low.distance(place), self.high.distance(place)
        # d sin(psi) comes from the energy, because beside a turning point the distance from there may have no digits.
        sine = math.sqrt(abs(signed_kinetic) / float(self.depth(above_low, below_high)))
        cosine = (above_low - below_high) / 2
        if cosine >= 0:
            since = self._from_high.time(math.atan2(sine, cosine))
        else:
            since = self.period / 2 - self._from_low.time(math.atan2(sine, -cosine))
        return -since if signed_kinetic > 0 else since

    def state(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return phi less the equilibrium [rad], and phi_dot [rad/s], a `time` [s] after the upper turning point."""
        since = np.remainder(time, self.period)
        up = since > self.period / 2
        since = np.where(up, self.period - since, since)
        upper = since <= self._from_high.duration
        psi = np.empty_like(since)
        psi[upper] = self._from_high.phase(since[upper])
        psi[~upper] = self._from_low.phase(self.period / 2 - since[~upper])  # counted from the lower turning point
        near, far = self._near(psi), self._far(psi)
        from_rest = np.where(upper, self.high.from_rest - near, self.low.from_rest + near)
        speed = self.half_width * np.sin(psi) / self.rate(np.where(upper, far, near), np.where(upper, near, far))
        return from_rest, np.where(up, speed, -speed)

    @cached_property
    def _from_high(self) -> Clock:
        """Return the clock of psi from the upper turning point to halfway."""
        return Clock.over(lambda psi: self.rate(self._far(psi), self._near(psi)), 0.0, math.pi / 2)

    @cached_property
    def _from_low(self) -> Clock:
        """Return the clock of pi - psi from the lower turning point to halfway."""
        return Clock.over(lambda psi: self.rate(self._near(psi), self._far(psi)), 0.0, math.pi / 2)

    def _near(self, psi: np.ndarray) -> np.ndarray:
        """Return the distance [rad] from the turning point from which `psi` counts."""
        return 2 * self.half_width * np.sin(psi / 2) ** 2

    def _far(self, psi: np.ndarray) -> np.ndarray:
        """Return the distance [rad] from the other turning point."""
        return 2 * self.half_width * np.cos(psi / 2) ** 2


def libration_through(oscillator: Oscillator, place: Place, kinetic: float = 0.0) -> Libration | None:
    """Return the libration that passes a `place` with `kinetic` energy [J]; None if it is too small to be anharmonic.

    The energy must be below that of the crest ahead, and the slope must not be negative.
    """
    crest = oscillator.crest
    if abs(place.from_rest) <= _HARMONIC and math.sqrt(kinetic / crest.curvature) <= _HARMONIC:
        return None
    low, high = ends(crest, place, kinetic)
    return Libration(oscillator, low, high)
