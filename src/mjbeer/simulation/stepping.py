"""Steps a model with MuJoCo's own integrators, in compiled code, in one run or many at once."""

import mujoco
import numpy as np
from mujoco import rollout

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import quiet, untimed

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
_BLOCK = 100_000
"""Steps between two returns to Python, where a long run can be interrupted and all but its samples is discarded."""


class Stepper:
    """A model set up to be stepped in one thread or several."""

    def __init__(self, model: mujoco.MjModel, threads: int = 1) -> None:
        self._model, self._threads = model, threads
        self._data = [mujoco.MjData(model) for _ in range(threads)]

    def run(self, starts: np.ndarray, samples: np.ndarray) -> np.ndarray:
        """Return the states of several runs after given numbers of steps, shape (runs, samples, nq + nv).

        `starts` has shape (runs, nq + nv), and `samples` are increasing numbers of steps. A run depends neither on
        the other runs nor on the number of threads.

        Raises:
          DivergenceError: if a run stops being finite; the message names the time and MuJoCo's reason.
        """
        model, size = self._model, starts.shape[1]
        full = np.zeros((len(starts), mujoco.mj_stateSize(model, _STATE)))
        full[:, 1 : 1 + size] = starts
        states = np.empty((len(starts), len(samples), size))
        states[:, samples == 0] = starts[:, None]
        last = int(samples[-1])
        # Every block has a fresh warmstart, so that a run does not depend on what ran before on the same data.
        warmstart = np.zeros((len(starts), model.nv))
        with quiet(), untimed(), rollout.Rollout(nthread=self._threads if self._threads > 1 else 0) as pool:
            for first in range(0, last, _BLOCK):
                count = min(_BLOCK, last - first)
                block, _ = pool.rollout(model, self._data, full, nstep=count, initial_warmstart=warmstart)
                _check_finite(model, block, (first + count) * model.opt.timestep)
                full = block[:, -1].copy()
                in_block = (samples > first) & (samples <= first + count)
                states[:, in_block] = block[:, samples[in_block] - first - 1, 1 : 1 + size]
        return states


def step(model: mujoco.MjModel, starts: np.ndarray, samples: np.ndarray, threads: int = 1) -> np.ndarray:
    """Return the states of several runs of a model after given numbers of steps, as `Stepper.run` does."""
    return Stepper(model, threads).run(starts, samples)


def _check_finite(model: mujoco.MjModel, block: np.ndarray, end: float) -> None:
    """Check that every run of a block is finite and has reached the time `end` [s].

    If MuJoCo gives up a run, it fills the rest of the block with the last state, whose time is before `end`.

    Raises:
      DivergenceError: if a run has not; the message names the time and MuJoCo's reason.
    """
    for run in block:
        reached = run[-1, 0]
        if reached < end - model.opt.timestep / 2 or not np.isfinite(run).all():
            data = mujoco.MjData(model)
            mujoco.mj_setState(model, data, run[-1], _STATE)
            mujoco.mj_step(model, data)
            kinds = [kind for name, kind in mujoco.mjtWarning.__members__.items() if name != "mjNWARNING"]
            warnings = [mujoco.mju_warningText(kind, 0) for kind in kinds if data.warning[kind].number]
            cause = "; ".join(warnings) if warnings else "its state is no longer finite"
            raise DivergenceError(f"the run diverged at t = {reached:.6g} s: {cause}")
