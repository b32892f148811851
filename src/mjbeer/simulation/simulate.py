"""The function `simulate`, the run that it returns, and the run's error by a second one."""

import math
import os
import warnings
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import DivergenceError, LiquidWarning, ParameterError, ToleranceError, UntrustedWarning
from mjbeer.model.joints import joint_addresses, to_coordinates
from mjbeer.model.setting import FRICTION, MJBEER_INTEGRATORS, Integrator, Rolling, Setting
from mjbeer.simulation.simulator import Simulator
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.oscillator import reduced
from mjbeer.theory.record import ERROR, Record, failed_checks, rolling_failures
from mjbeer.theory.scene import DURATION, PHI0, Scene
from mjbeer.theory.trajectory import Trajectory, distance

_ON_A_STEP = 1e-10
"""Largest distance of a requested time from a multiple of the timestep, over the time: a running sum of a million
timesteps, as MuJoCo's own clock counts, is 2e-11 off (measured)."""
_MOST_SAMPLES = 1e8
"""Largest number of samples at every timestep: they take ten gigabytes."""
_MOST_STEPS = 1e12
"""Largest number of steps: at half a microsecond each they take a week."""
_OVER_DISTANCE = 3.2
"""Error estimate over the distance to an uneven run. A contact is 0.62 times as soft in that run, so that its distance
is 1/2.6 of the error; 3.2 allows for an order that has not settled."""
_START_OFFSET = 4e-14
"""Distance between the starts of a run and of the uneven one [rad]: a hundred times their rounding, which shows how
much that matters beside a separatrix. A larger one could move the motion against an error, and hide it."""
_DEPTH = 0.5
"""Depth at which a can in contact starts in the uneven run, over that in the run. The error of softness falls to 0.62
or to 0.38 of itself; that of the depth falls to half, between them, as the two may be of opposite sign."""
_COMPARED, _PARTS = 4096, 32
"""Number of timesteps, evenly spread over a run, at which the uneven run is compared with it besides the samples; and
of the parts of a run to a tolerance, in each of which its runs are compared at least once."""
_MAX_TURN_PER_STEP = 2.0
"""Largest angle that the load may turn in a timestep [rad], unless its motion hardly depends on the angle: J looks the
same at every step of pi, but not to the stages of DOP853."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(Trajectory):
    """A simulated motion and its setting.

    What it says about itself rests on all of its steps, and does not depend on the samples that were asked for.
    """

    setting: Setting
    """How the can was made to roll and how it was stepped."""
    record: Record
    """The extremes of the motion over all its steps, on which its warnings rest."""
    chosen: str
    """The name of the integrator; with a tolerance it is "GaussJackson" or "DOP853"."""
    error: float | None
    """The error that was estimated on the way to a tolerance [rad]; None without one."""
    checkpoints: Coordinates
    """The motion as it was stepped, from `phi0` less its whole turns, at the samples and at times that are spread over
    the whole run, where a second run is compared."""

    def __post_init__(self) -> None:
        """Check nothing: the start is checked before a run, and its samples are finite after it."""

    @property
    def rolling(self) -> str:
        """Return "reduced", "equality" or "contact"."""
        return self.setting.rolling

    @property
    def integrator(self) -> str:
        """Return the name of the integrator."""
        return self.chosen

    @property
    def timestep(self) -> float | None:
        """Return the fixed timestep of the integrator [s]; None with a tolerance."""
        return self.setting.timestep if self.setting.tolerance is None else None

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling without slipping was possible with a coefficient of `friction`.

        It is infinite if rolling was possible to the end. With infinite friction only N > 0 has to hold; any other
        takes a run as long as this one.
        """
        friction = require.non_negative("friction", friction, finite=False)
        if friction == self.record.friction:
            return self.record.rolling_ends_at
        simulator = Simulator(self.scene, self.setting)
        start = simulator.initial_state(reduced(self.phi0), self.phi_dot0)
        record = simulator.solve(start, self.checkpoints.time, friction).record
        assert record is not None
        return record.rolling_ends_at

    @cached_property
    def error_estimate(self) -> float:
        """Return the estimated global error of phi and u/a [rad], relative to the angle where that exceeds 1 rad.

        It rests on the largest distance from a second run. Without a tolerance the first access makes that run, which
        takes up to three times as long as this one; the error is infinite if it diverges. In a contact the slip and the
        depth of the can, both in radii, are added: a can that has slid is elsewhere by as much, and one that has sunk
        in rolls on a smaller radius. A start beyond half a turn adds the rounding of its whole turns.
        """
        error = compare_uneven(self) if self.error is None else self.error
        if self.rolling == "contact":
            error += (self.record.slip + self.record.lift) / self.scene.can.radius
        return error + _turns_rounding(self.phi0)

    @property
    def trusted(self) -> bool:
        """Return whether there are no warnings; with a fixed timestep this needs `error_estimate`'s run."""
        return not self.warnings

    @cached_property
    def failed_checks(self) -> tuple[str, ...]:
        """Return those reasons to doubt that the equations were solved that take no second run."""
        found = failed_checks(self.record, self.rolling)
        turn = self.record.largest_rate * (timestep := self.timestep or 0.0)
        if turn > _MAX_TURN_PER_STEP and self.integrator != "DOP853":
            # Damping slows the load, and the slower it is, the less even it turns: down to the rate that is no trouble.
            rate = min(abs(self.phi_dot0), _MAX_TURN_PER_STEP / timestep) if self.scene.dissipates else self.phi_dot0
            if self.scene.oscillator.unevenness(self.phi0, rate) > ERROR:
                found.append(
                    f"the load turns by {turn:.3g} rad in a timestep (trusted up to {_MAX_TURN_PER_STEP:g}), in which "
                    "its weight and inertia change unseen"
                )
        return tuple(found)

    @cached_property
    def rolling_warnings(self) -> tuple[str, ...]:
        """Return where the can did not, or could not, roll without slipping, one sentence for each."""
        return tuple(rolling_failures(self.record, self.rolling, self.setting.friction))

    @cached_property
    def solver_warnings(self) -> tuple[str, ...]:
        """Return the reasons to doubt that the equations of the model were solved, one sentence for each."""
        if (error := self.error_estimate) <= ERROR:
            return self.failed_checks
        finer = "other timesteps" if self.timestep is not None else "a tighter tolerance"
        if math.isfinite(error):
            found = f"phi and u/a are off by {error:.3g} rad (trusted up to {ERROR:g}), as a run at {finer} shows"
        else:
            found = f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
        return (*self.failed_checks, found)


