"""What is measured on a motion: slip, turning points, take-off, and how far it is from another."""

import math

import numpy as np

from mjbeer.theory.trajectory import Trajectory


def farthest(angles: np.ndarray, truth: np.ndarray) -> float:
    """Largest distance of `angles` from `truth` [rad].

    Where that has come more than 1 rad from its start, the distance is relative to how far.
    """
    way = np.maximum.accumulate(np.abs(truth - truth[0]))
    return float(np.max(np.abs(angles - truth) / np.maximum(1, way)))


def swing_period(trajectory: Trajectory) -> float:
    """Mean period of a swing [s], from its turning points."""
    return 2 * math.pi / trajectory.frequency()


def acceleration(trajectory: Trajectory) -> float:
    """Mean acceleration of the axis down the incline [m/s^2], of a motion that starts at rest."""
    return float(2 * (trajectory.u[-1] - trajectory.u[0]) / trajectory.time[-1] ** 2)


def takeoff(trajectory: Trajectory) -> float | None:
    """Angle from the top [rad] at which the load is when the can leaves the incline; None if it does not.

    Touching is to be within 1e-9 of a radius: a soft contact sinks in by more than that.
    """
    above = np.flatnonzero(trajectory.lift > 1e-9 * trajectory.scene.can.radius)
    return None if not len(above) else math.pi - float(trajectory.phi[above[0]])


def distance(phi: np.ndarray, u: np.ndarray, other_phi: np.ndarray, other_u: np.ndarray, radius: float) -> float:
    """Largest distance of two motions in phi and u/a [rad]."""
    return max(float(np.abs(phi - other_phi).max()), float(np.abs(u - other_u).max()) / radius)
