"""Integration to a global tolerance: two runs of the eighth-order integrator judge each other."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer import dop853
from mjbeer.distance import farthest
from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.scene import Scene
from mjbeer.state import read

_FIRST = 1 / 64
"""Local tolerance of the first run per global tolerance: over some ten periods local errors add up to 10-20
times themselves (measured on all scenes), and the estimate is cautious."""
_RATIO = 8.0
"""Local tolerance of one run over that of the next: 1.3 times the evaluations at order 8."""
_CAUTION = 3.0
"""The estimate over the distance of two runs: where rounding rules, the finer run is off by as much as the other."""
_SMALLEST = 1e-16
"""Local tolerance below which a step's error is rounding."""
_EVALUATIONS = 5_000_000
"""Most evaluations that one run may take: some ten seconds. A smooth motion takes thousands."""


@dataclass(frozen=True, eq=False)
class Solution:
    """States, shape (samples, nq + nv), and the estimate of their error [rad], relative beyond 1 rad."""

    states: np.ndarray
    estimate: float


def solve(model: mujoco.MjModel, scene: Scene, start: np.ndarray, times: np.ndarray, tolerance: float) -> Solution:
    """States at `times` [s] whose error in phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

    The estimate is three times the distance of a run from a second one, eight times as fine, which is what is
    returned: as long as the method's error dominates, its own is an order of magnitude smaller.

    Raises:
      ToleranceError: if the runs do not come that close; the message says how close they came.
    """
    local = tolerance * _FIRST
    coarse, best = _run(model, scene, start, times, local, tolerance), np.inf
    while True:
        local /= _RATIO
        if local < _SMALLEST:
            raise ToleranceError(
                f"tolerance {tolerance:g} rad is not reached: two runs at the limit of rounding differ by "
                f"{best:.2g} rad"
            )
        fine = _run(model, scene, start, times, local, tolerance)
        estimate = _CAUTION * distance(model, scene, coarse, fine)
        if estimate <= tolerance:
            return Solution(fine, estimate)
        if estimate > best:
            raise ToleranceError(
                f"tolerance {tolerance:g} rad is not reached: two runs differ by {best:.2g} rad, and finer ones by "
                f"{estimate:.2g} rad; the motion is not smooth enough, or rounding has the upper hand"
            )
        coarse, best = fine, estimate


def distance(model: mujoco.MjModel, scene: Scene, one: np.ndarray, other: np.ndarray) -> float:
    """Largest difference of phi and of u/a between two runs [rad], relative to the angle where that exceeds 1 rad."""
    first, second = read(model, scene, one), read(model, scene, other)
    return max(farthest(first.phi, second.phi), farthest(first.u / scene.can.radius, second.u / scene.can.radius))


def _run(
    model: mujoco.MjModel, scene: Scene, start: np.ndarray, times: np.ndarray, local: float, tolerance: float
) -> np.ndarray:
    try:
        return dop853.integrate(model, start, times, tolerance=local, scale=scales(model, scene), limit=_EVALUATIONS)
    except DivergenceError as error:
        raise ToleranceError(f"tolerance {tolerance:g} rad is not reached: {error}") from error


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Size of each component of the state below which an error counts absolutely, shape (nq + nv,).

    Lengths count in radii, rates per sqrt(a/g).
    """
    radius = scene.can.radius
    slides = np.array([model.joint(i).type[0] == mujoco.mjtJoint.mjJNT_SLIDE for i in range(model.njnt)])
    positions = np.where(slides, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
