"""A trial: a scene, its start, how it is simulated and which samples are asked for, all in one line of Python."""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.model.setting import FRICTION, TUNED, Integrator, Rolling, Softness
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene

_SETTING = "phi0", "phi_dot0", "rolling", "integrator", "timestep"


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
        setting = {name: getattr(self, name) for name in (*_SETTING, "tolerance", "times", "friction", "softness")}
        return simulate(self.scene, duration=self.timestep * self.steps, **setting)

    def __str__(self) -> str:
        """Return the call of `simulate` as one line of Python."""
        samples = f"np.arange(0, {self.steps + 1}, {self.every})"
        if self.moments is not None:
            samples = f"np.array({list(self.moments)})"
        words = [
            repr(self.scene),
            f"duration={self.timestep!r} * {self.steps}",
            *(f"{name}={getattr(self, name)!r}" for name in _SETTING),
            f"tolerance={self.tolerance!r}",
            f"times={self.timestep!r} * {samples}",
            f"friction={self.friction!r}",
            *([] if self.softness == TUNED else [f"softness={self.softness!r}"]),
        ]
        return f"simulate({', '.join(words)})"


def steps_of(duration: float, timestep: float) -> int:
    """Return the number of timesteps to the first one at or after a duration."""
    return math.ceil(duration / timestep * (1 - 1e-10))
