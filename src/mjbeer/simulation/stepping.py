"""Stepping a model with MuJoCo's own integrators, in compiled code, one run or many at once."""

import mujoco
import numpy as np
from mujoco import rollout

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import quiet, untimed

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
_BLOCK = 100_000
"""Steps between two returns to Python, so that a long run can be interrupted and only its samples are kept."""


class Stepper:
    """A model set up to be stepped, in one thread or several."""

    def __init__(self, model: mujoco.MjModel, threads: int = 1) -> None:
        self._model, self._threads = model, threads
        self._data = [mujoco.MjData(model) for _ in range(threads)]

    def run(self, starts: np.ndarray, samples: np.ndarray) -> np.ndarray:
        """States of several runs after given numbers of steps, shape (runs, samples, nq + nv).

        `starts` has shape (runs, nq + nv), `samples` are increasing numbers of steps. Runs depend neither on
        each other nor on the number of threads.

        Raises:
          DivergenceError: if a run stops being finite; the message has the time and MuJoCo's reason.
        """
        model, size = self._model, starts.shape[1]
        full = np.zeros((len(starts), mujoco.mj_stateSize(model, _STATE)))
        full[:, 1 : 1 + size] = starts
        states = np.empty((len(starts), len(samples), size))
        states[:, samples == 0] = starts[:, None]
        last = int(samples[-1])
        # A fresh warmstart for every block, whatever ran before on the same data: runs repeat to the bit.
        warmstart = np.zeros((len(starts), model.nv))
        with quiet(), untimed(), rollout.Rollout(nthread=self._threads if self._threads > 1 else 0) as pool:
            for done in range(0, last, _BLOCK):
                count = min(_BLOCK, last - done)
                block, _ = pool.rollout(model, self._data, full, nstep=count, initial_warmstart=warmstart)
                _check(model, block, (done + count) * model.opt.timestep)
                full = block[:, -1].copy()
                wanted = (samples > done) & (samples <= done + count)
                states[:, wanted] = block[:, samples[wanted] - done - 1, 1 : 1 + size]
        return states


def step(model: mujoco.MjModel, starts: np.ndarray, samples: np.ndarray, threads: int = 1) -> np.ndarray:
    """States of several runs of a model after given numbers of steps, as `Stepper.run`."""
    return Stepper(model, threads).run(starts, samples)


def _check(model: mujoco.MjModel, block: np.ndarray, end: float) -> None:
    """MuJoCo repeats the last state of a run that it gives up."""
    for run in block:
        reached = run[-1, 0]
        if reached < end - model.opt.timestep / 2 or not np.isfinite(run).all():
            data = mujoco.MjData(model)
            mujoco.mj_setState(model, data, run[-1], _STATE)
            mujoco.mj_step(model, data)
            kinds = [each for name, each in mujoco.mjtWarning.__members__.items() if name != "mjNWARNING"]
            seen = [mujoco.mju_warningText(each, 0) for each in kinds if data.warning[each].number]
            cause = "; ".join(seen) if seen else "its state is no longer finite"
            raise DivergenceError(f"the run diverged at t = {reached:.6g} s: {cause}")
