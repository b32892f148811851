"""Keeps the record of a run from all of its steps, as they are taken."""

import math

import mujoco
import numpy as np

from mjbeer.model.state import read
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

_PARTS = 8
"""Parts into which a step of DOP853, which may be half a swing long, is cut to find the lowest normal force."""


class Recorder:
    """The record of a run of one model of a scene."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf) -> None:
        """Begin the record of a run whose can would slip where rolling needs more than a coefficient `friction`."""
        self._model, self._scene = model, scene
        self.record = Record(scene, friction)
        self._last: np.ndarray | None = None

    def add(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps: the times [s] and states, shape (steps, nq + nv), at their ends."""
        self.record.add(read(self._model, self._scene, states, times))

    def add_smooth(self, times: np.ndarray, states: np.ndarray, slopes: np.ndarray) -> None:
        """Add the next steps of a method with large steps, with the time derivatives of the states.

        The normal force is looked for within the steps too, on the polynomials of fifth degree that have the angles,
        rates and accelerations at both ends of each step.
        """
        motion = read(self._model, self._scene, states, times)
        self.record.add_conserved(motion)
        accelerations = read(self._model, self._scene, slopes, times).phi_dot
        ends = np.stack([times, motion.phi, motion.phi_dot, accelerations])
        if self._last is not None:
            ends = np.concatenate([self._last, ends], axis=1)
        self._last = ends[:, -1:]
        if ends.shape[1] == 1:
            self.record.add_forces(ends[0], ends[1], ends[2])
        else:
            self.record.add_forces(*_within(*ends))


def _within(
    time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray, phi_ddot: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times [s], phi [rad] and phi_dot [rad/s] within steps, from their values and derivatives at the ends."""
    part = np.arange(1, _PARTS + 1) / _PARTS
    step = np.diff(time)[:, None]
    # phi = phi_0 + h phi_dot_0 s + h^2 phi_ddot_0 s^2 / 2 + c_3 s^3 + c_4 s^4 + c_5 s^5, with s from 0 to 1
    rate, bend = step * phi_dot[:-1, None], step**2 * phi_ddot[:-1, None]
    gap = phi[1:, None] - phi[:-1, None] - rate - bend / 2
    rate_gap = step * phi_dot[1:, None] - rate - bend
    bend_gap = step**2 * phi_ddot[1:, None] - bend
    cubic = 10 * gap - 4 * rate_gap + bend_gap / 2
    quartic = -15 * gap + 7 * rate_gap - bend_gap
    quintic = 6 * gap - 3 * rate_gap + bend_gap / 2
    angle = phi[:-1, None] + part * (rate + part * (bend / 2 + part * (cubic + part * (quartic + part * quintic))))
    slope = rate + part * (bend + part * (3 * cubic + part * (4 * quartic + part * 5 * quintic)))
    times = time[:-1, None] + part * step
    return times.ravel(), angle.ravel(), (slope / step).ravel()
