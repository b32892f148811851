"""MuJoCo's own integrators, stepped in blocks through `mujoco.rollout`."""

from collections.abc import Generator, Sequence
from copy import copy

import mujoco
import numpy as np
from mujoco.rollout import rollout

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators import Observer
from mjbeer.model.mujoco_library import MAX_STATE, quiet

_BLOCK = 4096
"""Steps between two returns to Python, where a run can be interrupted: their states fit into a
processor's cache."""
_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
"""MuJoCo's state of a run: the time first, then positions and rates."""


class MuJoCoSteps:
    """The integrator that a model names, with fixed timesteps.

    A step is one timestep, or several unequal `timesteps` [s] one after the other. There are
    samples at the ends of steps only: `run` returns the states at those that are nearest to the
    times asked for.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, timesteps: Sequence[float], name: str
    ) -> None:
        self.name = name
        self._data = data
        self._models = [_with_timestep(model, timestep) for timestep in timesteps]
        self._step = sum(timesteps)

    def run(
        self, start: np.ndarray, times: np.ndarray, observer: Observer | None = None
    ) -> np.ndarray:
        """Return the states after the steps that end nearest to `times` [s].

        The shape is (samples, nq + nv).

        Raises:
          DivergenceError: if the motion stops being finite; the message has the time and MuJoCo's
            reason.
        """
        wanted = np.rint(times / self._step).astype(np.int64)  # steps after which there is a sample
        samples = np.empty((len(times), len(start)))
        samples[wanted == 0] = start
        if observer:
            observer(np.zeros(1), start[None])
        done = 0
        for states in self._blocks(start, int(wanted[-1])):
            after = done + len(states)
            first, end = np.searchsorted(wanted, [done + 1, after + 1])
            # the samples that lie in this block
            samples[first:end] = states[wanted[first:end] - (done + 1)]
            if observer:
                observer(self._step * np.arange(done + 1, after + 1), states)
            done = after
        return samples

    def _blocks(self, start: np.ndarray, count: int) -> Generator[np.ndarray]:
        """Yield the states at the ends of `count` steps in blocks, shape (steps, nq + nv).

        The next block overwrites the one before.
        """
        model = self._models[0]
        data = self._data
        rows = np.empty((_BLOCK, mujoco.mj_stateSize(model, _STATE)))
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = np.split(start, [model.nq])
        for done in range(0, count, _BLOCK):
            block = rows[: min(_BLOCK, count - done)]
            states = block[:, 1 : 1 + len(start)]
            with quiet():
                if len(self._models) == 1:
                    _roll_out(model, data, block)
                else:
                    self._take_unequal(states)
            self._check(states, done)
            yield states

    def _take_unequal(self, states: np.ndarray) -> None:
        """Take a step of several timesteps for each row of `states`, and write its end there."""
        data = self._data
        for state in states:
            for model in self._models:
                mujoco.mj_step(model, data)
            state[: data.qpos.size] = data.qpos
            state[data.qpos.size :] = data.qvel

    def _check(self, states: np.ndarray, done: int) -> None:
        """Raise a `DivergenceError` if the states of a block after `done` steps are not finite."""
        data = self._data
        causes = [mujoco.mju_warningText(kind, 0) for kind in np.flatnonzero(data.warning.number)]
        largest = max(np.abs(states).max(), np.abs(data.qacc).max())
        if not causes and largest < MAX_STATE:  # false for NaN, too
            return
        finite = (np.abs(states) < MAX_STATE).all(axis=1)
        steps = len(states) if finite.all() else int(finite.argmin())
        cause = "; ".join(causes) or "its state is no longer finite"
        time = (done + steps) * self._step
        raise DivergenceError(f"the run diverged at t = {time:.6g} s: {cause}")


def _with_timestep(model: mujoco.MjModel, timestep: float) -> mujoco.MjModel:
    """Return the model if it has this timestep [s], else a copy of it that has."""
    if model.opt.timestep != timestep:
        model = copy(model)
        model.opt.timestep = timestep
    return model


def _roll_out(model: mujoco.MjModel, data: mujoco.MjData, block: np.ndarray) -> None:
    """Take a step for each row of `block` in compiled code, and write MuJoCo's state there."""
    state = np.empty((1, block.shape[1]))
    mujoco.mj_getState(model, data, state[0], _STATE)
    rollout(
        [model],
        data,
        state,
        nstep=len(block),
        initial_warmstart=data.qacc_warmstart[None],
        state=block[None],
        skip_checks=True,
    )
