"""The motion of a scene, from theory or from a simulation, with checks of whether it can be trusted."""

import os
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.theory import conserved, measure
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.forces import Forces, rolling_forces
from mjbeer.theory.record import Record, doubts
from mjbeer.theory.scene import Scene


def _views() -> Any:
    """Return the module that makes pictures and files of a motion; theory knows neither, and does not import it."""
    return import_module("mjbeer.drawing.views")


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Trajectory(Coordinates):
    """A motion of a scene, with the energy, forces and warnings that follow from it.

    The coordinates are those of Fig. 3 of the paper. `u` is the distance of the can's axis down the incline [m],
    positive downhill. `phi` is the angle of the load to the incline [rad]: 0 where its centre of mass is nearest to the
    incline, and growing as the can rolls downhill. `roll` is the angle by which the can itself has turned [rad], which
    is u/a as long as it does not slip. `lift` is its height above the incline [m]. `u_dot`, `phi_dot`, `roll_dot` and
    `lift_dot` are their rates. A sliding load starts at u = b sin(phi0) and not at 0, so that its centre of mass starts
    at s = 0 (eq. 12); a frozen one starts at u = a phi0 (eq. 50).

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
        return rolling_forces(self.scene, self.phi, self.phi_dot, self.u_dot)

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
        return tuple(doubts(self.record, self.rolling))

    def plot(self, theory: bool = False) -> Any:
        """Plot phi [degrees] and u [m] over time in a new figure, and return its two matplotlib axes.

        With `theory`, the exact motion from the same start is drawn beneath.
        """
        return _views().plot(self, theory)

    def to_dataframe(self) -> Any:
        """Return the motion as a pandas DataFrame: a row for each sample, columns with their units.

        Raises:
          MjbeerError: if pandas is not installed.
        """
        return _views().dataframe(self)

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the motion as CSV: one line per sample, units in the header, numbers with all their digits.

        Raises:
          OutputError: if the file cannot be written.
        """
        _views().write_csv(self, path)

    def video(
        self,
        width: int = 640,
        height: int = 360,
        fps: float = 30,
        speed: float = 1.0,
        camera: str = "auto",
        progress: bool = True,
    ) -> Any:
        """Return a video of the motion, which a notebook shows; the arguments are those of `mjbeer.render`.

        Raises:
          ParameterError: if an argument is not allowed.
          RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
        """
        return _views().video(self, width, height, fps, speed, camera, progress)

    def __repr__(self) -> str:
        """Return the motion in one line; whether it is trusted is not in it, as that may take a second run."""
        time = self.time
        return (
            f"<{type(self).__name__} {self.scene.attachment}, {self.rolling}, {self.integrator}: {len(time)} "
            f"sample{'s' * (len(time) != 1)} to t = {time[-1]:.6g} s, phi = {self.phi[-1]:.6g} rad, "
            f"u = {self.u[-1]:.6g} m>"
        )

    def _repr_html_(self) -> str:
        """Return the motion's key figures, and what it says about itself, for a notebook."""
        return _views().trajectory_html(self)

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings."""
        return not self.warnings

    def frequency(self) -> float:
        """Return the angular frequency of the swing [rad/s], measured at all its turning points.

        With damping or drag these are the turning points until the swing has died away.

        Raises:
          NoEquilibriumError: if the load has no equilibrium to swing about.
          NoLibrationError: if the damping lets it creep back without a swing.
          MjbeerError: if the motion hardly swings, if its samples are further apart than about a third of a period, or
            if there are fewer than three turning points among them, which bound a whole period.
        """
        swing = measure.swinging(self, self.scene)
        turns = measure.turning_times(swing, self.scene)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        measure.require_swing(swing, self.scene, phi0=self.phi0, phi_dot0=self.phi_dot0)
        periods = (len(turns) - 1) // 2  # only whole periods, as the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))
