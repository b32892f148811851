"""Quantities measured on a motion: slip, turning points, take-off, and its distance from another motion."""

import math

import numpy as np

from mjbeer.exceptions import MjbeerError
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import accelerations
from mjbeer.theory.scene import Scene

_LEAST_SWING = 1e-10
"""Smallest swing whose frequency is measured [rad], relative beyond 1 rad: a million times the rounding of phi."""
_FOLLOWED = 0.05
"""Largest difference between the angle from one sample to the next and that from their rates and accelerations, over
the range of phi. Four samples a period of a small swing have 0.007, three have 0.03, two have 0.2."""


def angle_distance(angles: np.ndarray, truth: np.ndarray, start: float | None = None) -> float:
    """Return the largest distance of `angles` from `truth` [rad].

    With the angle at the `start` [rad], each distance is divided by the largest angle that `truth` has turned from
    there so far, where that exceeds 1 rad: this is the error that a tolerance bounds. `truth` is then in order of time.
    """
    apart = np.abs(angles - truth)
    if start is None:
        return float(np.max(apart))
    return float(np.max(apart / np.maximum(1, np.maximum.accumulate(np.abs(truth - start)))))


def distance(motion: Coordinates, truth: Coordinates, radius: float, start: tuple[float, float] | None = None) -> float:
    """Return the larger of `angle_distance` for phi and for u/a [rad] from another motion at the same times.

    `start` has phi [rad] and u [m] at time 0, from which the distance is made relative.
    """
    phi, u = start if start is not None else (None, None)
    return max(
        angle_distance(motion.phi, truth.phi, phi),
        angle_distance(motion.u / radius, truth.u / radius, u / radius if u is not None else None),
    )


def slip(motion: Coordinates, radius: float) -> np.ndarray:
    """Return the distance that a can of this `radius` [m] has slid instead of rolled [m]: u - a roll."""
    return motion.u - radius * motion.roll


def mean_acceleration(motion: Coordinates) -> float:
    """Return the mean acceleration of the axis down the incline [m/s^2] of a motion that starts at rest."""
    return float(2 * (motion.u[-1] - motion.u[0]) / motion.time[-1] ** 2)


def takeoff(motion: Coordinates, radius: float) -> float | None:
    """Return the angle of the load from the top [rad] when the can leaves the incline; None if it stays.

    A lift of up to 1e-9 radii counts as touching: a soft contact sinks in by more than that.
    """
    above = np.flatnonzero(motion.lift > 1e-9 * radius)
    return None if not len(above) else math.pi - float(motion.phi[above[0]])


def turning_times(motion: Coordinates, scene: Scene) -> np.ndarray:
    """Return the times [s] at which phi_dot changes sign, with an error of fourth order in the sampling interval.

    Between the two samples around a change of sign, phi_dot is replaced by the cubic that has its values and its
    derivatives at both. The derivatives, phi_ddot, come from the equation of motion.
    """
    time, phi_dot = motion.time, motion.phi_dot
    _, phi_ddot = accelerations(scene, motion.phi, phi_dot, motion.u_dot)
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


def swinging(motion: Coordinates, scene: Scene) -> Coordinates:
    """Return the samples of a motion up to the last that still swings, where damping or drag ends the swing.

    What is left then is the rounding of phi_dot, whose changes of sign are no turning points.
    """
    if not scene.dissipates:
        return motion
    least = _LEAST_SWING * scene.frequency() * max(1.0, float(np.abs(motion.phi).max()))
    last = int(np.flatnonzero(np.abs(motion.phi_dot) > least).max(initial=-1)) + 1
    return Coordinates(**{name: getattr(motion, name)[:last] for name in Coordinates.__dataclass_fields__})


def require_swing(motion: Coordinates, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Check that turning points of the motion from a start [rad, rad/s] are those of a swing that its samples follow.

    Raises:
      NoEquilibriumError: if the load has no equilibrium to swing about.
      MjbeerError: if the motion rests but for rounding and the softness of a contact, or its samples are too far apart.
    """
    rest, oscillator = scene.equilibrium(), scene.oscillator
    rest += 2 * math.pi * round((phi0 - rest) / (2 * math.pi))
    if not scene.dissipates:  # `swinging` does it where the energy is not that of a swing alone
        energy = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2 + float(oscillator.drop(rest, phi0))
        least = oscillator.stiffness() * (_LEAST_SWING * max(1.0, abs(phi0))) ** 2 / 2
        kinetic = float((oscillator.inertia(motion.phi) * motion.phi_dot**2).max()) / 2
        if not energy > least or kinetic > 2 * energy:
            raise MjbeerError(
                f"no frequency: the load starts with {energy:.2g} J above its equilibrium, which is a swing of less "
                f"than {_LEAST_SWING:g} rad, or one that is hidden by what else moves the load, up to {kinetic:.2g} J"
            )
    phi, phi_dot, step = motion.phi, motion.phi_dot, np.diff(motion.time)
    _, phi_ddot = accelerations(scene, phi, phi_dot, motion.u_dot)
    turned = step * (phi_dot[:-1] + phi_dot[1:]) / 2 - step**2 * np.diff(phi_ddot) / 12
    if len(phi) > 1 and not np.abs(turned - np.diff(phi)).max() <= _FOLLOWED * np.ptp(phi):
        raise MjbeerError(
            f"no frequency: the samples, up to {step.max():.3g} s apart, do not follow the swing; at least three a "
            "period are needed"
        )
