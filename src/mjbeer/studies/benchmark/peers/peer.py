"""Peer: another tool that computes the motion of a scene, to be timed beside MuJoCo.

SciPy and heyoka integrate equations of motion derived by hand.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import DivergenceError, ParameterError
from mjbeer.theory.scene import Scene

Motion = tuple[np.ndarray, np.ndarray]
"""phi [rad] and u [m], with one entry for each sample."""
Integrate = Callable[[], Motion]
"""A function that integrates a motion from its start and returns it."""


@dataclass(frozen=True)
class Peer:
    """A tool that computes the motion of a scene, with the ladder of its accuracies."""

    name: str
    tolerances: tuple[float, ...]
    """Its ladder, finest last."""
    set_up: Callable[[Scene, float, float, np.ndarray, float], Integrate] = field(repr=False)
    """The function that `prepare` calls with the arguments that it has checked."""

    def prepare(self, scene: Scene, phi0: float, phi_dot0: float, times: ArrayLike, tolerance: float) -> Integrate:
        """Set up a motion, and return a function that integrates it from its start at every call.

        `phi0` [rad] and `phi_dot0` [rad/s] are the start, `times` [s] the samples, the first at 0, and `tolerance` is
        one of `tolerances` or any other. Equations, models and compilation are done here, so that only calls of the
        function need be timed. It raises DivergenceError, with the tool's message, if the tool fails.

        Raises:
          ParameterError: if the start, the times or the tolerance are not allowed.
          UnsupportedError: if the tool has no model of the scene.
        """
        phi0, phi_dot0 = require.start(phi0, phi_dot0)
        times = _samples(times)
        solve = self.set_up(scene, phi0, phi_dot0, times, require.positive("tolerance", tolerance))

        def integrate() -> Motion:
            phi, u = solve()
            # The last is enough: a value that is not finite stays so. To test all would take a fifth of heyoka's time.
            if phi.shape != times.shape or not (math.isfinite(phi[-1]) and math.isfinite(u[-1])):
                raise DivergenceError(f"{self.name}: the motion did not stay finite until {times[-1]:g} s")
            return phi, u

        return integrate


def decades(first: int, last: int) -> tuple[float, ...]:
    """Return the tolerances 10^-first to 10^-last, each a tenth of the one before."""
    return tuple(float(f"1e-{digits}") for digits in range(first, last + 1))


def _samples(times: ArrayLike) -> np.ndarray:
    """Return the times [s] of the samples as an array.

    Raises:
      ParameterError: unless they are finite and increasing, and the first is 0.
    """
    values = np.array(times, dtype=float)
    if (
        values.ndim != 1
        or len(values) < 2
        or not np.isfinite(values).all()
        or values[0]
        or (np.diff(values) <= 0).any()
    ):
        raise ParameterError(f"times must be two or more, the first at 0, each later than the last [s], got {times!r}")
    return values
