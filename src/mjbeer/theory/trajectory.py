"""The motion of a scene, from theory or a simulation: what is measured on it, and whether it can be trusted."""

import io
import math
import os
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.theory import equations
from mjbeer.theory.equations import Coordinates, Forces, accelerations, rolling_forces
from mjbeer.theory.record import Record, doubts
from mjbeer.theory.scene import Scene, views

_LEAST_SWING = 1e-10
"""Smallest swing whose frequency is measured [rad], relative beyond 1 rad: a million times the rounding of phi."""
_FOLLOWED = 0.05
"""Largest difference between the angle from one sample to the next and that from their rates and accelerations, over
the range of phi. Four samples a period of a small swing have 0.007, three have 0.03, two have 0.2."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Trajectory(Coordinates):
    """A motion of a scene, with the energy, forces and warnings that follow from it.

    The coordinates are those of Fig. 3 of the paper. `u` is the place of the can's axis along the incline [m],
    positive downhill. It starts at b sin(phi0) for a sliding load, whose centre of mass starts at
    s = u - b sin(phi) = 0 (eq. 12), and at a phi0 for a frozen one (eq. 50): `distance` is counted from the start.
    `phi` is the angle of the load to the incline [rad]: 0 where its centre of mass is nearest to the incline, and
    growing as the can rolls downhill. `roll` is the angle by which the can itself has turned [rad], which is u/a as
    long as it does not slip. `lift` is its height above the incline [m]. `u_dot`, `phi_dot`, `roll_dot` and `lift_dot`
    are their rates.

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
        return equations.energy(self.scene, self)

    @cached_property
    def record(self) -> Record:
        """Return the extremes of the motion, on which its warnings rest: of all samples, or of all steps of a run."""
        return Record.of(self, self.scene)

    @property
    def energy_drift(self) -> float:
        """Return the largest change of energy, relative to the largest kinetic energy of the swing."""
        return self.record.energy_drift

    @property
    def distance(self) -> np.ndarray:
        """Return how far the axis has come down the incline since time 0 [m], at each sample."""
        return self.u - self.scene.start(self.phi0, self.phi_dot0)[0]

    @property
    def slip(self) -> np.ndarray:
        """Return the distance that the can has slid instead of rolled, u - a roll [m], at each sample."""
        return slip(self, self.scene.can.radius)

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
        return takeoff(self, self.scene.can.radius)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Return the reasons not to trust this motion, one sentence for each; empty if there are none."""
        return tuple(doubts(self.record, self.rolling))

    def plot(self, *names: str, theory: bool = False) -> Any:
        """Plot quantities, as "phi", "u" and "energy", in a new figure, and return the matplotlib axes of each.

        Without names they are phi [degrees] and u [m]. With `theory`, the exact motion from the same start is beneath.

        Raises:
          ParameterError: if there is no quantity of a name; the message lists the names.
        """
        return views().plot(self, *names, theory=theory)

    def to_dataframe(self) -> Any:
        """Return the motion as a pandas DataFrame: a row for each sample, columns with their units.

        Raises:
          MjbeerError: if pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise MjbeerError("to_dataframe needs pandas: pip install pandas") from error
        return pd.DataFrame(self._columns())

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the motion as CSV: one line per sample, units in the header, numbers with all their digits.

        Raises:
          OutputError: if the file cannot be written.
        """
        from mjbeer.output import files

        files.write(require.path(path), csv(self))

    def _columns(self) -> dict[str, np.ndarray]:
        """Return the columns of the motion's table by their names, which end with the unit."""
        return {
            "time [s]": self.time,
            "u [m]": self.u,
            "phi [rad]": self.phi,
            "u_dot [m/s]": self.u_dot,
            "phi_dot [rad/s]": self.phi_dot,
            "roll [rad]": self.roll,
            "lift [m]": self.lift,
            "slip [m]": self.slip,
            "energy [J]": self.energy,
            "normal force needed [N]": self.forces.normal,
            "friction force needed [N]": self.forces.friction,
        }

    def video(
        self,
        path: str | os.PathLike[str] | None = None,
        width: int = 640,
        height: int = 360,
        fps: float = 30,
        speed: float = 1.0,
        camera: str = "auto",
        progress: bool = True,
    ) -> Any:
        """Return a video of the motion, which a notebook shows, and write it to `path` (.mp4) if there is one.

        The other arguments are those of `mjbeer.render`.

        Raises:
          ParameterError: if an argument is not allowed.
          RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
          OutputError: if the file cannot be written.
        """
        return views().video(self, path, width, height, fps, speed, camera, progress)

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
        return views().trajectory_html(self)

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
        swing = swinging(self, self.scene)
        turns = turning_times(swing, self.scene)
        if len(turns) < 3:
            raise MjbeerError(
                f"no frequency: the motion turns {len(turns)} times in {self.time[-1]:.6g} s, 3 are needed"
            )
        require_swing(swing, self.scene, phi0=self.phi0, phi_dot0=self.phi_dot0)
        periods = (len(turns) - 1) // 2  # only whole periods, as the two halves of a swing differ on an incline
        return float(2 * np.pi * periods / (turns[2 * periods] - turns[0]))


def csv(motion: Trajectory) -> str:
    """Return a motion as CSV: one line per sample, units in the header, numbers with all their digits."""
    table, text = motion._columns(), io.StringIO()
    rows, header = np.column_stack(list(table.values())), ",".join(table)
    np.savetxt(text, rows, fmt="%.17g", delimiter=",", header=header, comments="")
    return text.getvalue()


