"""Every scene as one conservative degree of freedom.

With the rolling constraint and the conserved momentum eliminated, each scene obeys

    1/2 J(phi) phi_dot^2 + V(phi) = E,
    J = base + chord sin^2(phi/2) + coupling sin^2(phi),
    V = -ramp phi - depth cos(phi - bottom).

If |ramp| < depth, V has in every turn a minimum (the equilibrium, or rest) and a maximum (the barrier). A frozen load
gives `chord` and `ramp` (eqs. 51 and 52), a sliding load `coupling` and no ramp (eq. 16, and eqs. 46 and 47 with u
eliminated). No digits of J are lost, as its coefficients are not negative; `Potential` has differences of V that lose
none.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.theory import formulas
from mjbeer.theory.can import Can, Load

_SINC_SERIES = np.array([1 / math.factorial(k) for k in range(19, 2, -2)])


class Distances(NamedTuple):
    """How far an angle is past the crest of its turn and past the rest of its well."""

    past_crest: float
    """[rad]"""
    past_rest: float
    """[rad]"""


class Potential:
    """The shape of V = -ramp phi - depth cos(phi - bottom) about its crest, for ramp >= 0.

    If ramp < depth, its crest is the barrier, with the equilibrium at a distance `well` before it. On a steeper incline
    V only falls, its crest is where it falls least, and the well has no width. In both cases

        -V'(crest + x) = excess + 2 held_torque sin^2(x/2) + curvature sin(x).

    V looks the same upside down: the torque at an angle y past the equilibrium is that at -y past the crest, and
    below(-well) is the height of the crest above the rest.
    """

    def __init__(self, ramp: float, depth: float, bottom: float) -> None:
        self.ramp = ramp
        """Mean torque downhill [N m]."""
        self.depth = depth
        """Amplitude of the cosine [J]."""
        self.bottom = bottom
        """Angle at which the cosine has its minimum [rad]."""
        self.held_torque = min(ramp, depth)
        """The part of the ramp's torque that the cosine can hold [N m]."""
        self.excess = ramp - self.held_torque
        """Torque at the crest [N m]; 0 if there is a barrier."""
        self.curvature = math.sqrt(depth - self.held_torque) * math.sqrt(depth + self.held_torque)
        """V'' at rest, and -V'' at the crest [J]."""
        self.lean = math.pi / 2
        """How far the equilibrium is past the minimum of the cosine, and the crest before its maximum [rad]."""
        self.well = 0.0
        """Distance of the crest from the rest before it [rad]."""
        if self.curvature > 0:
            self.lean = math.atan2(ramp, self.curvature)
            self.well = 2 * math.atan2(self.curvature, self.held_torque)
        self.crest_past_pi = bottom - self.lean
        """The crest is at pi + crest_past_pi [rad], which keeps its digits."""
        self.rest = bottom + self.lean
        """Angle of the equilibrium [rad]."""
        self.drop_per_turn = math.tau * ramp
        """Energy that the ramp gives in a turn downhill [J]."""
        self.edge_above_crest = max(0.0, -float(self.below(-math.pi)))
        """Height of a turn's uphill edge, half a turn before its crest, above the crest; 0 if it is lower [J]."""

    def below(self, x: np.ndarray | float) -> np.ndarray:
        """Return V(crest) - V(crest + x) [J] for `x` [rad] of either sign; at x = -y it is V(rest + y) - V(rest)."""
        by_ramp = self.excess * x + self.held_torque * x * sinc_gap(x)
        return by_ramp + 2 * self.curvature * np.sin(x / 2) ** 2

    def mean_torque(self, x: float, length: np.ndarray | float) -> np.ndarray:
        """Return (V(crest + x) - V(crest + x + length)) / length [N m], which is smooth through length 0."""
        half = length / 2
        middle = x + half
        gap = sinc_gap(half)
        by_ramp = self.excess + self.held_torque * (2 * np.sin(middle / 2) ** 2 + np.cos(middle) * gap)
        return by_ramp + self.curvature * np.sin(middle) * (1 - gap)

    def distances(self, phi: float) -> Distances:
        """Return how far `phi` [rad], of any size, is past the crest of its turn and past the rest of its well.

        The well is the one between that crest and the next one if phi is past the crest.
        """
        past_crest = math.remainder(_past_pi(phi) - self.crest_past_pi, math.tau)
        past_rest = math.remainder(reduced(phi) - self.rest, math.tau)
        if self.well > 0 and abs(past_rest) < abs(past_crest):
            past_crest = _past_pi(past_rest) + 2 * self.lean
            if past_crest >= math.pi:
                past_crest -= math.tau
            return Distances(past_crest, past_rest)
        past_rest = past_crest + self.well
        if past_crest >= 0:
            past_rest -= math.tau
        return Distances(past_crest, past_rest)


