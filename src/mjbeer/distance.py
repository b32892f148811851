"""How far one motion is from another."""

import numpy as np


def farthest(angles: np.ndarray, truth: np.ndarray) -> float:
    """Largest distance of `angles` from `truth` [rad], relative to how far that has come from its start if over 1 rad."""
    way = np.maximum.accumulate(np.abs(truth - truth[0]))
    return float(np.max(np.abs(angles - truth) / np.maximum(1, way)))
