"""The judge of runs: whether one is right, refused, doubted by itself, or wrong and silent.

Two theories that share no code, exact theory and Taylor series, say what is right wherever both
know the motion.
"""

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.exceptions import (
    DivergenceError,
    NoLibrationError,
    ParameterError,
    ToleranceError,
    UnsupportedError,
    UntrustedWarning,
)
from mjbeer.model.attach import attach
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import FRICTION, Integrator, Rolling
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.taylor_series import series
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import exact, exact_motion

RIGHT = "right"
REFUSED = "refused"
WARNED = "doubted"
UNDETECTED_ERROR = "silent"
VERDICTS = (RIGHT, REFUSED, WARNED, UNDETECTED_ERROR)
"""The ways in which a run can end.

It is right if it is trusted, with an error of at most `record.ERROR` and of its tolerance; refused
if it ends in an error that states the reason; doubted if it warns, whether it is right or wrong. It
is silent if it is trusted and wrong, which must not happen.
"""
BOTH = "two theories"
THEORY = "exact theory alone"
SERIES = "series alone"
NOBODY = "nobody"
JUDGES = (BOTH, THEORY, SERIES, NOBODY)
"""The judges that a run can have.

The series do not cover damping, and exact theory does not cover motions on a separatrix.
"""
REFUSALS = (ParameterError, ToleranceError, UnsupportedError, DivergenceError)
"""The errors by which a run is refused. Any other, such as a missing template, stops the study."""
_ROUNDING = float(np.finfo(float).eps)
MAX_AMPLIFICATION = 10.0
"""Largest distance between the two theories that rounding explains.

It is relative to the effect of rounding errors in the numbers of start and scene. In 2,400 random
runs it was at most 2 where the distance needed an explanation.
"""
_FLOOR = 1e-11
"""Distance between the two theories that needs no explanation [rad], relative beyond 1 rad.

The rounding of a hundred swings, each of which takes the series twenty steps, is up to 1e-12.
"""
_LAST_DIGITS = 4.0
"""The same in last digits of the angle, which after many turns are large."""


@dataclass(frozen=True)
class Trial:
    """Everything that defines a run; units are those of `simulate`."""

    scene: Scene
    phi0: float
    phi_dot0: float = 0.0
    rolling: Rolling = "reduced"
    integrator: Integrator | None = None
    """None with a tolerance."""
    timestep: float = 1e-3
    tolerance: float | None = None
    friction: float = FRICTION
    steps: int = 1000
    """Duration in timesteps."""
    every: int = 1
    """Number of timesteps from one sample to the next."""
    moments: tuple[float, ...] | None = None
    """The times of the samples in timesteps, if they are not regular."""
    attached: bool = False
    """Whether `mjbeer.attach` puts the can into another world, which RK4 steps."""

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        if self.moments is not None:
            return self.timestep * np.array(self.moments)
        return self.timestep * np.arange(0, self.steps + 1, self.every)

    @property
    def duration(self) -> float:
        """Duration of the run [s]."""
        return self.timestep * self.steps

    @property
    def kind(self) -> str:
        """The kind of model that is simulated."""
        if self.attached:
            return "attached"
        return f"{self.rolling}, damped" if self.scene.dissipates else self.rolling


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    verdict: str
    """One of `VERDICTS`; empty for a trusted run without a judge."""
    judged_by: str = ""
    """One of `JUDGES`; empty if the run was refused."""
    error: float = math.inf
    """Largest error of phi and u/a [rad], relative beyond 1 rad."""
    admitted: float = math.inf
    """The run's estimate of its own error [rad]."""
    says: str = ""
    """The run's warnings, or the text of the error that ended it."""


class References(NamedTuple):
    """The motion that theory predicts, or several where rounding decides."""

    judged_by: str
    """One of `JUDGES`."""
    motions: list[np.ndarray]
    """The motions that a run may be near: phi and u/a [rad] of each, shape (2, samples)."""
    distance: float
    """Distance between the two theories [rad], relative beyond 1 rad; infinite if it is more than
    rounding explains."""


