"""The motion of a scene, from theory or from a simulation, with checks of whether it can be trusted."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.theory import conserved, measure
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces, rolling_forces
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trust import doubts


@dataclass(frozen=True, eq=False, kw_only=True)
class Trajectory(Coordinates):
    """A motion of a scene, with the energy, forces and warnings that follow from it.

    Raises:
      ParameterError: if an array is not finite, not one-dimensional, empty, or not as long as the times.
    """

    scene: Scene
    phi0: float
    """Angle phi at time 0 [rad], whether there is a sample of it or not."""
    phi_dot0: float
    """Rate of phi at time 0 [rad/s]."""

    def __post_init__(self) -> None:
        require.instance("scene", self.scene, Scene)
        phi0, phi_dot0 = require.start(self.phi0, self.phi_dot0)
        require.store(self, phi0=phi0, phi_dot0=phi_dot0)
        for name in Coordinates.__dataclass_fields__:
            require.store(self, **{name: require.samples(name, getattr(self, name))})
            if (count := len(getattr(self, name))) != len(self.time):
                raise ParameterError(f"{name} must have as many entries as time, {len(self.time)}, got {count}")

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

    @cached_property
    def record(self) -> Record:
        """Return the extremes of the motion, on which its warnings rest: of all samples, or of all steps of a run."""
        return Record.of(self, self.scene)

    @property
    def energy_drift(self) -> float:
        """Return the largest change of energy, relative to the largest kinetic energy of the swing."""
        return self.record.energy_drift

    @property
    def slip(self) -> np.ndarray:
        """Return the distance that the can has slid instead of rolled, u - a roll [m], at each sample."""
        return measure.slip(self, self.scene.can.radius)

    @cached_property
    def forces(self) -> Forces:
        """Return the normal and friction force [N] that rolling without slipping needs along this motion."""
        return rolling_forces(self.scene, self.phi, self.phi_dot)

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling without slipping was possible with a coefficient of `friction`.

        It is infinite if rolling was possible to the end. Infinite friction, the default, leaves only N > 0 to hold.
        """
        return Record.of(self, self.scene, require.friction(friction)).fails_at

    def takeoff(self) -> float | None:
        """Return the angle of the load from the top [rad] when the can leaves the incline; None if it stays."""
        return measure.takeoff(self, self.scene.can.radius)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Return the reasons not to trust this motion, one sentence for each; empty if there are none."""
        return tuple(doubts(self.record, can_part=self.rolling == "contact"))

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings."""
        return not self.warnings

    def frequency(self) -> float:
        """Return the angular frequency of the swing [rad/s], measured at all its turning points.

        Raises:
          NoEquilibriumError: if the load has no equilibrium to swing about.
          MjbeerError: if the motion hardly swings, if its samples are further apart than about a third of a period, or
            if there are fewer than three turning points among them, which bound a whole period.
        """
        turns = measure.turning_times(self, self.scene.oscillator)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        measure.require_swing(self, self.scene.oscillator, phi0=self.phi0, phi_dot0=self.phi_dot0)
        periods = (len(turns) - 1) // 2  # only whole periods, as the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))
