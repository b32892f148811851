"""Where the search begins: values on a grid, with the place and the release that fit best."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from mjbeer.theory.scene import Scene
from mjbeer.tracks.track_model import TrackModel
from mjbeer.tracks.unknowns import Unknown

_STRETCHES = (0.5, 2.0)
"""Smallest and largest factor from the incline that was simulated to that of a sliding load."""


class FirstGuess(NamedTuple):
    """Values of the unknowns, and how far their motion is from the track."""

    values: dict[str, float]
    misfit: float
    """Standard deviation of the track's places from the motion [m]; NaN if no motion has these
    values."""


def first_guesses(model: TrackModel, unknowns: Sequence[Unknown]) -> list[FirstGuess]:
    """Return the guesses on a grid of values, the most promising first.

    Guesses that fit better than all their neighbours on the grid come first. Then come the best
    guess for each pair of fill and damping, and the rest; each group is sorted by misfit. The
    second group is there for fills near that of the fastest swing: they may lie in two valleys, and
    the grid may be too coarse to show the ridge between them.
    """
    axes = {}
    for unknown in unknowns:
        tried = _tried_values(unknown, model, unknowns)
        axes[unknown.name] = sorted(set(tried))
    guesses = []
    for point in itertools.product(*axes.values()):
        values = dict(zip(axes, point, strict=True))
        guesses.append(guess_anywhere(model, values))

    misfits = np.array([guess.misfit for guess in guesses])
    misfits[np.isnan(misfits)] = math.inf
    grid = misfits.reshape([len(axis) for axis in axes.values()])
    lowest_nearby = ndimage.minimum_filter(grid, size=3, mode="nearest")
    is_lowest = (grid == lowest_nearby).ravel()

    by_misfit = np.argsort(misfits, kind="stable")[: np.isfinite(misfits).sum()].tolist()
    valleys = [index for index in by_misfit if is_lowest[index]]
    best_of_kind: dict[tuple[float | None, float | None], int] = {}
    for index in by_misfit:
        values = guesses[index].values
        best_of_kind.setdefault((values.get("fill"), values.get("damping")), index)
    ranking = dict.fromkeys([*valleys, *best_of_kind.values(), *by_misfit])
    return [guesses[index] for index in ranking]


def guess_anywhere(model: TrackModel, values: dict[str, float]) -> FirstGuess:
    """Return values with the place and the release that fit best, for releases at any time.

    The releases that are tried are so close together that the swings are in step for one of them.
    """
    # Over 1.8 durations, neighbours are at most 0.7 swing times apart, in which a load swings by
    # less than a radian; only a track of very many swings has fewer releases than that.
    count = min(2000, max(91, math.ceil(2.6 * model.duration / model.swing_time)))
    releases = model.track.time[0] + model.duration * np.linspace(-1, 0.8, count)
    return _best_release(model, values, releases, most_points=100)


def guess_nearby(model: TrackModel, values: dict[str, float]) -> FirstGuess:
    """Return values with the place and the release that fit best, up to some swings away.

    If the release is some whole swings too early or too late, the can is ahead or behind although
    it rocks in step. The release among the values is one of those that are compared.
    """
    # A swing takes five swing times: three swings each way, in steps of a sixth of a radian or so.
    releases = values["released"] + 17 * model.swing_time * np.linspace(-1, 1, 201)
    return _best_release(model, values, releases, most_points=2000)


def _best_release(
    model: TrackModel, values: dict[str, float], releases: np.ndarray, most_points: int
) -> FirstGuess:
    """Return values with the best of these releases, its place, and a sliding load's incline."""
    points = slice(None, None, max(1, len(model.track.time) // most_points))
    time = model.track.time[points]
    along = model.track.along[points]
    distances, _ = model.motion(values, time - releases[:, np.newaxis])  # (releases, points)
    incline_is_sought = "incline" in values
    if incline_is_sought and model.scene.attachment == "sliding":
        stretches = _stretches(distances, along)
    else:
        stretches = np.ones(len(releases))
    rest = along - stretches[:, np.newaxis] * distances
    misfits = np.std(rest, axis=1)
    best = int(np.argmin(misfits))
    best_values = dict(values)
    best_values["released"] = float(releases[best])
    best_values["place"] = float(np.mean(rest[best]))
    if incline_is_sought:
        best_values["incline"] = values["incline"] * float(stretches[best])
    return FirstGuess(best_values, float(misfits[best]))


def _stretches(distances: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return the factors on the distances that bring them nearest to the places, shape (releases,).

    A sliding load's incline is multiplied by the factor, as distances are nearly proportional to
    it.
    """
    centred = distances - distances.mean(axis=1, keepdims=True)
    squares = np.maximum((centred**2).sum(axis=1), 1e-30)  # a can that still lies has none
    return np.clip(centred @ along / squares, *_STRETCHES)


def _tried_values(unknown: Unknown, model: TrackModel, unknowns: Sequence[Unknown]) -> list[float]:
    """Return the values of an unknown on the grid: one if it was measured.

    Several are needed, as another incline, damping or release may give nearly the same track if the
    track begins late, and as ice swings equally fast at two fills.
    """
    guess = unknown.guess
    if unknown.measured is not None:
        return [guess]
    # The swings must be in step with the track's. A sliding load's incline follows by `_stretches`.
    if unknown.name == "incline" and not unknown.log:
        phi0_is_sought = any(other.name == "phi0" for other in unknowns)
        factors = (0.8, 1.0) if phi0_is_sought else (0.7, 0.85, 1.0, 1.2, 1.5)
        return [factor * guess for factor in factors]
    if unknown.name == "fill":
        return [guess, *_tried_fills(model.scene, model.duration / model.swing_time)]
    if unknown.name == "damping":
        return [guess, 0.55, 0.75, 1.3, 1.8]
    if unknown.name == "phi0":
        return [guess, *np.linspace(-3, 3, 7).tolist()]
    return [guess]


def _tried_fills(scene: Scene, swings: float) -> list[float]:
    """Return fills on the grid for a track of so many swings.

    Undamped swings whose frequency is a little off get out of step with the track. With the square
    root of the fill the frequency grows from 0 to its largest value and falls to 0 again, nearly
    evenly. The fills are so close together that a fill between two of them, if it is in step in the
    middle of the track, is out of step by at most a radian at both ends.
    """
    if scene.dissipates:
        return np.linspace(0.05, 0.95, 19).tolist()
    count = min(150, max(19, math.ceil(0.65 * swings)))
    return (np.linspace(0.1, 0.985, count) ** 2).tolist()
