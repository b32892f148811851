"""MuJoCo's own integrators, stepping a model, and the record of all steps of a run, made while it is stepped."""

import math
from copy import copy
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco.rollout import rollout

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators import Observer
from mjbeer.model.joints import to_coordinates
from mjbeer.model.mujoco_library import LARGEST, quiet, untimed
from mjbeer.theory.equations import accelerations
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

_BLOCK = 4096
"""Steps between two returns to Python, where a long run can be interrupted. Their states fit into a processor's
cache."""
_STATE, _GUESSED = mujoco.mjtState.mjSTATE_FULLPHYSICS, mujoco.mjtState.mjSTATE_INTEGRATION
"""MuJoCo's state of a run, time, positions and rates first; and with it where the solver of constraints begins."""


@dataclass(frozen=True, eq=False)
class Solution:
    """The states of a run, and what it says of itself."""

    states: np.ndarray
    """States at the samples, shape (samples, nq + nv)."""
    record: Record | None = None
    """The extremes of all steps, if they were asked for."""
    error: float | None = None
    """Estimated error of phi and u/a [rad], relative beyond 1 rad; None if there was no second run."""
    integrator: str | None = None
    """The name of the integrator, if it was chosen for a tolerance."""


class Stepper:
    """A model set up to be stepped with its own timestep, which may be taken in several `parts`, whose sum is 1."""

    def __init__(self, model: mujoco.MjModel, parts: tuple[float, ...] = (), data: mujoco.MjData | None = None) -> None:
        self._timestep = model.opt.timestep
        self._models = [copy(model) for _ in parts] or [model]
        for changed, part in zip(self._models, parts, strict=bool(parts)):
            changed.opt.timestep = part * self._timestep
        self._data = mujoco.MjData(model) if data is None else data
        self._rows = np.empty((1, _BLOCK, mujoco.mj_stateSize(model, _STATE)))

    def run(self, start: np.ndarray, samples: np.ndarray, observer: Observer | None = None) -> np.ndarray:
        """Return the states after increasing numbers of steps, `samples`, as an array of shape (samples, nq + nv).

        Raises:
          DivergenceError: if the run stops being finite; the message names the time and MuJoCo's reason.
        """
        data, size, step = self._data, self._models[0].nq, self._timestep
        mujoco.mj_resetData(self._models[0], data)
        data.qpos[:], data.qvel[:] = start[:size], start[size:]
        states = np.empty((len(samples), len(start)))
        states[samples == 0] = start
        if observer:
            observer(np.zeros(1), start[None])
        last = int(samples[-1])
        before = np.empty(mujoco.mj_stateSize(self._models[0], _GUESSED))
        with quiet(), untimed():
            for first in range(0, last, _BLOCK):
                mujoco.mj_getState(self._models[0], data, before, _GUESSED)
                block = self._advance(min(_BLOCK, last - first))
                if _warnings(data) or not max(np.abs(block).max(), np.abs(data.qacc).max()) < LARGEST:
                    raise self._divergence(before, first, len(block))
                begin, after = np.searchsorted(samples, [first + 1, first + len(block) + 1])
                states[begin:after] = block[samples[begin:after] - first - 1]
                if observer:
                    observer(step * np.arange(first + 1, first + len(block) + 1), block)
        return states

    def _advance(self, count: int) -> np.ndarray:
        """Take so many steps, and return the states at their ends, which the next call overwrites.

        What follows a warning of MuJoCo's is no motion.
        """
        data, rows = self._data, self._rows[:, :count]
        states, size = rows[0, :, 1 : 1 + len(data.qpos) + len(data.qvel)], len(data.qpos)
        if len(self._models) == 1:
            state, guess = np.empty((1, rows.shape[2])), data.qacc_warmstart[None]
            mujoco.mj_getState(self._models[0], data, state[0], _STATE)
            rollout(self._models, data, state, nstep=count, initial_warmstart=guess, state=rows, skip_checks=True)
            return states
        qpos, qvel, places, rates = data.qpos, data.qvel, states[:, :size], states[:, size:]
        for row in range(count):
            for model in self._models:
                mujoco.mj_step(model, data)
            places[row], rates[row] = qpos, qvel
        return states

    def _divergence(self, before: np.ndarray, first: int, count: int) -> DivergenceError:
        """Take `count` steps again, after the `first` ones and from the state `before` them, and say what is wrong."""
        data, step = self._data, self._timestep
        mujoco.mj_resetData(self._models[0], data)
        mujoco.mj_setState(self._models[0], data, before, _GUESSED)
        for row in range(first, first + count):
            for model in self._models:
                mujoco.mj_step(model, data)
            if not all(abs(number) < LARGEST for number in (*data.qpos, *data.qvel, *data.qacc)):
                cause = _warnings(data) or "its state is no longer finite"
                return DivergenceError(f"the run diverged at t = {row * step:.6g} s: {cause}")
        # As of an inertia that rounding loses: what follows is finite, and may be anything.
        return DivergenceError(f"the run diverged before t = {(first + count) * step:.6g} s: {_warnings(data)}")


def _warnings(data: mujoco.MjData) -> str:
    """Return what MuJoCo warns of in a run; empty if it does not."""
    return "; ".join(mujoco.mju_warningText(kind, 0) for kind in np.flatnonzero(data.warning.number))


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
        if not self._within:
            self.record.add(motion)
            return
        self.record.add_conserved(motion)
        rates = motion.phi_dot, motion.u_dot
        gains = accelerations(self._scene, motion.phi, *rates)[::-1]
        ends = np.concatenate([self._last, np.stack([times, motion.phi, motion.u, *rates, *gains])], axis=1)
        self._last = ends[:, -1:]
        self.record.add_forces(*_between(ends[0], *ends[1:].reshape(3, 2, -1)))


# A polynomial of fifth degree over a step, from its change, rates and second derivatives at both ends, at parts of it.
_PART = np.arange(1, 9)[:, None] / 8  # a step of DOP853 may be half a swing long
_ENDS = np.array([[1, 1, 1, 1, 1], [1, 0, 0, 0, 0], [0, 2, 0, 0, 0], [1, 2, 3, 4, 5], [0, 2, 6, 12, 20]])
_POWER, _TERMS = np.arange(1, 6), np.linalg.inv(_ENDS)
_CHANGES, _RATES = _PART**_POWER @ _TERMS, _POWER * _PART ** (_POWER - 1) @ _TERMS


def _between(time: np.ndarray, place: np.ndarray, rate: np.ndarray, gain: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return times [s], phi, phi_dot and u_dot within steps, from both coordinates and their derivatives at the ends.

    These have shape (2, ends); a single end is returned as it is.
    """
    if len(time) == 1:
        return time, place[0], *rate
    step = np.diff(time)
    first, bend = step * rate[:, :-1], step**2 * gain[:, :-1]
    last, bent = step * rate[:, 1:], step**2 * gain[:, 1:]
    ends, step = np.stack([np.diff(place), first, bend, last, bent], axis=-1), step[:, None]
    phi, (phi_dot, u_dot) = place[0, :-1, None] + ends[0] @ _CHANGES.T, ends @ _RATES.T / step
    return tuple(each.ravel() for each in (time[:-1, None] + step * _PART.T, phi, phi_dot, u_dot))
