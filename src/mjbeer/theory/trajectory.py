"""A motion of a scene, from theory or from a simulation, with what it says about itself."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mjbeer.exceptions import MjbeerError
from mjbeer.theory import diagnostics
from mjbeer.theory.forces import Forces, rolling_forces
from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A motion, one row a sample. Fields named `_dot` are rates of change [per s]."""

    scene: Scene
    rolling: str
    """How the can was made to roll: "exact" (theory), "reduced", "equality" or "contact"."""
    integrator: str
    """Integrator, or "exact"."""
    timestep: float | None
    """Fixed step of the integrator [s], if it had one."""
    time: np.ndarray
    """Time [s]."""
    u: np.ndarray
    """Distance of the axis down the incline [m], paper's Fig. 3."""
    phi: np.ndarray
    """Angle of the load's flat surface to the incline [rad], paper's Fig. 3."""
    u_dot: np.ndarray
    phi_dot: np.ndarray
    roll: np.ndarray
    """Angle by which the can has rolled [rad]; u/a where it does not slip."""
    roll_dot: np.ndarray
    lift: np.ndarray
    """Height of the can above the incline [m]; slightly negative in a soft contact."""
    lift_dot: np.ndarray
    second_opinion: Callable[[], float] | None = field(default=None, repr=False)
    """Estimates the error of a simulation by another run; not called before somebody asks."""

    @cached_property
    def error_estimate(self) -> float | None:
        """Estimated global error of phi and u/a [rad], relative to the total angle where that exceeds 1 rad.

        It is by a second run: the one that a tolerance took anyway, or one at half the timestep, which is made when
        this is first asked for and takes twice as long as the first. Infinite if that one diverges; None for theory.
        """
        return None if self.second_opinion is None else self.second_opinion()

    @cached_property
    def energy(self) -> np.ndarray:
        """Kinetic and potential energy of can and load together [J]."""
        return diagnostics.energy(self)

    @property
    def energy_drift(self) -> float:
        """Largest change of energy over the run, relative to the largest kinetic energy of the swing."""
        return diagnostics.energy_drift(self)

    @property
    def slip(self) -> np.ndarray:
        """Distance that the can has slid instead of rolled, u - a roll less that at the start [m]."""
        return diagnostics.slip(self)

    @cached_property
    def forces(self) -> Forces:
        """Normal and friction force [N] that rolling without slipping needs along this motion."""
        return rolling_forces(self.scene, self.phi, self.phi_dot)

    def rolls_until(self, friction: float = np.inf) -> float:
        """Until when [s] rolling without slipping was possible at a friction coefficient.

        Infinite if it was to the end. With the default only N > 0 is asked for.
        """
        return diagnostics.rolls_until(self, friction)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Why this motion is not to be relied on, a sentence each; empty if nothing is wrong."""
        return diagnostics.warnings(self)

    @property
    def trusted(self) -> bool:
        """Whether the run's own diagnostics found nothing wrong with it."""
        return not self.warnings

    def frequency(self) -> float:
        """Measured angular frequency of the swing [rad/s], from all its turning points.

        Raises:
          MjbeerError: if the motion has fewer than two turning points of the same kind.
        """
        turns = diagnostics.turning_times(self)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        periods = (len(turns) - 1) // 2  # whole ones: the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))
