"""Coordinates of a motion at some times, and their rates."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Motion:
    """Sampled coordinates and their rates; the fields are those of a Trajectory."""

    u: np.ndarray
    phi: np.ndarray
    u_dot: np.ndarray
    phi_dot: np.ndarray
    roll: np.ndarray
    roll_dot: np.ndarray
    lift: np.ndarray
    lift_dot: np.ndarray
