"""Every scene as one conservative degree of freedom.

With the rolling constraint and the conserved momentum eliminated, each scene obeys

    1/2 J(phi) phi_dot^2 + V(phi) = E,
    J = base + chord sin^2(phi/2) + swing sin^2(phi),
    V = -slope phi - depth cos(phi - bottom).

A frozen load gives `chord` and `slope` (eqs. 51 and 52), a sliding load `swing` and no
slope (eq. 16, and eqs. 46 and 47 with u eliminated). All coefficients of J are
non-negative, so J never cancels.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load

_NO_SLOPE = 1e-30


@dataclass(frozen=True)
class Oscillator:
    """Coefficients of J [kg m^2] and V [J]."""

    base: float
    chord: float
    swing: float
    slope: float
    depth: float
    bottom: float

    @classmethod
    def sliding(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Load that slides without friction about the axis (section 3 of the paper)."""
        rolling = can.mass + can.inertia / can.radius**2
        total = load.mass + rolling
        moment = load.mass * load.offset
        # g sin(alpha) - A, with A the steady acceleration of footnote 4
        lag = gravity * math.sin(incline) * (can.inertia / can.radius**2) / total
        normal = gravity * math.cos(incline)
        return cls(
            base=load.inertia + moment * load.offset * rolling / total,
            chord=0.0,
            swing=moment * load.offset * load.mass / total,
            slope=0.0,
            depth=moment * math.hypot(normal, lag),
            bottom=math.atan2(-lag, normal),
        )

    @classmethod
    def frozen(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Load that is rigidly attached to the can (appendix A of the paper)."""
        radius, offset = can.radius, load.offset
        slope = (load.mass + can.mass) * gravity * radius * math.sin(incline)
        depth = load.mass * gravity * offset
        inertia = load.inertia + load.mass * (radius - offset) ** 2
        return cls(
            base=inertia + can.inertia + can.mass * radius**2,
            chord=4 * load.mass * radius * offset,
            swing=0.0,
            # A slope that is lost in the rounding of the weight over 1e14 rad of rolling is none.
            slope=slope if abs(slope) > _NO_SLOPE * depth else 0.0,
            depth=depth,
            bottom=-incline,
        )

    def mirrored(self) -> "Oscillator":
        """The same motion seen from behind: phi and the incline change sign."""
        return Oscillator(self.base, self.chord, self.swing, -self.slope, self.depth, -self.bottom)

    def inertia(self, phi: np.ndarray | float) -> np.ndarray:
        """J at `phi` [rad], in [kg m^2]."""
        return self.base + self.chord * np.sin(phi / 2) ** 2 + self.swing * np.sin(phi) ** 2

    def potential(self, phi: np.ndarray | float) -> np.ndarray:
        """V at `phi` [rad], in [J]."""
        return -self.slope * phi - self.depth * np.cos(phi - self.bottom)

    def drop(self, phi: np.ndarray | float, start: float) -> np.ndarray:
        """V(start) - V(phi) [J] without the cancellation of the plain difference."""
        turned = phi - start
        middle = (phi + start) / 2 - self.bottom
        return self.slope * turned - 2 * self.depth * np.sin(middle) * np.sin(turned / 2)

    def surplus(self, phi: np.ndarray | float, start: float, kinetic: float) -> np.ndarray:
        """E - V(phi) [J] of the motion that passes `start` with `kinetic` energy (slope >= 0).

        Beside a barrier it is counted from there, so that it keeps its digits where it is small.
        """
        plain = kinetic + self.drop(phi, start)
        if self.slope >= self.depth:
            return plain
        top = self.barrier()
        return np.where(np.cos(phi - top) < 0.5, plain, kinetic - self._below(start - top) + self._below(phi - top))

    def _below(self, past: np.ndarray | float) -> np.ndarray:
        """V(barrier) - V(barrier + past) [J]."""
        return self.slope * past * sinc_gap(past) + 2 * self.stiffness() * np.sin(past / 2) ** 2

    def stiffness(self) -> float:
        """V'' at the equilibrium, -V'' at the barrier [J]."""
        return math.sqrt((self.depth - self.slope) * (self.depth + self.slope))

    def force(self, phi: float) -> float:
        """-V' at `phi` [N m], a product of the distances to the equilibrium and the barrier (slope >= 0)."""
        if self.slope >= self.depth:
            return self.slope - self.depth * math.sin(phi - self.bottom)
        return 2 * self.depth * math.sin((phi - self.barrier()) / 2) * math.sin((phi - self.equilibrium()) / 2)

    def acceleration(self, phi: np.ndarray | float, phi_dot: np.ndarray | float) -> np.ndarray:
        """phi_ddot [rad/s^2] from the equation of motion, (16) and (52) for massless cans."""
        inertia_slope = self.chord * np.sin(phi) / 2 + self.swing * np.sin(2 * phi)
        torque = self.slope - self.depth * np.sin(phi - self.bottom)
        return (torque - inertia_slope * phi_dot**2 / 2) / self.inertia(phi)

    def equilibrium(self) -> float:
        """Angle of stable equilibrium [rad]: eq. (53) for a frozen load.

        Raises:
          NoEquilibriumError: if nothing holds the load (it is balanced, or there is no
            gravity), or if the slope is more than it can hold.
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
        """Angular frequency of small oscillations [rad/s], sqrt(V''/J) at equilibrium: eqs. (10), (55)."""
        rest = self.equilibrium()
        return math.sqrt(self.stiffness() / float(self.inertia(rest)))

    def barrier(self) -> float:
        """The unstable equilibrium that bounds libration on the downhill side [rad] (slope >= 0)."""
        return self.bottom + math.pi - (self.equilibrium() - self.bottom)

    def separatrix(self) -> tuple[float, float]:
        """The angles between which the largest libration about the equilibrium swings [rad]."""
        if self.slope < 0:
            low, high = self.mirrored().separatrix()
            return -high, -low
        top = self.barrier()
        if self.slope == 0:
            return top - 2 * math.pi, top
        return self.turning_point(top, 0.0, top - 2 * math.pi, self.equilibrium()), top

    def turning_point(self, start: float, kinetic: float, outer: float, inner: float) -> float:
        """Where the motion that passes `start` [rad] with `kinetic` energy [J] turns, between two angles.

        At `outer` the motion is energetically forbidden, at `inner` allowed.
        """
        from scipy.optimize import brentq

        def left(phi: float) -> float:
            return float(self.surplus(phi, start, kinetic))

        return float(brentq(left, outer, inner, xtol=1e-30, rtol=4 * np.finfo(float).eps, maxiter=500))

    def require_libration(self, phi: float) -> None:
        """Check that a release from rest at `phi` [rad] swings about the equilibrium.

        Raises:
          NoLibrationError: if it does not; the message names the separatrix.
        """
        low, high = self.separatrix()
        if not low < phi < high:
            rest = self.equilibrium()
            raise NoLibrationError(
                f"amplitude {phi - rest:.6g} rad is not inside the separatrix: released from rest, the load "
                f"swings about its equilibrium only for amplitudes between {low - rest:.6g} and {high - rest:.6g} rad"
            )


def sinc(x: np.ndarray | float) -> np.ndarray:
    """sin(x)/x, to full relative precision at its zeros as well, unlike np.sinc."""
    x = np.where(x == 0, 1e-300, x)
    return np.sin(x) / x


def sinc_gap(x: np.ndarray | float) -> np.ndarray:
    """1 - sin(x)/x, by its series where the difference would cancel."""
    square, series = np.square(np.minimum(np.abs(x), 1)), np.ones_like(x)
    for k in range(17, 1, -2):
        series = 1 - square / ((k + 1) * (k + 2)) * series
    return np.where(np.abs(x) < 1, square / 6 * series, 1 - sinc(x))
