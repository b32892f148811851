"""A can in a race, and when it finishes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing.world.positions import coordinates
from mjbeer.exceptions import ParameterError
from mjbeer.theory.exact import exact
from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]

    @cached_property
    def distance(self) -> np.ndarray:
        """Return how far the can has rolled since the start [m], at each sample."""
        return self.trajectory.u - self.trajectory.u[0]

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s].

        Raises:
          ParameterError: if its motion ends before that.
        """
        if self.distance[-1] < length:
            raise ParameterError(f"{self.name} rolls {self.distance[-1]:.3g} m, and the race is over {length:g} m")

        def ahead(time: float) -> float:
            u, *_ = coordinates(self.trajectory, np.array([time]))[0]
            return u - self.trajectory.u[0] - length

        return float(brentq(ahead, 0, self.trajectory.time[-1], xtol=1e-12))

    def finish_of_theory(self, length: float) -> float:
        """Return when exact theory has the can at a `length` [m] from the start, as a time [s]."""
        scene, phi0 = self.trajectory.scene, self.trajectory.phi0

        def ahead(time: float) -> float:
            motion = exact(scene, np.array([0.0, time]), phi0, self.trajectory.phi_dot0)
            return float(motion.u[1] - motion.u[0]) - length

        return float(brentq(ahead, 1e-3, self.trajectory.time[-1], xtol=1e-12))

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at some times [s], shape (times, 4).

        At times after the last sample they are those of the last sample.
        """
        moments = np.minimum(times, self.trajectory.time[-1])
        return coordinates(self.trajectory, moments) - [self.trajectory.u[0], 0, 0, 0]
