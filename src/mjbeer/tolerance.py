"""Integration to a global tolerance: two runs of the eighth-order integrator judge each other."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.distance import farthest
from mjbeer.dop853 import Integrator
from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.scene import Scene
from mjbeer.state import read

_ORDER = 8
_FIRST = 0.07
"""Local tolerance of the first run per global tolerance. Over some ten periods local errors add up to 2-20 times
themselves (measured on all scenes)."""
_FINER = 1.3
"""Steps of the second run for each of the first one's: an eighth of its error."""
_LEAST, _MOST = 1.1, 4.0
"""Fewest and most steps of a later run for each of the run before."""
_CAUTION = 1.5
"""The estimate over the distance of the first two runs: ten times what the method leaves of it."""
_CAUTION_LATER = 3.0
"""The same for later ones, which start at the same place: where rounding rules, they may be near by chance."""
_NEAR_ROUNDING = 1e-11
"""Tolerance from which down the first two are judged like later ones."""
_PROGRESS = 0.75
"""The distance of two runs over that of the two before, above which finer ones are not worth it."""
_NUDGE = 4e-14
"""How far from the start the first run starts, relative to the scales. Rounding adds some 1e-15 to a run; what a
motion beside a separatrix makes of that is in the distance of the first two, forty times as large."""
_EVALUATIONS = 5_000_000
"""Most evaluations that one run may take: some seconds. A smooth motion takes thousands."""


@dataclass(frozen=True, eq=False)
class Solution:
    """States, shape (samples, nq + nv), and the estimate of their error [rad], relative beyond 1 rad."""

    states: np.ndarray
    estimate: float


class Solver:
    """A model of a scene set up to be integrated to tolerances."""

    def __init__(self, model: mujoco.MjModel, scene: Scene) -> None:
        self._integrator, self._scale = Integrator(model), scales(model, scene)
        unit = read(model, scene, np.eye(model.nq + model.nv))
        # phi and u/a are sums of components of the state.
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])

    def run(self, start: np.ndarray, times: np.ndarray, tolerance: float) -> Solution:
        """States at `times` [s] whose error in phi and u/a is below `tolerance` [rad] (relative beyond 1 rad).

        The first run chooses its steps, and starts a little beside the `start`; each other one divides the steps of
        the run before. The estimate is a multiple of the distance of the last two.

        Raises:
          ToleranceError: if the runs do not come that close; the message says how close they came.
        """
        finer, before = _FINER, np.inf
        caution = _CAUTION if tolerance > _NEAR_ROUNDING else _CAUTION_LATER
        local, beside = _FIRST * tolerance, start + _NUDGE * self._scale
        try:
            coarse = self._integrator.run(beside, times, tolerance=local, scale=self._scale, limit=_EVALUATIONS)
            while True:
                mesh = refine(self._integrator.mesh, finer)
                if len(mesh) * 12 > _EVALUATIONS:
                    raise DivergenceError(f"{len(mesh)} steps would be too many")
                fine = self._integrator.run(start, times, mesh=mesh)
                apart = self._distance(coarse, fine)
                estimate = caution * apart
                if estimate <= tolerance:
                    return Solution(fine, estimate)
                if apart > _PROGRESS * before:
                    raise ToleranceError(
                        f"tolerance {tolerance:g} rad is not reached: two runs differ by {before:.2g} rad, and finer "
                        f"ones by {apart:.2g} rad; the motion is not smooth enough, or rounding has the upper hand"
                    )
                coarse, before, caution = fine, apart, _CAUTION_LATER
                # The next distance is the error of the finer run, a tenth of the estimate.
                finer = min(max(_LEAST, _FINER * (estimate / (5 * tolerance)) ** (1 / _ORDER)), _MOST)
        except DivergenceError as error:
            raise ToleranceError(f"tolerance {tolerance:g} rad is not reached: {error}") from error

    def _distance(self, one: np.ndarray, other: np.ndarray) -> float:
        """Largest difference of phi and of u/a [rad], relative to the angle where that exceeds 1 rad."""
        angles, truth = one @ self._angles, other @ self._angles
        return max(farthest(angles[:, column], truth[:, column]) for column in (0, 1))


def tuning(scene: Scene, rolling: str, timestep: float) -> float:
    """The timestep [s] to tune a model's constraints to where the steps are the integrator's own.

    A rigid equality only takes back what rounding lets slip. In half a swing of the smallest pendulum that fits into
    the can, sqrt(a/g), it does so gently enough not to limit the steps.
    """
    slow = scene.gravity > 0 and rolling == "equality"
    return float(np.sqrt(scene.can.radius / scene.gravity)) / 2 if slow else timestep


def refine(mesh: np.ndarray, finer: float) -> np.ndarray:
    """Times of a mesh with `finer` steps for each of those of `mesh`."""
    place = np.linspace(0, len(mesh) - 1, round(finer * (len(mesh) - 1)) + 1)
    return np.interp(place, np.arange(len(mesh)), mesh)


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Size of each component of the state below which an error counts absolutely, shape (nq + nv,).

    Lengths count in radii, rates per sqrt(a/g).
    """
    radius = scene.can.radius
    slides = np.array([model.joint(i).type[0] == mujoco.mjtJoint.mjJNT_SLIDE for i in range(model.njnt)])
    positions = np.where(slides, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
