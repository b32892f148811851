"""The motion of a scene, from theory or a simulation.

What is measured on it, and whether it can be trusted.
"""

import io
import math
import os
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.theory import damped_motion, equations, motion
from mjbeer.theory.equations import (
    Coordinates,
    Forces,
    accelerations,
    axis_motion,
    initial_state,
    rolling_forces,
    select_samples,
)
from mjbeer.theory.record import Diagnosis, Record, diagnose
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

    from mjbeer.drawing.video import Camera


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Trajectory(Coordinates):
    """A motion of a scene, with the energy, forces and warnings that follow.

    It has an array for each of the `Coordinates`.

    Raises:
      ParameterError: if an array is not finite, not one-dimensional, empty, or not as long as the
        times, or if the times do not increase.
    """

    scene: Scene
    phi0: float
    """Angle phi at time 0 [rad], whether there is a sample of it or not."""
    phi_dot0: float
    """Rate of phi at time 0 [rad/s]."""

    def __post_init__(self) -> None:
        require.instance("scene", self.scene, Scene)
        phi0, phi_dot0 = require.start(self.phi0, self.phi_dot0)
        require.set_fields(self, phi0=phi0, phi_dot0=phi_dot0)
        for name in Coordinates.__dataclass_fields__:
            samples = require.samples(name, getattr(self, name))
            if len(samples) != len(self.time):
                needed = f"{name} must have as many entries as time, {len(self.time)}"
                raise ParameterError(f"{needed}, got {len(samples)}")
            require.set_fields(self, **{name: samples})
        require.times("time", self.time, increasing=True)

    @property
    def rolling(self) -> str:
        """Return how the can rolls.

        It is "exact" in theory; "reduced", "equality" or "contact" in a simulation.
        """
        return "exact"

    @property
    def integrator(self) -> str:
        """Return the name of the integrator, or "exact"."""
        return "exact"

    @cached_property
    def energy(self) -> np.ndarray:
        """Return the kinetic and potential energy of can and load together [J], at each sample."""
        kinetic = equations.kinetic_energy(self.scene, self)
        return kinetic + equations.potential_energy(self.scene, self)

    @cached_property
    def record(self) -> Record:
        """Return the extremes of the motion, on which its warnings rest.

        They are those of all samples, or of all steps of a run.
        """
        return Record.of(self, self.scene)

    @property
    def energy_drift(self) -> float:
        """Return the largest change of energy divided by the swing's largest kinetic energy."""
        return self.record.energy_drift

    @property
    def distance(self) -> np.ndarray:
        """Return how far the axis has come down the incline since time 0 [m], at each sample."""
        return self.u - initial_state(self.scene, self.phi0, self.phi_dot0).u

    @property
    def slip(self) -> np.ndarray:
        """Return the distance that the can has slid instead of rolled [m], at each sample.

        It is u - a roll.
        """
        return self.u - self.scene.can.radius * self.roll

    @cached_property
    def forces(self) -> Forces:
        """Return the normal and friction force [N] that rolling without slipping needs."""
        return rolling_forces(self.scene, self.phi, self.phi_dot, self.u_dot)

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling without slipping was possible.

        The coefficient of friction is `friction`; with infinite friction, the default, only N > 0
        has to hold. The time is infinite if rolling was possible to the end.

        Raises:
          ParameterError: if `friction` is negative or no number.
        """
        friction = require.non_negative("friction", friction, finite=False)
        return Record.of(self, self.scene, friction).rolling_ends_at

    @cached_property
    def diagnosis(self) -> Diagnosis:
        """Return what the record says against the motion."""
        return diagnose(self.record, self.rolling)

    @property
    def solver_warnings(self) -> tuple[str, ...]:
        """Return the reasons to doubt that the model's equations were solved, a sentence each."""
        return self.diagnosis.solver

    @property
    def rolling_warnings(self) -> tuple[str, ...]:
        """Return where a can did not, or could not, roll without slipping, a sentence each."""
        return self.diagnosis.rolling

    @property
    def liquid_warnings(self) -> tuple[str, ...]:
        """Return where the model of a liquid does not hold, a sentence each.

        It is no lump, slips faster or slower than its damping allows, or its surface tilts by more
        than 0.2 rad against its rest.
        """
        return self.diagnosis.liquid

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return the reasons not to trust this motion, a sentence each.

        Those of the solver come first, then those of rolling and of a liquid.
        """
        return (*self.solver_warnings, *self.rolling_warnings, *self.liquid_warnings)

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings."""
        return not self.warnings

    def frequency(self) -> float:
        """Return the angular frequency of the swing [rad/s].

        It is measured at all turning points until the swing dies away.

        Raises:
          NoEquilibriumError: if the load has no equilibrium to swing about.
          NoLibrationError: if the damping lets it creep back without a swing.
          MjbeerError: if the motion has fewer than three turning points of swings of 1e-5 rad, or
            its samples are too far apart.
        """
        scene = self.scene
        # What is slower may be rounding, or the ringing of a contact.
        fast = np.flatnonzero(np.abs(self.phi_dot) > 1e-5 * scene.frequency())
        swing = select_samples(self, slice(int(np.max(fast, initial=-1)) + 1))
        phi_ddot = accelerations(scene, swing.phi, swing.phi_dot, swing.u_dot).phi_ddot
        turning_times = _sign_changes(swing.time, swing.phi_dot, phi_ddot)
        if len(turning_times) < 3:
            missing = f"no frequency: a swing of 1e-5 rad turns {len(turning_times)} times here"
            raise MjbeerError(f"{missing}, and 3 are needed")
        # A small swing without damping is the fastest one.
        if not np.diff(swing.time).max() * scene.oscillator.frequency() <= math.tau / 3:
            missing = "no frequency: the samples are too far apart"
            raise MjbeerError(f"{missing}; at least three a period are needed")
        # Only whole periods, as the two halves of a swing differ on an incline.
        periods = (len(turning_times) - 1) // 2
        return float(math.tau * periods / (turning_times[2 * periods] - turning_times[0]))

    def plot(self, *names: str, theory: bool = False) -> "tuple[Axes, ...]":
        """Plot quantities, as "phi", "u" and "energy", in a new figure.

        Return the matplotlib axes of each. Without names they are phi [degrees] and u [m]. With
        `theory`, the exact motion from the same start is beneath.

        Raises:
          ParameterError: if there is no quantity of a name; the message lists the names.
        """
        from mjbeer.drawing import plot

        return plot.plot(self, *names, theory=theory)

    def video(
        self,
        path: str | os.PathLike[str] | None = None,
        width: int = 640,
        height: int = 360,
        fps: float = 30,
        speed: float = 1.0,
        camera: "Camera" = "auto",
        progress: bool = True,
    ) -> None:
        """Write a video of the motion to `path` (.mp4), or show it in a notebook if there is none.

        The arguments and the errors are those of `mjbeer.render`.
        """
        from mjbeer.drawing import video

        video.render(self, path, width, height, fps, speed, camera, progress)

    def to_dataframe(self) -> "DataFrame":
        """Return the motion as a pandas DataFrame: a row for each sample, units in the headers."""
        import pandas as pd

        return pd.DataFrame(_columns(self))

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the motion as CSV: a line for each sample, units in the header, all digits.

        Raises:
          OutputError: if the file cannot be written.
        """
        from mjbeer.output import files

        files.write(require.path(path), csv(self))

    def __repr__(self) -> str:
        """Return the motion in one line, which does not say whether it is trusted.

        That may take a second run.
        """
        kind = f"{type(self).__name__} {self.scene.attachment}, {self.rolling}, {self.integrator}"
        end = f"t = {self.time[-1]:.6g} s, phi = {self.phi[-1]:.6g} rad, u = {self.u[-1]:.6g} m"
        samples = f"{len(self.time)} sample{'s' if len(self.time) != 1 else ''}"
        return f"<{kind}: {samples} to {end}>"


def exact(scene: Scene, time: ArrayLike, phi0: float, phi_dot0: float = 0.0) -> Trajectory:
    """Return the exact motion of a scene from `phi0` [rad] and `phi_dot0` [rad/s] at time 0.

    `time` [s] has the increasing times of the samples, none before 0. `Scene.initial_axis` has u
    and u_dot at time 0. A start beyond a whole turn gives an `AngleWarning`, as degrees may have
    been meant.

    Raises:
      ParameterError: if `scene` is no scene, times are negative, not finite or not increasing, the
        start is not between -1e4 and 1e4 rad or -1e6 and 1e6 rad/s, the motion has more than 1e4
        turns on an incline, or is beyond double precision.
      NoLibrationError: if the start is so near the separatrix that its rounding decides how the
        motion goes on.
      ToleranceError: with damping or drag, if the motion takes too many steps, or rounding of the
        start changes phi by more than 1e-4 rad; the message says until when it can be followed.
    """
    require.instance("scene", scene, Scene)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    require.warn_of_degrees(phi0)
    return exact_motion(scene, require.times("time", time, increasing=True), phi0, phi_dot0)


def exact_motion(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> Trajectory:
    """Return the motion of `exact`, without a warning about the start."""
    radius = scene.can.radius
    start = initial_state(scene, phi0, phi_dot0)
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            if scene.dissipates:
                swing, axis = damped_motion.solve(scene, time, start)
            else:
                swing = motion.solve(scene.oscillator, time, phi0, phi_dot0)
                axis = axis_motion(scene, time, swing.phi, swing.phi_dot, start)
    except ArithmeticError as error:
        raise ParameterError(
            f"this motion is beyond double precision ({error}), got phi0 = {phi0!r} rad, "
            f"phi_dot0 = {phi_dot0!r} rad/s until {float(time.max())!r} s in {scene!r}"
        ) from error
    still = np.zeros_like(time)
    return Trajectory(
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        time=time,
        u=axis.u,
        phi=swing.phi,
        u_dot=axis.u_dot,
        phi_dot=swing.phi_dot,
        roll=axis.u / radius,
        roll_dot=axis.u_dot / radius,
        lift=still,
        lift_dot=still,
    )


def csv(motion: Trajectory) -> str:
    """Return a motion as CSV, as `Trajectory.to_csv` writes it."""
    table = _columns(motion)
    rows = np.column_stack(list(table.values()))
    text = io.StringIO()
    np.savetxt(text, rows, fmt="%.17g", delimiter=",", header=",".join(table), comments="")
    return text.getvalue()


def _columns(motion: Trajectory) -> dict[str, np.ndarray]:
    """Return the columns of a motion's table by their names, which end with the unit."""
    units = {"time": "s", "u": "m", "phi": "rad", "u_dot": "m/s", "phi_dot": "rad/s"}
    units |= {"roll": "rad", "lift": "m", "slip": "m", "energy": "J"}
    columns = {f"{name} [{unit}]": getattr(motion, name) for name, unit in units.items()}
    for name, force in vars(motion.forces).items():
        columns[f"{name} force needed [N]"] = force
    return columns


