"""Runs and judges a random run, and says whether what it warned of is a fact or a false alarm."""

from dataclasses import dataclass, replace

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.state import START_DEPTH
from mjbeer.studies.stability.outcome import ACCURATE, REFUSALS, Outcome, judge
from mjbeer.studies.stability.reference.lagrangian import LongMotionError, reference
from mjbeer.studies.stability.search.random_run import RandomRun
from mjbeer.studies.stability.truth import angles, truth
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.exact import solution
from mjbeer.theory.record import ERROR, LIFT, SLIP
from mjbeer.theory.scene import Scene

FALSE = "false alarm"
PARTS = "real slip or lift"
WAY = "wrong on the way"
SENSITIVE = "sensitive start"
ALARMS = (FALSE, PARTS, WAY, SENSITIVE)
"""What the warnings of an accurate run can be. All but the first are facts: the can slips or lifts by more than is
trusted; the run is right at its samples and wrong between them; a start that is closer than models are made moves the
exact motion by more than is trusted, or the run itself: one that rests where its timestep is far too long, say, is
right only as long as nothing disturbs it."""
SMALL = 1e-4
"""Error [rad] below which there should be no false alarm at all: a hundredth of what is trusted."""
PULL = "from t ="
"""Beginning of the warning that the incline would have to pull, which is a fact of the exact motion."""
_ASIDE = 1e-13
"""Distance of starts that count as the same [rad], relative beyond 1 rad: some hundred roundings."""
_SAFETY = 2.5
"""Error estimate of a run over what a second run shows, at least."""


@dataclass(frozen=True)
class Finding:
    """How a random run ended, and what its warnings were worth."""

    outcome: Outcome
    alarm: str = ""
    """One of `ALARMS`; empty if the run is not accurate, or warned of nothing but a pull."""
    error: float = 0.0
    """Largest error on the whole way of a run whose alarm is false [rad]."""


def check(run: RandomRun) -> Finding:
    """Simulate a run and judge it at its samples; if it is accurate and flagged, judge it at every timestep too."""
    outcome = judge(run.simulate)
    if outcome.verdict != ACCURATE or all(alarm.startswith(PULL) for alarm in outcome.alarms):
        return Finding(outcome)
    try:
        whole = replace(run, every=1, moments=None).simulate()
    except (DivergenceError, *REFUSALS):
        return Finding(outcome, WAY)
    radius = run.scene.can.radius
    error = truth(run.scene, whole.time, run.phi0, run.phi_dot0).off(whole.phi, whole.u / radius)
    if not error <= ERROR:
        return Finding(outcome, WAY)
    if max(whole.record.slip / SLIP, whole.record.lift / LIFT) > radius:
        return Finding(outcome, PARTS)
    return Finding(outcome, SENSITIVE) if _is_sensitive(run, whole.time) else Finding(outcome, FALSE, error)


def _is_sensitive(run: RandomRun, times: np.ndarray) -> bool:
    """Return whether a start beside that of a run moves the exact motion, or the run, by more than is trusted."""
    aside = START_DEPTH if run.rolling == "contact" else _ASIDE * max(1.0, abs(run.phi0))
    sides = aside, -aside
    try:
        motions = [_motion(run.scene, times, run.phi0 + side, run.phi_dot0) for side in (0.0, *sides)]
        others = [replace(run, phi0=run.phi0 + side, every=1, moments=None).simulate() for side in sides]
    except LongMotionError:
        return False
    except (DivergenceError, *REFUSALS):
        return True
    motion, *beside = (angles(run.scene, motion, run.phi0, run.phi_dot0) for motion in (*motions, *others))
    return not max(motion.off(other.phi, other.roll) for other in beside) * _SAFETY <= ERROR


def _motion(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Coordinates:
    """Return the motion from a start, by the theory that refuses as few motions as it can."""
    if scene.dissipates:
        return solution(scene, times, phi0, phi_dot0)
    return reference(scene, times, phi0, phi_dot0)
