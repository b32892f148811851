"""What was in the can: the scene whose simulated motion is that of a track, with errors that hold."""

import contextlib
import itertools
import math
import os
import warnings
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import OptimizeResult

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.exceptions import MjbeerError, ParameterError
from mjbeer.output import terminal
from mjbeer.simulation.run import Run
from mjbeer.theory.scene import Scene
from mjbeer.tracks.problem import FREE, Problem
from mjbeer.tracks.track import Track

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BEND = 5e-3
"""How far a lens usually bends the picture of a straight board [m]."""
LAW_ERROR = 0.1
"""Relative error of a liquid's damping law itself, beside which that of the fit stands: of W^1.5 and its polynomial."""
_DOUBTED = 1e-3
"""Chance that noise leaves what was left from which on the model is said to be wrong."""
_UNKNOWN = 0.3
"""Part of a value in a direction that the track does not tell from which on it is named, over its size."""
_PULLED = 3.0
"""Distance of a fitted value from the known one that is told, over the error of the latter."""
_AS_GOOD = 9.0
"""Sum of squares by which another minimum may be worse to be told: three standard errors."""
_NOISES = ("along", "m"), ("roll", "rad"), ("phi", "rad")
_STARTS = 6
"""Starts that are followed to the end."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """A scene whose motion is that of a track: what follows from it, how well, and what does not."""

    track: Track
    scene: Scene
    """The scene as fitted; the rolling resistance is in its incline, which is less by it."""
    phi0: float
    """Angle at which the load was let go [rad]."""
    values: dict[str, float]
    """The fitted values: of the scene, "damping" as a factor on its own law; "place" and "released", where the can was
    [m] and when it was let go [s], in the track's own counting; "bend" of its middle [m]; and if the roll was tracked,
    "scale", by how much the track is too long, and "turned", the roll at first [rad]."""
    errors: dict[str, float]
    """The standard errors of the values, if the model is right."""
    correlation: np.ndarray
    """The correlations of the errors, in the order of the values."""
    noise: dict[str, float]
    """Standard deviation of the track from the model: "along" [m], "roll" and "phi" [rad]."""
    warnings: tuple[str, ...]
    """What speaks against the model, and what the track cannot tell, one sentence for each."""
    run: Run
    """The fitted motion since the can was let go."""
    model: dict[str, np.ndarray]
    """What the track would be without noise: "along" [m], "roll" and "phi" [rad], each of shape (points,)."""

    def lines(self) -> list[str]:
        """Return each value of the scene with its error in words, angles in degrees."""
        told = []
        for name in (*FREE, "phi0", "scale"):
            if name in self.values:
                value, error, unit = self.values[name], self.errors[name], ""
                if name in ("incline", "phi0"):
                    value, error, unit = math.degrees(value), math.degrees(error), "°"
                digits = max(0, 1 - math.floor(math.log10(error))) if 0 < error < math.inf else 3
                words = {"incline": "incline, less rolling resistance", "damping": "damping over its law"}.get(
                    name, name
                )
                law = f", and ± {LAW_ERROR * value:.2g} of the law itself" if name == "damping" else ""
                told.append(f"{words}: {value:.{digits}f}{unit} ± {error:.{digits}f}{unit}{law}")
        return told

    @property
    def title(self) -> str:
        """Return what was fitted to what, in a line."""
        noise = ", ".join(
            f"{1e3 * self.noise[name]:.2g} m{unit} ({name})" for name, unit in _NOISES if name in self.noise
        )
        return f"{in_words(self.scene)}; {len(self.track.time)} points with a noise of {noise}"

    def __str__(self) -> str:
        return "\n".join([self.title, *self.lines(), *(f"note: {each}" for each in self.warnings)])

    __repr__ = __str__

    def plot(self) -> "tuple[Axes, ...]":
        """Plot track and model, what is left in mm, and the speed, in a new figure; return the axes of each."""
        import matplotlib as mpl
        from matplotlib import pyplot as plt

        from mjbeer.output.plots import COLOURS, REFERENCE, SIMULATED, STYLE

        time, released = self.track.time, self.values["released"]
        figure = plt.figure(figsize=(8, 7.5), layout="constrained")
        points: dict[str, object] = {"marker": ".", "markersize": 3, "linestyle": "", "color": COLOURS[1]}
        with mpl.rc_context(STYLE):
            panels = tuple(figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2)))
            panels[0].plot(time, self.track.along, label="track", **points)
            panels[0].plot(time, self.model["along"], label="model", **SIMULATED)
            panels[1].plot(time, 1e3 * (self.track.along - self.model["along"]), **points)
            panels[2].plot(np.append(time[0], released + self.run.time), np.append(0.0, self.run.u_dot), **SIMULATED)
            panels[1].axhline(0, **REFERENCE)
            for axes in panels:
                axes.axvline(released, **REFERENCE)
            for axes, told in zip(panels, ("along [m]", "track − model [mm]", "speed [m/s]"), strict=True):
                axes.set_ylabel(told)
            panels[2].set(xlabel="time [s]", xlim=(time[0], time[-1]))
            panels[0].legend()
            figure.suptitle("\n".join(self.lines()), fontsize=STYLE["axes.labelsize"], x=0.02, ha="left")
        return panels

    def video(self, path: str | os.PathLike[str], width: int = 1280, height: int = 720, speed: float = 1.0) -> None:
        """Write a film of the fitted motion (.mp4), with the tracked places as marks at the height of the axis.

        Raises:
          RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
          OutputError: if the file cannot be written.
        """
        from mjbeer.drawing.film import MotionFilm
        from mjbeer.drawing.overlay import Look
        from mjbeer.drawing.video import write

        time = self.track.time - self.values["released"]
        u = np.interp(time, self.run.time, self.run.u) + self.track.along - self.model["along"]
        measured = np.stack([time, u], axis=1)
        look = Look("A filmed can, and the motion that was fitted to it", marks=("measured",), measured=measured)
        write(MotionFilm(lambda: self.run, speed, look).plan(), require.path(path), width, height, 30, lambda _: None)


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

    `free` has the names of what is sought: "incline" [rad], "fill", "damping" (a factor on the scene's own law) and
    "drag" [kg/m]. The `scene` has everything else, and a guess of those. `known` are measured values with their
    standard errors, which count as much as the track; "scale" may be among them, by which the track is too long. `phi0`
    [rad] is the load's angle when the can is let go, at rest: a number, "level" for a level surface, or "free". Where
    the can was and when it was let go are always sought, and so is a bend of the track as a lens makes one, of the size
    `bend` [m], by default 5 mm or 1/400 of a shorter way; 0 is none. A tracked roll gives the scale. If `progress` is
    true and standard error is a terminal, it shows a progress bar.

    Raises:
      ParameterError: if an argument is not allowed, or the scene has not what is sought.
      MjbeerError: if no motion of such a scene is like the track.
    """
    require.instance("track", track, Track)
    require.instance("scene", scene, Scene)
    console = terminal.STDERR if require.boolean("progress", progress) else None
    with warnings.catch_warnings(action="ignore"):  # they are about guesses, and the fit has those of its own run
        names, priors = _names(track, scene, free, {} if known is None else known, phi0, bend)
        problem = Problem(track, scene, names, priors, phi0)
        guesses = {"incline": scene.incline, "fill": scene.load.fill or 0.5, "drag": scene.drag, "scale": 1.0}
        guess = {name: guesses.get(name, 0.0) for name in names} | {name: priors[name][0] for name in priors}
        begins = _begins(scene, guess, priors)
        with terminal.progress_bar(console, len(begins) + _STARTS) as step:
            minima = _minima(problem, begins, step)
        best = min(_squares(each) for each in minima)
        alike = [each for each in minima if _squares(each) < best + _AS_GOOD]
        # Of minima that the track does not tell apart, the one that is nearest to the given scene.
        start, own = np.array([*guess.values()]) / problem.sizes, names.index("place")
        found = min(alike, key=lambda each: float(np.abs(each.x - start)[:own].sum()))
        return _fit(problem, found, alike)


