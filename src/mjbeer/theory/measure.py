"""Quantities measured on a motion: slip, turning points, take-off, and its distance from another motion."""

import math

import numpy as np

from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces
from mjbeer.theory.oscillator import Oscillator


def angle_distance(angles: np.ndarray, truth: np.ndarray, relative: bool = True) -> float:
    """Return the largest distance of `angles` from `truth` [rad].

    If `relative`, each distance is divided by the largest angle that `truth` has turned from its start so far, where
    that exceeds 1 rad.
    """
    turned = np.maximum.accumulate(np.abs(truth - truth[0])) if relative else np.zeros_like(truth)
    return float(np.max(np.abs(angles - truth) / np.maximum(1, turned)))


def distance(motion: Coordinates, truth: Coordinates, radius: float, relative: bool = True) -> float:
    """Return the larger of `angle_distance` for phi and for u/a [rad] from another motion at the same times."""
    return max(
        angle_distance(motion.phi, truth.phi, relative),
        angle_distance(motion.u / radius, truth.u / radius, relative),
    )


def slip(motion: Coordinates, radius: float) -> np.ndarray:
    """Return the distance that a can has slid instead of rolled: u - a roll less its value at the first sample [m]."""
    slid = motion.u - radius * motion.roll
    return slid - slid[0]


def mean_acceleration(motion: Coordinates) -> float:
    """Return the mean acceleration of the axis down the incline [m/s^2] of a motion that starts at rest."""
    return float(2 * (motion.u[-1] - motion.u[0]) / motion.time[-1] ** 2)


def takeoff(motion: Coordinates, radius: float) -> float | None:
    """Return the angle of the load from the top [rad] when the can leaves the incline; None if it stays.

    A lift of up to 1e-9 radii counts as touching: a soft contact sinks in by more than that.
    """
    above = np.flatnonzero(motion.lift > 1e-9 * radius)
    return None if not len(above) else math.pi - float(motion.phi[above[0]])


def rolls_until(time: np.ndarray, forces: Forces, friction: float = math.inf) -> float:
    """Return the first time [s] at which N < 0 or |F| > friction N, interpolated between samples; infinity if none."""
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
    fraction = margin[before] / (margin[before] - margin[after])
    return float(time[before] + fraction * (time[after] - time[before]))


def turning_times(motion: Coordinates, oscillator: Oscillator) -> np.ndarray:
    """Return the times [s] at which phi_dot changes sign, with an error of fourth order in the sampling interval.

    Between the two samples around a change of sign, phi_dot is replaced by the cubic that has its values and its
    derivatives at both. The derivatives, phi_ddot, come from the equation of motion.
    """
    time, phi_dot = motion.time, motion.phi_dot
    phi_ddot = oscillator.acceleration(motion.phi, phi_dot)
    turns = []
    for before in np.flatnonzero((phi_dot[:-1] > 0) != (phi_dot[1:] > 0)):
        step = time[before + 1] - time[before]
        p0, p1 = phi_dot[before], phi_dot[before + 1]
        m0, m1 = step * phi_ddot[before], step * phi_ddot[before + 1]
        cubic = np.polynomial.Polynomial([p0, m0, 3 * (p1 - p0) - 2 * m0 - m1, 2 * (p0 - p1) + m0 + m1])
        roots = cubic.roots()
        real = roots.real[np.abs(roots.imag) < 1e-9]
        inside = real[(real >= -1e-9) & (real <= 1 + 1e-9)]
        turns.append(time[before] + step * (inside[0] if len(inside) else p0 / (p0 - p1)))
    return np.array(turns)
