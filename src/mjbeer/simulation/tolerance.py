"""Integration to a global tolerance, with an error estimate from the distance of two runs."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.model import check
from mjbeer.model.setting import DOP853, GAUSS_JACKSON
from mjbeer.model.state import read
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.dop853_kernel import LARGEST
from mjbeer.simulation.gauss_jackson import GaussJackson, plan
from mjbeer.simulation.stepping import Recorder, Solution, Watcher
from mjbeer.theory.equations import stiffness
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import angle_distance

_SAFETY = 1.5
"""Error estimate over the distance of two runs."""
_SAFETY_BY_CHANCE = 3.0
"""The same from the third run on, and for tolerances outside `_ASYMPTOTIC`, where two runs may agree by chance."""
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
_SMALLEST = 1e-16
"""Local tolerance below which the error of a step is rounding."""
_STALLED = 0.75
"""Distance of two runs over that of the two runs before, above which the finer runs were no progress."""
_PATIENCE = 2
"""Number of times in a row that finer runs may be no progress: with too large steps their distance is arbitrary."""
_EVERY = 2
"""Runs of DOP853 are compared at the end of every second step: each comparison takes the next run three evaluations."""
_EVALUATIONS = 5_000_000
"""Largest number of evaluations in one run, which take some seconds. A smooth motion takes thousands."""
_STABLE = 6.4 / 12
"""Longest step of DOP853 over the time in which damping brings can and load together, for each of its evaluations."""

_DRIFT = 0.5
"""Error of phi over that which the drift of the swing's energy implies at most: the rate of a rotation goes with the
square root of its energy, and the frequency of a swing depends on its energy less than that."""
_FAR = 4.0
"""Beside a barrier the frequency depends on the energy more, and _DRIFT grows: from where the energy is as near to that
of the barrier as a quarter of the largest kinetic energy (measured for swings of 2.85 rad: 2 instead of 0.5)."""
_NEAREST = 10.0
"""How many times _DRIFT is at most. Nearer to the barrier the drift would be that of rounding, and the distance of the
runs shows how much the motion amplifies."""
_NO_LOSS = 1e-2
"""Relative error of the model's accelerations over the tolerance, below which it would have to grow a hundredfold."""
_LOSS = 2.0
"""Estimated effect of that error over the effect of an equal nudge of the start (measured: up to 1.8)."""

_LOOSE = 3e-5
"""Largest tolerance for which Gauss-Jackson is tried; from there on its least evaluations are more than DOP853's."""
_PILOT = 1e-4
"""Local tolerance of the run of DOP853 that shows how long a timestep of Gauss-Jackson may be."""
_ASTRAY = 0.1
"""Largest distance [rad], relative beyond 1 rad, of that run from those of Gauss-Jackson at the end."""
_FINER = 1.2
"""Timestep of one run of Gauss-Jackson over that of the next."""
_SHARED = 5
"""Number of timesteps after which those of one run of Gauss-Jackson end with one of the next, which has six."""
_GAIN = 9.0
"""Error of one run of Gauss-Jackson over that of the next, 1.2^12."""
_CHEAPER = 0.8
"""Largest number of evaluations of Gauss-Jackson over those of DOP853 to the tolerance, at which it is tried: it takes
two runs that are nearly alike, where the first of two runs of DOP853 takes three quarters of the second one."""


class _Ends:
    """Keeps the ends of all steps of a run, and shows them to another `Watcher`, too."""

    def __init__(self, further: Watcher | None = None) -> None:
        self._further, self._kept = further, list[tuple[np.ndarray, np.ndarray]]()

    def __call__(self, times: np.ndarray, states: np.ndarray, slopes: np.ndarray | None) -> None:
        self._kept.append((times.copy(), states.copy()))
        if self._further:
            self._further(times, states, slopes)

    def times_and_states(self) -> tuple[np.ndarray, np.ndarray]:
        times, states = zip(*self._kept, strict=True)
        return np.concatenate(times), np.concatenate(states)


@dataclass(frozen=True, eq=False)
class _Run:
    """A run that is compared with the one before: at all samples, and at the ends of steps of the one before.

    The motion is looked at everywhere in this way, whatever samples were asked for: what is brief takes short steps.
    """

    states: np.ndarray
    """States at the samples."""
    ends: np.ndarray
    """Times [s] at which the next run is compared with this one, besides the samples."""
    at_ends: np.ndarray
    record: Record | None
    distance: float = math.inf
    """Largest distance in phi and u/a [rad] from the run before, relative beyond 1 rad."""


