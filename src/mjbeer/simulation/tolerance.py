"""Integration to a global tolerance, with an error estimate from the distance of two runs."""

import math

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError, UnsupportedError
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.gauss_jackson import GaussJackson
from mjbeer.integrators.uneven_time import OwnTime, own_time
from mjbeer.model.joints import joint_addresses
from mjbeer.model.mujoco_library import LARGEST
from mjbeer.simulation.fixed_step import Recorder, Solution
from mjbeer.simulation.smooth_recorder import SmoothRecorder
from mjbeer.theory.scene import Scene, relaxation_rate

_COMPARED = 256
"""Samples at which runs of Gauss-Jackson are compared, if there are more: an error changes within a part of a swing."""
_LIGHT, _BRIEF = 10.0, 4.0
"""How uneven J is over its least value, from which on a wheel is light: its load makes much of its error while it is
fast, at the lowest point. Two runs of Gauss-Jackson with the same error by chance were 2.8 times as far off as they
should have been; the second number is their safety. Rounding grows with the ratio, as large inertias cancel in the
small one, and so does the nudge."""
_LIGHTEST = 40.0
"""The same, from which on DOP853 takes the wheel: a step of Gauss-Jackson as a whole is too long for the passage."""
_SAFETY_BY_CHANCE = 3.0
"""Error estimate over the distance of two runs where they may agree by chance: from the third run on, where rounding
counts, and for tolerances outside `_ASYMPTOTIC`."""
_ASYMPTOTIC = (1e-11, 1e-5)
"""Range of tolerances in which rounding or large steps do not hide the method's order."""
_NUDGE = 4e-14
"""Distance of the first run's start from the given start, over the size of each component: the distance of the first
two runs then includes the effect of a small change of the start, which is large beside a separatrix."""
_PUSH = 2e-15
"""Steady change of phi_ddot in a nudged run of Gauss-Jackson, over g/a: it shows where a small change of energy on
the way matters and one of the start does not, as for a swing that comes near a barrier's top."""
_ROUNDING = 0.3
"""Effect of the rounding of Gauss-Jackson over that of nudge and push: in 1,500 random motions of sliding loads, judged
by motions of 33 digits, it was 0.1 at most and 0.01 in the median. With 0.15, 2 of 50,801 tolerances were broken."""
_CHORD, _CHORD_AT_MOST = 0.3, 4.0
"""The same for a frozen load, over the least cos(phi/2), and at most. MuJoCo takes the direction of the chord tendon
from its length, which vanishes there: beside a crest near phi = pi rounding may do more than the nudge does."""
_ROUNDING_OVER_NUDGE = 3 / 40
"""Estimated effect of rounding over that of the nudge: a run's rounding is like a nudge of some 1e-15; safety is 3."""

_FIRST = 0.05
"""Local tolerance of the first run over the global one: errors add up to 2-20 times a local one in ten periods."""
_COARSEST = 1e-6
"""Largest local tolerance: of 2,000 runs with larger steps one was 7.5 times as far from the exact motion as from the
other run."""
_FIRST_RATIO, _RATIO = 64.0, 8.0
"""Local tolerance of the first run over that of the second, and of any other over that of the next: 1.7 and 1.3 times
the evaluations. Errors scatter by ten about what a local tolerance lets expect: with a ratio of 8 the first two runs
were within a third of their common error once in 3,000 random liquids."""
_SMALLEST = 1e-16
"""Local tolerance below which the error of a step is rounding."""
_EVALUATIONS = 2_000_000
"""Largest number of evaluations in all runs of a call, which take some seconds. A smooth motion takes thousands."""
_STABLE = 6.4 / 12
"""Longest step of DOP853 over the time in which damping brings can and load together, for each of its evaluations."""

_DRIFT = 1.5
"""Error of phi over that which the drift of the swing's energy implies at most: 0.5 for rotations and small swings, up
to 2 for swings of 2.85 rad. There the distance of the runs shows how much the motion amplifies."""
_SHORTER = 1.25
"""Longest step of one run of DOP853 over that of the next, at least: a rotation is so even that steps of any length
keep a local tolerance, and two runs with the same steps have the same error."""