def judge(trial: Trial) -> Outcome:
    """Simulate, and return how the run ended.

    Raises:
      MjbeerError: if the run cannot even be tried, as when its template is missing.
    """
    if trial.attached:
        return _judge_attached(trial)
    try:
        run = _simulate(trial)
    except REFUSALS as error:
        return Outcome(REFUSED, says=str(error))
    scene = trial.scene
    references = reference_motions(scene, run.time, trial.phi0, trial.phi_dot0)
    # Where rounding decides, there are several motions, from starts that doubles hardly tell apart.
    start = _start(scene, trial.phi0, trial.phi_dot0)
    angles = _angles(scene, run)
    distances = [_largest_distance(angles, motion, start) for motion in references.motions]
    error = min(distances, default=math.inf)
    outcome = Outcome("", references.judged_by, error, run.error_estimate)
    if math.isinf(references.distance):
        reason = "two theories differ by more than rounding explains"
        return replace(outcome, verdict=UNDETECTED_ERROR, says=reason)
    # Warnings about a liquid concern the model, and not the solution of its equations.
    warned = (*run.solver_warnings, *run.rolling_warnings)
    if warned:
        return replace(outcome, verdict=WARNED, says="; ".join(warned))
    if references.judged_by == NOBODY:
        return outcome
    allowed = ERROR
    if trial.tolerance is not None:
        allowed = min(ERROR, trial.tolerance + references.distance)
    return replace(outcome, verdict=RIGHT if error <= allowed else UNDETECTED_ERROR)


def _simulate(trial: Trial) -> Run:
    """Return the run. Warnings are not shown, as the run itself has those that count."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return simulate(
            scene=trial.scene,
            duration=trial.duration,
            phi0=trial.phi0,
            phi_dot0=trial.phi_dot0,
            rolling=trial.rolling,
            integrator=trial.integrator,
            timestep=trial.timestep,
            tolerance=trial.tolerance,
            friction=trial.friction,
            times=trial.times,
        )


def _judge_attached(trial: Trial) -> Outcome:
    """Judge a can that `attach` puts into a world, as long as it rolls; warnings are `attach`'s."""
    scene = trial.scene
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        times, phi = roll(scene, trial.phi0, trial.duration, trial.timestep)
    motion = exact(scene, times, trial.phi0)
    rolls = times <= motion.rolls_until(trial.friction)
    largest = np.abs(phi - motion.phi)[rolls].max(initial=0.0)
    error = float(largest / max(1.0, np.abs(motion.phi - trial.phi0).max()))
    warned = []
    for warning in caught:
        if issubclass(warning.category, UntrustedWarning):
            warned.append(str(warning.message))
    verdict = RIGHT if error <= ERROR else UNDETECTED_ERROR
    if warned:
        verdict = WARNED
    return Outcome(verdict, THEORY, error, ERROR, "; ".join(warned))