def largest_error(
    motion: Coordinates, truth: Coordinates, radius: float, start: tuple[float, float] | None = None
) -> float:
    """Return the largest distance of phi and of u/a [rad] from another motion at the same times.

    With phi [rad] and u [m] at the `start`, each distance is divided by the largest angle that
    `truth` has turned from there so far, where that exceeds 1 rad. This is the error that a
    tolerance bounds.
    """
    angles = np.column_stack([motion.phi, motion.u / radius])
    true_angles = np.column_stack([truth.phi, truth.u / radius])
    if start is None:
        return largest_angle_error(angles, true_angles)
    phi0, u0 = start
    return largest_angle_error(angles, true_angles, np.array([phi0, u0 / radius]))


def largest_angle_error(
    angles: np.ndarray,
    true_angles: np.ndarray,
    start_angles: np.ndarray | None = None,
) -> float:
    """Return the largest distance [rad] of angles from the true ones.

    Both have the shape (samples, angles), in the order of time. With `start_angles`, of shape
    (angles,), each distance is divided by the largest angle turned from there so far, where that
    exceeds 1 rad. The distance from what is no number is infinite.
    """
    apart = np.abs(angles - true_angles)
    if start_angles is not None:
        turned = np.abs(true_angles - start_angles)
        apart /= np.maximum(1.0, np.maximum.accumulate(turned))
    largest = float(apart.max())
    return largest if largest < math.inf else math.inf


def _sign_changes(time: np.ndarray, rate: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Return the times [s] at which `rate` changes sign; its derivative is `change`.

    Between two samples it is taken to be the cubic that has its values and derivatives at both,

        first + first_slope x + square x^2 + cube x^3,

    where x is the share of the step and slopes are derivatives by x.
    """
    before = np.flatnonzero(np.diff(rate > 0))
    step = np.diff(time)[before]
    first = rate[before]
    last = rate[before + 1]
    first_slope = step * change[before]
    last_slope = step * change[before + 1]
    square = 3 * (last - first) - 2 * first_slope - last_slope
    cube = 2 * (first - last) + first_slope + last_slope
    low = np.zeros_like(step)
    high = np.ones_like(step)
    for _ in range(54):  # bisection to the last digit
        x = (low + high) / 2
        value = first + x * (first_slope + x * (square + x * cube))
        is_beyond = (value > 0) != (first > 0)
        low = np.where(is_beyond, low, x)
        high = np.where(is_beyond, x, high)
    return time[before] + step * high
