"""Runs of a half-full can whose load is damped, at any timestep and damping: how they end, and what theory expects.

The scene is beer that slides in a can of sheet metal, let go at 1 rad on the paper's incline. All ways of rolling can
have it, and so are compared with the same motion.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import build
from mjbeer.model.numbers import stiffest
from mjbeer.model.setting import Integrator, Rolling, Setting
from mjbeer.predictions import linear_stability, soft_rolling
from mjbeer.predictions.linear_stability import GROWTH
from mjbeer.predictions.soft_constraint import MAX_IMPEDANCE, spring
from mjbeer.predictions.soft_rolling import System
from mjbeer.simulation.run import Run, integrate
from mjbeer.studies.stability.outcome import REFUSALS, explodes
from mjbeer.studies.stability.truth import angles
from mjbeer.theory.can import Can
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.exact import exact
from mjbeer.theory.named import sliding
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene

EXPLODED, INACCURATE, WARNED, TRUSTED, SILENT = range(5)
"""Outcomes of a run, as numbers for the cells of a map. It exploded, or was refused; its error is above `record.ERROR`,
and it says so; it is accurate, and warns nevertheless; it is accurate and trusted. The last must not occur: its error
is above `record.ERROR`, and it is trusted."""
MEANINGS = ("exploded", "inaccurate, and says so", "accurate, but warns", "accurate and trusted", "wrong and silent")
"""The outcomes in words."""
START = 1.0
"""phi at the start [rad], where can and load are at rest."""
DURATION = 1.024
"""Duration of a run [s], in which the damped load swings twice."""
_SAMPLES = 16
"""Samples of a run after its start. Its warnings rest on all of its steps."""
_PARTS = 8
"""Parts of a run in which theory takes the load's angle as constant."""
_POINTS = 2
"""Number of points at which the can in contact touches the ground."""


def scene(damping: float) -> Scene:
    """Return beer that slides in a can of sheet metal with a damping [N m s]."""
    return sliding(can=Can.sheet_metal(), damping=damping)


@dataclass(frozen=True)
class Ended:
    """How a run ended."""

    outcome: int
    """EXPLODED, INACCURATE, WARNED, TRUSTED or SILENT."""
    error: float = math.inf
    """Largest error of phi and u/a at the samples [rad], relative beyond 1 rad."""
    implied: float = math.inf
    """The error that the run itself estimates [rad], relative beyond 1 rad."""


class DampedRuns:
    """Runs with one way of rolling, one integrator and one damping [N m s], at any of some timesteps [s]."""

    def __init__(self, rolling: Rolling, integrator: Integrator, damping: float, timesteps: Sequence[float]) -> None:
        self._rolling, self._integrator, self._scene = rolling, integrator, scene(damping)
        self._times = {timestep: _samples(timestep) for timestep in timesteps}
        every = np.unique(np.concatenate(list(self._times.values())))
        self._exact = exact(self._scene, every, START)
        self._kinetic = float(kinetic_energy(self._scene, self._exact).max())
        self._systems = list(_systems(rolling, self._scene))

    def measure(self, timestep: float) -> Ended:
        """Simulate with one of the timesteps [s], and return how that ended."""
        run = self._simulate(timestep)
        if run is None:
            return Ended(EXPLODED)
        at = np.searchsorted(self._exact.time, run.time)
        truth = angles(self._scene, self._exact, START, 0.0)
        truth = replace(truth, phi=truth.phi[at], roll=truth.roll[at])
        error = truth.off(run.phi, run.u / self._scene.can.radius)
        if not run.trusted:
            right = WARNED if error <= ERROR else INACCURATE
            outcome = EXPLODED if explodes(run, self._kinetic) else right
        else:
            outcome = TRUSTED if error <= ERROR else SILENT
        return Ended(outcome, error, run.error_estimate or 0.0)

    def explodes(self, timestep: float) -> bool:
        """Simulate with any timestep [s], and return whether the run explodes."""
        run = self._simulate(timestep)
        return run is None or explodes(run, self._kinetic)

    def growth(self, timestep: float) -> float:
        """Return the logarithm of the largest factor by which theory lets a small disturbance grow in a run.

        In each part of the run the matrix of a step is that of small motions about the load's angle then, and a
        disturbance grows with its spectral radius. It may begin and end with any part.
        """
        row = spring(stiffest(self._integrator, timestep, self._rolling == "contact"), 1.0, MAX_IMPEDANCE)
        steps, growth, largest = DURATION / _PARTS / timestep, 0.0, 0.0
        for system in self._systems:
            radius = linear_stability.spectral_radius(system.step(self._integrator, row, timestep))
            growth = max(0.0, growth + steps * math.log(radius))
            largest = max(largest, growth)
        return largest

    def predict(self, timestep: float) -> bool:
        """Return whether theory lets a small disturbance grow by `GROWTH` in a run with a timestep [s]."""
        return self.growth(timestep) > math.log(GROWTH)

    def _simulate(self, timestep: float) -> Run | None:
        """Return the run with a timestep [s]; None if it diverges or is refused."""
        times = self._times.get(timestep, _samples(timestep))
        setting = Setting(self._rolling, self._integrator, timestep)
        try:
            return integrate(self._scene, START, 0.0, setting, times)
        except (DivergenceError, *REFUSALS):
            return None


def _samples(timestep: float) -> np.ndarray:
    """Return the times of the samples of a run [s], which are multiples of its timestep."""
    return timestep * np.unique(np.rint(np.linspace(0, DURATION, _SAMPLES + 1) / timestep))


def _systems(rolling: Rolling, scene: Scene) -> Iterator[System]:
    """Yield the linear equations of small motions about the load's angle in the middle of each part of a run."""
    middles = (np.arange(_PARTS) + 0.5) * DURATION / _PARTS
    impratio = float(build(scene, rolling).opt.impratio)
    for angle in exact(scene, middles, START).phi.tolist():
        if rolling == "reduced":
            yield soft_rolling.by_coordinates(scene, angle)
        elif rolling == "equality":
            yield soft_rolling.by_equality(scene, excess=0.0, angle=angle)
        else:
            yield soft_rolling.by_contact(scene, 0.0, _POINTS, impratio, angle)
