"""Trials, and their judge: how a run ended, by two theories that share no code, and by what it says of itself."""

import dataclasses
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import DivergenceError, NoLibrationError, ParameterError, ToleranceError, UnsupportedError
from mjbeer.model.setting import FRICTION, Integrator, Rolling
from mjbeer.model.state import START_DEPTH
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.reference import LongMotionError, reference
from mjbeer.theory.equations import Coordinates, kinetic_energy
from mjbeer.theory.exact import solution
from mjbeer.theory.record import ERROR, LIFT, SLIP, doubts
from mjbeer.theory.scene import Scene

VERDICTS = {
    (ACCURATE := "stable and accurate"): "accurate",
    (INACCURATE := "stable, inaccurate"): "inaccurate",
    (UNSTABLE := "unstable, detected"): "unstable",
    (REFUSED := "refused"): "refused",
    (SILENT := "wrong and silent"): "silent",
    (MISSED := "tolerance missed"): "missed",
    (THEORIES := "theories differ"): "theories",
    (UNKNOWN := "beyond theory"): "beyond",
}
"""Every way in which a run can end, and in a word. Only damped motions are beyond theory, the reference of which knows
no damping."""
NEVER = (SILENT, MISSED, THEORIES)
"""The verdicts that must not occur: a run that is trusted although it is wrong, a run whose error is above its
tolerance, and a motion of which two theories say different things that no rounding explains."""
ALARMS = {
    (FALSE := "false alarm"): "false alarms",
    (PARTS := "real slip or lift"): "slip or lift",
    (WAY := "wrong on the way"): "way",
    (SENSITIVE := "sensitive start"): "sensitive",
}
"""What the warnings of an accurate run can be, and in short. All but the first are facts: the can slips or lifts by
more than is trusted; the run is right at its samples and wrong between them; a start that is closer than models are
made moves the exact motion by more than is trusted, or the run itself: one that rests where its timestep is far too
long, say, is right only as long as nothing disturbs it."""
REFUSALS = (ParameterError, ToleranceError, UnsupportedError)
"""The errors with which a run is refused. Others, such as a template that is missing, are no way to end."""
_GAIN = 10.0
"""A run is unstable if its kinetic energy exceeds the largest that the motion can have by this factor."""
_ROUNDING = float(np.finfo(float).eps)
_NEXT = 1 + _ROUNDING
"""The next number after 1."""
_NUDGES = 10.0
"""Largest distance of the two theories over the effect of nudging start and scene by a rounding each. In 2,400 random
runs it was at most 2 where it needed an explanation."""
_FLOOR = 1e-11
"""Distance of the two theories that needs no explanation [rad], relative beyond 1 rad: the rounding of some hundred
swings, each of which the reference makes in twenty steps, is up to 1e-12."""
_LAST_DIGITS = 4.0
"""The same in roundings of the angle itself, which has few digits left after many turns."""
_ASIDE = 1e-13
"""Distance of starts that count as the same [rad], relative beyond 1 rad: some hundred roundings."""
_SENSITIVE = 2.5
"""What is trusted over the effect of a start aside, from which on a start is sensitive: the estimate of a run, which is
3 times what a second run shows or a little more, is then at the edge of what is trusted."""
_SAMPLES = "steps", "every", "moments"
"""The fields that say which samples are asked for."""


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

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        if self.moments is not None:
            return self.timestep * np.array(self.moments)
        return self.timestep * np.arange(0, self.steps + 1, self.every)

    def simulate(self) -> Run:
        """Return the simulated motion at the times of its samples."""
        setting = {name: value for name, value in vars(self).items() if name not in _SAMPLES}
        return simulate(duration=self.timestep * self.steps, times=self.times, **setting)


def steps_of(duration: float, timestep: float) -> int:
    """Return the number of timesteps to the first one at or after a duration."""
    return math.ceil(duration / timestep * (1 - 1e-10))


@dataclass(frozen=True, eq=False)
class Angles:
    """phi and u/a of a motion [rad] at some times, and where both started."""

    phi: np.ndarray
    roll: np.ndarray
    start: tuple[float, float]

    @classmethod
    def of(cls, scene: Scene, motion: Coordinates, phi0: float, phi_dot0: float) -> "Angles":
        """Return the angles of a motion that starts at `phi0` [rad] with `phi_dot0` [rad/s]."""
        radius = scene.can.radius
        return cls(motion.phi, motion.u / radius, (phi0, scene.start(phi0, phi_dot0)[0] / radius))

    def off(self, phi: np.ndarray, roll: np.ndarray) -> float:
        """Return the largest distance of `phi` and `roll` from this motion [rad], relative to the way beyond 1 rad."""
        off = []
        for found, right, start in zip((phi, roll), (self.phi, self.roll), self.start, strict=True):
            turned = np.maximum.accumulate(np.abs(right - start))
            off.append(np.max(np.abs(found - right) / np.maximum(1, turned)))
        return float(np.max(off))