def roll(
    scene: Scene, phi0: float, duration: float, timestep: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return times [s], and phi [rad] at each, of a can that `mjbeer.attach` puts into a world.

    It is let go at `phi0` [rad] on a slope, and rolls there in plain MuJoCo.
    """
    radius = scene.can.radius
    tilt = scene.incline
    model = _world_with(scene, timestep)
    data = mujoco.MjData(model)
    u, _ = scene.initial_axis(phi0, 0.0)
    swings = scene.attachment == "sliding"
    down = np.array([math.cos(tilt), 0, -math.sin(tilt)])
    normal = np.array([math.sin(tilt), 0, math.cos(tilt)])
    half = (tilt + u / radius) / 2  # of the can's roll, for a quaternion
    # The can is pressed into the slope by a billionth of its radius, so that they touch.
    place = radius * (1 - 1e-9) * normal + u * down
    data.joint("can-free").qpos = [*place, math.cos(half), 0, math.sin(half), 0]
    if swings:
        data.joint("can-swing").qpos = phi0 - u / radius
    mujoco.mj_forward(model, data)
    steps = math.ceil(duration / timestep)
    turned = np.empty(steps)  # of the can
    swung = np.zeros(steps)  # of the load in it
    with quiet():
        for step in range(steps):
            x_axis = data.body("can-can").xmat.reshape(3, 3)[:, 0]
            turned[step] = math.atan2(-x_axis @ normal, x_axis @ down)
            if swings:
                swung[step] = data.joint("can-swing").qpos[0]
            mujoco.mj_step(model, data)
    phi = np.unwrap(turned) + swung
    whole_turns = round((phi0 - phi[0]) / (2 * math.pi))
    return timestep * np.arange(steps), phi + 2 * math.pi * whole_turns


def _world_with(scene: Scene, timestep: float) -> mujoco.MjModel:
    """Return a world with a slope and a can."""
    spec = mujoco.MjSpec()
    spec.option.timestep = timestep
    spec.option.integrator = int(mujoco.mjtIntegrator.mjINT_RK4)
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    half = scene.incline / 2
    slope = spec.worldbody.add_frame(quat=[math.cos(half), 0, math.sin(half), 0])
    plane = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    plane.set_frame(slope)
    attach(spec, scene)
    return spec.compile()


def reference_motions(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> References:
    """Return the motion that theory predicts at increasing `times` [s]."""
    try:
        by_theory = _angles(scene, exact_motion(scene, times, phi0, phi_dot0))
    except (NoLibrationError, ParameterError, ToleranceError):
        by_theory = None  # on a separatrix, or where rounding leaves no digits
    by_series = _by_series(scene, times, phi0, phi_dot0)
    if by_series is None:
        if by_theory is None:
            return References(NOBODY, [], 0.0)
        return References(THEORY, [by_theory], 0.0)
    if by_theory is None:
        perturbed = perturbed_references(scene, times, phi0, phi_dot0)
        return References(SERIES, [by_series, *perturbed], 0.0)
    start = _start(scene, phi0, phi_dot0)
    distance = _largest_distance(by_theory, by_series, start)
    largest_angle = max(float(np.abs(by_series[0]).max()), abs(phi0))
    if distance <= _FLOOR + _LAST_DIGITS * _ROUNDING * largest_angle:
        return References(BOTH, [by_theory, by_series], distance)
    perturbed = list(perturbed_references(scene, times, phi0, phi_dot0))
    effect = sum(_largest_distance(motion, by_series, start) for motion in perturbed)
    if distance > MAX_AMPLIFICATION * effect:
        distance = math.inf
    return References(BOTH, [by_theory, by_series, *perturbed], distance)


def _angles(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return phi and u/a [rad], shape (2, samples)."""
    return np.array([motion.phi, motion.u / scene.can.radius])


def _start(scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    """Return phi and u/a at the start [rad], shape (2, 1)."""
    u, _ = scene.initial_axis(phi0, phi_dot0)
    return np.array([[phi0], [u / scene.can.radius]])


def _largest_distance(motion: np.ndarray, reference: np.ndarray, start: np.ndarray) -> float:
    """Return the largest distance of a motion from a reference [rad].

    It is relative to the angle turned so far where that exceeds 1 rad.
    """
    turned = np.maximum.accumulate(np.abs(reference - start), axis=1)
    return float((np.abs(motion - reference) / np.maximum(1, turned)).max())


def _by_series(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> np.ndarray | None:
    """Return the motion by Taylor series; None if it is damped or takes too many steps."""
    if scene.dissipates:
        return None
    try:
        return _angles(scene, series(scene, times, phi0, phi_dot0))
    except ToleranceError:
        return None


def perturbed_references(
    scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float
) -> Iterator[np.ndarray]:
    """Yield motions, by series, after one number of scene or start was changed in its last digit.

    The incline is changed by the last digit of 1 rad. This lifts or lowers the next crest by as
    much as rounding on the way there does, and so shows whether a motion near the separatrix passes
    the crest by chance.
    """
    aside = _ROUNDING * max(1.0, abs(phi0))
    more = 1 + _ROUNDING
    steeper = replace(scene, incline=scene.incline + _ROUNDING)
    flatter = replace(scene, incline=scene.incline - _ROUNDING)
    heavier = replace(scene, gravity=scene.gravity * more)
    perturbed = (
        (scene, phi0 + aside, phi_dot0),
        (scene, phi0 - aside, phi_dot0),
        (scene, phi0, phi_dot0 * more),
        (steeper, phi0, phi_dot0),
        (flatter, phi0, phi_dot0),
        (heavier, phi0, phi_dot0),
    )
    for perturbed_scene, start, rate in perturbed:
        motion = _by_series(perturbed_scene, times, start, rate)
        if motion is not None:
            yield motion
