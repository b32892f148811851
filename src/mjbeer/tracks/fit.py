"""What was in the can: the scene whose simulated motion is that of a track, with its errors."""

import contextlib
import inspect
import math
import os
import warnings
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.output import terminal
from mjbeer.simulation.run import Run
from mjbeer.theory.scene import Scene
from mjbeer.tracks.doubts import doubts
from mjbeer.tracks.first_guess import first_guesses
from mjbeer.tracks.least_squares import Minimum, distinct, first_round, next_round
from mjbeer.tracks.track import Track
from mjbeer.tracks.track_model import TrackModel, with_parameters
from mjbeer.tracks.unknowns import (
    FITTABLE,
    NAMES,
    Measurement,
    Unknown,
    distance_from_guess,
    make_unknowns,
    to_values,
)

remade = with_parameters
"""The name by which the checks of tracks still import it."""
BEND = 5e-3
"""How far a lens usually bends the picture of a straight board [m]."""
LAW_ERROR = 0.1
"""Relative error of a liquid's damping law itself: of W^1.5 and its polynomial."""
_FIRST_ROUNDS = 16
"""First guesses from which least squares begin."""
_SEARCHES = 6
"""Those of them that are followed to the end."""
_ALIKE = 9.0
"""The difference of costs from which on the track tells minima apart: three standard errors."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """A scene whose motion is that of a track: what follows from it, how well, and what does not.

    Dictionaries are by name: of the unknowns, or of what was tracked, "along" [m], and perhaps
    "roll" and "phi" [rad].
    """

    track: Track
    scene: Scene
    """The scene as fitted: its incline is the true one less the rolling resistance."""
    values: dict[str, float]
    """What was found of the scene, "damping" as a factor on its own law; "place" [m] and "released"
    [s], where and when the can was let go, as the track counts; "bend", how far the middle of the
    track is bent [m]; with a tracked roll "scale", by which the track is too long, and "turned",
    the roll at first [rad]."""
    errors: dict[str, float]
    """The standard errors of the values, if the model is right."""
    correlation: np.ndarray
    """The correlation of these errors, shape (values, values)."""
    noise: dict[str, float]
    """The standard deviation of what was tracked from the model."""
    warnings: tuple[str, ...]
    """What speaks against the model, and what the track cannot tell."""
    run: Run
    """The motion from the release on."""
    model: dict[str, np.ndarray]
    """The track without noise, shape (points,) each."""

    def lines(self) -> list[str]:
        """Return each value of the scene with its error in words, angles in degrees."""
        lines = []
        for name in (*FITTABLE, "phi0", "scale"):
            if name in self.values:
                lines.append(self._line(name))
        return lines

    def _line(self, name: str) -> str:
        """Return a value with its error in words, to two digits of the error."""
        value = self.values[name]
        error = self.errors[name]
        unit = ""
        if name in ("incline", "phi0"):
            value = math.degrees(value)
            error = math.degrees(error)
            unit = "°"
        digits = max(0, 1 - math.floor(math.log10(error)))
        line = f"{value:.{digits}f}{unit} ± {error:.{digits}f}{unit}"
        if name == "incline":
            return f"incline, less rolling resistance: {line}"
        if name == "damping":
            of_law = f"± {LAW_ERROR * value:.2g} of the law itself"
            return f"damping over its law: {line}, and {of_law}"
        return f"{name}: {line}"

    @property
    def title(self) -> str:
        """Return what was fitted to what, in a line."""
        parts = []
        for channel, deviation in self.noise.items():
            unit = "mm" if channel == "along" else "mrad"
            parts.append(f"{1e3 * deviation:.2g} {unit} ({channel})")
        points = f"{len(self.track.time)} points with a noise of {', '.join(parts)}"
        return f"{in_words(self.scene)}; {points}"

    def __str__(self) -> str:
        notes = [f"note: {warning}" for warning in self.warnings]
        return "\n".join([self.title, *self.lines(), *notes])

    __repr__ = __str__

    def plot(self) -> tuple[Any, ...]:
        """Plot track and model, the rest in mm, and the speed, in a new figure; return the axes."""
        from matplotlib import pyplot as plt

        from mjbeer.output.plots import COLOURS, REFERENCE, SIMULATED, STYLE

        time = self.track.time
        rest = self.track.along - self.model["along"]
        run_time = np.append(time[0], self.values["released"] + self.run.time)
        run_speed = np.append(0.0, self.run.u_dot)  # it lies still until it is let go
        with plt.rc_context(STYLE | {"lines.markersize": 3}):
            figure = plt.figure(figsize=(8, 7.5), layout="constrained")
            places, rests, speeds = figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2))
            places.plot(time, self.track.along, ".", color=COLOURS[1], label="track")
            places.plot(time, self.model["along"], label="model", **SIMULATED)
            places.set_ylabel("along [m]")
            places.legend()
            rests.plot(time, 1e3 * rest, ".", color=COLOURS[1])
            rests.axhline(0, **REFERENCE)
            rests.set_ylabel("track − model [mm]")
            speeds.plot(run_time, run_speed, **SIMULATED)
            speeds.set(xlabel="time [s]", ylabel="speed [m/s]", xlim=(time[0], time[-1]))
            title = "\n".join(self.lines())
            figure.suptitle(title, fontsize=STYLE["axes.labelsize"], x=0.02, ha="left")
        return places, rests, speeds

    def video(
        self,
        path: str | os.PathLike[str],
        width: int = 1280,
        height: int = 720,
        speed: float = 1.0,
    ) -> None:
        """Write a film of `run` (.mp4), with the tracked places as marks.

        The arguments and errors are those of `mjbeer.render`.
        """
        from mjbeer.drawing.film import MotionFilm
        from mjbeer.drawing.overlay import Look
        from mjbeer.drawing.video import write

        time = self.track.time - self.values["released"]
        rest = self.track.along - self.model["along"]
        places = np.interp(time, self.run.time, self.run.u) + rest
        look = Look(
            "A filmed can and the fitted motion",
            marks=("measured",),
            measured=np.stack([time, places], axis=1),
        )
        film = MotionFilm(lambda: self.run, look, speed=speed)
        write(film.plan(), require.path(path), width, height, 30)


def fit(
    track: Track,
    scene: Scene,
    free: Collection[str] = ("incline",),
    known: Mapping[str, tuple[float, float]] | None = None,
    phi0: float | str = "level",
    bend: float | None = None,
    progress: bool = True,
) -> Fit:
    """Return the scene whose motion, as MuJoCo simulates it, is that of a track.

    Where the can was and when it was let go are always sought, and so is a bend of the track.

    Args:
      track: what was filmed.
      scene: what rolls, with a guess of all that is sought.
      free: names of what is sought: "incline" [rad], "fill", "damping" (a factor on the scene's own
        law) and "drag" [kg/m].
      known: measured values with standard errors, which count as much as the track; also "scale",
        by which the track is too long, and which a tracked roll gives.
      phi0: the load's angle when the can is let go, at rest: a number [rad], "level" for a level
        surface, or "free".
      bend: how far a lens bends the track about [m]: 5 mm or 1/400 of a shorter way by default,
        not at all if 0.
      progress: whether a terminal shows a progress bar.

    Raises:
      ParameterError: if an argument is not allowed, or the scene has not what is sought.
      MjbeerError: if no motion of such a scene is like the track.
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
    with warnings.catch_warnings(action="ignore"):  # of guesses; the fitted run has its own
        minima = _search(model, unknowns, progress)
        if not minima:
            raise MjbeerError(f"no motion of such a scene is like the track, got {scene!r}")
        return _result(model, unknowns, minima)


