"""Integrators around MuJoCo's forward dynamics, in compiled code: they know the model, and nothing of the theory."""

from collections.abc import Callable

import numpy as np

Observer = Callable[[np.ndarray, np.ndarray], None]
"""Is shown the steps of a run: the times [s] at their ends, and the states there, shape (steps, nq + nv)."""
