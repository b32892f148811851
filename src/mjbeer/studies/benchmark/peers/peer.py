"""Other tools on the same scenes, to be timed beside MuJoCo: SciPy here, heyoka and EXUDYN in modules of their own.

SciPy and heyoka integrate the equations of motion that one derives by hand; EXUDYN is given bodies and joints.
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
"""phi [rad] and u [m], one row a sample."""
Integrate = Callable[[], Motion]


@dataclass(frozen=True)
class Peer:
    """A tool that computes the motion of a scene, and how finely it can be asked to."""

    name: str
    knob: str
    """What its accuracy is set by: "tolerance" or "timestep"."""
    unit: str
    """Unit of the knob; a tolerance has none."""
    knobs: tuple[float, ...]
    """The ladder of settings, finest last."""
    set_up: Callable[[Scene, float, float, np.ndarray, float], Integrate] = field(repr=False)
    """What `prepare` calls when it has checked its arguments."""

    def prepare(self, scene: Scene, phi0: float, phi_dot0: float, times: ArrayLike, knob: float) -> Integrate:
        """Do once all that a motion needs but its integration: equations, models, compilation.

        `phi0` [rad] and `phi_dot0` [rad/s] are the start, `times` [s] the samples, the first at 0, and `knob` the
        setting, of `knobs` or any other. What comes back integrates the motion from its start at every call, and is
        all that is to be timed. It raises DivergenceError, with the tool's own words, if the tool fails.

        Raises:
          ParameterError: on a start, times or a setting that make no sense, or that the tool cannot keep to.
          UnsupportedError: if the tool has no model of the scene.
        """
        phi0, phi_dot0 = require.start(phi0, phi_dot0)
        times = _samples(times)
        solve = self.set_up(scene, phi0, phi_dot0, times, require.positive(self.knob, knob, self.unit))

        def integrate() -> Motion:
            phi, u = solve()
            # What is not finite once stays so, and to ask every sample would be a fifth of heyoka's time.
            if phi.shape != times.shape or not (math.isfinite(phi[-1]) and math.isfinite(u[-1])):
                raise DivergenceError(f"{self.name}: the motion did not stay finite until {times[-1]:g} s")
            return phi, u

        return integrate


def decades(first: int, last: int) -> tuple[float, ...]:
    """The tolerances 10^-first to 10^-last."""
    return tuple(float(f"1e-{digits}") for digits in range(first, last + 1))


def _samples(times: ArrayLike) -> np.ndarray:
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
