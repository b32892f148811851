"""Integration to a global tolerance, with an error estimate from the distance of two runs."""

import math

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.model import check
from mjbeer.model.setting import DOP853
from mjbeer.simulation import radau
from mjbeer.simulation.comparison import NUDGE, ROUNDING_OVER_NUDGE, SAFETY_BY_CHANCE, Comparison, few, safety
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson_pair import GaussJacksonPair
from mjbeer.simulation.radau import Radau
from mjbeer.simulation.recorder import Recorder
from mjbeer.simulation.solution import Solution
from mjbeer.theory.losses import stiffest
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

_FIRST = 0.07
"""Local tolerance of the first run over the global tolerance. Over some ten periods the local errors add up to 2-20
times a local tolerance (measured on all scenes)."""
_COARSEST = 1e-6
"""Largest local tolerance. With larger steps the two runs of a motion that spins up may have much the same error: one
of 2,000 runs was 7.5 times as far from the exact motion as from the other run."""
_RATIO = 8.0
"""Local tolerance of one run over that of the next. At order 8 the next one takes 1.3 times the evaluations."""
_SMALLEST = 1e-16
"""Local tolerance below which the error of a step is rounding."""
_STALLED = 0.75
"""Distance of two runs over that of the two runs before, above which the finer runs were no progress."""
_PATIENCE = 2
"""Number of times in a row that finer runs may be no progress: with too large steps their distance is arbitrary."""
_NO_LOSS = 1e-2
"""Relative error of the model's accelerations over the tolerance, below which its effect is not looked at: it would
have to grow a hundredfold."""
_LOSS = 2.0
"""Estimated effect of that error over the effect of an equal nudge of the start (measured: up to 1.8)."""
_STIFF = 3e5
"""Duration over the time in which damping brings can and load together, from which on a run takes an implicit method.
DOP853 has no step that is longer than 6.4 of these times, and would take a million evaluations or more."""
_STIFFEST = 1e12
"""Largest inverse of that time [1/s]. A torque changes by as much, times the rounding of a rate, 1e-15 rad/s or more,
over the inertia: a thousandth of a frozen load's accelerations, 100 rad/s^2."""
_EVALUATIONS = 5_000_000
"""Largest number of evaluations in one run, which take some seconds. A smooth motion takes thousands."""


