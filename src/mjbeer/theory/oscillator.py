"""Every scene as one conservative degree of freedom.

With the rolling constraint and the conserved momentum eliminated, each scene obeys

    1/2 J(phi) phi_dot^2 + V(phi) = E,
    J = base + chord sin^2(phi/2) + swing sin^2(phi),
    V = -slope phi - depth cos(phi - bottom).

V is a cosine on a ramp: `slope` is the steepness of the ramp, a torque, `depth` the amplitude of the cosine, and
`bottom` the angle of its minimum. If |slope| < depth, V has in every turn a minimum (the equilibrium) and a maximum
(the barrier). A frozen load gives `chord` and `slope` (eqs. 51 and 52), a sliding load `swing` and no slope (eq. 16,
and eqs. 46 and 47 with u eliminated). All coefficients of J are non-negative, so J never cancels.

V is needed only as differences: `drop`, and those that `crest` has in forms in which nothing cancels.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.theory.can import Can
from mjbeer.theory.crest import Crest, root
from mjbeer.theory.load import Load


@dataclass(frozen=True)
class Oscillator:
    """The coefficients of J and V in the formulas above."""

    base: float
    """Constant part of J [kg m^2]."""
    chord: float
    """Coefficient of sin^2(phi/2) in J [kg m^2]."""
    swing: float
    """Coefficient of sin^2(phi) in J [kg m^2]."""
    slope: float
    """Mean torque downhill [N m]."""
    depth: float
    """Amplitude of the cosine in V [J]."""
    bottom: float
    """Angle at which the cosine in V has its minimum [rad]."""

    @classmethod
    def sliding(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Return the oscillator of a load that slides without friction about the axis (section 3 of the paper)."""
        effective_can_mass = can.mass + can.inertia / can.radius**2
        total = load.mass + effective_can_mass
        moment = load.mass * load.offset
        # g sin(alpha) - A, with A the steady acceleration of footnote 4
        lag = gravity * math.sin(incline) * (can.inertia / can.radius**2) / total
        normal = gravity * math.cos(incline)
        return cls(
            base=load.inertia + moment * load.offset * effective_can_mass / total,
            chord=0.0,
            swing=moment * load.offset * load.mass / total,
            slope=0.0,
            depth=moment * math.hypot(normal, lag),
            bottom=math.atan2(-lag, normal),
        )

    @classmethod
    def frozen(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Return the oscillator of a load that is rigidly attached to the can (appendix A of the paper)."""
        radius, offset = can.radius, load.offset
        inertia = load.inertia + load.mass * (radius - offset) ** 2
        return cls(
            base=inertia + can.inertia + can.mass * radius**2,
            chord=4 * load.mass * radius * offset,
            swing=0.0,
            slope=(load.mass + can.mass) * gravity * radius * math.sin(incline),
            depth=load.mass * gravity * offset,
            bottom=-incline,
        )

    def mirror(self) -> "Oscillator":
        """Return the oscillator of the same motion seen from behind, with the signs of phi and the incline changed."""
        return replace(self, slope=-self.slope, bottom=-self.bottom)

    def inertia(self, phi: np.ndarray | float) -> np.ndarray:
        """Return J [kg m^2] at `phi` [rad]."""
        return self.base + self.chord * np.sin(phi / 2) ** 2 + self.swing * np.sin(phi) ** 2

    def inertia_past_crest(self, x: np.ndarray | float) -> np.ndarray:
        """Return J [kg m^2] at a distance `x` [rad] past the crest, where pi need not be added, for slope >= 0."""
        past_pi = self.crest.offset + x
        return self.base + self.chord * np.cos(past_pi / 2) ** 2 + self.swing * np.sin(past_pi) ** 2

    def potential(self, phi: np.ndarray | float) -> np.ndarray:
        """Return V [J] at `phi` [rad]."""
        return -self.slope * phi - self.depth * np.cos(phi - self.bottom)

    def drop(self, phi: np.ndarray | float, start: np.ndarray | float) -> np.ndarray:
        """Return V(start) - V(phi) [J] without the cancellation of the plain difference."""
        turned = phi - start
        middle = (phi + start) / 2 - self.bottom
        return self.slope * turned - 2 * self.depth * np.sin(middle) * np.sin(turned / 2)

    def stiffness(self) -> float:
        """Return V'' at the equilibrium, which is also -V'' at the barrier [N m/rad]."""
        return math.sqrt(self.depth - abs(self.slope)) * math.sqrt(self.depth + abs(self.slope))

    def unevenness(self, phi0: float, phi_dot0: float) -> float:
        """Return by how much phi_dot varies over a turn, relative to itself, for a start [rad, rad/s] that rotates.

        It is large where neither the energy of the start nor that which a turn downhill adds is much more than the
        depth of the well.
        """
        drive = float(self.inertia(phi0)) * phi_dot0**2 / 2 + abs(self.slope)
        by_weight = self.depth / drive if drive > 0 else (math.inf if self.depth > 0 else 0.0)
        return (self.chord + self.swing) / (2 * self.base) + by_weight

    def acceleration(self, phi: np.ndarray | float, phi_dot: np.ndarray | float) -> np.ndarray:
        """Return phi_ddot [rad/s^2] from the equation of motion, which is (16) or (52) for a massless can."""
        inertia_slope = self.chord * np.sin(phi) / 2 + self.swing * np.sin(2 * phi)
        torque = self.slope - self.depth * np.sin(phi - self.bottom)
        return (torque - inertia_slope * phi_dot**2 / 2) / self.inertia(phi)

    def equilibrium(self) -> float:
        """Return the angle of stable equilibrium [rad]: eq. (53) for a frozen load.

        Raises:
          NoEquilibriumError: if the load is balanced about the axis, there is no gravity, or the incline is steeper
            than the load can hold.
        """
        if self.depth == 0:
            raise NoEquilibriumError(
                "nothing restores the load: it is balanced about the axis (offset 0 m) or gravity is 0 m/s^2, "
                "so no angle is a stable equilibrium"
            )
        if abs(self.slope) > self.depth:
            raise NoEquilibriumError("the incline is steeper than the load can hold")
        return self.bottom + math.atan2(self.slope, self.stiffness())

    def frequency(self) -> float:
        """Return the angular frequency of small oscillations [rad/s], sqrt(V''/J) at equilibrium: eqs. (10), (55)."""
        return math.sqrt(self.stiffness() / float(self.inertia(self.equilibrium())))

    @cached_property
    def crest(self) -> Crest:
        """Return the crest of V, for slope >= 0."""
        return Crest.of(slope=self.slope, depth=self.depth, bottom=self.bottom)

    def barrier(self) -> float:
        """Return the unstable equilibrium that bounds libration on the downhill side [rad], for slope >= 0."""
        return math.pi + self.crest.offset

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles between which the largest libration about the equilibrium swings [rad]."""
        if self.slope < 0:
            low, high = self.mirror().separatrix()
            return -high, -low
        crest = self.crest
        behind = 2 * math.pi - crest.well
        # As high as the barrier, on the downhill side of the one before it, which is a step higher.
        past = root(lambda x: float(crest.below(x)) - crest.step, 0, behind)
        return crest.rest - behind + past, self.barrier()

    def require_libration(self, phi: float) -> None:
        """Check that a release from rest at `phi` [rad] swings about the equilibrium.

        Raises:
          NoLibrationError: if it does not; the message names the amplitudes of the separatrix.
        """
        low, high = self.separatrix()
        if not low < phi < high:
            rest = self.equilibrium()
            raise NoLibrationError(
                f"amplitude {phi - rest:.6g} rad is not inside the separatrix: released from rest, the load "
                f"swings about its equilibrium only for amplitudes between {low - rest:.6g} and {high - rest:.6g} rad"
            )
