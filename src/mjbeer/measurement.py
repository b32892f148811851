"""What is measured on simulated motions, always against exact theory."""

import math

import numpy as np

from mjbeer.distance import farthest
from mjbeer.exact import exact
from mjbeer.model import DOP853
from mjbeer.scene import Scene
from mjbeer.simulation import simulate
from mjbeer.trajectory import Trajectory

TOP = math.pi - 0.05
"""Where a hoop is let go to fall from its top [rad]: a little beside, or it would stay."""


def phi_error(trajectory: Trajectory) -> float:
    """Largest distance of phi from the exact motion with the same start [rad]."""
    return float(np.abs(trajectory.phi - _truth(trajectory)).max())


def relative_phi_error(trajectory: Trajectory) -> float:
    """The same relative to the angle that phi has turned, where that exceeds 1 rad: what a tolerance bounds."""
    return farthest(trajectory.phi, _truth(trajectory))


def _truth(trajectory: Trajectory) -> np.ndarray:
    return exact(trajectory.scene, trajectory.time, trajectory.phi[0], trajectory.phi_dot[0]).phi


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


def fall_from_top(scene: Scene, timestep: float, friction: float) -> Trajectory:
    """A hoop let go at TOP, in contact, until just after it parts or passes the bottom."""
    times = np.linspace(0, 3, 3001)
    fall = exact(scene, times, TOP)
    parts = fall.rolls_until()
    bottom = times[np.argmax(fall.phi < 0)]
    duration = parts * 1.02 if math.isfinite(parts) else float(bottom)
    return simulate(scene, duration, TOP, rolling="contact", timestep=timestep, friction=friction)


def observed_order(steps: np.ndarray, errors: np.ndarray) -> float:
    """Slope of log(error) over log(step)."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def ladder(scene: Scene, integrator: str, steps: np.ndarray, duration: float, phi0: float) -> np.ndarray:
    """Errors of phi [rad] at a ladder of timesteps [s], reduced."""
    runs = (simulate(scene, duration, phi0, integrator=integrator, timestep=float(h)) for h in steps)
    return np.array([phi_error(each) for each in runs])


def order(scene: Scene, integrator: str) -> float:
    """Observed order of an integrator on a swing of 0.3 rad, over six halvings of the timestep.

    At order eight six halvings span 14 digits, more than a double has: there the slope is over those
    rungs of the six halvings, at ratio sqrt(2), whose error is between 1e-3 rad and 1e-13 rad.
    """
    if integrator != DOP853:
        steps = (4e-2 if integrator == "RK4" else 4e-3) / 2.0 ** np.arange(7)
        return observed_order(steps, ladder(scene, integrator, steps, 2.0, 0.3))
    steps = 0.2 / np.sqrt(2) ** np.arange(13)
    errors = ladder(scene, integrator, steps, 20.0, 0.3)
    clear = (errors < 1e-3) & (errors > 1e-13)
    return observed_order(steps[clear], errors[clear])