def compare_uneven(run: Run) -> float:
    """Return the error of phi and u/a [rad] that an uneven run shows, relative beyond 1 rad; infinite if that diverges.

    Constraints that are tuned to the timestep are harder in it, so that its distance from the first run includes the
    effect of their softness. It begins a little aside, which adds that of rounding, and of a contact's depth.
    """
    scene, setting, motion = run.scene, run.setting, run.checkpoints
    phi0 = reduced(run.phi0)
    simulator = Simulator(scene, setting, uneven=True)
    start = simulator.initial_state(phi0 + _START_OFFSET, run.phi_dot0)
    if setting.rolling == "contact":
        start[joint_addresses(simulator.model)["lift"]] *= _DEPTH
    try:
        states = simulator.solve(start, motion.time).states
    except DivergenceError:
        return math.inf
    begin = phi0, scene.start(phi0, run.phi_dot0)[0]
    uneven = to_coordinates(simulator.model, scene, states, motion.time)
    return _OVER_DISTANCE * distance(motion, uneven, scene.can.radius, begin)


def simulate(
    scene: Scene,
    duration: float | None = None,
    phi0: float = PHI0,
    phi_dot0: float = 0.0,
    rolling: Rolling = "reduced",
    integrator: Integrator | None = None,
    timestep: float = 1e-3,
    tolerance: float | None = None,
    times: ArrayLike | None = None,
    friction: float = FRICTION,
    mjcf: str | os.PathLike[str] | None = None,
) -> Run:
    """Return the motion of a scene, stepped by MuJoCo in compiled code.

    Args:
      scene: what rolls.
      duration: how long [s], 2 s if there are no `times` either; samples at every timestep end with the first one at
        or after it.
      phi0: angle of the load to the incline at the start [rad].
      phi_dot0: its rate at the start [rad/s].
      rolling: how the can is made to roll, as in `build`: "reduced", "equality" or "contact".
      integrator: one of MuJoCo's five, "DOP853" or, in "reduced" without damping, "GaussJackson"; RK4 if none is given.
      timestep: fixed timestep [s], to which a contact is tuned; with a tolerance the interval between samples.
      tolerance: largest error of phi and u/a [rad], relative beyond 1 rad, to which the integrator and its steps are
        then chosen. A "contact" is refused, as its softness is an error of the model.
      times: increasing times of the samples [s], for MuJoCo's integrators multiples of the timestep.
      friction: coefficient of friction of a contact.
      mjcf: a folder of MJCF that is read instead of mjbeer's, as in `build`.

    A run that slips, parts from the incline, drifts in energy, or would have to be pulled at gives an
    `UntrustedWarning`, one in which a liquid is no lump any more a `LiquidWarning`, and a start beyond a whole turn an
    `AngleWarning`.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if the MJCF is missing, lacks an element, or moves otherwise than theory says.
      DivergenceError: if the motion stops being finite.
      ToleranceError: if the tolerance is not reached.
    """
    require.instance("scene", scene, Scene)
    if duration is not None:
        duration = require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    require.warn_of_degrees(phi0)
    setting = Setting.of(integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction, mjcf=mjcf)
    if times is None:
        sample_times = _every_step(DURATION if duration is None else duration, setting.timestep)
    else:
        sample_times = _sample_times(duration, setting, require.times("times", times, increasing=True))
    run = integrate(scene, phi0=phi0, phi_dot0=phi_dot0, setting=setting, times=sample_times)
    if found := (*run.failed_checks, *run.rolling_warnings):
        warnings.warn("this run is not to be relied on: " + "; ".join(found), UntrustedWarning, stacklevel=2)
    for about in run.liquid_warnings:
        warnings.warn(about, LiquidWarning, stacklevel=2)
    return run