class Solver:
    """A model of a scene, set up to be integrated to global tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, data: mujoco.MjData) -> None:
        self._model, self._scene, self._dop853 = model, scene, Integrator(model, data)
        self._scale, form = scales(model, scene), scene.oscillator
        # phi and u/a are sums of components of the state.
        unit = read(model, scene, np.eye(model.nq + model.nv), times=np.zeros(model.nq + model.nv))
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])
        rounding = max(1.0, _CANCELLED * form.swing / form.base)
        self._nudge, self._smallest = _NUDGE * rounding * self._scale, _SMALLEST * max(1.0, rounding / _RATIO**2)
        try:
            self._gauss_jackson: GaussJackson | None = GaussJackson(model, self._dop853)
        except UnsupportedError:
            self._gauss_jackson = None

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return states at `times` [s] whose error of phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Each run has a local tolerance of an eighth of that of the run before, and the first starts a nudge from
        `start`. The error estimate is a multiple of the distance of the last two runs, and no less than what the drift
        of energy and momentum implies: over many turns the errors of two runs may be the same by chance. From the third
        run on an eighth of the distance before counts if that is larger. None of these shows the effect of rounding; it
        is estimated by further runs where it may matter.

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
        found = None
        if self._gauss_jackson is not None and tolerance <= _LOOSE:
            found = self._by_gauss_jackson(self._gauss_jackson, start, times, tolerance, friction)
        return self._by_dop853(start, times, tolerance, friction) if found is None else found

    def _by_gauss_jackson(
        self, method: GaussJackson, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float
    ) -> Solution | None:
        """Return the solution, or None if it is not within the `tolerance` [rad], or DOP853 is cheaper.

        A coarse run of DOP853 shows how long a timestep may be, and that two runs have not gone the same wrong way.
        """
        pilot = _Ends()
        try:
            (end,) = self._dop853.run(
                start, times[-1:], tolerance=_PILOT, scale=self._scale, limit=_EVALUATIONS, watch=pilot
            )
            timestep, evaluations = plan(pilot.times_and_states()[0], tolerance, _PILOT)
            local = _FIRST * tolerance / _RATIO
            if not evaluations < _CHEAPER * self._dop853.evaluations * (_PILOT / local) ** (1 / 8):
                return None
            coarse = self._take(partial(method.run, timestep=timestep), start + self._nudge, times, stride=_SHARED)
            safety, rounding = _safety(tolerance), 0.0
            for further in (False, True):
                timestep /= _FINER
                fine = self._take(
                    partial(method.run, timestep=timestep), start, times, coarse, friction, stride=_SHARED
                )
                if not further:
                    rounding = _ROUNDING_OVER_NUDGE * fine.distance  # the first distance includes the nudge
                error = max(safety * fine.distance, self._drift(fine), rounding)
                if error <= tolerance and self._distance(end[None], fine.states[-1:], start) <= _ASTRAY:
                    return Solution(fine.states, fine.record, error, GAUSS_JACKSON)
                if _SAFETY_BY_CHANCE * fine.distance > _GAIN * tolerance:  # the next run would not reach it
                    return None
                coarse, safety = fine, _SAFETY_BY_CHANCE
        except DivergenceError:
            pass
        return None

    def _by_dop853(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return the solution by ever finer runs of DOP853."""
        local, stalled = max(min(_FIRST * tolerance, _COARSEST), _RATIO * self._smallest), 0
        run = partial(self._integrate, times=times, tolerance=tolerance)
        coarse = run(start + self._nudge, local=local)
        local /= _RATIO
        fine = run(start, local=local, before=coarse, friction=friction)
        first, further = fine.distance, False
        error, drift = _safety(tolerance) * first, self._drift(fine)
        while max(error, drift) > tolerance:
            if error <= tolerance:  # the drift may be that of a model which no smaller steps can cure
                self._loss(fine.states, start, partial(run, local=local), tolerance)
            if local < _RATIO * self._smallest:
                reason = f"two runs at the limit of rounding differ by {fine.distance:.2g} rad"
                raise _not_reached(tolerance, reason if error > tolerance else _lost(drift))
            coarse, local, drift_before, further = fine, local / _RATIO, drift, True
            fine = run(start, local=local, before=coarse, friction=friction)
            error, drift = _SAFETY_BY_CHANCE * max(fine.distance, coarse.distance / _RATIO), self._drift(fine)
            now, then = (fine.distance, coarse.distance) if error > tolerance else (drift, drift_before)
            stalled = 0 if now <= _STALLED * then else stalled + 1
            if max(error, drift) > tolerance and stalled > _PATIENCE:
                reason = (
                    f"two runs differ by {coarse.distance:.2g} rad, and finer ones by {fine.distance:.2g} rad; the "
                    "motion is not smooth enough, or rounding has the upper hand"
                )
                raise _not_reached(tolerance, reason if error > tolerance else _lost(drift))
        rounding = _ROUNDING_OVER_NUDGE * first if further else 0.0  # the first distance includes the nudge
        if rounding > tolerance:
            # On either side of the start, because from one side of a barrier's top all motions fall the same way.
            starts = start + self._nudge, start - self._nudge
            rounding = _ROUNDING_OVER_NUDGE * max([run(each, local=local, before=fine).distance for each in starts])
            if rounding > tolerance:
                raise _not_reached(tolerance, f"the rounding of the start grows to {rounding:.2g} rad")
        loss = self._loss(fine.states, start, partial(run, local=local), tolerance)
        return Solution(fine.states, fine.record, max(error, drift, rounding, loss), DOP853)

    def _distance(self, coarse: np.ndarray, fine: np.ndarray, start: np.ndarray) -> float:
        """Return the largest distance of two runs in phi or u/a [rad], relative to the angle beyond 1 rad."""
        angles, truth, first = coarse @ self._angles, fine @ self._angles, start @ self._angles
        return max(angle_distance(angles[:, column], truth[:, column], float(first[column])) for column in (0, 1))

    def _drift(self, run: _Run) -> float:
        """Return the error of phi and u/a [rad] that the drift of energy and momentum in a run's record implies."""
        record = run.record
        assert record is not None
        if self._model.npair:  # a contact takes energy, and gives it back
            return 0.0
        gap = _FAR * record.to_barrier
        share = min(max(1.0, record.swing / gap), _NEAREST) if gap > 0 else _NEAREST
        return max(_DRIFT * share * record.swing_error_at_most, record.axis_error)

    def _take(
        self,
        method: Callable[..., np.ndarray],
        start: np.ndarray,
        times: np.ndarray,
        before: _Run | None = None,
        friction: float | None = None,
        stride: int = _EVERY,
    ) -> _Run:
        """Return a run by a method, compared with the run `before`; with a record if there is a `friction`.

        The next run is compared with it at the end of each step whose number is a multiple of `stride`.
        """
        recorder = None if friction is None else Recorder(self._model, self._scene, friction)
        watch = _Ends(recorder)
        if before is None:
            states, distance = method(start, times, watch=watch), math.inf
        else:
            along = np.concatenate([times, before.ends])
            order, found = np.argsort(along, kind="stable"), np.empty((len(along), len(start)))
            found[order] = method(start, along[order], watch=watch)
            states = found[: len(times)]
            distance = self._distance(before.states, states, start)
            if len(before.ends):
                distance = max(distance, self._distance(before.at_ends, found[len(times) :], start))
        ends, at_ends = watch.times_and_states()
        chosen = slice(stride, int(np.searchsorted(ends, times[-1])), stride)
        return _Run(states, ends[chosen], at_ends[chosen], recorder.record if recorder else None, distance)

    def _integrate(
        self,
        start: np.ndarray,
        times: np.ndarray,
        local: float,
        tolerance: float,
        before: _Run | None = None,
        friction: float | None = None,
    ) -> _Run:
        """Return a run of DOP853 with a `local` tolerance; the `tolerance` is only for the error message."""
        method = partial(self._dop853.run, tolerance=local, scale=self._scale, limit=_EVALUATIONS)
        try:
            return self._take(method, start, times, before, friction)
        except DivergenceError as error:
            raise _not_reached(tolerance, str(error)) from error

    def _loss(self, fine: np.ndarray, start: np.ndarray, run: Callable[[np.ndarray], _Run], tolerance: float) -> float:
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
        effect = _LOSS * self._distance(run(start + min(loss, 1.0) * self._scale).states, fine, start)
        if effect > tolerance:
            raise _not_reached(
                tolerance,
                f"with masses so unequal MuJoCo's equality loses {loss:.2g} of what moves the load, an error of "
                f'{effect:.2g} rad; rolling="reduced" loses nothing',
            )
        return effect


def _safety(tolerance: float) -> float:
    """Return the error estimate of a tolerance [rad] over the distance of the first two runs."""
    return _SAFETY if _ASYMPTOTIC[0] < tolerance < _ASYMPTOTIC[1] else _SAFETY_BY_CHANCE


def _not_reached(tolerance: float, reason: str) -> ToleranceError:
    return ToleranceError(f"tolerance {tolerance:g} rad is not reached: {reason}")


def _lost(drift: float) -> str:
    return (
        f"two runs agree, but energy or momentum drift like an error of {drift:.2g} rad; the model loses in rounding "
        "what moves it"
    )


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