_FINER = 1.35
"""Timestep of one run of Gauss-Jackson over that of the next. The distance of the two is the error of the coarser one,
37 times that of the finer one, for which it is taken. At a ratio of 1.15 two errors of 1e-4 were 1e-6 apart."""
_SHARE, _REFERENCE, _ADDED, _POWER = 0.078, 1e-9, 1.5, 1 / 14
"""First timestep of Gauss-Jackson over the distance of the nearest pole, for an error of 1e-9 rad in a cycle; powers of
the number of cycles with which errors add up, and of an error with which a timestep grows. Nine of ten of 1,466 random
motions allow 1.03 times the timestep or more."""
_GAP = 2.5
"""Energy below or above the crest, over the depth of the well, from which on a load hardly lingers there: beside the
crest the time of a swing, and so its error, grows as the inverse of that energy."""
_TRIES = 3
"""Largest number of finer runs of Gauss-Jackson."""


class ToleranceLoop:
    """A model of a scene, set up to be integrated to global tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, dynamics: Dynamics) -> None:
        self._model, self._scene, self._dynamics = model, scene, dynamics
        joints, radius = joint_addresses(model), scene.can.radius
        rate = math.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
        sizes = np.array([radius if name in ("slide", "lift") else 1.0 for name in joints])
        self._scale = np.append(sizes, rate * sizes)
        """Size of each component of the state below which its error counts absolutely: of lengths a radius, of angles
        1 rad, and of their rates these times sqrt(g/a)."""
        parts = {"slide": (0.0, 1 / radius), "lift": (0.0, 0.0)}  # phi and u/a are sums of components of the state
        angle = 1.0, 0.0 if "slide" in joints else 1.0
        self._angles = np.array([parts.get(name, angle) for name in joints] + [(0.0, 0.0)] * model.nv)
        shape = scene.oscillator
        uneven = max(shape.coupling, shape.chord / 4) / shape.base  # half angles of a chord count half
        self._light, lightest = uneven > _LIGHT, uneven > _LIGHTEST
        self._size = _NUDGE * max(1.0, shape.coupling / (_LIGHT * shape.base)) * self._scale
        try:
            self._gauss_jackson = None if lightest else GaussJackson(model, self._dynamics)
        except UnsupportedError:
            self._gauss_jackson = None

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return states at `times` [s] whose error of phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Of a smooth motion, runs of Gauss-Jackson are tried first; otherwise all runs are DOP853's, with ever smaller
        local tolerances. The first starts a nudge from `start`. The error estimate is a multiple of the distance of the
        last two runs, and no less than what the drift of energy and momentum implies: over many turns the errors of two
        runs may be the same by chance. From the third run of DOP853 on a share of the distance before counts if that is
        larger. The solution has the record of all steps of the last run, for a coefficient of `friction`.

        Raises:
          ToleranceError: if the runs do not come that close; the message names how close they came.
        """
        if tolerance < 1e-15:
            raise _not_reached(tolerance, "less than 1e-15 rad is beyond the rounding of an angle")
        if (rate := _stiffest(self._scene)) * times[-1] > _STABLE * _EVALUATIONS:
            raise _not_reached(
                tolerance,
                f"damping brings can and load together {rate:.2g} times a second, and steps as short as that would be "
                f'too many over {times[-1]:.6g} s; integrator="implicitfast" has longer ones, and a frozen load is the '
                "limit",
            )
        self._left = _EVALUATIONS
        # The nudge adds to the energy of the swing by phi and by its rate, and the push by the first motion.
        phi, phi_dot = (float(part @ self._angles[: len(part), 0]) for part in np.split(start, 2))
        gain = float(self._scene.oscillator.acceleration(phi, phi_dot))
        self._push = math.copysign(_PUSH * (self._scale[-1] / self._scale[len(start) // 2 - 1]) ** 2, phi_dot or gain)
        self._nudge = self._size * np.repeat([math.copysign(1.0, -gain), math.copysign(1.0, phi_dot)], len(start) // 2)
        if self._gauss_jackson is not None:
            # What is asked for more loosely has the timestep of this tolerance, which is nearly the longest.
            tight = min(tolerance, _ASYMPTOTIC[1])
            if found := self._by_gauss_jackson(self._gauss_jackson, start, times, tight, friction):
                return found
        return self._by_dop853(start, times, tolerance, friction)

    def _by_gauss_jackson(
        self, method: GaussJackson, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float
    ) -> Solution | None:
        """Return the solution, or None if it is not within the `tolerance` [rad].

        The coarser of two runs is nudged, at its start and all along.
        """
        stride = 1 if self._light else math.ceil(len(times) / _COMPARED)
        compared = slice((len(times) - 1) % stride, None, stride)  # with the last one
        some_times = np.ascontiguousarray(times[compared])
        safety = _BRIEF if self._light else 1.0
        phi0, phi_dot0 = float(start[method.size - 1]), float(start[-1])
        timestep, fastest = _longest(self._scene, phi0, phi_dot0, times[-1], tolerance / safety)
        own = pendulum_time(self._scene, phi0, 1e-3 * tolerance, timestep * fastest)
        try:
            for _ in range(_TRIES):
                coarse = method.run(start + self._nudge, some_times, timestep, own, None, self._push, self._left / 2)
                self._left -= method.evaluations
                recorder = SmoothRecorder(self._model, self._scene, friction)
                fine = method.run(start, times, timestep / _FINER, own, recorder, 0.0, self._left / 2)
                self._left -= method.evaluations
                compare = np.ascontiguousarray(fine[compared])
                distance = _distance(self._angles, coarse, compare, start)
                record = recorder.record
                drift = max(_DRIFT * record.swing_error, record.axis_error)
                rounding = _ROUNDING
                if self._scene.oscillator.chord > 0:
                    chord = float(np.abs(np.cos(compare[:, method.size - 1] / 2)).min())
                    rounding = min(_CHORD_AT_MOST, _CHORD / chord)
                safety = max(safety, rounding)
                hopeful = max(safety * rounding * distance, drift) <= tolerance < safety * distance
                if hopeful or tolerance < _ASYMPTOTIC[0]:
                    # It may be the nudge alone, of which rounding is a part. Or rounding has made up for the nudge.
                    plain = method.run(start, some_times, timestep, own, None, 0.0, self._left / 2)
                    self._left -= method.evaluations
                    nudged = _distance(self._angles, coarse, plain, start)
                    distance = max(_distance(self._angles, plain, compare, start), rounding * nudged)
                error = max(safety * distance, drift)
                if error <= tolerance:
                    return Solution(fine, record, error, "GaussJackson")
                timestep *= min(1 / _FINER, (tolerance / error) ** (1 / 12))  # its order is 13: on the safe side
        except DivergenceError:
            pass
        return None

    def _by_dop853(self, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float) -> Solution:
        """Return the solution by ever finer runs of DOP853."""
        integrator, limit, longest = DOP853(self._model, self._dynamics), math.inf, math.inf

        def run(start: np.ndarray, local: float, recorder: Recorder | None = None) -> np.ndarray:
            nonlocal limit, longest
            most = min(limit, self._left)
            try:
                states = integrator.run(start, times, None, local, self._scale, most, longest, recorder)
            except DivergenceError as error:
                raise _not_reached(tolerance, str(error)) from error
            self._left -= integrator.evaluations
            # With four times the evaluations of the run before it is rounding that makes the steps small.
            limit, longest = 4 * integrator.evaluations, integrator.longest / _SHORTER
            return states

        local = max(min(_FIRST * tolerance, _COARSEST), _FIRST_RATIO * _SMALLEST)
        smooth = _ASYMPTOTIC[0] < tolerance <= _ASYMPTOTIC[1] and not (self._light or self._model.neq)
        # What Gauss-Jackson has not reached is beside a separatrix or near rounding, where errors are alike by chance.
        by_chance = _SAFETY_BY_CHANCE * (2 if self._light or self._gauss_jackson else 1)
        if self._light and tolerance < _ASYMPTOTIC[0]:
            by_chance *= 2  # of 3,597 tolerances of light wheels one, of 1e-12, was missed by 1.7 times
        safety = 1.0 if smooth else by_chance  # the distance is the error of the coarser run, and much larger
        coarse, stalled, estimate = run(start + self._nudge, local), 0, math.inf
        distances, ratios = [0.0], [1.0, _FIRST_RATIO]
        while True:
            local /= ratios[-1]
            recorder = Recorder(self._model, self._scene, friction, within=True)
            fine = run(start, local, recorder)
            distances.append(_distance(self._angles, coarse, fine, start))
            drift = max(_DRIFT * recorder.record.swing_error_at_most, recorder.record.axis_error)
            error = safety * max(distances[-1], distances[-2] / ratios[-2])
            if max(error, drift) <= tolerance:
                break
            stalled = 0 if max(error, drift) <= 0.75 * estimate else stalled + 1  # above that it is no progress
            ratios.append(min(_RATIO, local / _SMALLEST))
            # With too large steps the distance is arbitrary: a finer run may be no progress, even twice. With a local
            # tolerance of more than half of that before a run is hardly any finer.
            if ratios[-1] < 2 or stalled > 2:
                end = "with ever smaller steps" if stalled > 2 else "at the limit of rounding"
                apart = ", then by ".join(f"{each:.2g} rad" for each in distances[1:][-2:])
                raise _not_reached(
                    tolerance,
                    f"two runs {end} differ by {apart}; energy or momentum drift like an error of {drift:.2g} rad; the "
                    "motion is not smooth, or rounding has the upper hand",
                )
            coarse, estimate, safety = fine, max(error, drift), by_chance
        rounding = _ROUNDING_OVER_NUDGE * distances[1] if distances[2:] else 0.0  # the first one includes the nudge
        if rounding > tolerance:
            # On either side of the start, because from one side of a barrier's top all motions fall the same way.
            beside = [run(start + side * self._nudge, local) for side in (1, -1)]
            rounding = _ROUNDING_OVER_NUDGE * max(_distance(self._angles, each, fine, start) for each in beside)
            if rounding > tolerance:
                raise _not_reached(tolerance, f"the rounding of the start grows to {rounding:.2g} rad")
        return Solution(fine, recorder.record, max(error, drift, rounding), "DOP853")


def _not_reached(tolerance: float, reason: str) -> ToleranceError:
    return ToleranceError(f"tolerance {tolerance:g} rad is not reached: {reason}")


def _stiffest(scene: Scene) -> float:
    """Return the largest rate at which damping brings can and load together [1/s], at the slip rates that may last.

    The weight of can and load, pulling at the rim, drives them apart at most at these.
    """
    if not scene.damping_law:
        return 0.0
    slip = min(scene.damping_law.rate_at(scene.mass * scene.gravity * scene.can.radius), LARGEST)
    return float(relaxation_rate(scene, np.linspace(0, math.pi, 91), slip).max())


def pendulum_time(scene: Scene, phi0: float, *precision: float) -> OwnTime:
    """Return a time that passes as fast as time at `phi0` [rad], in which the load is a pendulum; see `own_time`."""
    return _in_units_of(scene, float(scene.oscillator.inertia(phi0)), *precision)


def even_at_most(scene: Scene) -> OwnTime:
    """Return the same time in a unit in which no step is longer than a timestep."""
    shape = scene.oscillator
    return _in_units_of(scene, shape.base + shape.chord + shape.coupling)


def _in_units_of(scene: Scene, inertia: float, *precision: float) -> OwnTime:
    """Return the time whose pace is sqrt(J / `inertia`)."""
    shape, arm = scene.oscillator, scene.load.moment / scene.effective_mass
    uneven, turns = (shape.coupling, 1.0) if shape.coupling > 0 else (shape.chord, 0.5)
    swing = shape.depth / inertia
    law = shape.ramp / inertia, swing * math.sin(shape.bottom), -swing * math.cos(shape.bottom)
    return own_time(shape.base / inertia, uneven / inertia, turns, *precision, share=arm, law=law)


def _longest(scene: Scene, phi0: float, phi_dot0: float, duration: float, tolerance: float) -> tuple[float, float]:
    """Return a timestep [s] with which runs of Gauss-Jackson of some `duration` [s] should keep a tolerance [rad].

    The second number is the largest rate of the load in the time of its uneven steps [rad/s].

    In the time of its uneven steps the load moves as a pendulum, whose inertia is that at the start. Without a slope
    its motion is an elliptic function, the nearest pole of which is at an imaginary time: K'(k) over the rate of small
    swings, where k^2 is the largest kinetic energy over that which turns the load over.
    """
    shape = scene.oscillator
    slope, depth, bottom = shape.ramp, shape.depth, shape.bottom
    inertia = shape.base + shape.chord * math.sin(phi0 / 2) ** 2 + shape.coupling * math.sin(phi0) ** 2
    mean = math.sqrt(shape.base + (shape.chord + shape.coupling) / 2)
    # Rest and crests are where V' = -slope + depth sin(phi - bottom) vanishes: the well around the start.
    lean = math.asin(max(-1.0, min(1.0, slope / depth))) if depth > 0 else 0.0
    well = bottom - lean + 2 * math.pi * round((phi0 - bottom + lean) / (2 * math.pi))
    energy = inertia * phi_dot0**2 / 2 - slope * phi0 - depth * math.cos(phi0 - bottom)
    crest, rest = well + math.copysign(math.pi, slope), well + 2 * lean
    most = max(0.0, energy + slope * rest + depth * math.cos(rest - bottom))
    over_crest = energy + slope * crest + depth * math.cos(crest - bottom)
    if turns := over_crest > 0 or abs(slope) >= depth:
        # It turns over and over, and a turn takes 2 pi mean(sqrt(J)) / sqrt(2 E), while E grows by 2 pi slope.
        most = (math.sqrt(2 * (most + 2 * depth)) + abs(slope) * duration / mean) ** 2 / 2
    if not depth > 0:
        return duration / 8, math.sqrt(2 * most / inertia)  # as for any motion that hardly moves
    one, modulus = 1.0, max(math.sqrt(most / (2 * depth)), 1e-3)  # smaller swings are as even
    turned = math.sqrt(2 * most) * duration / mean if turns else 4 * modulus
    while abs(one - modulus) > 1e-3 * one:  # their arithmetic-geometric mean is pi/2 over K'
        one, modulus = (one + modulus) / 2, math.sqrt(one * modulus)
    pole = math.pi / (2 * one) * math.sqrt(inertia / depth)
    cycles = math.sqrt(depth) / mean * duration / (2 * math.pi)
    slowed = max(1e-6, min(1.0, _GAP * abs(over_crest) / depth))
    allowed = tolerance / _REFERENCE * max(1.0, turned) * slowed / max(0.5, cycles) ** _ADDED
    return min(_SHARE * pole * allowed**_POWER, duration / 8), math.sqrt(2 * most / inertia)


def _distance(angles: np.ndarray, coarse: np.ndarray, fine: np.ndarray, start: np.ndarray) -> float:
    """Return the largest distance of two runs in phi or u/a [rad], relative to the angle beyond 1 rad.

    These are the products of a state and the two columns of `angles`. The distance from what is no number is infinite.
    """
    turned = np.maximum.accumulate(np.abs((fine - start) @ angles))
    distance = float((np.abs((fine - coarse) @ angles) / np.maximum(turned, 1.0)).max())
    return distance if distance < math.inf else math.inf
