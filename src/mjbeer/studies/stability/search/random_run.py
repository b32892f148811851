"""A random run: a scene, its start, how it is simulated and which samples are asked for, all on one line."""

from dataclasses import dataclass

import numpy as np

from mjbeer.model.setting import Integrator, Rolling
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene


@dataclass(frozen=True)
class RandomRun:
    """Everything that defines a run; units are those of `simulate`."""

    region: str
    """The part of the search that it belongs to."""
    scene: Scene
    phi0: float
    phi_dot0: float
    rolling: Rolling
    integrator: Integrator | None
    """None with a tolerance."""
    timestep: float
    tolerance: float | None
    friction: float
    steps: int
    """Duration in timesteps."""
    every: int = 1
    """Number of timesteps from one sample to the next."""
    moments: tuple[float, ...] | None = None
    """The times of the samples in timesteps, if they are not regular."""

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        if self.moments is not None:
            return self.timestep * np.array(self.moments)
        return self.timestep * np.arange(0, self.steps + 1, self.every)

    def simulate(self) -> Run:
        """Return the simulated motion at the times of its samples."""
        return simulate(
            self.scene,
            duration=self.timestep * self.steps,
            phi0=self.phi0,
            phi_dot0=self.phi_dot0,
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            tolerance=self.tolerance,
            times=self.times,
            friction=self.friction,
        )

    def __str__(self) -> str:
        """Return the call of `simulate` as one line of Python."""
        samples = f"np.arange(0, {self.steps + 1}, {self.every})"
        if self.moments is not None:
            samples = f"np.array({list(self.moments)})"
        words = [
            repr(self.scene),
            f"duration={self.timestep!r} * {self.steps}",
            *(f"{name}={getattr(self, name)!r}" for name in ("phi0", "phi_dot0", "rolling", "integrator", "timestep")),
            f"tolerance={self.tolerance!r}",
            f"times={self.timestep!r} * {samples}",
            f"friction={self.friction!r}",
        ]
        return f"simulate({', '.join(words)})"
