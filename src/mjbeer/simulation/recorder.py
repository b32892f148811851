"""Keeps the record of a run from all of its steps, as they are taken."""

import math
from typing import Protocol

import mujoco
import numpy as np

from mjbeer.model.state import read
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

_PARTS = 8
"""Parts into which a step of mjbeer's own integrators is cut to find the lowest normal force: one of DOP853 may be half
a swing long."""


class Observer(Protocol):
    """What a method with large steps shows its steps to."""

    def add_smooth(self, times: np.ndarray, states: np.ndarray, slopes: np.ndarray) -> None:
        """Add the next steps: the times [s] at their ends, the states there, and their time derivatives."""


class Recorder:
    """The record of a run of one model of a scene."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf) -> None:
        """Begin the record of a run whose can would slip where rolling needs more than a coefficient `friction`."""
        self._model, self._scene = model, scene
        self.record = Record(scene, friction)
        self._last: np.ndarray | None = None
        size = model.nq + model.nv
        unit = read(model, scene, np.eye(size), np.zeros(size))
        self._rates = np.stack([unit.phi_dot, unit.u_dot] if scene.dissipates else [unit.phi_dot], axis=1)
        """The weights of a state's components in phi_dot and, where it matters to the forces, in u_dot."""

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
        moved = [(motion.phi, motion.phi_dot), (motion.u, motion.u_dot)][: self._rates.shape[1]]
        ends = np.stack(
            [
                times,
                *(
                    row
                    for (way, rate), bend in zip(moved, (slopes @ self._rates).T, strict=True)
                    for row in (way, rate, bend)
                ),
            ]
        )
        if self._last is not None:
            ends = np.concatenate([self._last, ends], axis=1)
        self._last = ends[:, -1:]
        time, phi, phi_dot, phi_ddot, *axis = ends
        u_dot = axis[1] if axis else 0.0
        if len(time) > 1:
            if axis:
                u_dot = _within(time, *axis)[2]
            time, phi, phi_dot = _within(time, phi, phi_dot, phi_ddot)
        self.record.add_forces(time, phi, phi_dot, u_dot)


def _hermite(part: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far a polynomial of fifth degree has come after parts of a step, and its derivative by the part.

    `ends` has its whole way, and its first and second derivatives at the start and then at the end.
    """
    way, rate, bend, last_rate, last_bend = ends
    # rate s + bend s^2 / 2 + c_3 s^3 + c_4 s^4 + c_5 s^5, with s from 0 to 1
    gap, rate_gap, bend_gap = way - rate - bend / 2, last_rate - rate - bend, last_bend - bend
    cubic = 10 * gap - 4 * rate_gap + bend_gap / 2
    quartic = -15 * gap + 7 * rate_gap - bend_gap
    quintic = 6 * gap - 3 * rate_gap + bend_gap / 2
    come = part * (rate + part * (bend / 2 + part * (cubic + part * (quartic + part * quintic))))
    return come, rate + part * (bend + part * (3 * cubic + part * (4 * quartic + part * 5 * quintic)))


_PART = np.arange(1, _PARTS + 1) / _PARTS
_COME, _SLOPE = (np.array(column).T for column in zip(*(_hermite(_PART, end) for end in np.eye(5)), strict=True))
"""The matrices of `_hermite` at the ends of the parts of a step, shape (`_PARTS`, 5)."""


def _within(
    time: np.ndarray, place: np.ndarray, speed: np.ndarray, acceleration: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times [s], a coordinate and its rate within steps, from its value and derivatives at the ends."""
    step = np.diff(time)
    rate, bend = np.stack([speed[:-1], speed[1:]]), np.stack([acceleration[:-1], acceleration[1:]])
    (rate, last_rate), (bend, last_bend) = step * rate, step**2 * bend
    ends = np.stack([np.diff(place), rate, bend, last_rate, last_bend], axis=1)
    step = step[:, None]
    times, within = time[:-1, None] + step * _PART, place[:-1, None] + ends @ _COME.T
    return times.ravel(), within.ravel(), (ends @ _SLOPE.T / step).ravel()