@dataclass(frozen=True, eq=False)
class Truth:
    """The motion at the times of the samples, by each theory that has it."""

    motions: tuple[Angles, ...]
    """The motions that a run may be near: that of each theory, and if they part those of starts a rounding aside."""
    apart: float | None
    """Largest distance of the two theories [rad], relative beyond 1 rad; None if only one has the motion."""
    explained: bool
    """Whether the effect of rounding on the motion explains that distance; False if no theory has the motion."""
    kinetic: float
    """Largest kinetic energy of can and load at the samples [J]."""

    def off(self, phi: np.ndarray, roll: np.ndarray) -> float:
        """Return the distance of `phi` and `roll` [rad] from the nearest motion, relative beyond 1 rad.

        Where rounding explains that motions part, each is that of a start that doubles cannot tell from this one.
        """
        return float(np.min([motion.off(phi, roll) for motion in self.motions], initial=np.inf))


def truth(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Truth:
    """Return the motion at increasing `times` [s] that starts at `phi0` [rad] with `phi_dot0` [rad/s] at time 0."""
    try:
        first = solution(scene, times, phi0, phi_dot0)
    except (NoLibrationError, ParameterError, ToleranceError):  # on a separatrix, and beyond what rounding leaves it
        first = None
    second = _reference(scene, times, phi0, phi_dot0)
    found = [motion for motion in (first, second) if motion is not None]
    seen = tuple(Angles.of(scene, motion, phi0, phi_dot0) for motion in found)
    kinetic = max((float(kinetic_energy(scene, motion).max()) for motion in found), default=0.0)
    if second is None:
        return Truth(seen, None, bool(seen), kinetic)
    if first is not None:
        apart = seen[1].off(seen[0].phi, seen[0].roll)
        if apart <= _FLOOR + _LAST_DIGITS * _ROUNDING * max(float(np.abs(second.phi).max()), abs(phi0)):
            return Truth(seen, apart, explained=True, kinetic=kinetic)
    beside = tuple(_beside(scene, times, phi0, phi_dot0))
    if first is None:
        return Truth((*seen, *beside), None, explained=True, kinetic=kinetic)
    effect = sum(seen[1].off(motion.phi, motion.roll) for motion in beside)
    return Truth((*seen, *beside), apart, explained=apart <= _NUDGES * effect, kinetic=kinetic)


def _reference(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Coordinates | None:
    """Return the motion by `reference`; None if it takes too many steps, or is damped."""
    try:
        return None if scene.dissipates else reference(scene, times, phi0, phi_dot0)
    except LongMotionError:
        return None


def _beside(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Iterator[Angles]:
    """Yield the motions, by `reference`, of a scene and a start of which one number is nudged by a rounding.

    The incline is nudged by a rounding of 1 rad: it lifts or lowers the next crest by as much as rounding on the way
    there, and so shows whether a motion beside the separatrix passes it by chance.
    """
    aside = _ROUNDING * max(1.0, abs(phi0))
    inclines, gravity = (scene.incline + _ROUNDING, scene.incline - _ROUNDING), scene.gravity * _NEXT
    changed = [dataclasses.replace(scene, incline=incline) for incline in inclines]
    changed.append(dataclasses.replace(scene, gravity=gravity))
    nudged = [(scene, phi0 + aside, phi_dot0), (scene, phi0 - aside, phi_dot0), (scene, phi0, phi_dot0 * _NEXT)]
    nudged += [(other, phi0, phi_dot0) for other in changed]
    for other, *start in nudged:
        if (motion := _reference(other, times, *start)) is not None:
            yield Angles.of(other, motion, *start)


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    verdict: str
    """One of `VERDICTS`."""
    error: float | None = None
    """Largest error of phi and u/a against the nearer theory [rad], relative beyond 1 rad; None if there is no run."""
    admitted: float | None = None
    """Largest error that the run's own diagnostics allow for [rad]: its error estimate, plus slip and lift in radii."""
    says: str = ""
    """The run's warnings, or the text of the error that ended it; empty if the run is trusted."""
    apart: float | None = None
    """Distance of the two theories [rad], relative beyond 1 rad; None if there is no run, or only one theory."""
    alarms: tuple[str, ...] = ()
    """Its warnings, or the text of the error that ended it, with dots instead of numbers, so that equals are equal.
    That the incline would have to pull is a fact of the exact motion, and not among them."""


def judge(make: Callable[[], Run]) -> Outcome:
    """Return how a run ended that is made now.

    A run is accurate if the error of phi and u/a is at most `record.ERROR`, the limit for trusted runs as well.

    Raises:
      MjbeerError: if the run cannot even be tried, as when its template is missing.
    """
    try:
        run = make()
    except (DivergenceError, *REFUSALS) as error:
        verdict = UNSTABLE if isinstance(error, DivergenceError) else REFUSED
        return Outcome(verdict, says=str(error), alarms=(_numberless(str(error)),))
    radius = run.scene.can.radius
    motion = truth(run.scene, run.time, run.phi0, run.phi_dot0)
    error = motion.off(run.phi, run.u / radius)
    pulls = run.rolling != "contact" and math.isfinite(run.record.fails_at)
    pull = doubts(run.record, run.rolling, run.setting.friction)[-1:] if pulls else []
    return Outcome(
        verdict=_verdict(run, motion, error),
        error=_finite(error),
        admitted=_finite((run.error_estimate or 0.0) + (run.record.slip + run.record.lift) / radius),
        says="; ".join(run.warnings),
        apart=motion.apart,
        alarms=tuple(_numberless(warning) for warning in run.warnings if warning not in pull),
    )


def explodes(run: Run, kinetic: float) -> bool:
    """Return whether a run has so much more kinetic energy than the motion can have that it is unstable.

    `kinetic` is the largest kinetic energy of can and load at the samples of the exact motion [J].
    """
    most = kinetic + 2 * run.scene.oscillator.depth
    return not float(kinetic_energy(run.scene, run).max()) <= _GAIN * most


def alarm(trial: Trial, outcome: Outcome) -> tuple[str, float]:
    """Return which of `ALARMS` the warnings of an accurate run are, and the largest error on its way if it is false.

    The first is "" where the run is not accurate, or warned of nothing but a pull.
    """
    if outcome.verdict != ACCURATE or not outcome.alarms:
        return "", 0.0
    try:
        whole = dataclasses.replace(trial, every=1, moments=None).simulate()
    except (DivergenceError, *REFUSALS):
        return WAY, 0.0
    radius = trial.scene.can.radius
    error = truth(trial.scene, whole.time, trial.phi0, trial.phi_dot0).off(whole.phi, whole.u / radius)
    if not error <= ERROR:
        return WAY, 0.0
    if max(whole.record.slip / SLIP, whole.record.lift / LIFT) > radius:
        return PARTS, 0.0
    return (SENSITIVE, 0.0) if _is_sensitive(trial, whole.time) else (FALSE, error)


def _is_sensitive(trial: Trial, times: np.ndarray) -> bool:
    """Return whether a start beside that of a trial moves the exact motion, or the run, by more than is trusted."""
    aside = START_DEPTH if trial.rolling == "contact" else _ASIDE * max(1.0, abs(trial.phi0))
    theory = solution if trial.scene.dissipates else reference  # which refuses as few motions as it can
    starts = [trial.phi0 + side for side in (0.0, aside, -aside)]
    try:
        motions = [theory(trial.scene, times, phi0, trial.phi_dot0) for phi0 in starts]
        motions += [dataclasses.replace(trial, phi0=phi0, every=1, moments=None).simulate() for phi0 in starts[1:]]
    except LongMotionError:
        return False
    except (DivergenceError, *REFUSALS):
        return True
    motion, *beside = (Angles.of(trial.scene, motion, trial.phi0, trial.phi_dot0) for motion in motions)
    return not max(motion.off(other.phi, other.roll) for other in beside) * _SENSITIVE <= ERROR


def _verdict(run: Run, motion: Truth, error: float) -> str:
    """Return how a run ended whose error is known, if theory has its motion."""
    if not motion.explained:
        return UNKNOWN if run.scene.dissipates else THEORIES
    if run.trusted and not error <= ERROR:
        return SILENT
    tolerance = run.setting.tolerance
    if tolerance is not None and run.rolling != "contact" and not error - (motion.apart or 0.0) <= tolerance:
        return MISSED
    if not run.trusted and explodes(run, motion.kinetic):
        return UNSTABLE
    return ACCURATE if error <= ERROR else INACCURATE


def _numberless(text: str) -> str:
    """Return a text with dots instead of its numbers."""
    return re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "…", text)


def _finite(value: float) -> float | None:
    """Return the value, or None, which JSON can hold, if it is infinite or NaN."""
    return value if math.isfinite(value) else None
