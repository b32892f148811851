"""Integration to a global tolerance by two runs of Gauss-Jackson that agree, where DOP853 is not cheaper."""

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.setting import GAUSS_JACKSON
from mjbeer.simulation.comparison import ROUNDING_OVER_NUDGE, SAFETY_BY_CHANCE, Comparison, few, safety
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson import GaussJackson, plan
from mjbeer.simulation.recorder import Recorder
from mjbeer.simulation.solution import Solution
from mjbeer.theory.scene import Scene

_LOOSE = 3e-5
"""Largest tolerance for which Gauss-Jackson is tried; from there on its least evaluations are more than DOP853's."""
_PILOT = 1e-4
"""Local tolerance of the run of DOP853 that shows how long a timestep of Gauss-Jackson may be."""
_ASTRAY = 0.1
"""Largest distance [rad], relative beyond 1 rad, of that run from those of Gauss-Jackson at the end."""
_FINER = 1.2
"""Timestep of one run of Gauss-Jackson over that of the next."""
_GAIN = 9.0
"""Error of one run of Gauss-Jackson over that of the next, 1.2^12."""
_CHEAPER = 0.8
"""Largest number of evaluations of Gauss-Jackson over those of DOP853 to the tolerance, at which it is tried: it takes
two runs that are nearly alike, where the first of two runs of DOP853 takes three quarters of the second one."""


class _Pilot:
    """What a run of DOP853 shows of how long its steps were, in place of a recorder."""

    def __init__(self) -> None:
        self._ends: list[np.ndarray] = []

    @property
    def ends(self) -> np.ndarray:
        """Return the times [s] at the start and at the ends of the steps."""
        return np.concatenate(self._ends)

    def add_smooth(self, times: np.ndarray, states: np.ndarray, slopes: np.ndarray) -> None:
        """Add the next steps."""
        self._ends.append(times.copy())


class GaussJacksonPair:
    """A model of a scene, set up for runs of Gauss-Jackson that are compared.

    The coarse run of DOP853 before them has no more evaluations than `limit`.

    Raises:
      UnsupportedError: if the model has constraints or damping.
    """

    def __init__(
        self, model: mujoco.MjModel, scene: Scene, explicit: Integrator, comparison: Comparison, limit: int
    ) -> None:
        self._model, self._scene, self._explicit = model, scene, explicit
        self._comparison, self._limit = comparison, limit
        self._method = GaussJackson(model, explicit)

    def solve(
        self, start: np.ndarray, times: np.ndarray, tolerance: float, local: float, friction: float
    ) -> Solution | None:
        """Return the solution, or None if it is not within the `tolerance` [rad], or DOP853 is cheaper.

        A coarse run of DOP853 shows how long a timestep may be, and that two runs have not gone the same wrong way.
        `local` is the local tolerance with which DOP853 would reach the tolerance.
        """
        if tolerance > _LOOSE:
            return None
        pilot = _Pilot()
        try:
            (end,) = self._explicit.run(
                start, times[-1:], tolerance=_PILOT, scale=self._comparison.scale, limit=self._limit, recorder=pilot
            )
            timestep, evaluations = plan(pilot.ends, tolerance, _PILOT)
            if not evaluations < _CHEAPER * self._explicit.evaluations * (_PILOT / local) ** (1 / 8):
                return None
            return self._agreed(start, times, timestep, end, tolerance, friction)
        except DivergenceError:
            return None

    def _agreed(
        self, start: np.ndarray, times: np.ndarray, timestep: float, end: np.ndarray, tolerance: float, friction: float
    ) -> Solution | None:
        """Return the second or the third of ever finer runs, if it is near the one before and to the coarse `end`."""
        compare, chosen, caution = self._comparison, few(len(times)), safety(tolerance)
        coarse, rounding = self._method.run(compare.aside(start), times[chosen], timestep), 0.0
        for further in (False, True):
            timestep /= _FINER
            recorder = Recorder(self._model, self._scene, friction)
            fine = self._method.run(start, times, timestep, recorder)
            distance = compare.distance(coarse, fine[chosen], start)
            if not further:
                rounding = ROUNDING_OVER_NUDGE * distance  # the first distance includes the nudge
            estimate = max(caution * distance, compare.drift(recorder.record), rounding)
            if estimate <= tolerance and compare.distance(end[None], fine[-1:], start) <= _ASTRAY:
                return Solution(fine, estimate, recorder.record, GAUSS_JACKSON)
            if SAFETY_BY_CHANCE * distance > _GAIN * tolerance:  # the next run would not reach it
                return None
            coarse, caution = fine[chosen], SAFETY_BY_CHANCE
        return None
