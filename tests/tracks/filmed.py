"""Tracks of cans that roll as exact theory says, for the tests of this folder."""

import numpy as np

from mjbeer import Scene, Track, exact

# When a can is let go [s], and where [m].
RELEASED = 17.4
PLACE = 0.1


def filmed(
    scene: Scene,
    phi0: float | None = None,
    noise: float = 1e-3,
    seed: int = 0,
    seconds: float = 3.0,
) -> Track:
    """The track of a can from 17 s on, with a gap; it is let go with a level surface."""
    start = -scene.incline if phi0 is None else phi0
    time = np.arange(round(60 * seconds)) / 60
    since = time - (RELEASED - 17)
    rolls = since > 0
    distance = np.zeros(len(time))
    distance[rolls] = exact(scene, since[rolls], start).distance
    kept = (time < 1.5) | (time > 1.7)
    errors = noise * np.random.default_rng(seed).standard_normal(kept.sum())
    return Track(17 + time[kept], PLACE + distance[kept] + errors)
