"""The integrator Radau: SciPy's implicit Runge-Kutta method of fifth order around MuJoCo's forward dynamics.

Its steps are as long as the motion is smooth, where those of an explicit method must follow how can and load come
together: a thousand times a second with damping of 0.1 N m s, and in proportion to the damping.
"""

import math

import numpy as np
import scipy.integrate

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import quiet, untimed
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.recorder import Recorder

NAME = "Radau"
"""The name of this integrator."""
_FINEST = 100 * float(np.finfo(float).eps)
"""Smallest local tolerance that SciPy's method takes as it is."""
_ASIDE = 1e-3
"""Distance of the states from whose accelerations the Jacobian is, relative to the size of a component. Differences on
both sides are then right to 1e-6, of which Newton's method needs a few digits. With smaller ones the rounding of a
torque that is stiff, and so the difference of two rates times a large number, would hide all the others."""
_EVALUATIONS = 1_000_000
"""Largest number of evaluations in one run, which take some minutes."""


class Radau:
    """The Radau method around the forward dynamics that an explicit `Integrator` has set up."""

    def __init__(self, explicit: Integrator) -> None:
        self._slope = explicit.slope
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        tolerance: float,
        scale: np.ndarray,
        limit: float = math.inf,
        recorder: Recorder | None = None,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], as `Integrator.run` does; every sample is the end of a step.

        Between the ends of steps the method knows a motion to fewer digits.

        Raises:
          DivergenceError: if the motion stops being finite, no step is small enough, or the limit is reached.
        """
        if tolerance < _FINEST:
            raise DivergenceError(f"the {NAME} run would need a local tolerance below {_FINEST:.2g}")
        samples, begun = np.empty((len(times), len(start))), int(np.searchsorted(times, 0.0, side="right"))
        samples[:begun], self.evaluations = start, 0
        if recorder:
            recorder.add(np.zeros(1), start[None])
        kept: list[tuple[float, np.ndarray]] = []
        with quiet(), untimed():
            method = scipy.integrate.Radau(
                lambda _, state: self._evaluate(state), 0.0, start, times[-1], rtol=tolerance, atol=tolerance * scale,
                jac=lambda _, state: self._jacobian(state, scale),
            )  # fmt: skip
            for sample in range(begun, len(times)):
                method.t_bound, method.status = times[sample], "running"
                while method.status == "running":
                    with np.errstate(over="ignore", invalid="ignore"):
                        message = method.step()
                    if method.status == "failed" or not np.isfinite(method.y).all():
                        raise DivergenceError(f"the {NAME} run diverged at t = {method.t:.6g} s: {message}")
                    if self.evaluations > min(limit, _EVALUATIONS):
                        raise DivergenceError(
                            f"the {NAME} run was given up at t = {method.t:.6g} s after {self.evaluations} evaluations"
                        )
                    kept.append((float(method.t), method.y.copy()))
                samples[sample] = method.y
        if recorder and kept:
            recorder.add(np.array([time for time, _ in kept]), np.array([state for _, state in kept]))
        return samples

    def _evaluate(self, state: np.ndarray) -> np.ndarray:
        self.evaluations += 1
        return self._slope(state)

    def _jacobian(self, state: np.ndarray, scale: np.ndarray) -> np.ndarray:
        """Return the derivatives of the slope by the components of a state, shape (nq + nv, nq + nv)."""
        columns = np.empty((len(state), len(state)))
        for column, aside in enumerate(_ASIDE * np.maximum(scale, np.abs(state))):
            moved = state.copy()
            moved[column] = state[column] + aside
            above, ahead = moved[column], self._evaluate(moved)
            moved[column] = state[column] - aside
            columns[:, column] = (ahead - self._evaluate(moved)) / (above - moved[column])
        return columns
