"""How far one motion is from another."""

import numpy as np


def farthest(angles: np.ndarray, truth: np.ndarray) -> float:
    """Largest distance of `angles` from `truth` [rad].

    Where that has come more than 1 rad from its start, the distance is relative to how far.
    """
    way = np.maximum.accumulate(np.abs(truth - truth[0]))
    return float(np.max(np.abs(angles - truth) / np.maximum(1, way)))
