"""The motion of a scene, from theory or from a simulation, with checks of whether it can be trusted."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.theory import conserved, measure
from mjbeer.theory.conserved import implied_error
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces, rolling_forces
from mjbeer.theory.scene import Scene

ERROR = 1e-2
"""Largest estimated error of phi and u/a [rad], relative beyond 1 rad, that is trusted: half a degree."""
SLIP = 1e-3
"""Largest slip, in radii, that is trusted: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline, in radii, that is trusted."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Trajectory(Coordinates):
    """A motion of a scene, with the energy, forces and warnings that follow from it."""

    scene: Scene

    @property
    def rolling(self) -> str:
        """Return how the can rolls: "exact" in theory; "reduced", "equality" or "contact" in a simulation."""
        return "exact"

    @property
    def integrator(self) -> str:
        """Return the name of the integrator, or "exact"."""
        return "exact"

    @property
    def timestep(self) -> float | None:
        """Return the fixed timestep of the integrator [s]; None if there was none."""
        return None

    @property
    def error_estimate(self) -> float | None:
        """Return the estimated error of phi and u/a [rad]; None for a motion from theory."""
        return None

    @cached_property
    def energy(self) -> np.ndarray:
        """Return the kinetic and potential energy of can and load together [J], at each sample."""
        return conserved.energy(self.scene, self)

    @property
    def energy_drift(self) -> float:
        """Return the largest change of energy over the run, relative to the largest kinetic energy of the swing."""
        return conserved.energy_drift(self.scene, self)

    @property
    def slip(self) -> np.ndarray:
        """Return the distance that the can has slid instead of rolled since the first sample, u - a roll [m]."""
        return measure.slip(self, self.scene.can.radius)

    @cached_property
    def forces(self) -> Forces:
        """Return the normal and friction force [N] that rolling without slipping needs along this motion."""
        return rolling_forces(self.scene, self.phi, self.phi_dot)

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling without slipping was possible with a coefficient of `friction`.

        It is infinite if rolling was possible to the end. Infinite friction, the default, leaves only N > 0 to hold.
        """
        return measure.rolls_until(self.time, self.forces, require.friction(friction))

    def takeoff(self) -> float | None:
        """Return the angle of the load from the top [rad] when the can leaves the incline; None if it stays."""
        return measure.takeoff(self, self.scene.can.radius)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Return the reasons not to trust this motion, one sentence for each; empty if there are none."""
        warnings = []
        radius, estimate = self.scene.can.radius, self.error_estimate
        implied = implied_error(self.scene, self)
        if not implied <= ERROR:
            warnings.append(
                f"energy or momentum drift like an error of {implied:.2g} rad of phi or u/a (trusted up to {ERROR:g}): "
                "take a smaller timestep or a better integrator"
            )
        slip = float(np.abs(self.slip).max()) / radius
        if slip > SLIP:
            warnings.append(f"the can slips by {slip:.2g} radii (trusted up to {SLIP:g})")
        if estimate is not None and not estimate <= ERROR:
            finer = "half the timestep" if self.timestep is not None else "a tighter tolerance"
            warnings.append(
                f"phi and u/a are off by {estimate:.2g} rad (trusted up to {ERROR:g}), as a run at {finer} shows"
                if math.isfinite(estimate)
                else f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
            )
        lift = float(np.abs(self.lift).max()) / radius
        if lift > LIFT:
            warnings.append(
                f"the can parts from the incline, or sinks in, by {lift:.2g} radii (trusted up to {LIFT:g})"
            )
        end = self.rolls_until()
        if self.rolling != "contact" and math.isfinite(end):
            warnings.append(
                f"from t = {end:.6g} s the incline would have to pull at the can (N < 0): a real one leaves it there"
            )
        return tuple(warnings)

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings."""
        return not self.warnings

    def frequency(self) -> float:
        """Return the angular frequency of the swing [rad/s], measured at all its turning points.

        Raises:
          MjbeerError: if the motion has fewer than three turning points, which bound a whole period.
        """
        turns = measure.turning_times(self, self.scene.oscillator)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        periods = (len(turns) - 1) // 2  # only whole periods, as the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))
