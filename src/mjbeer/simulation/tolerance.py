"""Integration to a global tolerance, with an error estimate from the distance of two runs."""

import math
from dataclasses import replace

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.model import check
from mjbeer.model.setting import DOP853, GAUSS_JACKSON
from mjbeer.model.state import read
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson import GaussJackson, plan
from mjbeer.simulation.stepping import LARGEST, Recorder, Solution
from mjbeer.theory.equations import stiffness
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import angle_distance

_SPREAD = 32
"""Number of times, evenly spread over a run, at which runs are compared besides the samples that are asked for."""
_SAFETY = 1.5
"""Error estimate over the distance of two runs."""
_SAFETY_BY_CHANCE = 3.0
"""The same from the third run on, where rounding counts, and for tolerances outside `_ASYMPTOTIC`: two runs may agree
by chance."""
_ASYMPTOTIC = (1e-11, 1e-5)
"""Range of tolerances in which rounding or large steps do not hide the method's order."""
_NUDGE = 4e-14
"""Distance of the first run's start from the given start, relative to `scales`. The distance of the first two runs then
includes the effect of a small change of the start, which is large beside a separatrix."""
_ROUNDING_OVER_NUDGE = 3 / 40
"""Estimated effect of rounding over that of the nudge: a run's rounding is like a nudge of some 1e-15; safety is 3."""
_CANCELLED = 0.1
"""That rounding over what MuJoCo loses of a small inertia, as a share of the larger ones that cancel in it."""

_FIRST = 0.07
"""Local tolerance of the first run over the global tolerance: over some ten periods errors add up to 2-20 times a local
tolerance (measured on all scenes)."""
_COARSEST = 1e-6
"""Largest local tolerance. With larger steps the two runs of a motion that spins up may have much the same error: one
of 2,000 runs was 7.5 times as far from the exact motion as from the other run."""
_RATIO = 8.0
"""Local tolerance of one run over that of the next. At order 8 the next one takes 1.3 times the evaluations."""
_ROUNDED_RATIO = 2.0
"""The same for distances that are counted on where both may be rounding: replays of the runs of light wheels, at 1,613
tolerances, then kept to all of them, the worst to 0.94 of it; with `_RATIO` five were missed, by up to 2.3."""
_SMALLEST = 1e-16
"""Local tolerance below which the error of a step is rounding."""
_STALLED = 0.75
"""Error estimate over that of the run before, above which the finer run was no progress."""
_PATIENCE = 2
"""Number of times in a row that finer runs may be no progress: with too large steps their distance is arbitrary."""
_EVALUATIONS = 5_000_000
"""Largest number of evaluations in one run, which take some seconds. A smooth motion takes thousands."""
_STABLE = 6.4 / 12
"""Longest step of DOP853 over the time in which damping brings can and load together, for each of its evaluations."""

_DRIFT = 1.5
"""Error of phi over that which the drift of the swing's energy implies at most: 0.5 for rotations and small swings, up
to 2 for swings of 2.85 rad. There the distance of the runs shows how much the motion amplifies."""
_MORE = 4
"""Evaluations of a run over those of the run before, from where on it is rounding that makes its steps small."""

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


