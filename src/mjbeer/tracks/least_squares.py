"""Least squares: the values whose motion comes nearest to a track, and their errors."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from scipy import optimize

from mjbeer.tracks.first_guess import FirstGuess, guess_nearby
from mjbeer.tracks.track_model import TrackModel
from mjbeer.tracks.unknowns import (
    Unknown,
    distance_from_guess,
    motion_slice,
    to_values,
    to_variables,
)

_FAR = 6.0
"""A point that is farther from the motion is left out, in standard deviations of the noise."""
_LEAST_NOISE = 1e-6
"""The least noise of a track, [m] or [rad]: that of the simulated motions."""
_SAME = 1e-2
"""Largest difference of a variable between two results that are one minimum."""
_TOLD_APART = 9.0
"""Difference of costs at which a track tells two minima apart: three standard errors, squared."""


class Weights(NamedTuple):
    """The weights of the points of a track.

    `noise` is the standard deviation of each channel, by which its residuals are divided, [m] or
    [rad], shape (channels, 1). `kept` says which points count, shape (channels, points).
    """

    noise: np.ndarray
    kept: np.ndarray


class Uncertainty(NamedTuple):
    """The errors of the variables of a minimum, if the model is right.

    The rows of `directions` are combinations of the variables with independent errors, whose
    standard deviations are `widths`.
    """

    directions: np.ndarray
    widths: np.ndarray

    @property
    def covariance(self) -> np.ndarray:
        """The covariance matrix of the variables, shape (unknowns, unknowns)."""
        return (self.directions.T * self.widths**2) @ self.directions

    @property
    def deviations(self) -> np.ndarray:
        """The standard deviations of the variables, shape (unknowns,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def correlation(self) -> np.ndarray:
        """The correlation matrix of the variables, shape (unknowns, unknowns)."""
        return self.covariance / np.outer(self.deviations, self.deviations)


@dataclass(frozen=True, eq=False)
class Minimum:
    """The result of a round of least squares."""

    variables: np.ndarray
    """The solver's variables of the unknowns."""
    residuals: np.ndarray
    """The residuals of the track's points, channel by channel, and then those of the measured
    values, all divided by their standard errors."""
    jacobian: np.ndarray
    """The derivatives of the residuals, shape (residuals, unknowns)."""
    converged: bool
    """Whether the solver came to an end within its largest number of steps."""
    weights: Weights
    """The weights of this round."""
    next_weights: Weights
    """The weights that follow from the residuals."""
    cost: float
    """Minus twice the logarithm of the likelihood with the next weights, up to a constant."""

    def uncertainty(self) -> Uncertainty:
        """Return the errors of the variables."""
        _, sizes, directions = np.linalg.svd(self.jacobian, full_matrices=False)
        widths = 1 / np.maximum(sizes, 1e-6)  # finite where a direction changes nothing
        return Uncertainty(directions, widths)


def first_round(model: TrackModel, unknowns: Sequence[Unknown], guess: FirstGuess) -> Minimum:
    """Return the minimum that is found from a guess, whose misfit is taken for the noise.

    Raises:
      ValueError: if there is no such motion.
    """
    noise = np.full((len(model.channels), 1), guess.misfit / model.scene.can.radius)  # [rad]
    noise[model.channels.index("along")] = guess.misfit
    weights = Weights(noise, np.ones(model.data.shape, bool))
    return _minimize(model, unknowns, guess.values, weights, "2-point")


def next_round(model: TrackModel, unknowns: Sequence[Unknown], minimum: Minimum) -> Minimum:
    """Return the minimum near another one, with its next weights and its best release.

    Raises:
      ValueError: if there is no such motion.
    """
    guess = guess_nearby(model, to_values(unknowns, minimum.variables))
    # Near a separatrix an incline's effect changes within the step of the derivatives.
    return _minimize(model, unknowns, guess.values, minimum.next_weights, "3-point")


def distinct(unknowns: Sequence[Unknown], minima: Sequence[Minimum]) -> list[Minimum]:
    """Return the minima whose motions differ, those with the least cost first."""
    of_motion = motion_slice(unknowns)
    chosen: list[Minimum] = []
    for minimum in sorted(minima, key=lambda minimum: minimum.cost):
        distances = [np.abs(minimum.variables - other.variables)[of_motion] for other in chosen]
        if all(distance.max(initial=0.0) >= _SAME for distance in distances):
            chosen.append(minimum)
    return chosen


def as_good_as_best(minima: Sequence[Minimum]) -> list[Minimum]:
    """Return the minima that the track cannot tell from the best of them."""
    least = min(minimum.cost for minimum in minima)
    return [minimum for minimum in minima if minimum.cost < least + _TOLD_APART]


def nearest_to_guess(unknowns: Sequence[Unknown], minima: Sequence[Minimum]) -> Minimum:
    """Return the minimum whose motion is nearest to the guess."""
    return min(minima, key=lambda minimum: distance_from_guess(unknowns, minimum.variables))


def _minimize(
    model: TrackModel,
    unknowns: Sequence[Unknown],
    values: dict[str, float],
    weights: Weights,
    derivatives: Literal["2-point", "3-point"],
) -> Minimum:
    """Return the minimum that is found from some values."""
    low = to_variables(unknowns, {unknown.name: unknown.low for unknown in unknowns})
    high = to_variables(unknowns, {unknown.name: unknown.high for unknown in unknowns})
    start = np.clip(to_variables(unknowns, values), low, high)
    solution = optimize.least_squares(
        _residuals,
        start,
        jac=derivatives,
        bounds=(low, high),
        args=(model, unknowns, weights),
        ftol=1e-6,
        xtol=1e-9,
        diff_step=1e-6,
        max_nfev=100,
    )
    next_weights = _suitable_weights(model, to_values(unknowns, solution.x), len(unknowns))
    return Minimum(
        variables=solution.x,
        residuals=solution.fun,
        jacobian=solution.jac,
        converged=solution.status > 0,
        weights=weights,
        next_weights=next_weights,
        cost=cost(next_weights, solution.fun[model.data.size :]),
    )


def _residuals(
    variables: np.ndarray, model: TrackModel, unknowns: Sequence[Unknown], weights: Weights
) -> np.ndarray:
    """Return the residuals of the track and of the measured values; NaN if there is no motion."""
    values = to_values(unknowns, variables)
    of_track = weights.kept * (model.predict(values) - model.data) / weights.noise
    of_measured = []
    for unknown in unknowns:
        if unknown.measured is not None:
            value, error = unknown.measured
            of_measured.append((values[unknown.name] - value) / error)
    return np.append(of_track, of_measured)


def _suitable_weights(model: TrackModel, values: dict[str, float], unknowns: int) -> Weights:
    """Return weights from the distances of a track from a motion: noise, and points to be kept."""
    distances = np.abs(model.predict(values) - model.data)
    deviations = 1.4826 * np.median(distances, axis=1, keepdims=True)  # of normal noise
    kept = distances <= _FAR * deviations
    spare = kept.sum(axis=1) - unknowns / len(model.channels)  # degrees of freedom of a channel
    squares = ((kept * distances) ** 2).sum(axis=1)
    noise = np.sqrt(_LEAST_NOISE**2 + squares / np.maximum(spare, 1.0))
    return Weights(noise[:, np.newaxis], kept)


def cost(weights: Weights, of_measured: np.ndarray) -> float:
    """Return minus twice the logarithm of the likelihood of a track with suitable weights."""
    points = weights.kept.shape[1]
    of_track = 2 * points * math.fsum(np.log(weights.noise[:, 0]))
    # A point that is left out counts as one at the limit, or leaving out a swing would pay.
    of_left_out = _FAR**2 * int((~weights.kept).sum())
    return of_track + of_left_out + float((of_measured**2).sum())
