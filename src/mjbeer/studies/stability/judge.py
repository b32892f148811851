"""The judge of runs: whether one is right, refused, doubted by itself, or wrong and silent.

Two theories that share no code say what is right, where both have the motion: exact theory, and Taylor series.
"""

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

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
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.taylor_series import series
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import exact, exact_motion

VERDICTS = RIGHT, REFUSED, DOUBTED, SILENT = "right", "refused", "doubted", "silent"
"""Every way in which a run can end. It is right if it is trusted, with an error of at most `record.ERROR` and of its
tolerance; refused if it ends in an error that states the reason; doubted if it warns, right or wrong. It is silent
if it is trusted and wrong, which must not occur."""
JUDGES = BOTH, THEORY, SERIES, NOBODY = "two theories", "exact theory alone", "series alone", "nobody"
"""The judges that a run can have. The series know no damping; exact theory refuses motions on a separatrix."""
REFUSALS = (ParameterError, ToleranceError, UnsupportedError, DivergenceError)
"""The errors with which a run is refused. Others, such as a template that is missing, are no way to end."""
_ROUNDING = float(np.finfo(float).eps)
_NUDGES = 10.0
"""Largest distance of the two theories over the effect of nudging start and scene by a rounding each. In 2,400 random
runs it was at most 2 where it needed an explanation."""
_FLOOR = 1e-11
"""Distance of the two theories that needs no explanation [rad], relative beyond 1 rad: the rounding of some hundred
swings, each of which the series take in twenty steps, is up to 1e-12."""
_LAST_DIGITS = 4.0
"""The same in roundings of the angle itself, which has few digits left after many turns."""


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
    """Whether the can lies in a world of its own, into which `mjbeer.attach` put it, and which RK4 steps."""

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        if self.moments is not None:
            return self.timestep * np.array(self.moments)
        return self.timestep * np.arange(0, self.steps + 1, self.every)

    @property
    def kind(self) -> str:
        """The kind of model that is simulated."""
        return "attached" if self.attached else f"{self.rolling}, damped" if self.scene.dissipates else self.rolling


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    verdict: str
    """One of `VERDICTS`; empty if a run that does not doubt itself has no judge."""
    judged_by: str = ""
    """One of `JUDGES`; empty if the run was refused."""
    error: float = math.inf
    """Largest error of phi and u/a [rad], relative beyond 1 rad."""
    admitted: float = math.inf
    """The run's own estimate of its error [rad]."""
    says: str = ""
    """The run's warnings, or the text of the error that ended it."""


def judge(trial: Trial) -> Outcome:
    """Simulate, and return how the run ended.

    Raises:
      MjbeerError: if the run cannot even be tried, as when its template is missing.
    """
    if trial.attached:
        return _judge_attached(trial)
    given = {
        name: value for name, value in vars(trial).items() if name not in ("steps", "every", "moments", "attached")
    }
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # MuJoCo's and the run's own; what counts is in its record
            run = simulate(duration=trial.timestep * trial.steps, times=trial.times, **given)
    except REFUSALS as error:
        return Outcome(REFUSED, says=str(error))
    judges, motions, theory_distance = truth(trial.scene, run.time, trial.phi0, trial.phi_dot0)
    start = _start(trial.scene, trial.phi0, trial.phi_dot0)
    # Where rounding decides, each motion is that of a start which doubles cannot tell from this one.
    error = min((_off(_angles(trial.scene, run), motion, start) for motion in motions), default=math.inf)
    admitted = run.error_estimate
    allowed = ERROR if trial.tolerance is None else min(ERROR, trial.tolerance + theory_distance)
    if math.isinf(theory_distance):
        return Outcome(SILENT, judges, error, admitted, "two theories differ by more than rounding explains")
    # What a liquid warns of is of the model, and of no equation's solution.
    doubts = (*run.solver_warnings, *run.rolling_warnings)
    right = "" if judges == NOBODY else RIGHT if error <= allowed else SILENT
    return Outcome(DOUBTED if doubts else right, judges, error, admitted, "; ".join(doubts))


def _judge_attached(trial: Trial) -> Outcome:
    """Judge a can that was put into a world, as long as it can roll there; what warns is `attach`."""
    scene, duration = trial.scene, trial.timestep * trial.steps
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        times, phi = roll(scene, trial.phi0, duration, trial.timestep)
    motion = exact(scene, times, trial.phi0)
    rolls = times <= motion.rolls_until(trial.friction)
    error = float(np.abs(phi - motion.phi)[rolls].max(initial=0.0) / max(1.0, np.abs(motion.phi - trial.phi0).max()))
    doubts = [str(each.message) for each in warned if issubclass(each.category, UntrustedWarning)]
    verdict = DOUBTED if doubts else RIGHT if error <= ERROR else SILENT
    return Outcome(verdict, THEORY, error, ERROR, "; ".join(doubts))


