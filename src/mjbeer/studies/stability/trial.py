"""A trial: a scene, its start, how it is simulated and which samples are asked for; its repr makes it again."""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.model.setting import FRICTION, TUNED, Integrator, Rolling, Softness
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene

_SAMPLES = "steps", "every", "moments"
"""The fields that say which samples are asked for."""


@dataclass(frozen=True)
class Trial:
    """Everything that defines a run; units are those of `simulate`."""

    scene: Scene
    phi0: float
    phi_dot0: float = 0.0
    rolling: Rolling = "reduced"
    integrator: Integrator | None = None
    """None with a tolerance."""
    timestep: float = 1e-3
    tolerance: float | None = None
    friction: float = FRICTION
    steps: int = 1000
    """Duration in timesteps."""
    every: int = 1
    """Number of timesteps from one sample to the next."""
    moments: tuple[float, ...] | None = None
    """The times of the samples in timesteps, if they are not regular."""
    softness: Softness = TUNED

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        if self.moments is not None:
            return self.timestep * np.array(self.moments)
        return self.timestep * np.arange(0, self.steps + 1, self.every)

    def simulate(self) -> Run:
        """Return the simulated motion at the times of its samples."""
        setting = {name: value for name, value in vars(self).items() if name not in _SAMPLES}
        return simulate(duration=self.timestep * self.steps, times=self.times, **setting)


def steps_of(duration: float, timestep: float) -> int:
    """Return the number of timesteps to the first one at or after a duration."""
    return math.ceil(duration / timestep * (1 - 1e-10))
