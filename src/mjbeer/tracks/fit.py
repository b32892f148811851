"""The function `fit`, which finds from a track and a guess what was in the can."""

import contextlib
import inspect
import warnings
from collections.abc import Collection, Mapping

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.output import terminal
from mjbeer.theory.scene import Scene
from mjbeer.tracks.doubts import doubts, doubts_of_law
from mjbeer.tracks.first_guess import first_guesses
from mjbeer.tracks.least_squares import (
    Minimum,
    as_good_as_best,
    distinct,
    first_round,
    nearest_to_guess,
    next_round,
)
from mjbeer.tracks.result import Fit
from mjbeer.tracks.track import Track
from mjbeer.tracks.track_model import TrackModel
from mjbeer.tracks.unknowns import (
    FITTABLE,
    NAMES,
    Measurement,
    Unknown,
    make_unknowns,
    to_values,
)

BEND = 5e-3
"""Usual bend of a straight board in the picture of a lens [m]."""
_FIRST_ROUNDS = 16
"""Number of first guesses from which least squares begin."""
_SEARCHES = 6
"""Number of their minima from which the search goes on to the end."""


def fit(
    track: Track,
    scene: Scene,
    free: Collection[str] = ("incline",),
    known: Mapping[str, tuple[float, float]] | None = None,
    phi0: float | str = "level",
    bend: float | None = None,
    progress: bool = True,
) -> Fit:
    """Return the scene whose motion, simulated by MuJoCo, comes nearest to a track.

    The place and the time at which the can was let go are always fitted, and so is a bend of the
    track.

    Args:
      track: the track that was filmed.
      scene: the scene, with guesses of the parameters that are to be fitted.
      free: names of the parameters that are to be fitted: "incline" [rad], "fill", "damping" (a
        factor on the scene's own law) and "drag" [kg/m].
      known: values that were measured besides the track, by name, each with its standard error;
        they are fitted, too. One may be "scale", the factor by which the track is too long, which
        otherwise only a tracked roll gives, or marks on the board.
      phi0: the load's angle when the can is let go, at rest: a number [rad], "level" for a level
        surface, or "free".
      bend: usual size of the bend of the track by a lens [m]; by default 5 mm, or 1/400 of the
        track's length if that is less. With 0 the track is straight.
      progress: whether a terminal shows a progress bar.

    Raises:
      ParameterError: if an argument is not allowed, or the scene has no such parameter.
      MjbeerError: if no motion of such a scene comes near the track.
    """
    require.instance("track", track, Track)
    require.instance("scene", scene, Scene)
    require.choice("progress", progress, (True, False))
    measured = _measurements(track, known, bend)
    listed = free if isinstance(free, (tuple, list, set)) else [free]
    names = {require.choice("free", name, FITTABLE) for name in listed}
    names.update(["place", "released", *measured])
    if track.roll is not None:
        names.update(["scale", "turned"])
    if not isinstance(phi0, str):
        require.start(phi0, 0.0)
    elif require.choice("phi0, if it is no number,", phi0, ("level", "free")) == "free":
        names.add("phi0")
    _require_parameters(scene, names)
    unknowns = make_unknowns(names, track, scene, measured)
    model = TrackModel(track, scene, phi0)
    # Warnings about guesses do not matter; those of the fitted run are in the result.
    with warnings.catch_warnings(action="ignore"):
        minima = _search(model, unknowns, progress)
        if not minima:
            raise MjbeerError(f"no motion of such a scene is like the track, got {scene!r}")
        return _result(model, unknowns, minima)


def _measurements(
    track: Track, known: Mapping[str, tuple[float, float]] | None, bend: float | None
) -> dict[str, Measurement]:
    """Return the measured values by name.

    One is a bend of 0, give or take its usual size; another the scale of a board with marks.
    """
    if bend is None:
        bend = min(BEND, float(np.ptp(track.along)) / 400)
    measured = {}
    if require.non_negative("bend", bend, "m") > 0:
        measured["bend"] = Measurement(0.0, bend)
    if track.scale_error > 0:
        measured["scale"] = Measurement(1.0, track.scale_error)
    for name, pair in require.instance("known", {} if known is None else known, dict).items():
        require.choice(f"a name in {require.format_value(known)}", name, NAMES)
        numbers = require.samples(f"known {name}", pair).tolist()
        if len(numbers) != 2 or not numbers[1] > 0:
            got = require.format_value(pair)
            raise ParameterError(f"known {name} must be a value and its error, got {got}")
        measured[name] = Measurement(*numbers)
    return measured


def _require_parameters(scene: Scene, names: Collection[str]) -> None:
    """Raise an error if a parameter is sought that the scene was made without."""
    make = scene.made_by.function if scene.made_by else Scene
    arguments = inspect.signature(make).parameters
    for name in FITTABLE:
        has_it = bool(scene.damping_law) if name == "damping" else name in arguments
        if name in names and not has_it:
            raise ParameterError(f"{name} is sought, which this scene was made without: {scene!r}")


def _search(model: TrackModel, unknowns: tuple[Unknown, ...], progress: bool) -> list[Minimum]:
    """Return the distinct minima that are found, the best first."""
    console = terminal.STDERR if progress else None
    with terminal.progress_bar(console, 1 + _SEARCHES) as step:
        step("looking for starts")
        first_minima = []
        for guess in first_guesses(model, unknowns)[:_FIRST_ROUNDS]:
            with contextlib.suppress(ValueError):  # SciPy's, where there is no such motion
                first_minima.append(first_round(model, unknowns, guess))
        minima = []
        for minimum in distinct(unknowns, first_minima)[:_SEARCHES]:
            step("fitting")
            with contextlib.suppress(ValueError):
                second = next_round(model, unknowns, minimum)
                minima.append(next_round(model, unknowns, second))
    return distinct(unknowns, minima)


def _result(model: TrackModel, unknowns: tuple[Unknown, ...], minima: list[Minimum]) -> Fit:
    """Return the fit of the minimum nearest to the guess, among those as good as the best."""
    alike = as_good_as_best(minima)
    best = nearest_to_guess(unknowns, alike)
    values = to_values(unknowns, best.variables)
    uncertainty = best.uncertainty()
    errors = {}
    for unknown, deviation in zip(unknowns, uncertainty.deviations.tolist(), strict=True):
        errors[unknown.name] = unknown.to_error(values[unknown.name], deviation)
    run = model.simulate(values, float(model.track.time[-1]) - values["released"])
    doubted = doubts(best, alike, unknowns)
    liquid = run.scene.damping_law.liquid
    if liquid and "damping" in values:
        doubted += doubts_of_law(liquid, values["damping"], errors["damping"])
    return Fit(
        track=model.track,
        scene=run.scene,
        values=values,
        errors=errors,
        correlation=uncertainty.correlation,
        noise=dict(zip(model.channels, best.weights.noise[:, 0].tolist(), strict=True)),
        warnings=(*doubted, *run.warnings),
        run=run,
        model=dict(zip(model.channels, model.predict(values), strict=True)),
    )
