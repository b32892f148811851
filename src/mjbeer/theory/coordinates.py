"""Positions and velocities of can and load at some times."""

from dataclasses import dataclass, fields

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError


@dataclass(frozen=True, eq=False, kw_only=True)
class Coordinates:
    """A motion in the coordinates of the paper's Fig. 3; every array has shape (samples,).

    Raises:
      ParameterError: if an array is not finite, not one-dimensional, empty, or not as long as the times.
    """

    time: np.ndarray
    """Time [s]."""
    u: np.ndarray
    """Distance of the axis down the incline [m]."""
    phi: np.ndarray
    """Angle of the load's flat surface to the incline [rad]."""
    u_dot: np.ndarray
    """Velocity of the axis down the incline [m/s]."""
    phi_dot: np.ndarray
    """Rate of phi [rad/s]."""
    roll: np.ndarray
    """Angle by which the can has rolled [rad]; u/a where it does not slip."""
    roll_dot: np.ndarray
    """Rate of roll [rad/s]."""
    lift: np.ndarray
    """Height of the can above the incline [m]; slightly negative in a soft contact."""
    lift_dot: np.ndarray
    """Velocity of the can away from the incline [m/s]."""

    def __post_init__(self) -> None:
        for each in fields(Coordinates):
            require.store(self, **{each.name: require.samples(each.name, getattr(self, each.name))})
            if (count := len(getattr(self, each.name))) != len(self.time):
                raise ParameterError(f"{each.name} must have as many entries as time, {len(self.time)}, got {count}")
