"""Reasons to doubt a fit: the model may be wrong, or the track may leave something open."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from scipy import fft, stats

from mjbeer.tracks.least_squares import Minimum
from mjbeer.tracks.unknowns import Unknown, motion_slice, to_values

_BY_CHANCE = 1e-3
"""Probability that a right model is doubted because its residuals are smooth by chance."""
_OPEN = 0.3
"""An unknown that may change by this part of a large change is named as left open."""


def doubts(
    minimum: Minimum, alike: Sequence[Minimum], unknowns: Sequence[Unknown]
) -> tuple[str, ...]:
    """Return the doubts about a minimum; `alike` are those that the track cannot tell apart."""
    found = [
        *_smooth_residuals(minimum),
        *_wrong_measurements(minimum, unknowns),
        *_open_directions(minimum, unknowns),
        *_unfinished_search(minimum),
        *_other_motions(minimum, alike, unknowns),
        *_left_out_points(minimum),
    ]
    return tuple(dict.fromkeys(found))


def chance_of_white_noise(residuals: np.ndarray) -> float:
    """Return the probability that white noise has slow waves as strong as these residuals have.

    All waves of white noise have the same mean power. Four F tests compare the slowest sixteenth,
    eighth, quarter and half of the waves with the others. The result is the smallest of the four
    probabilities, multiplied by four.
    """
    power = fft.dct(residuals, norm="ortho") ** 2 + 1e-12  # no 0 / 0 where nothing is left
    chances = []
    for part in (16, 8, 4, 2):
        slow = math.ceil(len(power) / part)
        ratio = power[:slow].mean() / power[slow:].mean()
        chances.append(float(stats.f.sf(ratio, slow, len(power) - slow)))
    return len(chances) * min(chances)


def _smooth_residuals(minimum: Minimum) -> Iterator[str]:
    """Doubt the model if the residuals of the places are smoother than noise."""
    kept = minimum.weights.kept[0]
    chance = chance_of_white_noise(minimum.residuals[: len(kept)][kept])
    if chance < _BY_CHANCE:
        once = f"{1 / max(chance, 1e-99):.0e} tracks"
        smooth = f"noise is as smooth as what is left once in {once}"
        yield f"the model is wrong, or the track: {smooth}"


def _wrong_measurements(minimum: Minimum, unknowns: Sequence[Unknown]) -> Iterator[str]:
    """Doubt a measured value that is more than three of its errors from the fitted one."""
    values = to_values(unknowns, minimum.variables)
    for unknown in unknowns:
        if unknown.measured is None:
            continue
        measured, error = unknown.measured
        errors_off = abs(values[unknown.name] - measured) / error
        if errors_off > 3:
            off = f"{unknown.name} is {errors_off:.1f} of its errors off"
            yield f"the model is wrong, or what was known: {off}"


def _open_directions(minimum: Minimum, unknowns: Sequence[Unknown]) -> Iterator[str]:
    """Name unknowns that the track leaves open: together they may change by a large change."""
    directions, widths = minimum.uncertainty()
    for direction, width in zip(directions, widths, strict=True):
        if width <= 1:
            continue
        changes = width * np.abs(direction)
        least = min(_OPEN, changes.max())
        pairs = zip(unknowns, changes, strict=True)
        names = [unknown.name for unknown, change in pairs if change >= least]
        yield f"this track does not tell {' from '.join(names)}"


def _unfinished_search(minimum: Minimum) -> Iterator[str]:
    """Say that the solver was stopped by its largest number of steps."""
    if not minimum.converged:
        yield "the search was stopped before it came to the nearest motion"


def _other_motions(
    minimum: Minimum, alike: Sequence[Minimum], unknowns: Sequence[Unknown]
) -> Iterator[str]:
    """Name motions that are as near to the track, but outside the errors of this one."""
    of_motion = motion_slice(unknowns)
    deviations = minimum.uncertainty().deviations
    for other in alike:
        errors_off = np.abs(other.variables - minimum.variables) / deviations
        if errors_off[of_motion].max(initial=0.0) > 6:
            values = to_values(unknowns[of_motion], other.variables[of_motion])
            there = ", ".join(f"{name} = {value:.4g}" for name, value in values.items())
            yield f"another motion is as near to the track: {there}"


def _left_out_points(minimum: Minimum) -> Iterator[str]:
    """Say how many points were left out."""
    count = int((~minimum.weights.kept).sum())
    if count:
        yield f"{count} points are far from all others, and were left out"
