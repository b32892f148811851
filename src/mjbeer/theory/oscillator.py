"""Every scene as one conservative degree of freedom.

With the rolling constraint and the conserved momentum eliminated, each scene obeys

    1/2 J(phi) phi_dot^2 + V(phi) = E,
    J = base + chord sin^2(phi/2) + swing sin^2(phi),
    V = -slope phi - depth cos(phi - bottom).

V is a cosine on a ramp: `slope` is the steepness of the ramp, a torque, `depth` the amplitude of the cosine, and
`bottom` the angle of its minimum. If |slope| < depth, V has in every turn a minimum (the equilibrium) and a maximum
(the barrier). A frozen load gives `chord` and `slope` (eqs. 51 and 52), a sliding load `swing` and no slope (eq. 16,
and eqs. 46 and 47 with u eliminated). All coefficients of J are non-negative, so J never cancels.

Heights of V are needed only as differences, each in a form in which nothing cancels:

    drop(phi, start) = V(start) - V(phi),
    surplus(phi, start, kinetic) = E - V(phi) = kinetic + drop(phi, start), the kinetic energy at phi,
    _below_barrier(past) = V(barrier) - V(barrier + past).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load

_NO_SLOPE = 1e-30
"""Slope over depth below which a slope counts as none: the rounding of the weight hides it over 1e14 rad of rolling."""


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
        slope = (load.mass + can.mass) * gravity * radius * math.sin(incline)
        depth = load.mass * gravity * offset
        inertia = load.inertia + load.mass * (radius - offset) ** 2
        return cls(
            base=inertia + can.inertia + can.mass * radius**2,
            chord=4 * load.mass * radius * offset,
            swing=0.0,
            slope=slope if abs(slope) > _NO_SLOPE * depth else 0.0,
            depth=depth,
            bottom=-incline,
        )

    def mirror(self) -> "Oscillator":
        """Return the oscillator of the same motion seen from behind, with the signs of phi and the incline changed."""
        return replace(self, slope=-self.slope, bottom=-self.bottom)

    def inertia(self, phi: np.ndarray | float) -> np.ndarray:
        """Return J [kg m^2] at `phi` [rad]."""
        return self.base + self.chord * np.sin(phi / 2) ** 2 + self.swing * np.sin(phi) ** 2

    def potential(self, phi: np.ndarray | float) -> np.ndarray:
        """Return V [J] at `phi` [rad]."""
        return -self.slope * phi - self.depth * np.cos(phi - self.bottom)

    def drop(self, phi: np.ndarray | float, start: float) -> np.ndarray:
        """Return V(start) - V(phi) [J] without the cancellation of the plain difference."""
        turned = phi - start
        middle = (phi + start) / 2 - self.bottom
        return self.slope * turned - 2 * self.depth * np.sin(middle) * np.sin(turned / 2)

    def surplus(self, phi: np.ndarray | float, start: float, kinetic: float) -> np.ndarray:
        """Return E - V(phi) [J] of the motion that passes `start` [rad] with `kinetic` energy [J], for slope >= 0.

        Near a barrier both terms are measured from the barrier's top, so that a small surplus keeps its digits.
        """
        from_start = kinetic + self.drop(phi, start)
        if self.slope >= self.depth:
            return from_start
        top = self.barrier()
        from_barrier = kinetic - self._below_barrier(start - top) + self._below_barrier(phi - top)
        return np.where(np.cos(phi - top) < 0.5, from_start, from_barrier)

    def _below_barrier(self, past: np.ndarray | float) -> np.ndarray:
        """Return V(barrier) - V(barrier + past) [J], with `past` [rad] of either sign."""
        return self.slope * past * sinc_gap(past) + 2 * self.stiffness() * np.sin(past / 2) ** 2

    def stiffness(self) -> float:
        """Return V'' at the equilibrium, which is also -V'' at the barrier [N m/rad]."""
        return math.sqrt((self.depth - self.slope) * (self.depth + self.slope))

    def force(self, phi: float) -> float:
        """Return the torque -V' [N m] at `phi` [rad], for slope >= 0.

        It is a product of sines of the distances to equilibrium and barrier, which keeps its digits near both.
        """
        if self.slope >= self.depth:
            return self.slope - self.depth * math.sin(phi - self.bottom)
        return 2 * self.depth * math.sin((phi - self.barrier()) / 2) * math.sin((phi - self.equilibrium()) / 2)

    def unevenness(self, phi0: float, phi_dot0: float) -> float:
        """Return by how much phi_dot varies over a turn, relative to itself, for a start [rad, rad/s] that rotates.

        It is large where the energy is not much more than a rotation needs.
        """
        kinetic = float(self.inertia(phi0)) * phi_dot0**2 / 2
        return (self.chord + self.swing) / (2 * self.base) + (self.depth / kinetic if kinetic > 0 else math.inf)

    def to_barrier(self, phi0: float, phi_dot0: float) -> float:
        """Return how far the energy of a start [rad, rad/s] is from that of the next barrier downhill of it [J].

        It is infinite if there is no barrier.
        """
        if self.slope < 0:
            return self.mirror().to_barrier(-phi0, -phi_dot0)
        if self.slope >= self.depth:
            return math.inf
        top = self.barrier()
        top += 2 * math.pi * math.ceil((phi0 - top) / (2 * math.pi))
        return abs(float(self.surplus(top, phi0, float(self.inertia(phi0)) * phi_dot0**2 / 2)))

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
        return self.bottom + math.asin(self.slope / self.depth)

    def frequency(self) -> float:
        """Return the angular frequency of small oscillations [rad/s], sqrt(V''/J) at equilibrium: eqs. (10), (55)."""
        return math.sqrt(self.stiffness() / float(self.inertia(self.equilibrium())))

    def barrier(self) -> float:
        """Return the unstable equilibrium that bounds libration on the downhill side [rad], for slope >= 0."""
        return self.bottom + math.pi - (self.equilibrium() - self.bottom)

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles between which the largest libration about the equilibrium swings [rad]."""
        if self.slope < 0:
            low, high = self.mirror().separatrix()
            return -high, -low
        top = self.barrier()
        if self.slope == 0:
            return top - 2 * math.pi, top
        uphill = self.turning_point(top, 0.0, forbidden=top - 2 * math.pi, allowed=self.equilibrium())
        return uphill, top

    def turning_point(self, start: float, kinetic: float, forbidden: float, allowed: float) -> float:
        """Return where the motion that passes `start` [rad] with `kinetic` energy [J] turns [rad].

        The point is sought between an angle that the energy forbids and one that it allows [rad].
        """
        from scipy.optimize import brentq

        def kinetic_left(phi: float) -> float:
            return float(self.surplus(phi, start, kinetic))

        return float(brentq(kinetic_left, forbidden, allowed, xtol=1e-30, rtol=4 * np.finfo(float).eps, maxiter=500))

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


def sinc(x: np.ndarray | float) -> np.ndarray:
    """Return sin(x)/x to full relative precision, at its zeros too, unlike np.sinc."""
    x = np.where(x == 0, 1e-300, x)
    return np.sin(x) / x


def sinc_gap(x: np.ndarray | float) -> np.ndarray:
    """Return 1 - sin(x)/x, by its series where the difference would cancel."""
    square, series = np.square(np.minimum(np.abs(x), 1)), np.ones_like(x)
    for k in range(17, 1, -2):
        series = 1 - square / ((k + 1) * (k + 2)) * series
    return np.where(np.abs(x) < 1, square / 6 * series, 1 - sinc(x))