def _measurements(
    track: Track, known: Mapping[str, tuple[float, float]] | None, bend: float | None
) -> dict[str, Measurement]:
    """Return what is known by name, with a bend of 0 give or take its usual size."""
    if bend is None:
        bend = min(BEND, float(np.ptp(track.along)) / 400)
    measured = {}
    if require.non_negative("bend", bend, "m") > 0:
        measured["bend"] = Measurement(0.0, bend)
    for name, pair in require.instance("known", {} if known is None else known, dict).items():
        require.choice(f"a name in {require.format_value(known)}", name, NAMES)
        numbers = require.samples(f"known {name}", pair).tolist()
        if len(numbers) != 2 or not numbers[1] > 0:
            got = require.format_value(pair)
            raise ParameterError(f"known {name} must be a value and its error, got {got}")
        measured[name] = Measurement(*numbers)
    return measured


def _require_parameters(scene: Scene, names: Collection[str]) -> None:
    """Raise an error if something of these is sought that the scene was made without."""
    make = scene.made_by.function if scene.made_by else Scene
    arguments = inspect.signature(make).parameters
    for name in FITTABLE:
        has_it = bool(scene.damping_law) if name == "damping" else name in arguments
        if name in names and not has_it:
            raise ParameterError(f"{name} is sought, which this scene was made without: {scene!r}")


def _search(model: TrackModel, unknowns: tuple[Unknown, ...], progress: bool) -> list[Minimum]:
    """Return the different minima that were found, the best first."""
    console = terminal.STDERR if progress else None
    with terminal.progress_bar(console, 1 + _SEARCHES) as step:
        step("looking for starts")
        begun = []
        for guess in first_guesses(model, unknowns)[:_FIRST_ROUNDS]:
            with contextlib.suppress(ValueError):  # SciPy's, where there is no such motion
                begun.append(first_round(model, unknowns, guess))
        minima = []
        for minimum in distinct(unknowns, begun)[:_SEARCHES]:
            step("fitting")
            with contextlib.suppress(ValueError):
                second = next_round(model, unknowns, minimum)
                minima.append(next_round(model, unknowns, second))
    return distinct(unknowns, minima)


def _result(model: TrackModel, unknowns: tuple[Unknown, ...], minima: list[Minimum]) -> Fit:
    """Return the fit of the best minimum: of those as good, the one nearest to the guess."""
    alike = [minimum for minimum in minima if minimum.cost < minima[0].cost + _ALIKE]
    best = min(alike, key=lambda minimum: distance_from_guess(unknowns, minimum.variables))
    values = to_values(unknowns, best.variables)
    uncertainty = best.uncertainty()
    errors = {}
    for unknown, deviation in zip(unknowns, uncertainty.deviations.tolist(), strict=True):
        errors[unknown.name] = unknown.to_error(values[unknown.name], deviation)
    run = model.simulate(values, float(model.track.time[-1]) - values["released"])
    return Fit(
        track=model.track,
        scene=run.scene,
        values=values,
        errors=errors,
        correlation=uncertainty.correlation,
        noise=dict(zip(model.channels, best.weights.noise[:, 0].tolist(), strict=True)),
        warnings=(*doubts(best, alike, unknowns), *run.warnings),
        run=run,
        model=dict(zip(model.channels, model.predict(values), strict=True)),
    )
