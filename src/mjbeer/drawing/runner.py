"""A can in a race, and when it finishes."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing.world.positions import coordinates
from mjbeer.theory.exact import exact
from mjbeer.theory.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Runner:
    """A can in the race."""

    name: str
    trajectory: Trajectory
    colour: tuple[float, float, float]
    """Colour of its label, its name and its line."""
    load: tuple[float, float, float] | None = None
    """Colour of what is in it; None is that of beer, or of ice if it is frozen."""

    @cached_property
    def distance(self) -> np.ndarray:
        """Return how far the can has rolled since the start [m], at each sample."""
        return self.trajectory.u - self.trajectory.u[0]

    def finish(self, length: float) -> float:
        """Return when the simulated can has rolled a `length` [m], as a time [s]; infinite if it ends before."""
        if self.distance[-1] < length:
            return math.inf

        def ahead(time: float) -> float:
            u, *_ = coordinates(self.trajectory, np.array([time]))[0]
            return u - self.trajectory.u[0] - length

        return float(brentq(ahead, 0, self.trajectory.time[-1], xtol=1e-12))

    def finish_of_theory(self, length: float) -> float:
        """Return when exact theory has the can at a `length` [m] from the start [s]; infinite where `finish` is."""
        if self.way_of_theory(self.trajectory.time[-1]) < length:
            return math.inf
        return float(brentq(lambda time: self.way_of_theory(time) - length, 1e-3, self.trajectory.time[-1], xtol=1e-12))

    def way_of_theory(self, time: float) -> float:
        """Return how far exact theory has the can from the start at a `time` [s], in metres."""
        motion = self.trajectory
        theory = exact(motion.scene, np.array([0.0, time]), motion.phi0, motion.phi_dot0)
        return float(theory.u[1] - theory.u[0])

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return u from the start [m], phi, roll [rad] and lift [m] at some times [s], shape (times, 4).

        At times after the last sample they are those of the last sample.
        """
        moments = np.minimum(times, self.trajectory.time[-1])
        return coordinates(self.trajectory, moments) - [self.trajectory.u[0], 0, 0, 0]
