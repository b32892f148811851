"""Where can and load are between the samples of a trajectory."""

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.theory.trajectory import Trajectory


def coordinates(trajectory: Trajectory, times: np.ndarray) -> np.ndarray:
    """Return u [m], phi [rad], roll [rad] and lift [m] at some times [s], shape (times, 4).

    Between two samples each is the cubic that has the samples' values and rates. Its error falls as the fourth power
    of the interval, so that the motion looks smooth even with 20 samples per second.
    """
    samples = np.stack([trajectory.u, trajectory.phi, trajectory.roll, trajectory.lift], axis=1)
    if len(samples) == 1:
        return np.repeat(samples, len(times), axis=0)
    rates = np.stack([trajectory.u_dot, trajectory.phi_dot, trajectory.roll_dot, trajectory.lift_dot], axis=1)
    return CubicHermiteSpline(trajectory.time, samples, rates)(times)