def _begins(scene: Scene, guess: dict[str, float], known: Mapping[str, object]) -> list[dict[str, float]]:
    """Return the values from which it is looked for starts."""
    frozen, tried = scene.attachment == "frozen", {name: [value] for name, value in guess.items()}
    fine = frozen and "phi0" not in tried  # the swings of ice are to be in phase with the track's
    if "fill" in tried and "fill" not in known:
        tried["fill"] += np.linspace(0.05, 0.95, 19 if fine else 6).tolist()
    if "damping" in tried and "damping" not in known:  # a late track: incline, damping and release look alike
        tried["damping"] += [-0.6, -0.3, 0.3, 0.6]
    if "phi0" in tried:
        tried["phi0"] = np.linspace(-3, 3, 13).tolist()
    if "incline" in tried and frozen:
        tried["incline"] = [each * guess["incline"] for each in ((0.7, 0.85, 1.0, 1.2, 1.5) if fine else (0.8, 1.0))]
    return [dict(zip(tried, each, strict=True)) for each in itertools.product(*tried.values())]


def _minima(problem: Problem, begins: list[dict[str, float]], step: Callable[[str], None]) -> list[OptimizeResult]:
    """Return where least squares end from the best starts."""
    rough = []
    for each in begins:
        step("looking for starts")
        rough.append(problem.begin(each))
    rough = sorted((each for each in rough if each[0] < math.inf), key=lambda start: start[0])
    # The best start of each fill, and then others: where the fill is free there are several minima.
    firsts = {values.get("fill"): (left, values) for left, values in reversed(rough)}
    chosen = sorted(firsts.values(), key=lambda start: start[0])
    minima = []
    for left, values in (chosen + [start for start in rough[:_STARTS] if start not in chosen])[:_STARTS]:
        step("fitting")
        with contextlib.suppress(MjbeerError):
            minima.append(problem.solve(values, left))
    if not minima:
        raise MjbeerError(f"no motion of such a scene is like the track, got {problem.scene!r}")
    return minima


