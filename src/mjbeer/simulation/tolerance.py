"""Integration to a global tolerance, with an error estimate from the distance of two runs."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.model.setting import DOP853, GAUSS_JACKSON
from mjbeer.model.state import read
from mjbeer.simulation import radau, residual
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson import GaussJackson, plan
from mjbeer.simulation.radau import Radau
from mjbeer.simulation.recorder import Recorder
from mjbeer.theory.losses import stiffest
from mjbeer.theory.measure import angle_distance
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
_SAFETY = 1.5
"""Error estimate over the distance of two runs."""
_SAFETY_BY_CHANCE = 3.0
"""The same where two runs may agree by chance: from the third run on, and for tolerances outside `_ASYMPTOTIC`, where
rounding or large steps hide the method's order."""
_ASYMPTOTIC = (1e-11, 1e-5)
"""Range of tolerances in which the method's order shows: the finer run has an eighth of the other one's error."""
_STALLED = 0.75
"""Distance of two runs over that of the two runs before, above which the finer runs were no progress."""
_PATIENCE = 2
"""Number of times in a row that finer runs may be no progress: with too large steps their distance is arbitrary."""
_NUDGE = 4e-14
"""Distance of the first run's start from the given start, relative to `scales`. The distance of the first two runs then
includes the effect of a small change of the start, which is large beside a separatrix."""
_ROUNDING_OVER_NUDGE = 3 / 40
"""Estimated effect of rounding over the effect of `_NUDGE`: the rounding of a run is like a nudge of some 1e-15, with a
safety factor of 3."""
_NO_LOSS = 1e-2
"""Relative error of the model's accelerations over the tolerance, below which its effect is not looked at: it would
have to grow a hundredfold."""
_LOSS = 2.0
"""Estimated effect of that error over the effect of an equal nudge of the start (measured: up to 1.8)."""
_DRIFT = 0.5
"""Error of phi over that which the drift of the swing's energy implies at most: the rate of a rotation goes with the
square root of its energy, and the frequency of a swing depends on its energy less than that."""
_FAR = 4.0
"""Beside a barrier the frequency depends on the energy more, and _DRIFT grows: from where the energy is as near to that
of the barrier as a quarter of the largest kinetic energy (measured for swings of 2.85 rad: 2 instead of 0.5)."""
_NEAREST = 10.0
"""How many times _DRIFT is at most. Nearer to the barrier the drift would be that of rounding, and the distance of the
runs shows how much the motion amplifies."""
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
_STIFF = 3e5
"""Duration over the time in which damping brings can and load together, from which on a run takes an implicit method.
DOP853 has no step that is longer than 6.4 of these times, and would take a million evaluations or more."""
_STIFFEST = 1e12
"""Largest inverse of that time [1/s]. A torque changes by as much, times the rounding of a rate, 1e-15 rad/s or more,
over the inertia: a thousandth of a frozen load's accelerations, 100 rad/s^2."""
_COMPARED = 64
"""Largest number of samples at which two runs are compared; they are spread over the motion as unevenly as the golden
section, so that no period is a multiple of the gaps. A run that is only compared has no others, as a sample in every
step takes a quarter more evaluations."""
_GOLDEN = (math.sqrt(5) - 1) / 2
_EVALUATIONS = 5_000_000
"""Largest number of evaluations in one run, which take some seconds. A smooth motion takes thousands."""


@dataclass(frozen=True, eq=False)
class Solution:
    """The states of a run and an estimate of their error."""

    states: np.ndarray
    """States, shape (samples, nq + nv)."""
    estimate: float | None = None
    """Estimated error of phi and u/a [rad], relative beyond 1 rad; None if there was no second run."""
    record: Record | None = None
    """The record of all steps, if it was asked for."""
    integrator: str | None = None
    """The name of the integrator, if it was chosen for a tolerance."""


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