@dataclass(frozen=True)
class Oscillator:
    """The coefficients of J and V in the formulas above."""

    base: float
    """Constant part of J [kg m^2]."""
    depth: float
    """Amplitude of the cosine in V [J]."""
    bottom: float
    """Angle at which the cosine in V has its minimum [rad]."""
    chord: float = 0.0
    """Coefficient of sin^2(phi/2) in J [kg m^2]."""
    coupling: float = 0.0
    """Coefficient of sin^2(phi) in J [kg m^2]."""
    ramp: float = 0.0
    """Mean torque downhill [N m]."""

    @classmethod
    def sliding(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Return the oscillator of a load that slides without friction about the axis (section 3 of the paper)."""
        total = load.mass + can.effective_mass
        # g sin(alpha) - A, with A the steady acceleration of footnote 4
        lag = gravity * math.sin(incline) * (can.inertia / can.radius**2) / total
        normal = gravity * math.cos(incline)
        return cls(
            base=load.inertia + load.moment * load.offset * can.effective_mass / total,
            coupling=load.moment * load.offset * load.mass / total,
            depth=load.moment * math.hypot(normal, lag),
            bottom=math.atan2(-lag, normal),
        )

    @classmethod
    def frozen(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Return the oscillator of a load that is rigidly attached to the can (appendix A of the paper)."""
        radius = can.radius
        offset = load.offset
        inertia = load.inertia + load.mass * (radius - offset) ** 2
        return cls(
            base=inertia + can.inertia + can.mass * radius**2,
            chord=4 * load.mass * radius * offset,
            ramp=(load.mass + can.mass) * gravity * radius * math.sin(incline),
            depth=load.moment * gravity,
            bottom=-incline,
        )

    @cached_property
    def mirrored(self) -> "Oscillator":
        """Return the oscillator that moves as this one does in a mirror, where phi has the opposite sign."""
        return replace(self, bottom=-self.bottom, ramp=-self.ramp)

    @cached_property
    def potential(self) -> Potential:
        """Return the shape of V about its crest; if the ramp is negative, that of the mirrored oscillator."""
        if self.ramp < 0:
            return self.mirrored.potential
        return Potential(self.ramp, self.depth, self.bottom)

    def inertia(self, phi: np.ndarray | float) -> np.ndarray:
        """Return J [kg m^2] at `phi` [rad]."""
        return formulas.inertia(self, phi)

    def kinetic_energy(self, phi: np.ndarray | float, phi_dot: np.ndarray | float) -> np.ndarray:
        """Return J phi_dot^2 / 2 [J], the kinetic energy of the swing."""
        return formulas.swing_energy(self, phi, phi_dot)

    def drop(self, phi: np.ndarray | float, from_phi: np.ndarray | float) -> np.ndarray:
        """Return V(from_phi) - V(phi) [J] without the cancellation of the plain difference."""
        return formulas.potential_drop(self, phi, from_phi)

    def rate_variation(self, phi0: float, phi_dot0: float) -> float:
        """Return the relative variation of phi_dot over a turn of a rotation.

        The rotation starts at `phi0` [rad] with `phi_dot0` [rad/s].
        """
        by_inertia = (self.chord + self.coupling) / (2 * self.base)
        if self.depth == 0:
            return by_inertia
        drive = float(self.kinetic_energy(phi0, phi_dot0)) + abs(self.ramp)
        return by_inertia + self.depth / drive if drive > 0 else math.inf

    def acceleration(
        self, phi: np.ndarray | float, phi_dot: np.ndarray | float, torque: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """Return phi_ddot [rad/s^2] from the equation of motion, which is (16) or (52) for a massless can.

        A `torque` [N m] acts beside those of inertia and weight.
        """
        return formulas.phi_acceleration(self, phi, phi_dot, torque)

    def equilibrium(self) -> float:
        """Return the angle of stable equilibrium [rad], where |ramp| <= depth: eq. (53) for a frozen load."""
        if self.depth == 0:
            raise NoEquilibriumError(
                "nothing restores the load: it is balanced about the axis (offset 0 m) or gravity is 0 m/s^2, "
                "so no angle is a stable equilibrium"
            )
        rest = self.potential.rest
        return -rest if self.ramp < 0 else rest

    def frequency(self) -> float:
        """Return the angular frequency of small oscillations [rad/s], sqrt(V''/J) at equilibrium: eqs. (10), (55)."""
        return math.sqrt(self.potential.curvature / float(self.inertia(self.equilibrium())))

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles between which the largest libration about the equilibrium swings [rad]."""
        potential = self.potential
        # V looks the same upside down: below(-well) is the height of the crest above the rest.
        barrier = float(potential.below(-potential.well))
        to_uphill_end = root(lambda angle: potential.below(angle) - barrier, 0, math.tau - potential.well)
        low = potential.rest - to_uphill_end
        high = math.pi + potential.crest_past_pi
        if self.ramp < 0:
            return -high, -low
        return low, high


def _past_pi(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest odd multiple of pi, to full relative precision."""
    return math.atan2(-math.sin(angle), -math.cos(angle))


def reduced(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest even multiple of pi, to full relative precision."""
    # The sine and cosine of the C library have as many digits of pi as that needs.
    return angle if abs(angle) <= math.pi else math.atan2(math.sin(angle), math.cos(angle))


def sinc_gap(x: np.ndarray | float) -> np.ndarray:
    """Return 1 - sin(x)/x, up to 1 by its series, as the difference would cancel."""
    square = np.square(np.minimum(np.abs(x), 1))
    series = square * np.polyval(_SINC_SERIES, -square)
    return np.where(np.abs(x) < 1, series, 1 - np.sinc(np.divide(x, math.pi)))


def root(function: Callable[[np.ndarray], np.ndarray], lower: float, upper: float) -> float:
    """Return where a function of an array is 0 between `lower`, where it is not positive, and `upper`, to rounding."""
    while True:  # SciPy's brentq takes longer to import than all the theory
        points = np.linspace(lower, upper, 257)
        positive = function(points) > 0
        positive[-1] = True
        first = max(1, int(np.argmax(positive)))
        if points[first - 1] <= lower and points[first] >= upper:
            return upper
        lower = float(points[first - 1])
        upper = float(points[first])
