"""Every scene as one conservative degree of freedom.

With the rolling constraint and the conserved momentum eliminated, each scene obeys

    J(phi) phi_dot^2 / 2 + V(phi) = E,
    J = base + chord sin^2(phi/2) + coupling sin^2(phi),
    V = -ramp phi - depth cos(phi - bottom).

A frozen load has a `chord` and a `ramp` (eqs. 51 and 52), a sliding load has a `coupling` and no
ramp (eq. 16, and eqs. 46 and 47 with u eliminated). No coefficient of J is negative, so that its
sum loses no digits.

If |ramp| < depth, V has in every turn a minimum, the equilibrium or *rest*, and a maximum, the
*crest*. `Oscillator` has the coefficients, with J, V and the equation of motion. `Potential`
describes V about its crest and its rest, for equilibria and exact motions; simulations do not need
it.
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
"""Coefficients of the series of (1 - sin(x)/x)/x^2 in -x^2, the highest power first."""


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
        """Return the oscillator of a load that slides without friction about the axis: section 3.

        With K = m_can + I_can/a^2, M_e = m + K and u_ddot from eq. (46), eq. (47) has the inertia

            J = I_cm + m b^2 - (m b cos(phi))^2 / M_e
              = I_cm + m b^2 K / M_e + (m b sin(phi))^2 / M_e

        and, with the steady acceleration A of footnote 4, the torque

            -m g b sin(alpha + phi) + m b cos(phi) A
              = -m b (g cos(alpha) sin(phi) + lag cos(phi)),
            lag = g sin(alpha) - A = g sin(alpha) (I_can/a^2) / M_e.
        """
        effective_mass = load.mass + can.effective_mass
        lag = gravity * math.sin(incline) * (can.inertia / can.radius**2) / effective_mass
        across = gravity * math.cos(incline)
        moment = load.moment
        return cls(
            base=load.inertia + moment * load.offset * can.effective_mass / effective_mass,
            coupling=moment * load.offset * load.mass / effective_mass,
            depth=moment * math.hypot(across, lag),
            bottom=math.atan2(-lag, across),
        )

    @classmethod
    def frozen(cls, can: Can, load: Load, incline: float, gravity: float) -> "Oscillator":
        """Return the oscillator of a load that is rigidly attached to the can: appendix A.

        J is the inertia about the line of contact. The square of the load's distance from it is
        a^2 + b^2 - 2 a b cos(phi) = (a - b)^2 + 4 a b sin^2(phi/2).
        """
        radius = can.radius
        offset = load.offset
        of_load = load.inertia + load.mass * (radius - offset) ** 2
        return cls(
            base=of_load + can.inertia + can.mass * radius**2,
            chord=4 * load.mass * radius * offset,
            ramp=(load.mass + can.mass) * gravity * radius * math.sin(incline),
            depth=load.moment * gravity,
            bottom=-incline,
        )

    @cached_property
    def mirrored(self) -> "Oscillator":
        """Return the oscillator of the same scene in a mirror, where phi has the opposite sign."""
        return replace(self, bottom=-self.bottom, ramp=-self.ramp)

    @cached_property
    def potential(self) -> "Potential":
        """Return the shape of V; if the ramp is negative, that of the mirrored oscillator."""
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

    def acceleration(
        self,
        phi: np.ndarray | float,
        phi_dot: np.ndarray | float,
        torque: np.ndarray | float = 0.0,
    ) -> np.ndarray:
        """Return phi_ddot [rad/s^2] from the equation of motion.

        It is (16) or (52) for a massless can. A `torque` [N m] acts beside those of inertia and
        weight.
        """
        return formulas.phi_acceleration(self, phi, phi_dot, torque)

    def rate_variation(self, phi0: float, phi_dot0: float) -> float:
        """Return roughly how unevenly a rotation turns: the relative variation of its phi_dot.

        The rotation starts at `phi0` [rad] with `phi_dot0` [rad/s]. As phi_dot is
        sqrt(2 (E - V)/J), it varies by half as much as J does, which is by chord + coupling of
        base, and by half as much as E - V, in which the cosine varies by 2 depth. E - V is taken
        to be the kinetic energy at the start and what the ramp adds to it in one radian.
        """
        by_inertia = (self.chord + self.coupling) / (2 * self.base)
        if self.depth == 0:
            return by_inertia
        energy = float(self.kinetic_energy(phi0, phi_dot0)) + abs(self.ramp)
        if energy == 0:
            return math.inf
        return by_inertia + self.depth / energy

    def equilibrium(self) -> float:
        """Return the angle of stable equilibrium [rad], where |ramp| <= depth.

        It is that of eq. (53) for a frozen load.
        """
        if self.depth == 0:
            raise NoEquilibriumError(
                "nothing restores the load: it is balanced about the axis (offset 0 m) or gravity "
                "is 0 m/s^2, so no angle is a stable equilibrium"
            )
        rest = self.potential.rest
        return -rest if self.ramp < 0 else rest

    def frequency(self) -> float:
        """Return the angular frequency of small oscillations [rad/s]: eqs. (10) and (55).

        It is sqrt(V''/J) at equilibrium.
        """
        inertia = float(self.inertia(self.equilibrium()))
        return math.sqrt(self.potential.curvature / inertia)

    def separatrix(self) -> tuple[float, float]:
        """Return the two angles between which the largest libration swings [rad].

        One of them is a crest. At the other end, uphill of the rest, V is as high as there.
        """
        potential = self.potential
        crest_above_rest = float(potential.rise(potential.well))
        to_uphill_end = root(
            lambda distance: potential.rise(-distance) - crest_above_rest,
            0,
            math.tau - potential.well,
        )
        low = potential.rest - to_uphill_end
        high = float(potential.phi_at(0.0))
        if self.ramp < 0:
            return -high, -low
        return low, high


class Distances(NamedTuple):
    """How far an angle is past the crest of its turn and past the rest of its well."""

    past_crest: float
    """[rad]"""
    past_rest: float
    """[rad]"""


class Potential:
    """V about its crest and its rest, for ramp >= 0, in differences that keep their digits.

    The torque is -V'(phi) = ramp - depth sin(phi - bottom). If ramp < depth, it vanishes at two
    angles of each turn. With sin(lean) = ramp / depth, these are

        rest = bottom + lean    and    crest = bottom + pi - lean,

    and the `well` from a rest to the next crest has the width pi - 2 lean. At an angle x past the
    crest, sin(phi - bottom) = sin(pi - lean + x) = sin(lean - x), and the torque is

        -V'(crest + x) = ramp - depth sin(lean - x)
                       = ramp (1 - cos(x)) + curvature sin(x),    curvature = depth cos(lean).

    If ramp >= depth, V falls everywhere. `crest` then names the angle at which it falls least,
    where lean = pi/2, and the torque is ramp - depth cos(x). With held_torque = min(ramp, depth)
    and excess = ramp - held_torque, one formula has both cases:

        -V'(crest + x) = excess + held_torque (1 - cos(x)) + curvature sin(x).

    Its integral from 0 to x is

        V(crest) - V(crest + x) = excess x + held_torque (x - sin(x)) + curvature (1 - cos(x)).

    V looks the same upside down: at an angle y past the rest the torque is
    ramp - depth sin(lean + y), as it is at x = -y past the crest.
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
        """What the cosine cannot hold: the torque at the crest [N m]; 0 if V has maxima."""
        self.curvature = math.sqrt(depth - self.held_torque) * math.sqrt(depth + self.held_torque)
        """V'' at the rest, and -V'' at the crest [J]: sqrt(depth^2 - ramp^2); 0 without a rest."""
        self.lean = math.pi / 2
        """Angle by which the ramp moves the rest downhill and the crest uphill [rad]."""
        self.well = 0.0
        """Distance from a rest to the next crest downhill [rad]; 0 without a rest."""
        if self.curvature > 0:
            self.lean = math.atan2(ramp, self.curvature)
            self.well = 2 * math.atan2(self.curvature, self.held_torque)
        self.rest = bottom + self.lean
        """Angle of the rest [rad]."""
        self.crest_past_pi = bottom - self.lean
        """Angle of the crest, less pi [rad]: on level ground this is 0 to all digits."""
        self.drop_per_turn = math.tau * ramp
        """Energy that the ramp gives in a turn downhill [J]."""
        self.edge_above_crest = max(0.0, -float(self.below(-math.pi)))
        """Height of a turn's uphill edge, half a turn before its crest, above the crest [J].

        0 if the edge is lower."""

    def phi_at(self, x: np.ndarray | float) -> np.ndarray | float:
        """Return the angle phi at `x` past the crest [rad]."""
        return math.pi + (self.crest_past_pi + x)

    def below(self, x: np.ndarray | float) -> np.ndarray:
        """Return V(crest) - V(crest + x) [J] for an `x` [rad] of either sign."""
        # x - sin(x) is x sinc_gap(x), and 1 - cos(x) is 2 sin^2(x/2).
        by_ramp = self.excess * x + self.held_torque * x * sinc_gap(x)
        return by_ramp + 2 * self.curvature * np.sin(x / 2) ** 2

    def rise(self, y: np.ndarray | float) -> np.ndarray:
        """Return V(rest + y) - V(rest) [J] for a `y` [rad] of either sign."""
        return self.below(-y)  # V looks the same upside down

    def mean_torque(self, x: float, length: np.ndarray | float) -> np.ndarray:
        """Return the mean of -V' from `x` past the crest over a `length` of either sign [N m].

        It is (V(crest + x) - V(crest + x + length)) / length, and smooth through length 0. With
        half = length/2, the mean of the sine is sin(middle) sin(half)/half, that of the cosine is
        cos(middle) sin(half)/half, and the factor sin(half)/half is 1 - gap.
        """
        half = length / 2
        middle = x + half
        gap = sinc_gap(half)
        mean_of_one_less_cosine = 2 * np.sin(middle / 2) ** 2 + np.cos(middle) * gap
        by_ramp = self.excess + self.held_torque * mean_of_one_less_cosine
        return by_ramp + self.curvature * np.sin(middle) * (1 - gap)

    def distances(self, phi: float) -> Distances:
        """Return how far `phi` [rad] of any size is past the crest of its turn and past its rest.

        The rest is that of the well in which `phi` is, which begins and ends at a crest. Of crest
        and rest, the nearer one is measured, and the distance from the other follows: so both
        distances keep their digits.
        """
        past_crest = math.remainder(_past_pi(phi) - self.crest_past_pi, math.tau)
        past_rest = math.remainder(reduced(phi) - self.rest, math.tau)
        if self.well > 0 and abs(past_rest) < abs(past_crest):
            # The crest is pi - 2 lean past the rest, give or take a turn.
            past_crest = _past_pi(past_rest) + 2 * self.lean
            if past_crest >= math.pi:
                past_crest -= math.tau
            return Distances(past_crest, past_rest)
        past_rest = past_crest + self.well
        if past_crest >= 0:  # in the well after the crest, not in the one before
            past_rest -= math.tau
        return Distances(past_crest, past_rest)