class Solver:
    """A model of a scene, set up to be integrated to global tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, data: mujoco.MjData | None = None) -> None:
        self._model, self._scene = model, scene
        self._explicit, self._scale = Integrator(model, data), scales(model, scene)
        self._integrator: Integrator | Radau = self._explicit
        try:
            self._smooth: GaussJackson | None = GaussJackson(model, self._explicit)
        except UnsupportedError:
            self._smooth = None
        # phi and u/a are sums of components of the state.
        unit = read(model, scene, np.eye(model.nq + model.nv), times=np.zeros(model.nq + model.nv))
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float = math.inf) -> Solution:
        """Return states at `times` [s] whose error of phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Each run has a local tolerance of an eighth of that of the run before, and the first starts `_NUDGE` from
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
        stiff = (rate := stiffest(self._scene)) * times[-1] > _STIFF
        if stiff and rate > _STIFFEST:
            raise _not_reached(
                tolerance,
                f"damping would bring can and load together {rate:.2g} times a second (at most {_STIFFEST:g}), and "
                "rounding of the slip rate hides its torque; a frozen load is their limit",
            )
        self._integrator = Radau(self._explicit) if stiff else self._explicit
        if (swift := self._by_gauss_jackson(start, times, tolerance, friction)) is not None:
            return swift
        local, stalled = max(min(_FIRST * tolerance, _COARSEST), _RATIO * _SMALLEST), 0
        safety, few = _safety(tolerance), _few(len(times))
        coarse = self._run(start + _NUDGE * self._scale, times[few], local=local, tolerance=tolerance)
        fine, record = self._recorded(start, times, local=local / _RATIO, tolerance=tolerance, friction=friction)
        first = before = self._distance(coarse, fine[few], start)
        estimate, drift, further = safety * first, self._drift(record), False
        while max(estimate, drift) > tolerance:
            if estimate <= tolerance:  # the drift may be that of a model which no smaller steps can cure
                self._loss(fine, start=start, times=times, local=local, tolerance=tolerance)
            local, further = local / _RATIO, True
            if local < _RATIO * _SMALLEST:
                apart = f"two runs at the limit of rounding differ by {before:.2g} rad"
                raise _not_reached(tolerance, apart if estimate > tolerance else _lost(drift))
            coarse = fine[few]
            fine, record = self._recorded(start, times, local=local / _RATIO, tolerance=tolerance, friction=friction)
            distance, drift_before, drift = self._distance(coarse, fine[few], start), drift, self._drift(record)
            estimate = _SAFETY_BY_CHANCE * max(distance, before / _RATIO)
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
        rounding = _ROUNDING_OVER_NUDGE * first if further else 0.0  # the first distance includes the nudge
        if rounding > tolerance:
            rounding = self._rounding_effect(fine[few], start=start, times=times[few], local=local, tolerance=tolerance)
        loss = self._loss(fine, start=start, times=times, local=local, tolerance=tolerance)
        return Solution(fine, max(estimate, drift, rounding, loss), record, radau.NAME if stiff else DOP853)

    def _drift(self, record: Record) -> float:
        """Return the error of phi and u/a [rad] that the drift of energy and momentum implies.

        A contact has no such drift to judge by: it takes energy, and gives it back. What damping takes in the long
        steps of an implicit method is not known to as many digits as these have.
        """
        if self._model.npair or isinstance(self._integrator, Radau):
            return 0.0
        gap = _FAR * record.to_barrier
        share = min(max(1.0, record.swing / gap), _NEAREST) if gap > 0 else _NEAREST
        return max(_DRIFT * share * record.swing_error, record.axis_error)

    def _rounding_effect(
        self, fine: np.ndarray, start: np.ndarray, times: np.ndarray, local: float, tolerance: float
    ) -> float:
        """Return the estimated effect of rounding on phi and u/a [rad], from two runs that start beside `start`.

        They start on either side, because from one side of a barrier's top all motions fall the same way.

        Raises:
          ToleranceError: if the effect is above `tolerance` [rad].
        """
        distances = []
        for side in (1, -1):
            nudged = self._run(start + side * _NUDGE * self._scale, times, local=local, tolerance=tolerance)
            distances.append(self._distance(nudged, fine, start))
        effect = _ROUNDING_OVER_NUDGE * max(distances)
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
        chosen = np.linspace(0, len(fine) - 1, min(residual.STATES, len(fine))).astype(int)
        _, loss = residual.residual(self._model, self._scene, fine[chosen], exact_constraint=True)
        if loss <= _NO_LOSS * tolerance:
            return 0.0
        few = _few(len(times))
        aside = self._run(start + min(loss, 1.0) * self._scale, times[few], local=local, tolerance=tolerance)
        effect = _LOSS * self._distance(aside, fine[few], start)
        if effect > tolerance:
            raise _not_reached(
                tolerance,
                f"with masses so unequal MuJoCo's equality loses {loss:.2g} of what moves the load, an error of "
                f'{effect:.2g} rad; rolling="reduced" loses nothing',
            )
        return effect

    def _by_gauss_jackson(
        self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float
    ) -> Solution | None:
        """Return the solution by Gauss-Jackson, or None where it does not reach the tolerance, or DOP853 is cheaper.

        A coarse run of DOP853 shows how long a timestep may be, and that two runs have not gone the same wrong way.
        """
        if (method := self._smooth) is None or tolerance > _LOOSE:
            return None
        pilot = _Pilot()
        try:
            (end,) = self._explicit.run(
                start, times[-1:], tolerance=_PILOT, scale=self._scale, limit=_EVALUATIONS, recorder=pilot
            )
            timestep, evaluations = plan(pilot.ends, tolerance, _PILOT)
            finer = (_PILOT * _RATIO / (_FIRST * tolerance)) ** (1 / 8)
            if not evaluations < _CHEAPER * finer * self._explicit.evaluations:
                return None
            few, safety, rounding = _few(len(times)), _safety(tolerance), None
            coarse = method.run(start + _NUDGE * self._scale, times[few], timestep)
            while True:
                timestep /= _FINER
                recorder = Recorder(self._model, self._scene, friction)
                fine = method.run(start, times, timestep, recorder)
                distance = self._distance(coarse, fine[few], start)
                first, rounding = rounding is None, rounding or _ROUNDING_OVER_NUDGE * distance
                estimate = max(safety * distance, self._drift(recorder.record), rounding)
                if estimate <= tolerance and self._distance(end[None], fine[-1:], start) <= _ASTRAY:
                    return Solution(fine, estimate, recorder.record, GAUSS_JACKSON)
                if not first or _SAFETY_BY_CHANCE * distance > _GAIN * tolerance:  # the next run would not reach it
                    return None
                coarse, safety = fine[few], _SAFETY_BY_CHANCE
        except DivergenceError:
            pass
        return None

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
                start, times, tolerance=local, scale=self._scale, limit=_EVALUATIONS, recorder=recorder
            )
        except DivergenceError as error:
            raise _not_reached(tolerance, str(error)) from error

    def _distance(self, coarse: np.ndarray, fine: np.ndarray, start: np.ndarray) -> float:
        """Return the largest distance of two runs in phi or u/a [rad], relative to the angle beyond 1 rad."""
        angles, truth, first = coarse @ self._angles, fine @ self._angles, start @ self._angles
        return max(angle_distance(angles[:, column], truth[:, column], float(first[column])) for column in (0, 1))


def _safety(tolerance: float) -> float:
    """Return the error estimate of a tolerance [rad] over the distance of the first two runs."""
    return _SAFETY if _ASYMPTOTIC[0] < tolerance < _ASYMPTOTIC[1] else _SAFETY_BY_CHANCE


def _few(samples: int) -> np.ndarray:
    """Return the indices of the samples at which two runs are compared: all, or `_COMPARED` of them with the last."""
    if samples <= _COMPARED:
        return np.arange(samples)
    spread = samples * (np.arange(1, _COMPARED) * _GOLDEN % 1)
    return np.unique(np.append(spread.astype(int), samples - 1))


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


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the size of each component of the state below which its error counts absolutely, shape (nq + nv,).

    It is a radius for lengths and 1 rad for angles, and these times sqrt(g/a) for their rates.
    """
    radius = scene.can.radius
    positions = np.where(model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