def _names(
    track: Track,
    scene: Scene,
    free: Collection[str],
    known: Mapping[str, tuple[float, float]],
    phi0: float | str,
    bend: float | None,
) -> tuple[list[str], dict[str, tuple[float, float]]]:
    """Return the names of what is sought, and what is known of it as the solver counts, after checks."""
    if not isinstance(free, (str, list, tuple, set)):
        raise ParameterError(f"free must be names, of {', '.join(FREE)}, got {require.format_value(free)}")
    free = {require.choice("free", name, FREE) for name in ([free] if isinstance(free, str) else free)}
    require.instance("known", known, dict)
    names = [name for name in FREE if name in free or name in known]
    if not isinstance(phi0, str):
        require.start(phi0, 0.0)
    elif require.choice("phi0, if it is no number,", phi0, ("level", "free")) == "free":
        names.append("phi0")
    usual = min(BEND, float(np.ptp(track.along)) / 400)
    bend = usual if bend is None else require.non_negative("bend", bend, "m")
    names += ["place", "released"] + ["bend"] * (bend > 0)
    names += ["scale"] * (track.roll is not None or "scale" in known) + ["turned"] * (track.roll is not None)
    if scene.attachment == "sliding" and scene.incline * float(track.along[-1] - track.along[0]) < 0:
        raise ParameterError("the can of this track rolls up the scene's incline: turn the sign of one of them")
    if "damping" in names and not scene.damping_law:
        raise ParameterError(f"damping is a factor on the scene's own, which has none, got {scene!r}")
    if "drag" in names and scene.attachment == "frozen":
        raise ParameterError(f"drag is for sliding loads only, got {scene!r}")
    if "fill" in names and (scene.made_by is None or scene.load.fill is None):
        raise ParameterError(f"a fill is sought of what sliding, frozen or liquid makes, got {scene!r}")
    priors = {"bend": (0.0, bend)} if bend else {}
    if not set(known) <= set(names):
        raise ParameterError(f"known must be one of {', '.join(names)}, got {require.format_value(known)}")
    for name, pair in known.items():
        if not isinstance(pair, (tuple, list)) or len(pair) != 2:
            raise ParameterError(f"known {name} must be a value and its error, got {require.format_value(pair)}")
        value = require.number(f"known {name}", pair[0])
        error = require.positive(f"error of the known {name}", pair[1])
        if name == "damping":
            value, error = math.log(require.positive("known damping", value)), error / value
        priors[name] = value, error
    return names, priors