# Helpers for angles


def _past_pi(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest odd multiple of pi, to all digits."""
    return math.atan2(-math.sin(angle), -math.cos(angle))


def reduced(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest even multiple of pi, to all digits."""
    # The sine and cosine of the C library know pi to as many digits as that needs.
    if abs(angle) <= math.pi:
        return angle
    return math.atan2(math.sin(angle), math.cos(angle))


def sinc_gap(x: np.ndarray | float) -> np.ndarray:
    """Return 1 - sin(x)/x; up to |x| = 1 by its series, as the difference would cancel."""
    square = np.square(np.minimum(np.abs(x), 1))
    series = square * np.polyval(_SINC_SERIES, -square)
    return np.where(np.abs(x) < 1, series, 1 - np.sinc(np.divide(x, math.pi)))


def root(function: Callable[[np.ndarray], np.ndarray], lower: float, upper: float) -> float:
    """Return where a function of an array becomes positive between `lower` and `upper`.

    It is found to rounding, by cutting the interval into 256 again and again. The function is not
    positive at `lower`, and is taken to be at `upper`.
    """
    while True:  # SciPy's brentq takes longer to import than all the theory
        points = np.linspace(lower, upper, 257)
        positive = function(points) > 0
        positive[-1] = True
        first = max(1, int(np.argmax(positive)))
        if points[first - 1] <= lower and points[first] >= upper:
            return upper
        lower = float(points[first - 1])
        upper = float(points[first])
