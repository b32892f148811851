"""The record of all steps of a run, made while a model is stepped."""

import math
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.model.joints import to_coordinates
from mjbeer.theory.equations import Coordinates, accelerations
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene


class Solution(NamedTuple):
    """The states of a run, and what it says of itself."""

    states: np.ndarray  # at the samples, shape (samples, nq + nv)
    record: Record | None  # the extremes of all steps, if they were asked for
    error: float | None  # estimate for phi and u/a [rad], relative beyond 1 rad; None if there was no second run
    integrator: str  # its name


class Recorder:
    """The record of a run of one model of a scene, an `Observer`.

    The steps of DOP853 are so long that forces are looked for `within` them, too.
    """

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf, within: bool = False) -> None:
        self._model, self._scene, self._within, self.record = model, scene, within, Record(scene, friction)
        self._last = np.empty((7, 0))

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        motion = to_coordinates(self._model, self._scene, states, times)
        if self._within:
            self.record.add_conserved(motion)
            self.add_forces(motion)
        else:
            self.record.add(motion)

    def add_forces(self, motion: Coordinates) -> None:
        """Add the forces within the next steps."""
        rates = motion.phi_dot, motion.u_dot
        gains = accelerations(self._scene, motion.phi, *rates)[::-1]
        ends = np.concatenate([self._last, np.stack([motion.time, motion.phi, motion.u, *rates, *gains])], axis=1)
        if self._last.shape[1] == 0:
            start = Coordinates(**{name: array[:1] for name, array in vars(motion).items()})
            self.record.add_forces(start.time, start.phi, start.phi_dot, start.u_dot)
        self._last = ends[:, -1:]
        if len(ends[0]) > 1:
            self.record.add_forces(*_between(ends[0], *ends[1:].reshape(3, 2, -1)))


_PARTS = 32
"""Points in a step at which forces are looked for. A step of DOP853 may be half a swing long, in which N varies by its
own size; between two of the points its extreme is then a thousandth of that beyond the larger one, (pi/64)^2/2."""
_PART = np.arange(1, _PARTS + 1)[:, None] / _PARTS
_POWER = np.arange(1, 6)
_ENDS = [[1, 1, 1, 1, 1], [1, 0, 0, 0, 0], [0, 2, 0, 0, 0], [1, 2, 3, 4, 5], [0, 2, 6, 12, 20]]
_CHANGES, _RATES = (each @ np.linalg.inv(_ENDS) for each in (_PART**_POWER, _POWER * _PART ** (_POWER - 1)))
"""What gives change and rate at `_PART` of a step, by the polynomial of fifth degree that has the change of the step,
and the rates and the second derivatives at its ends."""


def _between(time: np.ndarray, place: np.ndarray, rate: np.ndarray, gain: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return times [s], phi, phi_dot and u_dot within steps, and at their ends but the first.

    Both coordinates and their derivatives at the ends have shape (2, ends).
    """
    step = np.diff(time)
    first, bend = step * rate[:, :-1], step**2 * gain[:, :-1]
    last, bent = step * rate[:, 1:], step**2 * gain[:, 1:]
    ends, step = np.stack([np.diff(place), first, bend, last, bent], axis=-1), step[:, None]
    phi, (phi_dot, u_dot) = place[0, :-1, None] + ends[0] @ _CHANGES.T, ends @ _RATES.T / step
    return tuple(each.ravel() for each in (time[:-1, None] + step * _PART.T, phi, phi_dot, u_dot))
