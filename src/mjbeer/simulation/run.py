"""A simulated motion, and what it says about itself."""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mjbeer import require
from mjbeer.model.setting import Setting
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.record import ERROR, Diagnosis, Record, diagnose
from mjbeer.theory.trajectory import Trajectory

_MAX_TURN_PER_STEP = 2.0
"""Largest angle that the load may turn in a timestep [rad]. DOP853 evaluates within the step, and
may turn further. For other integrators it does not matter if the motion hardly depends on the
angle."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(Trajectory):
    """A simulated motion and its setting.

    What it says about itself rests on all of its steps, and does not depend on the samples that
    were asked for.
    """

    setting: Setting
    """How the can was made to roll and how it was stepped."""
    record: Record = field()  # else the property of `Trajectory` would be its default
    """The extremes of the motion over all its steps, on which its warnings rest."""
    diagnosis: Diagnosis = field()
    """What the record says against the motion."""
    method: str
    """The name of the integrator; with a tolerance it is "GaussJackson" or "DOP853"."""
    error: float | None
    """The error that was estimated on the way to a tolerance [rad]; None without one."""
    checkpoints: Coordinates
    """The motion as it was stepped, from `phi0` less its whole turns, at the samples and at times
    that are spread over the whole run, where a second run is compared."""

    def __post_init__(self) -> None:
        """Check nothing: the start is checked before a run, and its samples are finite after it."""

    @property
    def rolling(self) -> str:
        """Return "reduced", "equality" or "contact"."""
        return self.setting.rolling

    @property
    def integrator(self) -> str:
        """Return the name of the integrator."""
        return self.method

    @property
    def timestep(self) -> float | None:
        """Return the fixed timestep of the integrator [s]; None with a tolerance."""
        return self.setting.timestep if self.setting.tolerance is None else None

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling was possible with a coefficient of `friction`.

        It is infinite if rolling was possible to the end. With infinite friction only N > 0 has to
        hold; any other takes a run as long as this one.
        """
        friction = require.non_negative("friction", friction, finite=False)
        if friction == self.record.friction:
            return self.record.rolling_ends_at
        from mjbeer.simulation.second_run import record_with_friction

        return record_with_friction(self, friction).rolling_ends_at

    @cached_property
    def error_estimate(self) -> float:
        """Return the estimated global error of phi and u/a [rad], relative beyond 1 rad.

        It rests on the largest distance from a second run. Without a tolerance the first access
        makes that run, which takes up to three times as long as this one; the error is infinite if
        it diverges. While a can in contact rolls, its slip and its depth, both in radii, are added:
        a can that has slid is elsewhere by as much, and one that has sunk in rolls on a smaller
        radius. A start beyond half a turn adds the rounding of its whole turns.
        """
        error = self.error
        if error is None:
            from mjbeer.simulation.second_run import compare_uneven

            error = compare_uneven(self)
        if self.rolling == "contact" and not self.rolling_warnings:
            error += (self.record.slip + self.record.lift) / self.scene.can.radius
        return error + turns_rounding(self.phi0)

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings; a fixed timestep needs `error_estimate`'s run."""
        return not self.warnings

    @cached_property
    def solver_warnings(self) -> tuple[str, ...]:
        """Return the reasons to doubt that the model's equations were solved, a sentence each."""
        if self.error_estimate <= ERROR:
            return self.diagnosis.solver
        finer = "other timesteps" if self.timestep is not None else "a tighter tolerance"
        if math.isfinite(self.error_estimate):
            reason = (
                f"phi and u/a are off by {self.error_estimate:.3g} rad (trusted up to {ERROR:g}), "
                f"as a run at {finer} shows"
            )
        else:
            reason = (
                f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
            )
        return (*self.diagnosis.solver, reason)


def diagnose_run(
    record: Record, setting: Setting, method: str, phi0: float, phi_dot0: float
) -> Diagnosis:
    """Return what the record of a run from `phi0` [rad] with `phi_dot0` [rad/s] says against it."""
    diagnosis = diagnose(record, setting.rolling, setting.friction)
    timestep = setting.timestep if setting.tolerance is None else 0.0
    turn = record.largest_rate * timestep
    if turn <= _MAX_TURN_PER_STEP or method == "DOP853":
        return diagnosis
    rate = phi_dot0
    if record.scene.dissipates:
        # Damping slows the load, and the slower it is, the less even it turns: down to the rate
        # that is no trouble.
        rate = min(abs(phi_dot0), _MAX_TURN_PER_STEP / timestep)
    if record.scene.oscillator.rate_variation(phi0, rate) <= ERROR:
        return diagnosis
    reason = (
        f"the load turns by {turn:.3g} rad in a timestep (trusted up to {_MAX_TURN_PER_STEP:g}), "
        "in which its weight and inertia change unseen"
    )
    return diagnosis._replace(solver=(*diagnosis.solver, reason))


def turns_rounding(phi0: float) -> float:
    """Return the rounding of phi and u/a [rad] by the whole turns of a start at `phi0` [rad].

    Up to half a turn it is 0. Four steps of a calculation round to a double of that size: the
    difference of the turns, their product with the radius, and either sum.
    """
    return 4 * float(np.spacing(abs(phi0))) if abs(phi0) > math.pi else 0.0
