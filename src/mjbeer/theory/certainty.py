"""Whether a motion follows from its start as far as doubles know the two: beside a separatrix it does not for long.

Rounding of the start and of the scene puts the crest elsewhere, by `Place.rounding`, and changes energies by
`ROUNDINGS`. If that may matter, the motion is computed again from starts that are changed by so much, in both ways.
"""

import math

import numpy as np

from mjbeer.exceptions import NoLibrationError, ToleranceError
from mjbeer.theory.place import ROUNDINGS
from mjbeer.theory.start import Start

UNCERTAIN = 1e-4
"""Largest effect of rounding on phi [rad], relative beyond 1 rad: a hundredth of the error of a run that is trusted."""
_SUSPECT = 0.1 * UNCERTAIN
"""Largest estimate of that effect at which no motion is computed again."""


def require_certain(start: Start, time: np.ndarray, turned: np.ndarray, phi_dot: np.ndarray) -> None:
    """Check that rounding hardly changes a motion, in which phi has `turned` so far [rad] at the times `time` [s].

    Raises:
      NoLibrationError: if the start is so near a separatrix that it does.
      ToleranceError: if the times are so long that it does.
    """
    order = np.argsort(time)
    angle = np.empty_like(time)
    angle[order] = np.maximum(1, np.maximum.accumulate(np.abs(turned[order])))
    late = _pace_rounding(start) * float(np.max(np.abs(phi_dot) * time / angle, initial=0.0))
    if not late <= UNCERTAIN:
        raise ToleranceError(
            f"phi is not known until {np.max(time):g} s: rounding of the scene changes its speed, and so phi by "
            f"{late:.2g} rad (relative beyond 1 rad), where at most {UNCERTAIN:g} is allowed"
        )
    if not _estimate(start, time, np.abs(phi_dot) / angle) <= _SUSPECT:
        effect = max(_effect(start.rounded(sign), time, turned, angle) for sign in (1, -1))
        if not effect <= UNCERTAIN:
            raise NoLibrationError(
                f"is too near a separatrix: rounding of start and scene changes phi by {effect:.2g} rad (relative "
                f"beyond 1 rad) until {np.max(time):g} s, where at most {UNCERTAIN:g} is allowed"
            )


def period_uncertainty(start: Start, period: float) -> float:
    """Return a rough bound on the effect of rounding on the `period` [s] of a swing, relative to it."""
    share, slowness = _sensitivity(start, 0.0)
    return 2 * share * slowness / period


def _pace_rounding(start: Start) -> float:
    """Return the relative rounding of the speed of a motion that does not hesitate at a crest: that of J and V."""
    crest = start.oscillator.crest
    return ROUNDINGS * (1 + (crest.ramp / crest.curvature) ** 2) if start.swings else ROUNDINGS


def _estimate(start: Start, time: np.ndarray, speed: np.ndarray) -> float:
    """Return a rough bound on the effect of rounding, if phi changes with a `speed` in the units of that effect."""
    latest = float(np.max(time, initial=0.0))
    share, slowness = _sensitivity(start, latest)
    # Each time that the motion passes or nears a crest, it is early or late by that share of the slowness.
    return share * (slowness + latest) * float(np.max(speed, initial=0.0))


def _sensitivity(start: Start, latest: float) -> tuple[float, float]:
    """Return by what share rounding changes the energy that is left at a crest, or missing, and 1/lambda [s] there.

    Without a barrier, a load still hesitates at the crest if the torque there is small. It does so over a `width`.
    """
    crest, place = start.oscillator.crest, start.place
    inertia, shift = float(start.oscillator.inertia_past_crest(0.0)), place.rounding(crest)
    rounding = ROUNDINGS * (start.kinetic + abs(float(crest.below(place.past))))
    rounding += abs(crest.torque(place.past)) * shift + crest.curvature * shift**2
    left = start.nearest_crest(latest)
    if crest.curvature > 0:
        share, slowness = ROUNDINGS * (crest.ramp / crest.curvature) ** 2, math.sqrt(inertia / crest.curvature)
    elif crest.excess > 0:
        width = min(math.pi, math.sqrt(crest.excess / crest.ramp)) if crest.ramp > 0 else math.pi
        share, slowness = ROUNDINGS * crest.slope / crest.excess, math.sqrt(inertia * width / crest.excess)
        left += crest.excess * width
    else:
        share = slowness = math.inf if crest.slope > 0 else 0.0
    return share + (rounding / left if left > 0 else math.inf), slowness


def _effect(rounded: Start, time: np.ndarray, turned: np.ndarray, angle: np.ndarray) -> float:
    """Return the distance of a motion from that of a start that is changed by rounding, relative to `angle`."""
    try:
        return float(np.max(np.abs(rounded.move(time)[0] - turned) / angle, initial=0.0))
    except NoLibrationError:
        return math.inf
