"""A simulated motion with its setting, which allows a second run at half the timestep to estimate the error."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mjbeer.exceptions import DivergenceError, ToleranceError
from mjbeer.model.setting import DOP853, Setting
from mjbeer.model.state import START_DEPTH
from mjbeer.simulation.prepare import Prepared
from mjbeer.theory.conserved import implied_error
from mjbeer.theory.measure import distance
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import ERROR, Trajectory

_SAFETY = 2.5
"""Error estimate over the distance to a run at half the timestep. A first-order method needs 2, because halving the
step halves its error; 2.5 allows for an order that has not settled."""
_ASIDE = 4e-14
"""Distance between the starts of a run and of the run at half its timestep [rad]: a hundred times their rounding.
Beside a separatrix it shows how much rounding matters. In contact it is `START_DEPTH` instead, as no two models would
have the same depth."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Trajectory):
    """A simulated motion, its start and its setting."""

    phi0: float
    """Start angle phi [rad]."""
    phi_dot0: float
    """Start rate of phi [rad/s]."""
    setting: Setting
    """How the can was made to roll and how it was stepped."""
    estimate: float | None = None
    """Estimated error [rad] of a run with a tolerance, which comes with the run; None without a tolerance."""

    @property
    def rolling(self) -> str:
        """Return how the can was made to roll: "reduced", "equality" or "contact"."""
        return self.setting.rolling

    @property
    def integrator(self) -> str:
        """Return the name of the integrator, which is "DOP853" with a tolerance."""
        return self.setting.integrator if self.setting.tolerance is None else DOP853

    @property
    def timestep(self) -> float | None:
        """Return the fixed timestep of the integrator [s]; None with a tolerance."""
        return self.setting.timestep if self.setting.tolerance is None else None

    @cached_property
    def error_estimate(self) -> float | None:
        """Return the estimated global error of phi and u/a [rad], relative to the angle where that exceeds 1 rad.

        It rests on the distance from a second run. With a tolerance that was made already. Otherwise the first access
        makes a run at half the timestep, which takes twice as long as this one; the error is infinite if it diverges.
        """
        if self.estimate is not None:
            return self.estimate
        try:
            return _SAFETY * distance(self, self.finer(), self.scene.can.radius)
        except DivergenceError:
            return math.inf

    def finer(self) -> "Run":
        """Return the same motion at half the timestep, from a start that is `_ASIDE` from this one.

        Constraints that are tuned to the timestep are harder in it, so that its distance from this motion includes the
        effect of their softness. The other start includes the effect of rounding.

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        aside = START_DEPTH if self.rolling == "contact" else _ASIDE
        setting = replace(self.setting, timestep=self.setting.timestep / 2)
        return integrate(self.scene, phi0=self.phi0 + aside, phi_dot0=self.phi_dot0, setting=setting, times=self.time)


def integrate(scene: Scene, phi0: float, phi_dot0: float, setting: Setting, times: np.ndarray) -> Run:
    """Return the motion of a scene in a setting at increasing `times` [s], with the same errors as `simulate`."""
    prepared = Prepared(scene, setting)
    solution = prepared.solve(prepared.start(phi0, phi_dot0), times)
    coordinates = prepared.coordinates(solution.states, times)
    run = Run(
        **vars(coordinates),
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        setting=setting,
        estimate=solution.estimate,
    )
    if setting.tolerance is not None and setting.rolling != "contact":
        _check_conserved(run, setting.tolerance)
    return run


def _check_conserved(run: Run, tolerance: float) -> None:
    """Check what the comparison of two runs cannot show, because both are wrong alike: lost digits, and slip.

    Raises:
      ToleranceError: if energy, momentum or slip implies an error above the tolerance.
    """
    implied, radius = implied_error(run.scene, run), run.scene.can.radius
    if implied > max(tolerance, ERROR):
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: two runs agree, but energy or momentum drift like an error "
            f"of {implied:.2g} rad; the model loses in rounding what moves it"
        )
    slip = float(np.abs(run.slip).max() / max(radius, np.abs(run.u - run.u[0]).max()))
    if slip > tolerance:
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: the can slips by {slip:.2g} of its way; with masses so "
            'unequal MuJoCo has no harder equality, and rolling="reduced" needs none'
        )
