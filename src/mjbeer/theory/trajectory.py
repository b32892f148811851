"""A motion of a scene, from theory or from a simulation, and whether to rely on it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.exceptions import MjbeerError
from mjbeer.theory import conserved, measure
from mjbeer.theory.conserved import implied_error
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces, rolling_forces
from mjbeer.theory.scene import Scene

ERROR = 1e-2
"""Largest estimated error of phi and u/a that is trusted [rad], relative beyond 1 rad: half a degree."""
SLIP = 1e-3
"""Largest slip that is trusted, in radii: a milliradian of roll angle."""
LIFT = 1e-3
"""Largest gap or penetration between can and incline that is trusted, in radii."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Trajectory(Coordinates):
    """A motion of a scene, one row a sample, with the energy, forces and warnings that follow from it."""

    scene: Scene

    @property
    def rolling(self) -> str:
        """How the can was made to roll: "exact" in theory; "reduced", "equality" or "contact" in a simulation."""
        return "exact"

    @property
    def integrator(self) -> str:
        """Name of the integrator, or "exact"."""
        return "exact"

    @property
    def timestep(self) -> float | None:
        """Fixed step of the integrator [s]; None if it had none."""
        return None

    @property
    def error_estimate(self) -> float | None:
        """Estimated error of phi and u/a [rad]; None in theory, which has none."""
        return None

    @cached_property
    def energy(self) -> np.ndarray:
        """Kinetic and potential energy of can and load together [J], at each sample."""
        return conserved.energy(self.scene, self)

    @property
    def energy_drift(self) -> float:
        """Largest change of energy over the run, relative to the largest kinetic energy of the swing."""
        return conserved.energy_drift(self.scene, self)

    @property
    def slip(self) -> np.ndarray:
        """Distance that the can has slid instead of rolled since the first sample, u - a roll [m]."""
        return measure.slip(self, self.scene.can.radius)

    @cached_property
    def forces(self) -> Forces:
        """Normal and friction force [N] that rolling without slipping needs along this motion."""
        return rolling_forces(self.scene, self.phi, self.phi_dot)

    def rolls_until(self, friction: float = np.inf) -> float:
        """Until when [s] rolling without slipping was possible at a friction coefficient.

        Infinite if it was to the end. With the default only N > 0 is asked for.
        """
        return measure.rolls_until(self.time, self.forces, friction)

    def takeoff(self) -> float | None:
        """Angle from the top [rad] at which the load is when the can leaves the incline; None if it does not."""
        return measure.takeoff(self, self.scene.can.radius)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Why this motion is not to be relied on, a sentence each; empty if nothing is wrong."""
        warnings = []
        radius, estimate = self.scene.can.radius, self.error_estimate
        implied = implied_error(self.scene, self)
        if not implied <= ERROR:
            warnings.append(
                f"energy or momentum drift like an error of {implied:.2g} rad of phi or u/a (trusted up to {ERROR:g}): "
                "take a smaller timestep or a better integrator"
            )
        slid = float(np.abs(self.slip).max()) / radius
        if slid > SLIP:
            warnings.append(f"the can slips by {slid:.2g} radii (trusted up to {SLIP:g})")
        if estimate is not None and not estimate <= ERROR:
            finer = "half the timestep" if self.timestep is not None else "a tighter tolerance"
            warnings.append(
                f"phi and u/a are off by {estimate:.2g} rad (trusted up to {ERROR:g}), as a run at {finer} shows"
                if math.isfinite(estimate)
                else f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
            )
        lifted = float(np.abs(self.lift).max()) / radius
        if lifted > LIFT:
            warnings.append(
                f"the can parts from the incline, or sinks in, by {lifted:.2g} radii (trusted up to {LIFT:g})"
            )
        parted = self.rolls_until()
        if self.rolling != "contact" and math.isfinite(parted):
            warnings.append(
                f"from t = {parted:.6g} s the incline would have to pull at the can (N < 0): a real one leaves it there"
            )
        return tuple(warnings)

    @property
    def trusted(self) -> bool:
        """Whether there are no warnings."""
        return not self.warnings

    def frequency(self) -> float:
        """Measured angular frequency of the swing [rad/s], from all its turning points.

        Raises:
          MjbeerError: if the motion has fewer than two turning points of the same kind.
        """
        turns = measure.turning_times(self, self.scene.oscillator)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        periods = (len(turns) - 1) // 2  # whole ones: the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))
