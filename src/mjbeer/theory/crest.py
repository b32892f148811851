"""Differences of V, measured from where nothing cancels: its crest, its well, or a turning point.

V falls downhill, for slope >= 0 that is with growing phi. If slope < depth, its crest is the barrier, its maximum in
every turn, with the equilibrium at a distance `well` before it. On a steeper incline V only falls, and its crest is
where it falls least; there the well has no width. In both cases the torque downhill at a distance x past the crest is

    -V'(crest + x) = excess + 2 ramp sin^2(x/2) + curvature sin(x).

Every turn is the same, but lower by `step` = 2 pi slope.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

_SHALLOW = 0.5
"""Width of a well [rad] below which it is shallow: 1 % of a step in height, where rounding does not matter yet."""


@dataclass(frozen=True)
class Crest:
    """The coefficients of the torque above, and where the crest is."""

    excess: float
    """Torque at the crest [N m]: 0 if there is a barrier."""
    ramp: float
    """Coefficient of 2 sin^2(x/2) in the torque [N m]; slope = excess + ramp."""
    curvature: float
    """-V'' at the crest, and V'' at the equilibrium [N m/rad]; 0 if there is no barrier."""
    bottom: float
    """Angle at which the cosine in V has its minimum [rad]."""
    lean: float
    """Angle of the equilibrium past `bottom` [rad]; pi/2 if there is none."""

    @classmethod
    def of(cls, slope: float, depth: float, bottom: float) -> "Crest":
        """Return the crest of V = -slope phi - depth cos(phi - bottom), for slope >= 0."""
        if slope >= depth:
            return cls(excess=slope - depth, ramp=depth, curvature=0.0, bottom=bottom, lean=math.pi / 2)
        curvature = math.sqrt(depth - slope) * math.sqrt(depth + slope)
        lean = math.atan2(slope, curvature)
        return cls(excess=0.0, ramp=slope, curvature=curvature, bottom=bottom, lean=lean)

    @property
    def slope(self) -> float:
        """Return the mean torque downhill [N m]."""
        return self.excess + self.ramp

    @property
    def step(self) -> float:
        """Return by how much V falls in a turn [J]."""
        return 2 * math.pi * self.slope

    @property
    def offset(self) -> float:
        """Return the angle of the crest, less pi [rad]."""
        return self.bottom - self.lean

    @property
    def rest(self) -> float:
        """Return the angle of the equilibrium [rad]."""
        return self.bottom + self.lean

    @property
    def well(self) -> float:
        """Return the angle from the equilibrium to the crest [rad]; 0 if there is no equilibrium."""
        return 2 * math.atan2(self.curvature, self.ramp) if self.curvature > 0 else 0.0

    @property
    def shallow(self) -> bool:
        """Return whether the well is so shallow, if there is one, that a load rolls on through it without a turn."""
        return self.well < _SHALLOW

    @property
    def turn_begins(self) -> float:
        """Return where a turn begins, past its crest [rad]: not where a load may be slow.

        That is at the equilibrium, with the crest in the middle of a turn. Where the well is shallow or there is none,
        it is at the crest, and the motion turns at most half a turn behind the crest, or ahead of it.
        """
        return 0.0 if self.shallow else -self.well

    @property
    def rise(self) -> float:
        """Return how much more than to be at the crest it takes to come from the turn behind [J]."""
        return max(0.0, -float(self.below(-math.pi))) if self.shallow else 0.0

    def below(self, x: np.ndarray | float) -> np.ndarray:
        """Return V(crest) - V(crest + x) [J], for `x` [rad] of either sign: the integral of the torque."""
        return self.excess * x + self.ramp * x * sinc_gap(x) + 2 * self.curvature * np.sin(x / 2) ** 2

    def above(self, y: np.ndarray | float) -> np.ndarray:
        """Return V(rest + y) - V(rest) [J], for `y` [rad] of either sign; there must be an equilibrium.

        V looks the same upside down: it rises from the equilibrium as it falls from the crest, the other way round.
        """
        return self.below(-y)

    def torque(self, x: float) -> float:
        """Return -V' [N m] at a distance `x` [rad] past the crest."""
        return self.excess + 2 * self.ramp * math.sin(x / 2) ** 2 + self.curvature * math.sin(x)

    def chord(self, turn: float, length: np.ndarray | float) -> np.ndarray:
        """Return (V(turn) - V(turn + length)) / length [N m], which is smooth through length 0.

        `turn` is a distance past the crest [rad]. It may be negative if the well is shallow; `length` [rad] is not.
        """
        middle, half = turn + length / 2, length / 2
        flattened = 2 * np.sin(middle / 2) ** 2 + np.cos(middle) * sinc_gap(half)
        return self.excess + self.ramp * flattened + self.curvature * np.sin(middle) * sinc(half)


def past_pi(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest odd multiple of pi, to full relative precision."""
    return math.atan2(-math.sin(angle), -math.cos(angle))


def past_zero(angle: float) -> float:
    """Return how far `angle` [rad] is past the nearest even multiple of pi, to full relative precision.

    The sine and cosine of the C library reduce angles of any size with as many digits of pi as that needs.
    """
    return angle if abs(angle) <= math.pi else math.atan2(math.sin(angle), math.cos(angle))


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


def root(function: Callable[[float], float], lower: float, upper: float) -> float:
    """Return where a function is 0 between `lower`, where it is not positive, and `upper`, to full relative precision.

    If it is not positive at `upper` it should be 0 there, and is only rounded.
    """
    from scipy.optimize import brentq

    if function(upper) <= 0:
        return upper
    return float(brentq(function, lower, upper, xtol=1e-30, rtol=4 * np.finfo(float).eps, maxiter=500))