def _squares(found: OptimizeResult) -> float:
    """Return the sum of squares of a minimum, comparable between minima of one track."""
    return sum(2 * len(kept) * math.log(found.noise[name]) for name, kept in found.kept.items())


def _fit(problem: Problem, found: OptimizeResult, alike: list[OptimizeResult]) -> Fit:
    """Return the fit of a minimum, with what there is to be warned of; `alike` are minima as good."""
    problem.noise, problem.kept = found.noise, found.kept
    values, names, own = problem.values(found.x), problem.names, problem.names.index("place")
    run = problem.simulate(values, float(problem.track.time[-1]) - values["released"])
    _, sizes, ways = np.linalg.svd(found.jac, full_matrices=False)
    spread = 1 / np.maximum(sizes, 1e-6)
    covariance = (ways.T * spread**2) @ ways
    errors = np.sqrt(np.diag(covariance))
    told = []
    if (chance := problem.chance(found)) < _DOUBTED:
        told.append(
            "the model is wrong, or the track: what is left is as smooth as noise is once in "
            f"{1 / max(chance, 1e-99):.0e} tracks, and the errors do not hold"
        )
    for name, (value, error) in problem.known.items():
        if (off := abs(values[name] - value) / error) > _PULLED:
            resists = "; rolling resistance lets it look less" if name == "incline" and values[name] < value else ""
            told.append(f"the {name} that was known is {off:.1f} of its errors off{resists}")
    for way, wide in zip(ways, spread, strict=True):  # directions in which the track says less than the sizes
        parts = [name for name, part in zip(names, way, strict=True) if abs(part) * wide > _UNKNOWN]
        if wide > 1 and len(parts) > 1:
            told.append(f"this track does not tell {' from '.join(parts)}")
        elif wide > 1:
            told.append(f"this track does not tell {names[int(np.argmax(np.abs(way)))]}")
    for other in alike:
        if own and (np.abs(other.x - found.x) / errors)[:own].max() > 2 * _PULLED:
            there = problem.values(other.x) | {"damping": math.exp(problem.values(other.x).get("damping", 0.0))}
            there = ", ".join(f"{name} = {there[name]:.4g}" for name in names[:own])
            told.append(f"another motion is as near to the track: {there}")
    if far := sum(int((~kept).sum()) for kept in problem.kept.values()):
        told.append(f"{far} points are far from all others, and were left out")
    model, factors = problem.model(values), dict.fromkeys(names, 1.0)
    if "damping" in values:
        values["damping"] = factors["damping"] = math.exp(values["damping"])
    return Fit(
        problem.track,
        run.scene,
        run.phi0,
        values,
        {name: factors[name] * error for name, error in zip(names, (errors * problem.sizes).tolist(), strict=True)},
        covariance / np.outer(errors, errors),
        dict(problem.noise),
        (*dict.fromkeys(told), *run.warnings),
        run,
        model,
    )
