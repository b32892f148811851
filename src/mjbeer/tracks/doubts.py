"""Reasons to doubt a fit: the model may be wrong, or the track may leave something open."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from scipy import fft, stats

from mjbeer.tracks.least_squares import Minimum
from mjbeer.tracks.unknowns import Unknown, in_words, motion_slice, to_values

_BY_CHANCE = 1e-3
"""Probability that a right model is doubted because its residuals are smooth by chance."""
_RAREST = 6
"""The rarest residuals that a message tells apart: those of noise in one of 10^6 tracks."""
_STANDARD_ERRORS = 3
"""A value is doubted if it is off by more of its standard errors."""
_LEAST_CHANCE = 0.1
"""The least part of a measurement's error by which the fitted value may differ by chance."""
POLYNOMIAL_ERROR = 0.1
"""Relative error of a liquid's damping in which a polynomial stands for W^1.5.

It is no bound on how far a real liquid differs from the law."""
_OPEN = 0.3
"""An unknown that may change by this part of a large change is named as left open."""


def doubts(
    minimum: Minimum, alike: Sequence[Minimum], unknowns: Sequence[Unknown]
) -> tuple[str, ...]:
    """Return the doubts about a minimum; `alike` are those that the track cannot tell apart."""
    all_doubts = [
        *_smooth_residuals(minimum),
        *_wrong_measurements(minimum, unknowns),
        *_open_directions(minimum, unknowns),
        *_unfinished_search(minimum),
        *_other_motions(minimum, alike, unknowns),
        *_left_out_points(minimum),
    ]
    return tuple(dict.fromkeys(all_doubts))


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
        power = min(_RAREST, math.floor(-math.log10(max(chance, 1e-99))))
        rare = f"which is as smooth in fewer than 1 of {10**power:,} tracks"
        yield f"the model is wrong, or the track: their difference is not like noise, {rare}"


def _wrong_measurements(minimum: Minimum, unknowns: Sequence[Unknown]) -> Iterator[str]:
    """Doubt a measured value that is too far from the fitted one.

    If the track tells little about it, the fitted value stays near the measured one even if that is
    wrong. So the distance is compared with the one to be expected if the measurement is right,
    whose square is that of the measurement's error less that of the fitted value's.
    """
    values = to_values(unknowns, minimum.variables)
    for unknown, deviation in zip(unknowns, minimum.uncertainty().deviations, strict=True):
        if unknown.measured is None:
            continue
        measured, error = unknown.measured
        value = values[unknown.name]
        left_open = unknown.to_error(value, float(deviation)) / error
        by_chance = error * math.sqrt(max(1 - left_open**2, _LEAST_CHANCE**2))
        errors_off = abs(value - measured) / by_chance
        if errors_off > _STANDARD_ERRORS:
            off = f"{errors_off:.1f} standard errors off {in_words(unknown.name, measured)}"
            hint = ""
            if unknown.name == "bend":
                hint = "; an oblique camera bends a track, and marks on the board unbend it"
            there = f"{unknown.name} is {in_words(unknown.name, value)}, {off}"
            yield f"the model is wrong, or what was known: {there}{hint}"


def doubts_of_law(liquid: str, factor: float, error: float) -> tuple[str, ...]:
    """Doubt a liquid whose damping is farther from its law than errors explain.

    `factor` is the damping divided by the law's, and `error` its standard error.
    """
    if abs(factor - 1) <= _STANDARD_ERRORS * math.hypot(error, POLYNOMIAL_ERROR):
        return ()
    reasons = f"was it {liquid}, at 20 °C, and did the camera look squarely at the board?"
    return (f"the damping is {factor:.2g} times that of {liquid}: {reasons}",)


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
            there = ", ".join(f"{name} {in_words(name, value)}" for name, value in values.items())
            yield f"another motion is as near to the track: {there}"


def _left_out_points(minimum: Minimum) -> Iterator[str]:
    """Say how many points were left out."""
    count = int((~minimum.weights.kept).sum())
    if count:
        yield f"{count} points are far from all others, and were left out"
