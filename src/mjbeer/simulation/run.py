"""A simulated motion that knows how it was made, and so can be made again, more finely."""

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
"""How far beside the start the run at half the timestep starts [rad]: a hundred roundings. In contact it is the depth
at which the can starts, in radii, which no two models would have alike. Beside a separatrix all depends on it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Trajectory):
    """A simulated motion, and how it was made."""

    phi0: float
    """Start angle phi [rad]."""
    phi_dot0: float
    """Start rate of phi [rad/s]."""
    setting: Setting
    estimate: float | None = None
    """Estimated error that the run came with [rad]: that of a run to a tolerance."""

    @property
    def rolling(self) -> str:
        """How the can was made to roll: "reduced", "equality" or "contact"."""
        return self.setting.rolling

    @property
    def integrator(self) -> str:
        """Name of the integrator; with a tolerance it is "DOP853"."""
        return self.setting.integrator if self.setting.tolerance is None else DOP853

    @property
    def timestep(self) -> float | None:
        """Fixed step of the integrator [s]; None with a tolerance."""
        return self.setting.timestep if self.setting.tolerance is None else None

    @cached_property
    def error_estimate(self) -> float | None:
        """Estimated global error of phi and u/a [rad], relative to the total angle where that exceeds 1 rad.

        It is by a second run: the one that a tolerance took anyway, or one at half the timestep, which is made when
        this is first asked for and takes twice as long as the first. It is infinite if that one diverges.
        """
        if self.estimate is not None:
            return self.estimate
        try:
            return _SAFETY * distance(self, self.finer(), self.scene.can.radius)
        except DivergenceError:
            return math.inf

    def finer(self) -> "Run":
        """The same motion at half the timestep, from a start a little aside.

        Constraints that are tuned to the timestep get harder with it, so that the distance shows what their softness
        does too; and the start aside shows what the motion makes of rounding.

        Raises:
          DivergenceError: if it stops being finite.
        """
        aside = START_DEPTH if self.rolling == "contact" else _ASIDE
        setting = replace(self.setting, timestep=self.setting.timestep / 2)
        return integrate(self.scene, self.phi0 + aside, self.phi_dot0, setting, self.time)


def integrate(scene: Scene, phi0: float, phi_dot0: float, setting: Setting, times: np.ndarray) -> Run:
    """The motion of a scene in a setting, at increasing `times` [s]; errors as in `simulate`."""
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
    """Refuse what two runs lose alike: a short arm in the rounding of a long way, or an equality's hardness."""
    implied, radius = implied_error(run.scene, run), run.scene.can.radius
    if implied > max(tolerance, ERROR):
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: two runs agree, but energy or momentum drift like an error "
            f"of {implied:.2g} rad; the model loses in rounding what moves it"
        )
    slid = float(np.abs(run.slip).max() / max(radius, np.abs(run.u - run.u[0]).max()))
    if slid > tolerance:
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: the can slips by {slid:.2g} of its way; with masses so "
            'unequal MuJoCo has no harder equality, and rolling="reduced" needs none'
        )
