"""Checks of the fit to a track: what it finds in exact theory's motions, without noise and with it."""

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.checks.check import Check
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import liquid, liquid_in
from mjbeer.theory.scene import Scene, frozen, sliding
from mjbeer.theory.trajectory import exact
from mjbeer.tracks.fit import BEND, Fit, fit, remade
from mjbeer.tracks.track import Track

_METAL, _GENTLE = Can.sheet_metal(), math.radians(2)
_WATER = liquid_in("water", _GENTLE, can=_METAL)
SCENES: dict[str, tuple[Scene, float | None, str]] = {
    "water on 2 degrees": (sliding(_GENTLE, 0.5, _METAL, _WATER.density, damping=_WATER.damping), None, "damping"),
    "olive oil on 3 degrees": (liquid("olive oil", math.radians(3), can=_METAL), None, "damping"),
    "ice on 5 degrees, from -1.5 rad": (frozen(math.radians(5), can=_METAL), -1.5, "fill"),
}
"""Scenes, phi0 [rad] (None: a level surface), and what is sought besides the incline."""
_RATE, _NOISE = 30, 3e-3  # of a slow camera [1/s] and [m]
_TRACKS = 6
_check = partial(Check, "tracks")


def checks() -> Iterator[Check]:
    """Yield the checks of the fit."""
    for name, (scene, phi0, other) in SCENES.items():
        by, reason = f"{name}, 60 points without noise", "the splines of the motion, and the tolerance"
        yield _check("incline of a track", partial(_lost, scene, phi0, other), by, 1e-6, "rad", reason)
        if phi0 is None:  # ice takes ten seconds
            quantity, by = "squares of errors over standard errors, less 1", f"{name}, {_TRACKS} tracks, 3 mm of noise"
            reason, bound = f"chance: three standard deviations of {2 * _TRACKS} squares", 3 * math.sqrt(1 / _TRACKS)
            yield _check(quantity, partial(_excess, scene, phi0, other), by, bound, "", reason)


def filmed(scene: Scene, phi0: float | None, rng: np.random.Generator | None = None) -> Track:
    """Return the track of a can that lies still for 0.3 s and is then let go; `rng` makes noise, and a lens's bend."""
    time = np.arange(60) / _RATE
    rolls = time > 0.3
    distance = np.zeros(len(time))
    distance[rolls] = exact(scene, time[rolls] - 0.3, -scene.incline if phi0 is None else phi0).distance
    if rng is not None:
        share = (distance - distance.min()) / np.ptp(distance)
        bend = min(BEND, np.ptp(distance) / 400) * rng.standard_normal()
        distance = distance + bend * 4 * share * (1 - share) + _NOISE * rng.standard_normal(len(time))
    return Track(17 + time, 0.1 + distance)


def fitted(track: Track, scene: Scene, phi0: float | None, other: str, bend: float | None = None) -> Fit:
    """Return the fit that begins from half a degree more."""
    guess = remade(scene, {"incline": scene.incline + math.radians(0.5)})
    return fit(track, guess, ("incline", other), None, "level" if phi0 is None else phi0, bend, progress=False)


def _lost(scene: Scene, phi0: float | None, other: str) -> float:
    return fitted(filmed(scene, phi0), scene, phi0, other, bend=0.0).values["incline"] - scene.incline


def _excess(scene: Scene, phi0: float | None, other: str) -> float:
    squares = []
    for seed in range(_TRACKS):
        found = fitted(filmed(scene, phi0, np.random.default_rng(seed)), scene, phi0, other)
        truth = {"incline": scene.incline, "damping": 1.0}
        off = np.array([(found.values[name] - truth[name]) / found.errors[name] for name in ("incline", other)])
        squares.append(float(off @ np.linalg.solve(found.correlation[:2, :2], off)) / 2)
    return float(np.mean(squares)) - 1
