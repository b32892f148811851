"""One measured setting: its error, what else the run says about itself, and its run time."""

import math
import statistics
from dataclasses import dataclass, field

import numpy as np

from mjbeer.settings import Curve
from mjbeer.trajectory import Trajectory


@dataclass
class Point:
    """A setting and what was measured with it. Errors are against exact theory."""

    case: str
    way: str
    method: str
    knob: str
    value: float
    """Timestep [s] or tolerance."""
    phi_max: float = math.nan
    """Largest error of phi over the run [rad]."""
    phi_end: float = math.nan
    """Error of phi at its end [rad]."""
    u_max: float = math.nan
    """Largest error of u/a over the run [rad]."""
    u_end: float = math.nan
    """Error of u/a at its end [rad]."""
    slip_max: float | None = None
    """Largest slip [radii]."""
    slip_integral: float | None = None
    """Integral of the slip's size over the run [radii s]."""
    energy_drift: float | None = None
    """The largest change of energy, with its sign, over the largest kinetic energy of the swing."""
    pressed: bool | None = None
    """Whether the motion needed N > 0 throughout."""
    model_error: float | None = None
    """Error of phi and u/a of the same model under DOP853 at a tolerance of 1e-13 [rad]."""
    integrator_error: float | None = None
    """Distance of the run from that [rad]."""
    timeconst: float | None = None
    """solref's time constant as asked for [s]."""
    effective_timeconst: float | None = None
    """The one that the solver got [s]."""
    impedance: float | None = None
    """Share of the force of a hard constraint, as asked for."""
    effective_impedance: float | None = None
    """The share that it had."""
    setup: float = math.nan
    """Time to build the model and whatever else is done once [s]."""
    failure: str | None = None
    """Why there is no error."""
    times: list[float] = field(default_factory=list)
    """Run times of the repeats [s]."""

    @property
    def curve(self) -> Curve:
        """The curve that it is on."""
        return Curve(self.way, self.method, self.knob)

    @property
    def error(self) -> float:
        """Largest error of phi and u/a over the run [rad]; infinite if it failed."""
        worst = max(self.phi_max, self.u_max)
        return worst if math.isfinite(worst) else math.inf

    @property
    def time(self) -> float:
        """Least run time [s]; NaN if it was not timed."""
        return min(self.times, default=math.nan)

    @property
    def median_time(self) -> float:
        """Median run time [s]; NaN if it was not timed."""
        return statistics.median(self.times) if self.times else math.nan

    def judge(self, phi: np.ndarray, u: np.ndarray, truth: Trajectory) -> None:
        """Fill in the errors of phi [rad] and u [m] at the samples of the exact motion."""
        radius = truth.scene.can.radius
        phi_error, u_error = np.abs(phi - truth.phi), np.abs(u - truth.u) / radius
        self.phi_max, self.phi_end = float(phi_error.max()), float(phi_error[-1])
        self.u_max, self.u_end = float(u_error.max()), float(u_error[-1])

    def listen(self, run: Trajectory) -> None:
        """Fill in what a run of MuJoCo says about itself."""
        radius = run.scene.can.radius
        slip = np.abs(run.slip) / radius
        self.slip_max, self.slip_integral = float(slip.max()), float(np.trapezoid(slip, run.time))
        change = run.energy - run.energy[0]
        self.energy_drift = math.copysign(run.energy_drift, float(change[np.abs(change).argmax()]))
        self.pressed = math.isinf(run.rolls_until())


def distance(phi: np.ndarray, u: np.ndarray, other_phi: np.ndarray, other_u: np.ndarray, radius: float) -> float:
    """Largest distance of two motions in phi and u/a [rad]."""
    return max(float(np.abs(phi - other_phi).max()), float(np.abs(u - other_u).max()) / radius)
