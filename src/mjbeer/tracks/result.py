"""The result of a fit: a scene and values with errors, in words, as a plot and as a film."""

import math
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.simulation.run import Run
from mjbeer.theory.scene import Scene
from mjbeer.tracks.doubts import POLYNOMIAL_ERROR
from mjbeer.tracks.track import Track
from mjbeer.tracks.unknowns import FITTABLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The scene whose motion comes nearest to a track, with the errors and the limits of the fit.

    The keys of `values` and `errors` are names of unknowns. Those of `noise` and `model` are names
    of what was tracked: "along" [m], and perhaps "roll" and "phi" [rad].
    """

    track: Track
    scene: Scene
    """The scene as fitted: its incline is the true one less the rolling resistance."""
    values: dict[str, float]
    """The fitted values.

    Those of the scene have their names in it; "damping" is a factor on the scene's own law. "place"
    [m] and "released" [s] say where and when the can was let go, in the coordinates of the track.
    "bend" is how far the middle of the track is bent [m]. A track with a roll has two more: "scale"
    is the factor by which the track is too long, and "turned" is the roll at the start [rad].
    """
    errors: dict[str, float]
    """The standard errors of the values, if the model is right."""
    correlation: np.ndarray
    """The correlation matrix of the errors, in the order of `values`."""
    noise: dict[str, float]
    """The standard deviation of the track from the model."""
    warnings: tuple[str, ...]
    """Reasons to doubt the model, and what the track leaves open."""
    run: Run
    """The simulated motion from the release on."""
    model: dict[str, np.ndarray]
    """The track as the fitted motion would give it without noise, shape (points,) each."""

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
            law = self.scene.damping_law
            if law.liquid and law.quadratic > 0:
                line += f", and ± {POLYNOMIAL_ERROR * value:.2g} as a polynomial stands for w^1.5"
            return f"damping as a multiple of its law: {line}"
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

    def plot(self) -> "tuple[Axes, ...]":
        """Plot track and model, their difference in mm, and the speed in a new figure.

        Returns the axes.
        """
        from matplotlib import pyplot as plt

        from mjbeer.output.plots import COLOURS, REFERENCE, SIMULATED, STYLE

        time = self.track.time
        deviation = self.track.along - self.model["along"]
        run_time = np.append(time[0], self.values["released"] + self.run.time)
        run_speed = np.append(0.0, self.run.u_dot)  # the can lies still until it is let go
        with plt.rc_context(STYLE | {"lines.markersize": 3}):
            figure = plt.figure(figsize=(8, 7.5), layout="constrained")
            places, deviations, speeds = figure.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2))
            # Circles that the line of the model leaves visible.
            circles: dict[str, Any] = {"color": COLOURS[1], "markerfacecolor": "none"}
            places.plot(time, self.track.along, "o", markersize=5, label="track", **circles)
            places.plot(time, self.model["along"], label="model", **SIMULATED)
            places.set_ylabel("along the incline [m]")
            places.legend(loc="upper left")
            left = 1e3 * np.sqrt(np.mean(deviation**2))
            deviations.set_title(f"What the model leaves: {left:.2g} mm (root mean square)")
            deviations.plot(time, 1e3 * deviation, ".", color=COLOURS[1])
            deviations.axhline(0, **REFERENCE)
            deviations.set_ylabel("track − model [mm]")
            speeds.plot(run_time, run_speed, **SIMULATED)
            speeds.set(xlabel="time [s]", ylabel="speed [m/s]", xlim=(time[0], time[-1]))
            title = "\n".join(self.lines())
            figure.suptitle(title, fontsize=STYLE["axes.labelsize"], x=0.02, ha="left")
        return places, deviations, speeds

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
        from mjbeer.drawing.style import FilmStyle
        from mjbeer.drawing.video import write

        time = self.track.time - self.values["released"]
        deviation = self.track.along - self.model["along"]
        places = np.interp(time, self.run.time, self.run.u) + deviation
        style = FilmStyle(
            "A filmed can and the fitted motion",
            marks=("measured",),
            measured=np.stack([time, places], axis=1),
        )
        film = MotionFilm(lambda: self.run, style, speed=speed)
        write(film.plan(), require.path(path), width, height, 30)
