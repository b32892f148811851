"""How a run ended: whether exact theory finds it accurate, and whether its own diagnostics warned if it is not."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.exceptions import DivergenceError, MjbeerError
from mjbeer.theory.conserved import kinetic_energy
from mjbeer.theory.exact import exact
from mjbeer.theory.measure import distance
from mjbeer.theory.trajectory import Trajectory
from mjbeer.theory.trust import ERROR

ACCURATE = "stable and accurate"
INACCURATE = "stable, inaccurate"
UNSTABLE = "unstable, detected"
REFUSED = "refused"
SILENT = "wrong and silent"
VERDICTS = (ACCURATE, INACCURATE, UNSTABLE, REFUSED, SILENT)
"""Every way in which a run can end. The last one must not occur: a run that is trusted although it is wrong."""
_GAIN = 10.0
"""A run is unstable if its kinetic energy exceeds the largest that the motion can have by this factor."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    verdict: str
    """One of `VERDICTS`."""
    error: float | None
    """Largest error of phi and u/a against exact theory [rad], relative beyond 1 rad; None if there is no run."""
    admitted: float | None
    """Largest error that the run's own diagnostics allow for [rad]: its error estimate, plus slip and lift in radii."""
    says: str
    """The run's warnings, or the text of the error that ended it; empty if the run is trusted."""


def judge(simulate: Callable[[], Trajectory]) -> Outcome:
    """Simulate a motion, and return how that ended.

    A run is accurate if the error of phi and u/a is at most `trajectory.ERROR`, the limit for trusted runs as well.

    Raises:
      NoLibrationError: if the start lies on the separatrix, where there is no exact motion to judge by.
    """
    try:
        run = simulate()
    except DivergenceError as error:
        return Outcome(UNSTABLE, None, None, str(error))
    except MjbeerError as error:
        return Outcome(REFUSED, None, None, str(error))
    truth = exact(run.scene, run.time, run.phi0, run.phi_dot0)
    radius = run.scene.can.radius
    error = distance(run, truth, radius, start=(run.phi0, run.scene.start(run.phi0, run.phi_dot0)[0]))
    if run.trusted:
        verdict = ACCURATE if error <= ERROR else SILENT
    elif _explodes(run, truth):
        verdict = UNSTABLE
    else:
        verdict = ACCURATE if error <= ERROR else INACCURATE
    admitted = (run.error_estimate or 0.0) + (run.record.slip + run.record.lift) / radius
    return Outcome(verdict, _finite(error), _finite(admitted), "; ".join(run.warnings))


def _explodes(run: Trajectory, truth: Trajectory) -> bool:
    """Return whether a run has so much more kinetic energy than the motion can have that it is unstable."""
    most = float(kinetic_energy(run.scene, truth).max()) + 2 * run.scene.oscillator.depth
    return not float(kinetic_energy(run.scene, run).max()) <= _GAIN * most


def _finite(value: float) -> float | None:
    """Return the value, or None, which JSON can hold, if it is infinite or NaN."""
    return value if math.isfinite(value) else None