def _every_step(duration: float, timestep: float) -> np.ndarray:
    """Return the times of all steps [s], from 0 to the first one at or after `duration`."""
    ratio = duration / timestep
    if ratio > _MOST_SAMPLES:
        raise ParameterError(
            f"a duration of {duration!r} s has too many timesteps of {timestep!r} s: at most {_MOST_SAMPLES:g}, "
            "or say with times= which samples to keep"
        )
    nearest = round(ratio)
    last = nearest if abs(ratio - nearest) <= _ON_A_STEP * ratio else math.ceil(ratio)
    return timestep * np.arange(last + 1)


def _sample_times(duration: float | None, setting: Setting, times: np.ndarray) -> np.ndarray:
    """Return the times of the samples [s], which for MuJoCo's integrators are exact multiples of the timestep."""
    timestep = setting.timestep
    if duration is not None and times[-1] > duration * (1 + _ON_A_STEP):
        raise ParameterError(f"times must be between 0 and the duration {duration!r} s, got {times[-1]} s")
    if setting.tolerance is not None:
        return times
    ratios = times / timestep
    if ratios[-1] > _MOST_STEPS:
        raise ParameterError(f"times must be within {_MOST_STEPS:g} timesteps of {timestep!r} s, got {times[-1]} s")
    if setting.integrator in MJBEER_INTEGRATORS:
        return times
    steps = np.rint(ratios)
    off = (np.abs(ratios - steps) > _ON_A_STEP * ratios) | (np.diff(steps, prepend=-1.0) == 0)
    if off.any():
        raise ParameterError(
            f"MuJoCo's integrators have samples at different multiples of the timestep {timestep!r} s only, not at "
            f'{times[off][0]} s; integrator="DOP853" has them anywhere'
        )
    return steps * timestep


def integrate(scene: Scene, phi0: float, phi_dot0: float, setting: Setting, times: np.ndarray) -> Run:
    """Return the motion of a scene in a setting at increasing `times` [s], with the same errors as `simulate`."""
    along, samples, checkpoints = times, slice(None), None
    if setting.tolerance is None:
        last = max(1, int(times[-1] / setting.timestep))
        checkpoints = setting.timestep * np.linspace(0, last, min(last, _COMPARED) + 1).astype(np.int64)
    elif (times[1:] - times[:-1]).max(initial=times[0]) > times[-1] / _PARTS:
        checkpoints = times[-1] * np.linspace(0, 1, _PARTS + 1)
    if checkpoints is not None:
        along = np.sort(np.concatenate([times, checkpoints[checkpoints <= times[-1]]]))
        along = along[np.diff(along, prepend=-1.0) > 0]  # unlike union1d it does not import masked arrays
        samples = np.searchsorted(along, times)
    near_phi0 = reduced(phi0)
    rounding = _turns_rounding(phi0)
    stepped = setting
    if setting.tolerance is not None and rounding > 0:
        if setting.tolerance <= rounding:
            raise ToleranceError(
                f"tolerance {setting.tolerance:g} rad is not reached: doubles near phi0 = {phi0!r} rad have errors of "
                f"up to {rounding:.2g} rad; start less whole turns away"
            )
        stepped = replace(setting, tolerance=setting.tolerance - rounding)
    simulator = Simulator.kept(scene, stepped)
    solution = simulator.solve(simulator.initial_state(near_phi0, phi_dot0), along, friction=math.inf)
    motion = to_coordinates(simulator.model, scene, solution.states, along)
    simulator.check(motion)
    assert solution.record is not None
    arrays = {name: array[samples] for name, array in vars(motion).items()}
    if rounding > 0:
        turns = phi0 - near_phi0
        arrays["phi"] += turns
        if scene.attachment == "frozen":  # u = a phi, and the can turns with its load
            arrays["u"] += scene.can.radius * turns
            arrays["roll"] += turns
    return Run(
        **arrays,
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        setting=setting,
        record=solution.record,
        chosen=solution.integrator,
        error=solution.error,
        checkpoints=motion,
    )


def _turns_rounding(phi0: float) -> float:
    """Return the rounding of phi and u/a [rad] by the whole turns of a start at `phi0` [rad]; 0 up to half a turn.

    Four steps of a calculation round to a double of that size: the difference of the turns, their product with the
    radius, and either sum.
    """
    return 4 * float(np.spacing(abs(phi0))) if abs(phi0) > math.pi else 0.0
