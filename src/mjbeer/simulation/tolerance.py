"""Integration to a global tolerance: two runs of the eighth-order integrator judge each other."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.model.state import read
from mjbeer.simulation.dop853 import Integrator
from mjbeer.theory.measure import angle_distance
from mjbeer.theory.scene import Scene

_FIRST = 0.07
"""Local tolerance of the first run per global tolerance. Over some ten periods local errors add up to 2-20 times
themselves (measured on all scenes)."""
_COARSEST = 1e-6
"""Largest local tolerance. With larger steps a motion that spins up goes astray before the order shows, and two runs
may miss alike: one of 2,000 was 7.5 times as far off as from the other."""
_RATIO = 8.0
"""Local tolerance of one run over that of the next: 1.3 times the evaluations at order 8."""
_SMALLEST = 1e-16
"""Local tolerance below which a step's error is rounding."""
_CAUTION, _MORE_CAUTION = 1.5, 3.0
"""The estimate over the distance of two runs; the method leaves an eighth of it in the finer one. The greater one
is for pairs that may be near each other by chance: later ones, which start at the same place, and those of ..."""
_SMOOTH = (1e-11, 1e-5)
"""... tolerances outside these, where rounding rules, or where steps are too large for the method's order."""
_PROGRESS = 0.75
"""The distance of two runs over that of the two before, above which the finer ones brought nothing."""
_PATIENCE = 1
"""How often in a row they may: steps that are too large for a motion miss by anything."""
_NUDGE = 4e-14
"""How far from the start the first run starts, relative to the scales. What a motion beside a separatrix makes of that
is in the distance of the first two."""
_OF_NUDGE = 3 / 40
"""The estimate of what rounding does, over what the nudge does: rounding adds some 1e-15 to a run."""
_EVALUATIONS = 5_000_000
"""Most evaluations that one run may take: some seconds. A smooth motion takes thousands."""


@dataclass(frozen=True, eq=False)
class Solution:
    """States, shape (samples, nq + nv), and the estimate of their error [rad], relative beyond 1 rad."""

    states: np.ndarray
    estimate: float | None = None
    """None where nothing has been compared."""


class Solver:
    """A model of a scene set up to be integrated to tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene) -> None:
        self._integrator, self._scale = Integrator(model), scales(model, scene)
        # phi and u/a are sums of components of the state.
        unit = read(model, scene, np.eye(model.nq + model.nv), times=np.zeros(model.nq + model.nv))
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float) -> Solution:
        """States at `times` [s] whose error in phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        Each run keeps its steps' errors below an eighth of what the run before did, and the first one starts a little
        beside the `start`. The estimate is a multiple of the distance of the last two, or of an eighth of the one
        before: later ones may be near each other by chance. Nor do they show what the motion makes of rounding, which
        is looked at apart where the first two were so far from each other that it may matter.

        Raises:
          ToleranceError: if the runs do not come that close; the message says how close they came.
        """
        local, stalled = max(min(_FIRST * tolerance, _COARSEST), _RATIO * _SMALLEST), 0
        caution = _CAUTION if _SMOOTH[0] < tolerance < _SMOOTH[1] else _MORE_CAUTION
        coarse = self._run(start + _NUDGE * self._scale, times, local, tolerance)
        fine = self._run(start, times, local / _RATIO, tolerance)
        first = before = self._distance(coarse, fine)
        if caution * first <= tolerance:
            return Solution(fine, caution * first)
        while True:
            local /= _RATIO
            if local < _RATIO * _SMALLEST:
                raise ToleranceError(
                    f"tolerance {tolerance:g} rad is not reached: two runs at the limit of rounding differ by "
                    f"{before:.2g} rad"
                )
            coarse, fine = fine, self._run(start, times, local / _RATIO, tolerance)
            apart = self._distance(coarse, fine)
            estimate = _MORE_CAUTION * max(apart, before / _RATIO)
            if estimate <= tolerance:
                rounding = _OF_NUDGE * first
                if rounding > tolerance:
                    rounding = self._of_rounding(fine, start, times, local / _RATIO, tolerance)
                return Solution(fine, max(estimate, rounding))
            stalled = stalled + 1 if apart > _PROGRESS * before else 0
            if stalled > _PATIENCE:
                raise ToleranceError(
                    f"tolerance {tolerance:g} rad is not reached: two runs differ by {before:.2g} rad, and finer "
                    f"ones by {apart:.2g} rad; the motion is not smooth enough, or rounding has the upper hand"
                )
            before = apart

    def _of_rounding(
        self, fine: np.ndarray, start: np.ndarray, times: np.ndarray, local: float, tolerance: float
    ) -> float:
        """What the motion makes of rounding [rad], by runs that start a little beside the start, on either side: from
        the top of a barrier all that start on one side fall alike."""
        nudged = (self._run(start + side * _NUDGE * self._scale, times, local, tolerance) for side in (1, -1))
        made = _OF_NUDGE * max(self._distance(each, fine) for each in nudged)
        if made > tolerance:
            raise ToleranceError(
                f"tolerance {tolerance:g} rad is not reached: the motion makes {made:.2g} rad of a start's rounding"
            )
        return made

    def _run(self, start: np.ndarray, times: np.ndarray, local: float, tolerance: float) -> np.ndarray:
        try:
            return self._integrator.run(start, times, tolerance=local, scale=self._scale, limit=_EVALUATIONS)
        except DivergenceError as error:
            raise ToleranceError(f"tolerance {tolerance:g} rad is not reached: {error}") from error

    def _distance(self, one: np.ndarray, other: np.ndarray) -> float:
        """Largest difference of phi and of u/a [rad], relative to the angle where that exceeds 1 rad."""
        angles, truth = one @ self._angles, other @ self._angles
        return max(angle_distance(angles[:, column], truth[:, column]) for column in (0, 1))


def tuning(scene: Scene, rolling: str, timestep: float) -> float:
    """The timestep [s] to tune a model's constraints to where the steps are the integrator's own.

    A rigid equality only takes back what rounding lets slip. In half a swing of the smallest pendulum that fits into
    the can, sqrt(a/g), it does so gently enough not to limit the steps.
    """
    slow = scene.gravity > 0 and rolling == "equality"
    return float(np.sqrt(scene.can.radius / scene.gravity)) / 2 if slow else timestep


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Size of each component of the state below which an error counts absolutely, shape (nq + nv,).

    Lengths count in radii, rates per sqrt(a/g).
    """
    radius = scene.can.radius
    slides = np.array([model.joint(i).type[0] == mujoco.mjtJoint.mjJNT_SLIDE for i in range(model.njnt)])
    positions = np.where(slides, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
