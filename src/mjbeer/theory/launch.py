"""The start of a motion without damping: its place in V, its energy, and what rounding makes of it.

All is written for a ramp that makes phi grow, and on level ground for a rotation with phi_dot > 0.
Other motions are reflected when they start, in `Launch.of`, and reflected back when they are
solved.
"""

import math
from dataclasses import dataclass
from functools import cached_property

from mjbeer.theory.oscillator import Oscillator, Potential
from mjbeer.theory.travel_time import EPS

ROUNDINGS = 4 * EPS
"""Relative error of J and of ramp / depth: up to nine roundings, but never all of one sign."""
_STILL = 1e-30
"""Largest distance from the equilibrium, and amplitude of a swing about it, that are rest [rad].

It is far below the rounding of any angle, and far above where the squares of angles underflow."""


@dataclass(frozen=True)
class Launch:
    """The start of a motion, after the reflection.

    A turn has a crest in its middle. A well lies between two crests and has a rest, the
    equilibrium; where the ramp exceeds the depth, there is none. The angles past crest and rest
    keep their digits beside them, and so do the energies.
    """

    oscillator: Oscillator
    """The reflected one where `direction` is -1."""
    direction: int
    """1, or -1 if phi and phi_dot have the opposite sign here."""
    phi: float
    """[rad]"""
    phi_dot: float
    """[rad/s]"""
    kinetic: float
    """Kinetic energy [J]."""
    past_crest: float
    """How far phi is past the crest of its turn [rad]."""
    past_rest: float
    """How far phi is past the rest of its well [rad]."""

    @classmethod
    def of(cls, oscillator: Oscillator, phi: float, phi_dot: float) -> "Launch":
        """Return the start at `phi` [rad] with `phi_dot` [rad/s], reflected if need be."""
        direction = 1
        if oscillator.ramp < 0 or (oscillator.ramp == 0 and phi_dot < 0):
            oscillator = oscillator.mirrored
            direction = -1
        phi *= direction
        phi_dot *= direction
        # J is taken at phi itself: where it has a narrow minimum, rounding of the other two angles
        # would change it.
        kinetic = float(oscillator.kinetic_energy(phi, phi_dot))
        distances = oscillator.potential.distances(phi)
        return cls(oscillator, direction, phi, phi_dot, kinetic, *distances)

    @property
    def potential(self) -> Potential:
        """Return the shape of V."""
        return self.oscillator.potential

    @cached_property
    def energy_above_crest(self) -> float:
        """Return E - V at the crest of the turn [J]."""
        return self.kinetic - float(self.potential.below(self.past_crest))

    @cached_property
    def energy_above_next_crest(self) -> float:
        """Return E - V at the next crest downhill [J]; this may be the crest of the turn."""
        if self.past_crest < 0:
            return self.energy_above_crest
        past_next_crest = self.past_rest - self.potential.well
        # V is compared with that at the nearer crest, where the difference keeps its digits.
        if abs(past_next_crest) <= self.past_crest:
            return self.kinetic - float(self.potential.below(past_next_crest))
        return self.energy_above_crest + self.potential.drop_per_turn

    @property
    def swings(self) -> bool:
        """Return whether the motion stays in its well, or ends on a crest."""
        return self.potential.well > 0 and self.energy_above_next_crest <= 0

    @property
    def is_still(self) -> bool:
        """Return whether the load rests in the equilibrium, or swings by less than doubles show."""
        if not self.swings:
            return False
        amplitude = math.sqrt(self.kinetic / self.potential.curvature)
        return max(abs(self.past_rest), amplitude) <= _STILL

    @property
    def stays(self) -> bool:
        """Return whether the load does not move, as far as doubles tell.

        It stays in the equilibrium, on a crest, or anywhere if nothing pulls it.
        """
        if self.is_still:
            return True
        if self.kinetic > 0 or self.potential.excess > 0:
            return False
        # The double nearest to an odd multiple of pi is up to 0.64 eps of it off, and that nearest
        # to the crest of a slope up to an eps of pi.
        is_on_crest = abs(self.past_crest) <= EPS * max(abs(self.phi), math.pi)
        return is_on_crest or self.potential.depth == 0


def rounding_delay(launch: Launch, margin: float, latest: float) -> float:
    """Return a rough bound on the time [s] by which rounding delays a motion until `latest` [s].

    The motion passes, or misses, crests by an energy of at least `margin` [J].
    """
    potential = launch.potential
    if potential.depth == 0:  # V is a plane, which has no crest
        return ROUNDINGS * latest
    if potential.curvature == 0:
        # There is no barrier. The torque at the crest is the difference of ramp and depth, which
        # magnifies their rounding by depth / excess. Squared, this is on the safe side.
        ratio = potential.held_torque / potential.excess if potential.excess > 0 else math.inf
        return ROUNDINGS * ratio**2 * latest

    # How far off V may be. If sin(lean) = ramp / depth has a relative error, lean has tan(lean)
    # times that error, and curvature = depth cos(lean) has a relative error tan(lean)^2 times it.
    tan_lean = potential.held_torque / potential.curvature
    curvature_error = ROUNDINGS * tan_lean**2  # relative

    # How far off the start may be, measured from the crest. On level ground the crest is at an odd
    # multiple of pi, from which `past_crest` is known to an eps.
    shift = ROUNDINGS * (abs(potential.bottom) + potential.lean + tan_lean)
    shift += EPS * abs(launch.past_crest)

    # How far off the energy at a crest may be.
    torque = abs(float(potential.mean_torque(launch.past_crest, 0.0)))
    energy_error = ROUNDINGS * (launch.kinetic + abs(float(potential.below(launch.past_crest))))
    energy_error += torque * shift + potential.curvature * shift**2
    margin_error = energy_error / margin if margin > 0 else math.inf  # relative

    # Near a crest the distance x from it grows as exp(lambda t), with lambda^2 = curvature / J. The
    # load spends a time of about log(1 / margin) / lambda there, which a relative error of the
    # margin changes by that error / lambda. Until `latest` it comes to some 1 + lambda latest
    # crests at most.
    inertia = float(launch.oscillator.inertia(potential.phi_at(0.0)))
    crest_time = math.sqrt(inertia / potential.curvature)  # 1 / lambda [s]
    return (curvature_error + margin_error) * (crest_time + latest)
