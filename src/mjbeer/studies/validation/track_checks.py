"""Checks of fits to tracks of exact motions, with and without noise."""

import math
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from mjbeer.checks.check import Check
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import liquid, liquid_in
from mjbeer.theory.paper_scenes import frozen, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import exact
from mjbeer.tracks.fit import BEND, fit
from mjbeer.tracks.result import Fit
from mjbeer.tracks.track import Track
from mjbeer.tracks.track_model import with_parameters

_METAL = Can.sheet_metal()
_GENTLE = math.radians(2)
_WATER = liquid_in("water", _GENTLE, can=_METAL)


class FilmedScene(NamedTuple):
    """A scene whose track is fitted."""

    scene: Scene
    phi0: float | None
    """[rad]; None for a level surface."""
    sought: str
    """The parameter that is fitted besides the incline."""


SCENES = {
    "water on 2 degrees": FilmedScene(
        sliding(_GENTLE, 0.5, _METAL, _WATER.density, damping=_WATER.damping), None, "damping"
    ),
    "olive oil on 3 degrees": FilmedScene(
        liquid("olive oil", math.radians(3), can=_METAL), None, "damping"
    ),
    "ice on 5 degrees, from -1.5 rad": FilmedScene(
        frozen(math.radians(5), can=_METAL), -1.5, "fill"
    ),
}
_RATE = 30
"""Pictures per second of a slow camera."""
_NOISE = 3e-3
"""Standard deviation of the noise of a track [m]."""
_TRACKS = 6
"""Number of noisy tracks of a scene."""


def checks() -> Iterator[Check]:
    """Yield the checks of the fit."""
    for name, filmed_scene in SCENES.items():
        yield Check(
            "tracks",
            "incline of a track",
            partial(_incline_error, filmed_scene),
            f"{name}, 60 points without noise",
            1e-6,
            "rad",
            "the splines of the motion, and the tolerance",
        )
        if filmed_scene.phi0 is None:  # ice takes ten seconds
            yield Check(
                "tracks",
                "squares of errors over standard errors, less 1",
                partial(_excess_of_squares, filmed_scene),
                f"{name}, {_TRACKS} tracks, 3 mm of noise",
                3 * math.sqrt(1 / _TRACKS),
                "",
                f"chance: three standard deviations of {2 * _TRACKS} squares",
            )


def filmed(scene: Scene, phi0: float | None, rng: np.random.Generator | None = None) -> Track:
    """Return the track of a can that lies still for 0.3 s and is then let go.

    With `rng` the track has noise, and the bend of a lens.
    """
    time = np.arange(60) / _RATE
    rolls = time > 0.3
    distance = np.zeros(len(time))
    start = -scene.incline if phi0 is None else phi0
    distance[rolls] = exact(scene, time[rolls] - 0.3, start).distance
    if rng is not None:
        share = (distance - distance.min()) / np.ptp(distance)
        bend = min(BEND, np.ptp(distance) / 400) * rng.standard_normal()
        noise = _NOISE * rng.standard_normal(len(time))
        distance = distance + bend * 4 * share * (1 - share) + noise
    return Track(17 + time, 0.1 + distance)


def fitted(track: Track, filmed_scene: FilmedScene, bend: float | None = None) -> Fit:
    """Return the fit to a track; its guess of the incline is half a degree too large."""
    scene = filmed_scene.scene
    guess = with_parameters(scene, {"incline": scene.incline + math.radians(0.5)})
    sought = ("incline", filmed_scene.sought)
    start = "level" if filmed_scene.phi0 is None else filmed_scene.phi0
    return fit(track, guess, sought, None, start, bend, progress=False)


def _incline_error(filmed_scene: FilmedScene) -> float:
    """Return the error of the incline [rad] without noise."""
    track = filmed(filmed_scene.scene, filmed_scene.phi0)
    result = fitted(track, filmed_scene, bend=0.0)
    return result.values["incline"] - filmed_scene.scene.incline


def _excess_of_squares(filmed_scene: FilmedScene) -> float:
    """Return the mean square of the errors, in units of the standard errors, less 1."""
    scene = filmed_scene.scene
    names = ("incline", filmed_scene.sought)
    truth = {"incline": scene.incline, "damping": 1.0}  # damping is a factor on the scene's law
    squares = []
    for seed in range(_TRACKS):
        track = filmed(scene, filmed_scene.phi0, np.random.default_rng(seed))
        result = fitted(track, filmed_scene)
        errors = [(result.values[name] - truth[name]) / result.errors[name] for name in names]
        deviations = np.array(errors)
        whitened = np.linalg.solve(result.correlation[:2, :2], deviations)
        squares.append(float(deviations @ whitened) / 2)
    return float(np.mean(squares)) - 1