class Solver:
    """A model of a scene, set up to be integrated to global tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, data: mujoco.MjData | None = None) -> None:
        self._model, self._scene = model, scene
        self._explicit, self._compare = Integrator(model, data), Comparison(model, scene)
        self._integrator: Integrator | Radau = self._explicit
        try:
            self._pair: GaussJacksonPair | None = GaussJacksonPair(
                model, scene, explicit=self._explicit, comparison=self._compare, limit=_EVALUATIONS
            )
        except UnsupportedError:
            self._pair = None

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float = math.inf) -> Solution:
        """Return states at `times` [s] whose error of phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Each run has a local tolerance of an eighth of that of the run before, and the first starts `NUDGE` from
        `start`. The error estimate is a multiple of the distance of the last two runs, and no less than what the drift
        of energy and momentum implies: over many turns the errors of two runs may be the same by chance. From the third
        run on an eighth of the distance before counts if that is larger. None of these shows the effect of rounding; it
        is estimated by further runs where it may matter.

        Where Gauss-Jackson needs fewer evaluations, two of its runs are tried first. Otherwise all runs are
        DOP853's, or Radau's if the motion is stiff.

        The solution has the record of all steps of the last run, for a coefficient of `friction`.

        Raises:
          ToleranceError: if the runs do not come that close; the message names how close they came.
        """
        stiff = self._is_stiff(times[-1], tolerance)
        self._integrator = Radau(self._explicit) if stiff else self._explicit
        pair, local = self._pair, _FIRST * tolerance / _RATIO
        if pair is not None and (swift := pair.solve(start, times, tolerance, local, friction)) is not None:
            return swift
        local, stalled = max(min(_FIRST * tolerance, _COARSEST), _RATIO * _SMALLEST), 0
        chosen = few(len(times))
        coarse = self._run(self._compare.aside(start), times[chosen], local=local, tolerance=tolerance)
        fine, record = self._recorded(start, times, local=local / _RATIO, tolerance=tolerance, friction=friction)
        first = before = self._compare.distance(coarse, fine[chosen], start)
        estimate, drift, further = safety(tolerance) * first, self._drift(record), False
        while max(estimate, drift) > tolerance:
            if estimate <= tolerance:  # the drift may be that of a model which no smaller steps can cure
                self._loss(fine, start=start, times=times, local=local, tolerance=tolerance)
            local, further = local / _RATIO, True
            if local < _RATIO * _SMALLEST:
                apart = f"two runs at the limit of rounding differ by {before:.2g} rad"
                raise _not_reached(tolerance, apart if estimate > tolerance else _lost(drift))
            coarse = fine[chosen]
            fine, record = self._recorded(start, times, local=local / _RATIO, tolerance=tolerance, friction=friction)
            distance = self._compare.distance(coarse, fine[chosen], start)
            drift_before, drift = drift, self._drift(record)
            estimate = SAFETY_BY_CHANCE * max(distance, before / _RATIO)
            progress = distance <= _STALLED * before if estimate > tolerance else drift <= _STALLED * drift_before
            stalled = 0 if progress else stalled + 1
            if max(estimate, drift) > tolerance and stalled > _PATIENCE:
                apart = (
                    f"two runs differ by {before:.2g} rad, and finer ones by {distance:.2g} rad; the motion is not "
                    "smooth enough, or rounding has the upper hand"
                )
                raise _not_reached(tolerance, apart if estimate > tolerance else _lost(drift))
            before = distance
        local /= _RATIO
        rounding = ROUNDING_OVER_NUDGE * first if further else 0.0  # the first distance includes the nudge
        if rounding > tolerance:
            rounding = self._rounding_effect(fine, start=start, times=times, local=local, tolerance=tolerance)
        loss = self._loss(fine, start=start, times=times, local=local, tolerance=tolerance)
        return Solution(fine, max(estimate, drift, rounding, loss), record, radau.NAME if stiff else DOP853)

    def _is_stiff(self, duration: float, tolerance: float) -> bool:
        """Return whether damping makes the motion over a `duration` [s] stiff.

        Raises:
          ToleranceError: if it is too stiff for any method; the `tolerance` is only for the message.
        """
        rate = stiffest(self._scene)
        if rate * duration <= _STIFF:
            return False
        if rate > _STIFFEST:
            raise _not_reached(
                tolerance,
                f"damping would bring can and load together {rate:.2g} times a second (at most {_STIFFEST:g}), and "
                "rounding of the slip rate hides its torque; a frozen load is their limit",
            )
        return True

    def _drift(self, record: Record) -> float:
        """Return the error of phi and u/a [rad] that the drift of energy and momentum implies.

        What damping takes in the long steps of an implicit method is not known to as many digits as these have.
        """
        return 0.0 if isinstance(self._integrator, Radau) else self._compare.drift(record)

    def _rounding_effect(
        self, fine: np.ndarray, start: np.ndarray, times: np.ndarray, local: float, tolerance: float
    ) -> float:
        """Return the estimated effect of rounding on phi and u/a [rad], from two runs that start beside `start`.

        They start on either side, because from one side of a barrier's top all motions fall the same way.

        Raises:
          ToleranceError: if the effect is above `tolerance` [rad].
        """
        distances, chosen = [], few(len(times))
        for side in (1, -1):
            nudged = self._run(
                self._compare.aside(start, side * NUDGE), times[chosen], local=local, tolerance=tolerance
            )
            distances.append(self._compare.distance(nudged, fine[chosen], start))
        effect = ROUNDING_OVER_NUDGE * max(distances)
        if effect > tolerance:
            raise _not_reached(tolerance, f"the rounding of the start grows to {effect:.2g} rad")
        return effect

    def _loss(self, fine: np.ndarray, start: np.ndarray, times: np.ndarray, local: float, tolerance: float) -> float:
        """Return the estimated effect on phi and u/a [rad] of what MuJoCo's sums lose in rounding, if it may matter.

        It is that of a start as far aside as the model's accelerations are from theory's, relative to them. Only an
        equality between very unequal masses loses that much.

        Raises:
          ToleranceError: if the effect is above `tolerance` [rad].
        """
        if not self._model.neq:
            return 0.0
        chosen = np.linspace(0, len(fine) - 1, min(check.STATES, len(fine))).astype(int)
        _, loss = check.residual(self._model, self._scene, fine[chosen], exact_constraint=True)
        if loss <= _NO_LOSS * tolerance:
            return 0.0
        chosen = few(len(times))
        aside = self._run(self._compare.aside(start, min(loss, 1.0)), times[chosen], local=local, tolerance=tolerance)
        effect = _LOSS * self._compare.distance(aside, fine[chosen], start)
        if effect > tolerance:
            raise _not_reached(
                tolerance,
                f"with masses so unequal MuJoCo's equality loses {loss:.2g} of what moves the load, an error of "
                f'{effect:.2g} rad; rolling="reduced" loses nothing',
            )
        return effect

    def _recorded(
        self, start: np.ndarray, times: np.ndarray, local: float, tolerance: float, friction: float
    ) -> tuple[np.ndarray, Record]:
        """Return the states of one run of DOP853 or Radau with a `local` tolerance, and its record."""
        recorder = Recorder(self._model, self._scene, friction)
        return self._run(start, times, local=local, tolerance=tolerance, recorder=recorder), recorder.record

    def _run(
        self, start: np.ndarray, times: np.ndarray, local: float, tolerance: float, recorder: Recorder | None = None
    ) -> np.ndarray:
        """Return the states of one run of DOP853 or Radau with a `local` tolerance.

        The `tolerance` is only for the error message.
        """
        try:
            return self._integrator.run(
                start, times, tolerance=local, scale=self._compare.scale, limit=_EVALUATIONS, recorder=recorder
            )
        except DivergenceError as error:
            raise _not_reached(tolerance, str(error)) from error


def _not_reached(tolerance: float, reason: str) -> ToleranceError:
    return ToleranceError(f"tolerance {tolerance:g} rad is not reached: {reason}")


def _lost(drift: float) -> str:
    return (
        f"two runs agree, but energy or momentum drift like an error of {drift:.2g} rad; the model loses in rounding "
        "what moves it"
    )


def tuning(scene: Scene, rolling: str, timestep: float) -> float:
    """Return the timestep [s] to which a model's constraints are tuned if the integrator chooses its own steps.

    A rigid equality only has to correct the slip that rounding causes. With sqrt(a/g)/2, a twelfth of the period
    of a pendulum of length a, the correction is too slow to limit the steps.
    """
    slow = scene.gravity > 0 and rolling == "equality"
    return float(np.sqrt(scene.can.radius / scene.gravity)) / 2 if slow else timestep
