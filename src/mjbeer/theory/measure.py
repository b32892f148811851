"""What is measured on a motion: slip, turning points, take-off, and how far it is from another."""

import math

import numpy as np

from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces
from mjbeer.theory.oscillator import Oscillator


def angle_distance(angles: np.ndarray, truth: np.ndarray, relative: bool = True) -> float:
    """Largest distance of `angles` from `truth` [rad].

    If `relative`, it is divided by how far `truth` has come from its start by then, where that exceeds 1 rad.
    """
    way = np.maximum.accumulate(np.abs(truth - truth[0])) if relative else np.zeros_like(truth)
    return float(np.max(np.abs(angles - truth) / np.maximum(1, way)))


def distance(motion: Coordinates, truth: Coordinates, radius: float, relative: bool = True) -> float:
    """Largest distance of phi and of u/a [rad] from another motion at the same times, as `angle_distance`."""
    return max(
        angle_distance(motion.phi, truth.phi, relative),
        angle_distance(motion.u / radius, truth.u / radius, relative),
    )


def slip(motion: Coordinates, radius: float) -> np.ndarray:
    """Distance that a can has slid instead of rolled, u - a roll less its value at the first sample [m]."""
    gap = motion.u - radius * motion.roll
    return gap - gap[0]


def mean_acceleration(motion: Coordinates) -> float:
    """Mean acceleration of the axis down the incline [m/s^2], of a motion that starts at rest."""
    return float(2 * (motion.u[-1] - motion.u[0]) / motion.time[-1] ** 2)


def takeoff(motion: Coordinates, radius: float) -> float | None:
    """Angle from the top [rad] at which the load is when the can leaves the incline; None if it does not.

    Touching is to be within 1e-9 of a radius: a soft contact sinks in by more than that.
    """
    above = np.flatnonzero(motion.lift > 1e-9 * radius)
    return None if not len(above) else math.pi - float(motion.phi[above[0]])


def rolls_until(time: np.ndarray, forces: Forces, friction: float = math.inf) -> float:
    """First time [s] at which N > 0 or |F| <= friction N fails, interpolated between samples; else infinity."""
    margin = forces.normal
    if math.isfinite(friction):
        margin = np.minimum(margin, friction * forces.normal - np.abs(forces.friction))
    failed = np.flatnonzero(margin < 0)
    if not len(failed):
        return math.inf
    after = int(failed[0])
    if after == 0:
        return float(time[0])
    before = after - 1
    part = margin[before] / (margin[before] - margin[after])
    return float(time[before] + part * (time[after] - time[before]))


def turning_times(motion: Coordinates, oscillator: Oscillator) -> np.ndarray:
    """Times [s] at which phi_dot changes sign.

    Between the two samples around each, phi_dot is the cubic that has the sampled phi_dot and the
    sampled phi_ddot (from the equation of motion, so the value holds for any state), which leaves an
    error of fourth order in the sampling interval.
    """
    time, rate = motion.time, motion.phi_dot
    slope = oscillator.acceleration(motion.phi, rate)
    turns = []
    for before in np.flatnonzero((rate[:-1] > 0) != (rate[1:] > 0)):
        step = time[before + 1] - time[before]
        p0, p1, m0, m1 = rate[before], rate[before + 1], step * slope[before], step * slope[before + 1]
        cubic = np.polynomial.Polynomial([p0, m0, 3 * (p1 - p0) - 2 * m0 - m1, 2 * (p0 - p1) + m0 + m1])
        roots = cubic.roots()
        real = roots.real[np.abs(roots.imag) < 1e-9]
        inside = real[(real >= -1e-9) & (real <= 1 + 1e-9)]
        turns.append(time[before] + step * (inside[0] if len(inside) else p0 / (p0 - p1)))
    return np.array(turns)