def roll(scene: Scene, phi0: float, duration: float, timestep: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times [s], and phi [rad] at each, of a can that `mjbeer.attach` puts into a world with a slope.

    It is let go at `phi0` [rad], and rolls there in plain MuJoCo.
    """
    spec, radius, tilt = mujoco.MjSpec(), scene.can.radius, scene.incline
    spec.option.timestep = timestep
    spec.option.integrator = int(mujoco.mjtIntegrator.mjINT_RK4)
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    slope = spec.worldbody.add_frame(quat=[math.cos(tilt / 2), 0, math.sin(tilt / 2), 0])
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1]).set_frame(slope)
    attach(spec, scene)
    model = spec.compile()
    data, (u, _), swings = mujoco.MjData(model), scene.initial_axis(phi0, 0.0), scene.attachment == "sliding"
    down, normal = np.array([math.cos(tilt), 0, -math.sin(tilt)]), np.array([math.sin(tilt), 0, math.cos(tilt)])
    half = (tilt + u / radius) / 2
    data.joint("can-free").qpos = [*(radius * (1 - 1e-9) * normal + u * down), math.cos(half), 0, math.sin(half), 0]
    if swings:
        data.joint("can-swing").qpos = phi0 - u / radius
    mujoco.mj_forward(model, data)
    angles = np.empty((2, math.ceil(duration / timestep)))
    with quiet():
        for place in range(angles.shape[1]):
            ahead = data.body("can-can").xmat.reshape(3, 3)[:, 0]
            angles[:, place] = (
                math.atan2(-ahead @ normal, ahead @ down),
                data.joint("can-swing").qpos[0] if swings else 0.0,
            )
            mujoco.mj_step(model, data)
    phi = np.unwrap(angles[0]) + angles[1]
    return timestep * np.arange(len(phi)), phi + 2 * math.pi * round((phi0 - phi[0]) / (2 * math.pi))


def truth(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> tuple[str, list[np.ndarray], float]:
    """Return which of `JUDGES` has the motion at increasing `times` [s], the motions that a run may be near, and by how
    much the two theories differ [rad], relative beyond 1 rad: infinitely, if by more than rounding explains.

    A motion is phi and u/a [rad], shape (2, samples).
    """
    try:
        first = _angles(scene, exact_motion(scene, times, phi0, phi_dot0))
    except (NoLibrationError, ParameterError, ToleranceError):  # on a separatrix, and beyond what rounding leaves it
        first = None
    second, start = _by_series(scene, times, phi0, phi_dot0), _start(scene, phi0, phi_dot0)
    if second is None:
        return (NOBODY, [], 0.0) if first is None else (THEORY, [first], 0.0)
    if first is None:
        return SERIES, [second, *_beside(scene, times, phi0, phi_dot0)], 0.0
    theory_distance = _off(first, second, start)
    if theory_distance <= _FLOOR + _LAST_DIGITS * _ROUNDING * max(float(np.abs(second[0]).max()), abs(phi0)):
        return BOTH, [first, second], theory_distance
    beside = list(_beside(scene, times, phi0, phi_dot0))
    effect = sum(_off(motion, second, start) for motion in beside)
    return BOTH, [first, second, *beside], theory_distance if theory_distance <= _NUDGES * effect else math.inf


def _angles(scene: Scene, motion: Coordinates) -> np.ndarray:
    return np.array([motion.phi, motion.u / scene.can.radius])


def _start(scene: Scene, phi0: float, phi_dot0: float) -> np.ndarray:
    return np.array([[phi0], [scene.initial_axis(phi0, phi_dot0)[0] / scene.can.radius]])


def _off(found: np.ndarray, right: np.ndarray, start: np.ndarray) -> float:
    """Return the largest distance of a motion from the `right` one [rad], relative to the way from the start."""
    turned = np.maximum.accumulate(np.abs(right - start), axis=1)
    return float((np.abs(found - right) / np.maximum(1, turned)).max())


def _by_series(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> np.ndarray | None:
    """Return the motion by Taylor series; None if it takes too many steps, or is damped."""
    try:
        return None if scene.dissipates else _angles(scene, series(scene, times, phi0, phi_dot0))
    except ToleranceError:
        return None


def _beside(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Iterator[np.ndarray]:
    """Yield the motions, by series, of a scene and a start of which one number is nudged by a rounding.

    The incline is nudged by a rounding of 1 rad: it lifts or lowers the next crest by as much as rounding on the way
    there, and so shows whether a motion beside the separatrix passes it by chance.
    """
    aside, next_ = _ROUNDING * max(1.0, abs(phi0)), 1 + _ROUNDING
    nudged = [(scene, phi0 + aside, phi_dot0), (scene, phi0 - aside, phi_dot0), (scene, phi0, phi_dot0 * next_)]
    nudged += [(replace(scene, incline=scene.incline + side), phi0, phi_dot0) for side in (_ROUNDING, -_ROUNDING)]
    for other, *start in [*nudged, (replace(scene, gravity=scene.gravity * next_), phi0, phi_dot0)]:
        if (motion := _by_series(other, times, *start)) is not None:
            yield motion
