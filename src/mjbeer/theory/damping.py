"""The torque between can and load, which turn at different rates."""

import math
from dataclasses import dataclass, field

import numpy as np

from mjbeer import require


@dataclass(frozen=True)
class Damping:
    """A torque c1 w + c2 w |w| + c3 w^3 against the slip rate w = roll_dot - phi_dot of can and load [rad/s].

    It acts on the load with the sign of w and on the can with the other one. MuJoCo's damping of a joint or a tendon is
    the same polynomial.

    Raises:
      ParameterError: if a coefficient is negative or not finite.
    """

    linear: float = 0.0
    """c1 [N m s]."""
    quadratic: float = 0.0
    """c2 [N m s^2]."""
    cubic: float = 0.0
    """c3 [N m s^3]."""
    holds: tuple[float, float] | None = field(default=None, compare=False, repr=False, kw_only=True)
    """Slip rates [rad/s] between which it is the damping of a real liquid; None if it is not one's."""
    coats_at: float = field(default=math.inf, compare=False, repr=False, kw_only=True)
    """Slip rate [rad/s] from which a film all round the wall can hold a third of that liquid."""

    def __post_init__(self) -> None:
        require.set_fields(
            self,
            linear=require.non_negative("damping", self.linear, "N m s"),
            quadratic=require.non_negative("quadratic damping", self.quadratic, "N m s^2"),
            cubic=require.non_negative("cubic damping", self.cubic, "N m s^3"),
        )

    def __bool__(self) -> bool:
        return any(self.coefficients)

    @property
    def coefficients(self) -> tuple[float, float, float]:
        """Return c1, c2 and c3."""
        return self.linear, self.quadratic, self.cubic

    def torque(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the torque [N m] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return rate * (self.linear + size * (self.quadratic + size * self.cubic))

    def derivative(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the derivative of the torque by the slip rate [N m s] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return self.linear + size * (2 * self.quadratic + size * 3 * self.cubic)

    def slip_rate(self, torque: float) -> float:
        """Return the slip rate [rad/s] at which the torque is `torque` [N m]; it is infinite if there is no damping."""
        if torque == 0:
            return 0.0
        # Each term alone would need a larger rate. Newton's method falls from above, as the sum is convex.
        terms = enumerate(self.coefficients, start=1)
        rate = min(((abs(torque) / c) ** (1 / power) for power, c in terms if c > 0), default=math.inf)
        while rate < math.inf:
            lower = rate - float((self.torque(rate) - abs(torque)) / self.derivative(rate))
            if not lower < rate:
                break
            rate = lower
        return math.copysign(rate, torque)
