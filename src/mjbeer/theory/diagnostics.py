"""What a trajectory says about itself: energy, slip, lift, forces, and whether to rely on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from mjbeer.theory.conserved import implied_error

if TYPE_CHECKING:
    from mjbeer.theory.trajectory import Trajectory

ERROR = 1e-2
"""Largest estimated error of phi and u/a that is trusted [rad], relative beyond 1 rad: half a degree."""
SLIP = 1e-3
"""Largest slip that is trusted, in radii: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline that is trusted, in radii."""
_ROUNDING = 1e-11  # share of an energy of which a thousandth, the drift that is trusted, is still many roundings


def energy(trajectory: Trajectory) -> np.ndarray:
    """Kinetic and potential energy [J] of can and load, for any state, rolling or not."""
    scene, phi = trajectory.scene, trajectory.phi
    return kinetic_energy(trajectory) - scene.gravity * (
        scene.mass * (trajectory.u * math.sin(scene.incline) - trajectory.lift * math.cos(scene.incline))
        + scene.load.mass * scene.load.offset * np.cos(scene.incline + phi)
    )


def kinetic_energy(trajectory: Trajectory) -> np.ndarray:
    """Kinetic energy [J] of can and load, eqs. (39) and (44) with slip and lift allowed."""
    can, load, offset = trajectory.scene.can, trajectory.scene.load, trajectory.scene.load.offset
    along = trajectory.u_dot - offset * np.cos(trajectory.phi) * trajectory.phi_dot
    across = trajectory.lift_dot + offset * np.sin(trajectory.phi) * trajectory.phi_dot
    return (
        can.mass * (trajectory.u_dot**2 + trajectory.lift_dot**2)
        + can.inertia * trajectory.roll_dot**2
        + load.mass * (along**2 + across**2)
        + load.inertia * trajectory.phi_dot**2
    ) / 2


def energy_drift(trajectory: Trajectory) -> float:
    """Largest change of energy, relative to the largest kinetic energy of the swing, J phi_dot^2 / 2.

    The energy of a whole can that runs away down the incline would hide what happens to the swing. A motion
    that hardly swings is compared with a hundredth of the load's weight on its arm, a swing of 0.14 rad,
    and a balanced load with what the can's energy is rounded by.
    """
    form = trajectory.scene.oscillator
    swing = float(np.max(form.inertia(trajectory.phi) * trajectory.phi_dot**2)) / 2
    scale = max(swing, form.depth / 100, _ROUNDING * float(kinetic_energy(trajectory).max()))
    change = float(np.abs(trajectory.energy - trajectory.energy[0]).max())
    return change / scale if scale > 0 else 0.0


def slip(trajectory: Trajectory) -> np.ndarray:
    """u - a roll less its value at the start [m]."""
    gap = trajectory.u - trajectory.scene.can.radius * trajectory.roll
    return gap - gap[0]


def rolls_until(trajectory: Trajectory, friction: float) -> float:
    """First time [s] at which N > 0 or |F| <= mu N fails, interpolated between samples; else infinity."""
    forces = trajectory.forces
    margin = forces.normal
    if math.isfinite(friction):
        margin = np.minimum(margin, friction * forces.normal - np.abs(forces.friction))
    failed = np.flatnonzero(margin < 0)
    if not len(failed):
        return math.inf
    after = int(failed[0])
    if after == 0:
        return float(trajectory.time[0])
    before = after - 1
    part = margin[before] / (margin[before] - margin[after])
    return float(trajectory.time[before] + part * (trajectory.time[after] - trajectory.time[before]))


def turning_times(trajectory: Trajectory) -> np.ndarray:
    """Times [s] at which phi_dot changes sign.

    Between the two samples around each, phi_dot is the cubic that has the sampled phi_dot and the
    sampled phi_ddot (from the equation of motion, so the value holds for any state), which leaves an
    error of fourth order in the sampling interval.
    """
    time, rate = trajectory.time, trajectory.phi_dot
    slope = trajectory.scene.oscillator.acceleration(trajectory.phi, rate)
    before = np.flatnonzero((rate[:-1] > 0) != (rate[1:] > 0))
    found = []
    for i in before:
        step = time[i + 1] - time[i]
        p0, p1, m0, m1 = rate[i], rate[i + 1], step * slope[i], step * slope[i + 1]
        cubic = np.polynomial.Polynomial([p0, m0, 3 * (p1 - p0) - 2 * m0 - m1, 2 * (p0 - p1) + m0 + m1])
        roots = cubic.roots()
        real = roots.real[np.abs(roots.imag) < 1e-9]
        inside = real[(real >= -1e-9) & (real <= 1 + 1e-9)]
        found.append(time[i] + step * (inside[0] if len(inside) else p0 / (p0 - p1)))
    return np.array(found)


def warnings(trajectory: Trajectory) -> tuple[str, ...]:
    """Why the motion is not to be relied on, a sentence each."""
    found = []
    radius = trajectory.scene.can.radius
    implied = implied_error(trajectory)
    if not implied <= ERROR:
        found.append(
            f"energy or momentum drift like an error of {implied:.2g} rad of phi or u/a (trusted up to {ERROR:g}): "
            "take a smaller timestep or a better integrator"
        )
    slid = float(np.abs(trajectory.slip).max()) / radius
    if slid > SLIP:
        found.append(f"the can slips by {slid:.2g} radii (trusted up to {SLIP:g})")
    estimate = trajectory.error_estimate
    if estimate is not None and not estimate <= ERROR:
        finer = "half the timestep" if trajectory.timestep is not None else "a tighter tolerance"
        found.append(
            f"phi and u/a are off by {estimate:.2g} rad (trusted up to {ERROR:g}), as a run at {finer} shows"
            if math.isfinite(estimate)
            else f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
        )
    lifted = float(np.abs(trajectory.lift).max()) / radius
    if lifted > LIFT:
        found.append(f"the can parts from the incline, or sinks in, by {lifted:.2g} radii (trusted up to {LIFT:g})")
    parted = trajectory.rolls_until()
    if trajectory.rolling != "contact" and math.isfinite(parted):
        found.append(
            f"from t = {parted:.6g} s the incline would have to pull at the can (N < 0): a real one leaves it there"
        )
    return tuple(found)
