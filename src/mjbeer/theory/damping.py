"""The torque between can and load, which turn at different rates, of a liquid that is neither free nor frozen."""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer import require


@dataclass(frozen=True)
class Damping:
    """A torque c1 w + c2 w |w| + c3 w^3 against the slip rate w of can and load [rad/s].

    The slip rate is roll_dot - phi_dot, by which the can turns faster than its load. The torque acts on the load with
    the sign of w and on the can with the other one. MuJoCo's damping of a joint or a tendon is the same polynomial.

    Raises:
      ParameterError: if a coefficient is negative or not finite.
    """

    linear: float = 0.0
    """c1 [N m s], of a torque that is proportional to the slip rate."""
    quadratic: float = 0.0
    """c2 [N m s^2]."""
    cubic: float = 0.0
    """c3 [N m s^3]."""

    def __post_init__(self) -> None:
        require.store(
            self,
            linear=require.non_negative("damping", self.linear, "N m s"),
            quadratic=require.non_negative("quadratic damping", self.quadratic, "N m s^2"),
            cubic=require.non_negative("cubic damping", self.cubic, "N m s^3"),
        )

    def __bool__(self) -> bool:
        """Return whether there is any torque."""
        return self != _NONE

    @property
    def coefficients(self) -> tuple[float, float, float]:
        """Return c1, c2 and c3."""
        return self.linear, self.quadratic, self.cubic

    def torque(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the torque [N m] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return rate * (self.linear + size * (self.quadratic + size * self.cubic))

    def slope(self, rate: np.ndarray | float) -> np.ndarray | float:
        """Return the derivative of the torque by the slip rate [N m s] at a slip rate [rad/s]."""
        size = np.abs(rate)
        return self.linear + size * (2 * self.quadratic + size * 3 * self.cubic)

    def rate(self, torque: float) -> float:
        """Return the slip rate [rad/s] at which the torque is `torque` [N m]; it is infinite if there is no damping."""
        return root(self.coefficients, torque)


def root(coefficients: tuple[float, float, float], value: float) -> float:
    """Return x with c1 x + c2 x |x| + c3 x^3 = `value`, where no coefficient is negative; infinite if all are zero."""
    if value == 0:
        return 0.0
    size, (linear, quadratic, cubic) = abs(value), coefficients
    # Each term alone would need a larger x. Newton's method falls from above, as the sum is convex.
    terms = enumerate(coefficients, start=1)
    x = min(((size / share) ** (1 / power) for power, share in terms if share > 0), default=math.inf)
    while x < math.inf:
        excess = x * (linear + x * (quadratic + x * cubic)) - size
        lower = x - excess / (linear + x * (2 * quadratic + x * 3 * cubic))
        if not lower < x:
            break
        x = lower
    return math.copysign(x, value)


_NONE = Damping()
