"""Methods that move a MuJoCo model. They know nothing of the theory that judges them."""

from typing import Protocol

import numpy as np


class Observer(Protocol):
    """Is shown the ends of all steps of a run, in order and in pieces; the start comes first."""

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Take the next times [s], shape (steps,), and the states then, shape (steps, nq + nv)."""


class Method(Protocol):
    """A way to integrate a model's motion, with everything set but the start and the samples."""

    name: str
    """The name of the method, as in `simulate(integrator=...)`."""

    def run(
        self, start: np.ndarray, times: np.ndarray, observer: Observer | None = None
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv).

        The motion begins at time 0 with the state `start`, shape (nq + nv,).

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        ...