def angle_distance(angles: np.ndarray, truth: np.ndarray, start: float | None = None) -> float:
    """Return the largest distance of `angles` from `truth` [rad].

    With the angle at the `start` [rad], each distance is divided by the largest angle that `truth` has turned from
    there so far, where that exceeds 1 rad: this is the error that a tolerance bounds. `truth` is then in order of time.
    """
    apart = np.abs(angles - truth)
    if start is None:
        return float(np.max(apart))
    return float(np.max(apart / np.maximum(1, np.maximum.accumulate(np.abs(truth - start)))))


def distance(motion: Coordinates, truth: Coordinates, radius: float, start: tuple[float, float] | None = None) -> float:
    """Return the larger of `angle_distance` for phi and for u/a [rad] from another motion at the same times.

    `start` has phi [rad] and u [m] at time 0, from which the distance is made relative.
    """
    phi, u = start if start is not None else (None, None)
    return max(
        angle_distance(motion.phi, truth.phi, phi),
        angle_distance(motion.u / radius, truth.u / radius, u / radius if u is not None else None),
    )


def slip(motion: Coordinates, radius: float) -> np.ndarray:
    """Return the distance that a can of this `radius` [m] has slid instead of rolled [m]: u - a roll."""
    return motion.u - radius * motion.roll


def mean_acceleration(motion: Coordinates) -> float:
    """Return the mean acceleration of the axis down the incline [m/s^2] of a motion that starts at rest."""
    return float(2 * (motion.u[-1] - motion.u[0]) / motion.time[-1] ** 2)


def takeoff(motion: Coordinates, radius: float) -> float | None:
    """Return the angle of the load from the top [rad] when the can leaves the incline; None if it stays.

    A lift of up to 1e-9 radii counts as touching: a soft contact sinks in by more than that.
    """
    above = np.flatnonzero(motion.lift > 1e-9 * radius)
    return None if not len(above) else math.pi - float(motion.phi[above[0]])


def turning_times(motion: Coordinates, scene: Scene) -> np.ndarray:
    """Return the times [s] at which phi_dot changes sign, with an error of fourth order in the sampling interval.

    Between the two samples around a change of sign, phi_dot is replaced by the cubic that has its values and its
    derivatives at both. The derivatives, phi_ddot, come from the equation of motion.
    """
    time, phi_dot = motion.time, motion.phi_dot
    _, phi_ddot = accelerations(scene, motion.phi, phi_dot, motion.u_dot)
    turns = []
    for before in np.flatnonzero((phi_dot[:-1] > 0) != (phi_dot[1:] > 0)):
        step = time[before + 1] - time[before]
        p0, p1 = phi_dot[before], phi_dot[before + 1]
        m0, m1 = step * phi_ddot[before], step * phi_ddot[before + 1]
        cubic = np.polynomial.Polynomial([p0, m0, 3 * (p1 - p0) - 2 * m0 - m1, 2 * (p0 - p1) + m0 + m1])
        roots = cubic.roots()
        real = roots.real[np.abs(roots.imag) < 1e-9]
        inside = real[(real >= -1e-9) & (real <= 1 + 1e-9)]
        turns.append(time[before] + step * (inside[0] if len(inside) else p0 / (p0 - p1)))
    return np.array(turns)


def swinging(motion: Coordinates, scene: Scene) -> Coordinates:
    """Return the samples of a motion up to the last that still swings, where damping or drag ends the swing.

    What is left then is the rounding of phi_dot, whose changes of sign are no turning points.
    """
    if not scene.dissipates:
        return motion
    least = _LEAST_SWING * scene.frequency() * max(1.0, float(np.abs(motion.phi).max()))
    last = int(np.flatnonzero(np.abs(motion.phi_dot) > least).max(initial=-1)) + 1
    return Coordinates(**{name: getattr(motion, name)[:last] for name in Coordinates.__dataclass_fields__})


def require_swing(motion: Coordinates, scene: Scene, phi0: float, phi_dot0: float) -> None:
    """Check that turning points of the motion from a start [rad, rad/s] are those of a swing that its samples follow.

    Raises:
      NoEquilibriumError: if the load has no equilibrium to swing about.
      MjbeerError: if the motion rests but for rounding and the softness of a contact, or its samples are too far apart.
    """
    rest, oscillator = scene.equilibrium(), scene.oscillator
    rest += 2 * math.pi * round((phi0 - rest) / (2 * math.pi))
    if not scene.dissipates:  # `swinging` does it where the energy is not that of a swing alone
        energy = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2 + float(oscillator.drop(rest, phi0))
        least = oscillator.crest.curvature * (_LEAST_SWING * max(1.0, abs(phi0))) ** 2 / 2
        kinetic = float((oscillator.inertia(motion.phi) * motion.phi_dot**2).max()) / 2
        if not energy > least or kinetic > 2 * energy:
            raise MjbeerError(
                f"no frequency: the load starts with {energy:.2g} J above its equilibrium, which is a swing of less "
                f"than {_LEAST_SWING:g} rad, or one that is hidden by what else moves the load, up to {kinetic:.2g} J"
            )
    phi, phi_dot, step = motion.phi, motion.phi_dot, np.diff(motion.time)
    _, phi_ddot = accelerations(scene, phi, phi_dot, motion.u_dot)
    turned = step * (phi_dot[:-1] + phi_dot[1:]) / 2 - step**2 * np.diff(phi_ddot) / 12
    if len(phi) > 1 and not np.abs(turned - np.diff(phi)).max() <= _FOLLOWED * np.ptp(phi):
        raise MjbeerError(
            f"no frequency: the samples, up to {step.max():.3g} s apart, do not follow the swing; at least three a "
            "period are needed"
        )
