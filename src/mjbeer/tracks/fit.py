"""What was in the can: the scene whose simulated motion is that of a track, with errors that hold."""

import contextlib
import functools
import inspect
import itertools
import math
import os
import warnings
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from operator import attrgetter, itemgetter
from typing import Any

import numpy as np
from scipy import fft, interpolate, ndimage, optimize, special

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.output import terminal
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene
from mjbeer.tracks.track import Track

FREE = "incline", "fill", "damping", "drag"  # what a scene has that can be fitted
_SIZES = {
    "incline": math.radians(1), "fill": 0.1, "damping": 1.0, "drag": 1e-3, "phi0": 0.2, "place": 0.02, "released": 0.1,
    "bend": 5e-3, "scale": 0.02, "turned": 0.2,
}  # fmt: skip
"""What is much of each value. Damping and a sliding load's incline count in their logarithms."""
_WITHIN = {"incline": require.INCLINE, "fill": (0.01, 0.99), "drag": (0.0, 1.0), "scale": (0.5, 2.0)}
_TRIED = {"fill": np.linspace(0.05, 0.95, 19), "damping": (0.55, 0.75, 1.3, 1.8), "phi0": np.linspace(-3, 3, 7)}
"""Values that are tried as starts. Incline, damping and release of a late track look alike, and two fills of ice."""
_BEGUN = 16  # starts whose first round is fitted
_STARTS = 6  # those of them that are followed to the end
_FAR = 6.0  # deviations of noise from which on a point is left out
BEND = 5e-3  # how far a lens usually bends the picture of a straight board [m]
LAW_ERROR = 0.1  # relative error of a liquid's damping law itself: of W^1.5 and its polynomial
_MIDDLE = 1e3  # the solver's variables at the guess, so that they differ by 1e-3 for the derivatives
_SOLVER: dict[str, Any] = {"ftol": 1e-6, "xtol": 1e-9, "diff_step": 1e-6, "max_nfev": 100}


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """A scene whose motion is that of a track: what follows from it, how well, and what does not.

    The `scene` is as fitted, its incline less by the rolling resistance. `values` are those of the scene, "damping" as
    a factor on its own law; "place" and "released", where the can was [m] and when it was let go [s], as the track
    counts; "bend" of its middle [m]; with a tracked roll "scale", by which the track is too long, and "turned", the
    roll at first [rad]. `errors` are their standard errors, if the model is right, `correlation` is that of the errors,
    and `noise` the standard deviation from the `model`, the track without noise: "along" [m], "roll" and "phi" [rad].
    `warnings` say what speaks against the model and what the track cannot tell; `run` is the motion from release on.
    """

    track: Track
    scene: Scene
    values: dict[str, float]
    errors: dict[str, float]
    correlation: np.ndarray
    noise: dict[str, float]
    warnings: tuple[str, ...]
    run: Run
    model: dict[str, np.ndarray]

    def lines(self) -> list[str]:
        """Return each value of the scene with its error in words, angles in degrees."""
        told, words = [], {"incline": "incline, less rolling resistance", "damping": "damping over its law"}
        for name in [each for each in (*FREE, "phi0", "scale") if each in self.values]:
            scale, unit = (180 / math.pi, "°") if name in ("incline", "phi0") else (1.0, "")
            value, error = scale * self.values[name], scale * self.errors[name]
            digits = max(0, 1 - math.floor(math.log10(error)))
            law = f", and ± {LAW_ERROR * value:.2g} of the law itself" if name == "damping" else ""
            told.append(f"{words.get(name, name)}: {value:.{digits}f}{unit} ± {error:.{digits}f}{unit}{law}")
        return told

    @property
    def title(self) -> str:
        """Return what was fitted to what, in a line."""
        noise = [f"{1e3 * rms:.2g} {'mm' if name == 'along' else 'mrad'} ({name})" for name, rms in self.noise.items()]
        return f"{in_words(self.scene)}; {len(self.track.time)} points with a noise of {', '.join(noise)}"

    def __str__(self) -> str:
        return "\n".join([self.title, *self.lines(), *(f"note: {each}" for each in self.warnings)])

    __repr__ = __str__

    def plot(self) -> tuple[Any, ...]:
        """Plot track and model, what is left in mm, and the speed, in a new figure; return the axes of each."""
        from matplotlib import pyplot as plt

        from mjbeer.output.plots import COLOURS, REFERENCE, SIMULATED, STYLE

        time, released = self.track.time, self.values["released"]
        with plt.rc_context(STYLE | {"lines.markersize": 3}):
            figure = plt.figure(figsize=(8, 7.5), layout="constrained")
            places, left, speed = figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2))
            places.plot(time, self.track.along, ".", color=COLOURS[1], label="track")
            places.plot(time, self.model["along"], label="model", **SIMULATED)
            places.set_ylabel("along [m]")
            places.legend()
            left.plot(time, 1e3 * (self.track.along - self.model["along"]), ".", color=COLOURS[1])
            left.axhline(0, **REFERENCE)
            left.set_ylabel("track − model [mm]")
            speed.plot(np.append(time[0], released + self.run.time), np.append(0.0, self.run.u_dot), **SIMULATED)
            speed.set(xlabel="time [s]", ylabel="speed [m/s]", xlim=(time[0], time[-1]))
            figure.suptitle("\n".join(self.lines()), fontsize=STYLE["axes.labelsize"], x=0.02, ha="left")
        return places, left, speed

    def video(self, path: str | os.PathLike[str], width: int = 1280, height: int = 720, speed: float = 1.0) -> None:
        """Write a film of `run` (.mp4), the tracked places as marks; arguments and errors are as in `mjbeer.render`."""
        from mjbeer.drawing.film import MotionFilm
        from mjbeer.drawing.style import FilmStyle
        from mjbeer.drawing.video import write

        time = self.track.time - self.values["released"]
        u = np.interp(time, self.run.time, self.run.u) + self.track.along - self.model["along"]
        measured = np.stack([time, u], axis=1)
        style = FilmStyle("A filmed can and the fitted motion", marks=("measured",), measured=measured)
        write(MotionFilm(lambda: self.run, style, speed=speed).plan(), require.path(path), width, height, 30)


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

    `free` are the names of what is sought: "incline" [rad], "fill", "damping" (a factor on the scene's own law) and
    "drag" [kg/m]; the `scene` has all else, and guesses of those. `known` are measured values with standard errors,
    which count as much as the track; also "scale", by which the track is too long, and which a tracked roll gives.
    `phi0` [rad] is the load's angle when the can is let go, at rest: a number, "level" for a level surface, or "free".
    Where the can was and when it was let go are always sought, and so is a bend of the track as by a lens, of the size
    `bend` [m]: 5 mm or 1/400 of a shorter way by default, none if 0. `progress` shows a progress bar in a terminal.

    Raises:
      ParameterError: if an argument is not allowed, or the scene has not what is sought.
      MjbeerError: if no motion of such a scene is like the track.
    """
    require.instance("track", track, Track)
    require.instance("scene", scene, Scene)
    console = terminal.STDERR if require.choice("progress", progress, (True, False)) else None
    bend = min(BEND, float(np.ptp(track.along)) / 400) if bend is None else require.non_negative("bend", bend, "m")
    measured = {"bend": (0.0, bend)} if bend > 0 else {}
    for name, pair in require.instance("known", {} if known is None else known, dict).items():
        require.choice(f"a name in {require.format_value(known)}", name, _SIZES)
        value, *error = require.samples(f"known {name}", pair).tolist()
        if len(error) != 1 or not error[0] > 0:
            raise ParameterError(f"known {name} must be a value and its error, got {require.format_value(pair)}")
        measured[name] = value, error[0]
    sought = {require.choice("free", name, FREE) for name in (free if isinstance(free, (tuple, list, set)) else [free])}
    sought |= {"place", "released", *measured, *["scale", "turned"] * (track.roll is not None)}
    if not isinstance(phi0, str):
        require.start(phi0, 0.0)
    elif require.choice("phi0, if it is no number,", phi0, ("level", "free")) == "free":
        sought.add("phi0")
    has = inspect.signature(scene.made_by[0] if scene.made_by else Scene).parameters
    for name in sought & {*FREE}:
        if not (scene.damping_law if name == "damping" else name in has):
            raise ParameterError(f"{name} is sought, which this scene was made without: {scene!r}")
    problem = _Problem(track, scene, sought, measured, phi0)
    # What is warned of is about guesses; the fitted run has its own.
    with warnings.catch_warnings(action="ignore"), terminal.progress_bar(console, 1 + _STARTS) as step:
        step("looking for starts")
        begun: list[optimize.OptimizeResult] = []
        for values in problem.starts()[:_BEGUN]:
            with contextlib.suppress(ValueError):  # there is no such motion
                begun.append(problem.begin(values))
        minima: list[optimize.OptimizeResult] = []
        for found in problem.different(begun)[:_STARTS]:
            step("fitting")
            with contextlib.suppress(ValueError):
                minima.append(problem.round(problem.round(found)))
        if not minima:
            raise MjbeerError(f"no motion of such a scene is like the track, got {scene!r}")
        return problem.result(minima)


def remade(scene: Scene, changes: Mapping[str, float]) -> Scene:
    """Return a scene made anew with other arguments, such as a fill."""
    make, given = scene.made_by or (functools.partial(replace, scene), {})
    return make(**{**given, **changes})


class _Problem:
    """Least squares over simulated motions: starts, residuals, minima, and what follows from them."""

    def __init__(self, track: Track, scene: Scene, names: set[str], known: dict[str, tuple], phi0: float | str) -> None:
        self.track, self.scene, self.known, self.phi0 = track, scene, known, phi0
        self.channels = [name for name in ("along", "roll", "phi") if getattr(track, name) is not None]
        self.data = np.stack([getattr(track, name) for name in self.channels])
        self.span, latest = float(np.ptp(track.time)), float(track.time[-1])
        self.pace = math.sqrt(scene.can.radius / max(scene.gravity, 1.0))  # a load swings by a radian in 0.8 of it [s]
        self.logarithmic = {"damping", *["incline"] * (scene.attachment == "sliding")} & names
        if "incline" in self.logarithmic and scene.incline * (track.along[-1] - track.along[0]) <= 0:
            raise ParameterError("the can of this track does not roll down the scene's incline: turn the sign of one")
        self.own = [name for name in (*FREE, "phi0") if name in names]
        guess = {"incline": scene.incline, "fill": scene.load.fill, "drag": scene.drag, "damping": 1.0, "scale": 1.0}
        guess |= {"turned": track.roll[0] if track.roll is not None else 0.0}
        guess |= {name: value for name, (value, _) in known.items()}
        self.guess = {name: float(guess.get(name) or 0.0) for name in _SIZES if name in names}
        within = _WITHIN | {"released": (latest - 4 * self.span, latest - 0.1 * self.span)}
        within |= {name: (0.01 * self.guess[name], 100 * self.guess[name]) for name in self.logarithmic}
        self.within = self.solved({name: within.get(name, (-math.inf, math.inf)) for name in self.guess}).T
        tried = {name: [value, *([] if name in known else _TRIED.get(name, []))] for name, value in self.guess.items()}
        if "incline" in names - {*known} - self.logarithmic:  # its swings are to be in phase with the track's
            factors = (0.8, 1.0) if "phi0" in names else (0.7, 0.85, 1.0, 1.2, 1.5)
            tried["incline"] = [scene.incline * factor for factor in factors]
        if "fill" in names - {*known} and not scene.dissipates:
            # Swings that go on for ever get out of step where the frequency is a little off. It grows from 0 to the
            # largest and falls to 0 again, nearly evenly in the square root of the fill. So many fills are tried that
            # one between two of them is out of step by a radian at most at either end, if it is in step in the middle.
            count = math.ceil(0.65 * self.span / self.pace)
            tried["fill"] = [self.guess["fill"], *np.linspace(0.1, 0.985, min(max(19, count), 150)) ** 2]
        self.tried = {name: sorted(set(values)) for name, values in tried.items()}
        self.spline = functools.lru_cache(100)(self._spline)

    def solved(self, values: Mapping[str, Any]) -> np.ndarray:
        """Return the solver's variables, or pairs of them: `_MIDDLE` is the guess, and 1 more is much."""
        found = []
        for name, guess in self.guess.items():
            value = np.array(values[name])
            off = np.log(value / guess) * abs(guess) if name in self.logarithmic else value - guess
            found.append(_MIDDLE + off / _SIZES[name])
        return np.array(found)

    def values(self, z: np.ndarray) -> dict[str, float]:
        """Return the values of the solver's variables."""
        found = {}
        for (name, guess), each in zip(self.guess.items(), z.tolist(), strict=True):
            off = _SIZES[name] * (each - _MIDDLE)
            found[name] = guess * math.exp(off / abs(guess)) if name in self.logarithmic else guess + off
        return found

    def simulate(self, values: Mapping[str, float], duration: float) -> Run:
        """Return the motion since the can was let go."""
        scene = remade(self.scene, {name: values[name] for name in ("incline", "fill", "drag") if name in values})
        if "damping" in values:
            law, factor = scene.damping_law, values["damping"]
            linear, quadratic, cubic = (factor * each for each in law.coefficients)
            scene = replace(scene, damping=replace(law, linear=linear, quadratic=quadratic, cubic=cubic))
        phi0 = values.get("phi0", -scene.incline if isinstance(self.phi0, str) else self.phi0)
        # A spline's error is below 1e-6 radii for swings; it is 1e-4 where the can turns by half a radian from one node
        # to the next, as it does at the end of an even acceleration.
        fastest = 2 * float(np.ptp(self.track.along)) / self.span
        step = min(0.25 * self.pace, 0.5 * scene.can.radius / fastest)
        nodes = np.linspace(0, duration, min(5000, max(50, math.ceil(duration / step))))
        return simulate(scene, duration, phi0, tolerance=1e-5, times=nodes)  # 1e-5 rad are 0.3 micrometres of the way

    def motion(self, values: Mapping[str, float], since: np.ndarray) -> np.ndarray:
        """Return distance [m] and phi [rad] at times since the can was let go [s], (2, ...); NaN if it cannot be."""
        # As long as an eighth of the track's time more or less needs, so that many a release has the same spline.
        duration = self.span / 8 * max(1, math.ceil(8 * float(since.max()) / self.span))
        try:
            return self.spline(tuple((name, values[name]) for name in self.own), duration)(np.maximum(since, 0.0))
        except MjbeerError:
            return np.full((2, *since.shape), math.nan)

    def _spline(self, own: tuple[tuple[str, float], ...], duration: float) -> interpolate.CubicHermiteSpline:
        run = self.simulate(dict(own), duration)
        return interpolate.CubicHermiteSpline(run.time, [run.distance, run.phi], [run.u_dot, run.phi_dot], axis=1)

    def model(self, values: Mapping[str, float]) -> np.ndarray:
        """Return what the track would be without noise, of shape (channels, points)."""
        distance, phi = self.motion(values, self.track.time - values["released"])
        along = values["place"] + distance
        # A parabola that is 1 in the middle. From measured places it would share their noise, and the bend be biased.
        share = (along - self.track.along.min()) / np.ptp(self.track.along)
        bent = values.get("bend", 0.0) * 4 * share * (1 - share)
        roll = values.get("turned", 0.0) + distance / self.scene.can.radius
        found = {"along": values.get("scale", 1.0) * along + bent, "roll": roll, "phi": phi}
        return np.stack([found[name] for name in self.channels])

    def residuals(self, z: np.ndarray, noise: np.ndarray, kept: np.ndarray) -> np.ndarray:
        """Return the distances of track and known values, NaN where there is no such motion: the solver steps back."""
        values = self.values(z)
        off = kept * (self.model(values) - self.data) / noise
        return np.append(off, [(values[name] - value) / error for name, (value, error) in self.known.items()])

    def starts(self) -> list[dict[str, float]]:
        """Return what was tried: what suits better than all beside it, the best of each fill and damping, and others.

        Twins near the fill of the fastest swing have no ridge between them that the net of what is tried could show.
        """
        suited = []
        for values in itertools.product(*self.tried.values()):
            suited.append(self.suit(dict(zip(self.tried, values, strict=True))))
        left = np.nan_to_num([values["left"] for values in suited], nan=math.inf)  # there is no such motion
        left = left.reshape([len(values) for values in self.tried.values()])
        lowest = left[left == ndimage.minimum_filter(left, 3, mode="nearest")].tolist()
        suited = sorted((values for values in suited if math.isfinite(values["left"])), key=itemgetter("left"))
        best: dict[tuple[float | None, float | None], dict[str, float]] = {}
        for values in suited:
            best.setdefault((values.get("fill"), values.get("damping")), values)
        chosen = [values for values in suited if values["left"] in lowest]
        for others in (best.values(), suited):
            chosen += [values for values in others if values not in chosen]
        return chosen

    def suit(self, values: dict[str, float], again: bool = False) -> dict[str, float]:
        """Return values with place, release and a sliding load's incline that suit best, and what is "left" [m].

        The release is looked for in the whole track, so closely that swings are in step for one. `again`: it is among
        the values, and is compared with those that are up to some swings away, for which the can is ahead or behind.
        """
        if again:
            released = values["released"] + 17 * self.pace * np.linspace(-1, 1, 201)  # the middle one is the same
        else:
            count = min(max(91, math.ceil(2.6 * self.span / self.pace)), 2000)
            released = self.track.time[0] + self.span * np.linspace(-1, 0.8, count)
        some = slice(None, None, max(1, len(self.track.time) // (2000 if again else 100)))
        time, along = self.track.time[some], self.track.along[some]
        ways, _ = self.motion(values, time - released[:, np.newaxis])
        within = (0.5, 2.0) if "incline" in self.logarithmic else (1.0, 1.0)  # ways are nearly proportional to it
        beside = ways - ways.mean(axis=1, keepdims=True)
        stretch = np.clip(beside @ along / np.maximum((beside**2).sum(axis=1), 1e-30), *within)
        off = along - stretch[:, np.newaxis] * ways
        at = int(np.argmin(np.std(off, axis=1)))
        suited = {"released": released[at], "place": np.mean(off[at]), "left": np.std(off[at])}
        return values | suited | {"incline": values.get("incline", 0.0) * stretch[at]}

    def begin(self, start: dict[str, float]) -> optimize.OptimizeResult:
        """Return what the first round finds from a start; ValueError: there is no such motion."""
        radius = self.scene.can.radius
        noise = np.array([[start["left"] / (1 if name == "along" else radius)] for name in self.channels])
        return self._least(start, noise, np.ones(self.data.shape, bool), "2-point")

    def round(self, found: optimize.OptimizeResult) -> optimize.OptimizeResult:
        """Return what another round finds, with the noise, the points and the swing at release that suit by now."""
        start = self.suit(self.values(found.x), again=True)
        # Beside a separatrix an incline's effect changes within the step of the derivatives.
        return self._least(start, found.next_noise, found.next_kept, "3-point")

    def _least(self, start: dict[str, float], noise: np.ndarray, kept: np.ndarray, jac: Any) -> optimize.OptimizeResult:
        """Return the least squares from a start, with the noise and the points to keep of the next round."""
        z = np.clip(self.solved(start), *self.within)
        found = optimize.least_squares(self.residuals, z, jac, self.within, args=(noise, kept), **_SOLVER)
        found.noise, found.kept = noise, kept
        off = self.model(self.values(found.x)) - self.data
        kept = np.abs(off) <= _FAR * 1.4826 * np.median(np.abs(off), axis=1, keepdims=True)  # deviations of noise
        spare = np.maximum(1.0, kept.sum(axis=1) - len(z) / len(off))
        noise = np.sqrt(1e-12 + ((kept * off) ** 2).sum(axis=1) / spare)[:, np.newaxis]  # 1e-6 at least
        found.next_noise, found.next_kept = noise, kept
        known = (found.fun[self.data.size :] ** 2).sum()
        # A point that is left out counts as one that is not quite: else a swing that is left out would be an advantage.
        found.squares = 2 * self.data.shape[1] * np.log(noise).sum() + _FAR**2 * (~kept).sum() + known
        return found

    def different(self, minima: list[optimize.OptimizeResult]) -> list[optimize.OptimizeResult]:
        """Return the minima that are not one and the same, the least squares first."""
        own, chosen = slice(len(self.own)), []
        for found in sorted(minima, key=attrgetter("squares")):
            if not any(np.abs(found.x - other.x)[own].max(initial=0.0) < 1e-2 for other in chosen):
                chosen.append(found)
        return chosen

    def result(self, minima: list[optimize.OptimizeResult]) -> Fit:
        """Return the fit of the best minimum, with what there is to be warned of."""
        own, minima = slice(len(self.own)), self.different(minima)
        alike = [each for each in minima if each.squares < minima[0].squares + 9.0]  # three standard errors
        # Of minima that the track does not tell apart, the one that is nearest to the given scene.
        found = min(alike, key=lambda each: np.abs(each.x - _MIDDLE)[own].sum())
        values = self.values(found.x)
        run = self.simulate(values, float(self.track.time[-1]) - values["released"])
        _, sizes, ways = np.linalg.svd(found.jac, full_matrices=False)
        spread = 1 / np.maximum(sizes, 1e-6)
        covariance = (ways.T * spread**2) @ ways
        deviations = np.sqrt(np.diag(covariance))
        told = []
        # F tests: of white noise the slow waves, as the slowest sixteenth of all, have no more than the others.
        power = fft.dct(found.fun[: len(self.track.time)][found.kept[0]], norm="ortho") ** 2 + 1e-12
        slow = [math.ceil(len(power) / part) for part in (16, 8, 4, 2)]
        chances = [special.fdtrc(n, len(power) - n, power[:n].mean() / power[n:].mean()) for n in slow]
        if (chance := len(chances) * min(chances)) < 1e-3:
            once = f"{1 / max(chance, 1e-99):.0e} tracks"
            told.append(f"the model is wrong, or the track: noise is as smooth as what is left once in {once}")
        for name, (value, error) in self.known.items():
            if (off := abs(values[name] - value) / error) > 3:
                told.append(f"the model is wrong, or what was known: {name} is {off:.1f} of its errors off")
        for way, wide in zip(ways, spread, strict=True):
            if wide > 1:  # the track says less than the sizes; named is what it leaves open by 0.3 of its size
                least = min(0.3, wide * np.abs(way).max())
                parts = [name for name, part in zip(self.guess, way, strict=True) if abs(part) * wide >= least]
                told.append(f"this track does not tell {' from '.join(parts)}")
        if found.status == 0:
            told.append("the search was stopped before it came to the nearest motion")
        for other in alike:
            if self.own and (np.abs(other.x - found.x) / deviations)[own].max() > 6:
                there = ", ".join(f"{name} = {value:.4g}" for name, value in [*self.values(other.x).items()][own])
                told.append(f"another motion is as near to the track: {there}")
        if far := int((~found.kept).sum()):
            told.append(f"{far} points are far from all others, and were left out")
        errors = {name: _SIZES[name] * each for name, each in zip(self.guess, deviations.tolist(), strict=True)}
        errors |= {name: errors[name] * values[name] / self.guess[name] for name in self.logarithmic}
        noise = dict(zip(self.channels, found.noise[:, 0].tolist(), strict=True))
        model = dict(zip(self.channels, self.model(values), strict=True))
        correlation = covariance / np.outer(deviations, deviations)
        told = (*dict.fromkeys(told), *run.warnings)
        return Fit(self.track, run.scene, values, errors, correlation, noise, told, run, model)
