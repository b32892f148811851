"""The track that a scene would give: its simulated motion, as a camera with a lens would see it."""

import functools
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy import interpolate

from mjbeer.exceptions import MjbeerError
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene
from mjbeer.tracks.track import Track
from mjbeer.tracks.unknowns import OF_MOTION

_TOLERANCE = 1e-5
"""The tolerance of a motion [rad]: a can of beer is at most 0.3 micrometres off."""
_KEPT_MOTIONS = 100
"""Number of motions that are kept: a search needs those of its last steps again."""


def with_parameters(scene: Scene, changes: Mapping[str, float]) -> Scene:
    """Return the scene that its maker returns with some arguments changed, such as the fill."""
    if scene.made_by is None:
        return replace(scene, **changes)
    make, given = scene.made_by
    return make(**{**given, **changes})


class TrackModel:
    """The track without noise, as a function of the unknowns.

    Args:
      track: the track that was filmed.
      scene: the scene, whose parameters are replaced by those among the unknowns.
      phi0: the load's angle at release [rad], or "level" for a level surface; it is replaced by a
        "phi0" among the unknowns.
    """

    def __init__(self, track: Track, scene: Scene, phi0: float | str) -> None:
        self.track = track
        self.scene = scene
        self.phi0 = phi0
        self.channels = track.channels
        self.data = np.stack([getattr(track, name) for name in self.channels])
        self.duration = float(np.ptp(track.time))
        # A load swings by a radian in 0.8 of this time [s]. Without gravity, any time will do.
        self.swing_time = math.sqrt(scene.can.radius / max(scene.gravity, 1.0))
        # Each model has a cache of its own, which is released with the model.
        self._kept_spline = functools.lru_cache(_KEPT_MOTIONS)(self._spline)

    def predict(self, values: Mapping[str, float]) -> np.ndarray:
        """Return the track at its times, shape (channels, points); NaN if no motion has the values.

        A lens bends it by a parabola, whose height is "bend" in the middle and 0 at both ends.
        """
        distance, phi = self.motion(values, self.track.time - values["released"])
        along = values["place"] + distance
        # The parabola is taken at the model's places: at the measured ones it would share their
        # noise, and the fitted bend would be biased.
        share = (along - self.track.along.min()) / np.ptp(self.track.along)
        bent = values.get("bend", 0.0) * 4 * share * (1 - share)
        predicted = {
            "along": values.get("scale", 1.0) * along + bent,
            "roll": values.get("turned", 0.0) + distance / self.scene.can.radius,
            "phi": phi,
        }
        return np.stack([predicted[name] for name in self.channels])

    def motion(self, values: Mapping[str, float], since: np.ndarray) -> np.ndarray:
        """Return distance [m] and phi [rad] at times `since` release [s], shape (2, *since.shape).

        Before the release the can lies at the start. If no motion has these values, the result is
        NaN, so that the solver steps back.
        """
        # The duration is a whole number of eighths of the track's, so that motions with many times
        # of release share one spline.
        eighth = self.duration / 8
        duration = eighth * max(1, math.ceil(float(since.max()) / eighth))
        parameters = tuple((name, values[name]) for name in OF_MOTION if name in values)
        try:
            spline = self._kept_spline(parameters, duration)
        except MjbeerError:
            return np.full((2, *since.shape), math.nan)
        return spline(np.maximum(since, 0.0))

    def simulate(self, values: Mapping[str, float], duration: float) -> Run:
        """Return the motion from release on, for a duration [s]."""
        scene = self._scene(values)
        if "phi0" in values:
            phi0 = values["phi0"]
        elif isinstance(self.phi0, str):
            phi0 = -scene.incline
        else:
            phi0 = self.phi0
        # The spline's error is below 1e-6 radii for swings. It is 1e-4 radii where the can turns by
        # half a radian between two nodes, as it does at the end of a constant acceleration.
        fastest = 2 * float(np.ptp(self.track.along)) / self.duration
        interval = min(0.25 * self.swing_time, 0.5 * scene.can.radius / fastest)
        count = min(5000, max(50, math.ceil(duration / interval)))
        nodes = np.linspace(0, duration, count)
        return simulate(scene, duration, phi0, tolerance=_TOLERANCE, times=nodes)

    def _scene(self, values: Mapping[str, float]) -> Scene:
        """Return the scene with these values; "damping" is a factor on the scene's own law."""
        changes = {name: values[name] for name in ("incline", "fill", "drag") if name in values}
        scene = with_parameters(self.scene, changes)
        if "damping" not in values:
            return scene
        law = scene.damping_law
        factor = values["damping"]
        damping = replace(
            law,
            linear=factor * law.linear,
            quadratic=factor * law.quadratic,
            cubic=factor * law.cubic,
        )
        return replace(scene, damping=damping)

    def _spline(
        self, parameters: tuple[tuple[str, float], ...], duration: float
    ) -> interpolate.CubicHermiteSpline:
        """Return a spline of distance [m] and phi [rad] by the time since release [s]."""
        run = self.simulate(dict(parameters), duration)
        values = [run.distance, run.phi]
        rates = [run.u_dot, run.phi_dot]
        return interpolate.CubicHermiteSpline(run.time, values, rates, axis=1)