class Solver:
    """A model of a scene, set up to be integrated to global tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, data: mujoco.MjData) -> None:
        self._model, self._scene, self._dop853 = model, scene, Integrator(model, data)
        self._scale, size = scales(model, scene), model.nq + model.nv
        unit = read(model, scene, np.eye(size), times=np.zeros(size))  # phi and u/a are sums of components of the state
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])
        rounding = max(1.0, _CANCELLED * scene.oscillator.swing / scene.oscillator.base)
        self._rounded = rounding > 1
        self._nudge, self._smallest = _NUDGE * rounding * self._scale, _SMALLEST * max(1.0, rounding / _RATIO**2)
        try:
            self._gauss_jackson: GaussJackson | None = GaussJackson(model, self._dop853)
        except UnsupportedError:
            self._gauss_jackson = None

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return states at `times` [s] whose error of phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Each run has a local tolerance of an eighth of that of the run before, and the first starts a nudge from
        `start`. The error estimate is a multiple of the distance of the last two runs at all samples, and no less than
        what the drift of energy and momentum implies: over many turns the errors of two runs may be the same by chance.
        From the third run on a share of the distance before counts if that is larger. None of these shows the effect of
        rounding; it is estimated by further runs where it may matter, and what an equality loses by its accelerations.

        Where Gauss-Jackson needs fewer evaluations, two of its runs are tried first. Otherwise all runs are DOP853's.
        The solution has the record of all steps of the last run, for a coefficient of `friction`.

        Raises:
          ToleranceError: if the runs do not come that close; the message names how close they came.
        """
        if (rate := _stiffest(self._scene)) * times[-1] > _STABLE * _EVALUATIONS:
            raise _not_reached(
                tolerance,
                f"damping brings can and load together {rate:.2g} times a second, and steps as short as that would be "
                f'too many over {times[-1]:.6g} s; integrator="implicitfast" has longer ones, and a frozen load is the '
                "limit",
            )
        along = np.union1d(times, np.linspace(0, times[-1], _SPREAD + 1))
        found = None
        if self._gauss_jackson is not None and tolerance <= _LOOSE:
            found = self._by_gauss_jackson(self._gauss_jackson, start, along, tolerance, friction)
        found = found or self._by_dop853(start, along, tolerance, friction)
        error = max(found.error or 0.0, self._loss(found, along, tolerance))
        return replace(found, states=found.states[np.searchsorted(along, times)], error=error)

    def _by_gauss_jackson(
        self, method: GaussJackson, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float
    ) -> Solution | None:
        """Return the solution, or None if it is not within the `tolerance` [rad], or DOP853 is cheaper.

        A coarse run of DOP853 shows how long a timestep may be, and that two runs have not gone the same wrong way.
        """
        ends, local = list[np.ndarray](), _FIRST * tolerance / _RATIO
        try:
            last = self._dop853.run(
                start, times[-1:], None, _PILOT, self._scale, _EVALUATIONS, lambda times, _: ends.append(times.copy())
            )
            timestep, evaluations = plan(np.concatenate(ends), tolerance, _PILOT)
            if not evaluations < _CHEAPER * self._dop853.evaluations * (_PILOT / local) ** (1 / 8):
                return None
            coarse, safety, rounding = method.run(start + self._nudge, times, timestep), self._safety(tolerance), 0.0
            for _ in range(2):
                timestep /= _FINER
                recorder = Recorder(self._model, self._scene, friction)
                fine = method.run(start, times, timestep, recorder)
                distance = self._distance(coarse, fine, start)
                rounding = rounding or _ROUNDING_OVER_NUDGE * distance  # the first distance includes the nudge
                error = max(safety * distance, self._drift(recorder.record), rounding)
                if error <= tolerance and self._distance(last, fine[-1:], start) <= _ASTRAY:
                    return Solution(fine, recorder.record, error, GAUSS_JACKSON)
                if _SAFETY_BY_CHANCE * distance > _GAIN * tolerance:  # the next run would not reach it
                    return None
                coarse, safety = fine, _SAFETY_BY_CHANCE
        except DivergenceError:
            pass
        return None

    def _by_dop853(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return the solution by ever finer runs of DOP853."""
        limit = _EVALUATIONS

        def run(start: np.ndarray, local: float, recorder: Recorder | None = None) -> np.ndarray:
            nonlocal limit
            try:
                states = self._dop853.run(start, times, None, local, self._scale, limit, recorder)
            except DivergenceError as error:
                raise _not_reached(tolerance, str(error)) from error
            limit = min(_EVALUATIONS, _MORE * self._dop853.evaluations)
            return states

        local = max(min(_FIRST * tolerance, _COARSEST), _RATIO * self._smallest)
        coarse, safety, stalled, estimate = run(start + self._nudge, local), self._safety(tolerance), 0, math.inf
        distances, ratio = [0.0], _ROUNDED_RATIO if self._rounded else _RATIO
        while True:
            local /= _RATIO
            recorder = Recorder(self._model, self._scene, friction, within=True)
            fine = run(start, local, recorder)
            distances.append(self._distance(coarse, fine, start))
            drift, error = self._drift(recorder.record), safety * max(distances[-1], distances[-2] / ratio)
            if max(error, drift) <= tolerance:
                break
            stalled = 0 if max(error, drift) <= _STALLED * estimate else stalled + 1
            if local < _RATIO * self._smallest or stalled > _PATIENCE:
                if error <= tolerance:
                    reason = f"two runs agree, but energy or momentum drift like an error of {drift:.2g} rad"
                else:
                    end = "with ever smaller steps" if stalled > _PATIENCE else "at the limit of rounding"
                    reason = f"two runs {end} differ by {distances[-1]:.2g} rad"
                raise _not_reached(tolerance, f"{reason}; the motion is not smooth, or rounding has the upper hand")
            coarse, estimate, safety = fine, max(error, drift), _SAFETY_BY_CHANCE
        rounding = _ROUNDING_OVER_NUDGE * distances[1] if distances[2:] else 0.0  # the first one includes the nudge
        if rounding > tolerance:
            # On either side of the start, because from one side of a barrier's top all motions fall the same way.
            beside = [run(start + side * self._nudge, local) for side in (1, -1)]
            rounding = _ROUNDING_OVER_NUDGE * max(self._distance(each, fine, start) for each in beside)
            if rounding > tolerance:
                raise _not_reached(tolerance, f"the rounding of the start grows to {rounding:.2g} rad")
        return Solution(fine, recorder.record, max(error, drift, rounding), DOP853)

    def _distance(self, coarse: np.ndarray, fine: np.ndarray, start: np.ndarray) -> float:
        """Return the largest distance of two runs in phi or u/a [rad], relative to the angle beyond 1 rad."""
        angles = zip((coarse @ self._angles).T, (fine @ self._angles).T, start @ self._angles, strict=True)
        return max(angle_distance(*each) for each in angles)

    def _drift(self, record: Record) -> float:
        """Return the error of phi and u/a [rad] that the drift of energy and momentum in a record implies."""
        if self._model.npair:  # a contact takes energy, and gives it back
            return 0.0
        return max(_DRIFT * record.swing_error_at_most, record.axis_error)

    def _loss(self, found: Solution, times: np.ndarray, tolerance: float) -> float:
        """Return the error [rad] that a joint equality makes whose sums lose what moves the load, in all runs alike."""
        if not self._model.neq:
            return 0.0
        motion = read(self._model, self._scene, found.states, times)
        assert found.record is not None
        lost = check.lost(self._model, self._scene, motion, found.record, exact_constraint=True)
        if lost > tolerance:
            raise _not_reached(
                tolerance,
                f"MuJoCo's equality between masses so unequal loses in rounding what moves the load, an error of "
                f'{lost:.2g} rad; rolling="reduced" loses nothing',
            )
        return lost

    def _safety(self, tolerance: float) -> float:
        """Return the error estimate of a tolerance [rad] over the distance of the first two runs."""
        smooth = _ASYMPTOTIC[0] < tolerance < _ASYMPTOTIC[1] and not self._rounded
        return _SAFETY if smooth else _SAFETY_BY_CHANCE


def _not_reached(tolerance: float, reason: str) -> ToleranceError:
    return ToleranceError(f"tolerance {tolerance:g} rad is not reached: {reason}")


def _stiffest(scene: Scene) -> float:
    """Return the largest rate at which damping brings can and load together [1/s], at the slip rates that may last.

    The weight of can and load, pulling at the rim, drives them apart at most at these.
    """
    if not scene.damping_law:
        return 0.0
    slip = min(scene.damping_law.rate(scene.mass * scene.gravity * scene.can.radius), LARGEST)
    angles = np.linspace(0, math.pi, 91)
    return float(stiffness(scene, angles, np.full_like(angles, slip), np.zeros_like(angles)).max())


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the size of each component of the state below which its error counts absolutely, shape (nq + nv,).

    It is a radius for lengths and 1 rad for angles, and these times sqrt(g/a) for their rates.
    """
    radius = scene.can.radius
    positions = np.where(model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
