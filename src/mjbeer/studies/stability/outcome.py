"""How a run ended: whether two theories find it accurate, and whether its own diagnostics warned if it is not."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

from mjbeer.exceptions import DivergenceError, ParameterError, ToleranceError, UnsupportedError
from mjbeer.simulation.run import Run
from mjbeer.studies.stability.truth import Truth, truth
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.record import ERROR

ACCURATE = "stable and accurate"
INACCURATE = "stable, inaccurate"
UNSTABLE = "unstable, detected"
REFUSED = "refused"
SILENT = "wrong and silent"
MISSED = "tolerance missed"
THEORIES = "theories differ"
UNKNOWN = "beyond theory"
VERDICTS = (ACCURATE, INACCURATE, UNSTABLE, REFUSED, SILENT, MISSED, THEORIES, UNKNOWN)
"""Every way in which a run can end. Only damped motions are beyond theory, the reference of which knows no damping."""
NEVER = (SILENT, MISSED, THEORIES)
"""The verdicts that must not occur: a run that is trusted although it is wrong, a run whose error is above its
tolerance, and a motion of which two theories say different things that no rounding explains."""
REFUSALS = (ParameterError, ToleranceError, UnsupportedError)
"""The errors with which a run is refused. Others, such as a template that is missing, are no way to end."""
_GAIN = 10.0
"""A run is unstable if its kinetic energy exceeds the largest that the motion can have by this factor."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    verdict: str
    """One of `VERDICTS`."""
    error: float | None
    """Largest error of phi and u/a against the nearer theory [rad], relative beyond 1 rad; None if there is no run."""
    admitted: float | None
    """Largest error that the run's own diagnostics allow for [rad]: its error estimate, plus slip and lift in radii."""
    says: str
    """The run's warnings, or the text of the error that ended it; empty if the run is trusted."""
    apart: float | None = None
    """Distance of the two theories [rad], relative beyond 1 rad; None if there is no run, or only one theory."""
    alarms: tuple[str, ...] = ()
    """Its warnings, or the text of the error that ended it, with dots instead of numbers, so that equals are equal."""


def judge(simulate: Callable[[], Run]) -> Outcome:
    """Simulate a motion, and return how that ended.

    A run is accurate if the error of phi and u/a is at most `record.ERROR`, the limit for trusted runs as well.

    Raises:
      MjbeerError: if the run cannot even be tried, as when its template is missing.
    """
    try:
        run = simulate()
    except DivergenceError as error:
        return Outcome(UNSTABLE, None, None, str(error), alarms=(_numberless(str(error)),))
    except REFUSALS as error:
        return Outcome(REFUSED, None, None, str(error), alarms=(_numberless(str(error)),))
    radius = run.scene.can.radius
    motion = truth(run.scene, run.time, run.phi0, run.phi_dot0)
    error = motion.off(run.phi, run.u / radius)
    return Outcome(
        verdict=_verdict(run, motion, error),
        error=_finite(error),
        admitted=_finite((run.error_estimate or 0.0) + (run.record.slip + run.record.lift) / radius),
        says="; ".join(run.warnings),
        apart=motion.apart,
        alarms=tuple(_numberless(warning) for warning in run.warnings),
    )


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


def explodes(run: Run, kinetic: float) -> bool:
    """Return whether a run has so much more kinetic energy than the motion can have that it is unstable.

    `kinetic` is the largest kinetic energy of can and load at the samples of the exact motion [J].
    """
    most = kinetic + 2 * run.scene.oscillator.depth
    return not float(kinetic_energy(run.scene, run).max()) <= _GAIN * most


def _numberless(text: str) -> str:
    """Return a text with dots instead of its numbers."""
    return re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "…", text)


def _finite(value: float) -> float | None:
    """Return the value, or None, which JSON can hold, if it is infinite or NaN."""
    return value if math.isfinite(value) else None
