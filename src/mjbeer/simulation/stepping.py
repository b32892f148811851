"""Steps a model with MuJoCo's own integrators, in compiled code."""

import copy

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import address, quiet, untimed
from mjbeer.simulation.compiling import told
from mjbeer.simulation.recorder import Recorder
from mjbeer.simulation.stepping_kernel import advance

_BLOCK = 4096
"""Steps between two returns to Python, where a long run can be interrupted. Their states fit into a processor's
cache."""


class Stepper:
    """A model set up to be stepped with its own timestep, which may be taken in several `parts`, whose sum is 1.

    Without `data` of the model it makes its own.
    """

    def __init__(self, model: mujoco.MjModel, parts: tuple[float, ...] = (), data: mujoco.MjData | None = None) -> None:
        self._timestep = model.opt.timestep
        self._models = [copy.copy(model) for _ in parts] or [model]
        for changed, part in zip(self._models, parts, strict=bool(parts)):
            changed.opt.timestep = part * self._timestep
        self._data = mujoco.MjData(model) if data is None else data
        self._addresses = np.array([changed._address for changed in self._models])
        self._views = self._data.qpos, self._data.qvel, self._data.qacc
        self._states = np.empty((_BLOCK, model.nq + model.nv))

    def run(self, start: np.ndarray, samples: np.ndarray, recorder: Recorder | None = None) -> np.ndarray:
        """Return the states after given numbers of steps, shape (samples, nq + nv).

        `start` has shape (nq + nv,), and `samples` are increasing numbers of steps. A `recorder` is shown all steps.

        Raises:
          DivergenceError: if the run stops being finite; the message names the time and MuJoCo's reason.
        """
        data, size = self._data, self._models[0].nq
        mujoco.mj_resetData(self._models[0], data)
        data.qpos[:], data.qvel[:] = start[:size], start[size:]
        states = np.empty((len(samples), len(start)))
        states[samples == 0] = start
        if recorder:
            recorder.add(np.zeros(1), start[None])
        last = int(samples[-1])
        with told(advance), quiet(), untimed():
            for first in range(0, last, _BLOCK):
                block = self._states[: min(_BLOCK, last - first)]
                count = advance(address("mj_step"), self._addresses, data._address, self._views, block)
                end, cause = (first + count) * self._timestep, _warnings(data)
                if count < len(block):
                    raise DivergenceError(
                        f"the run diverged at t = {end:.6g} s: {cause or 'its state is no longer finite'}"
                    )
                if cause:  # as of an inertia that rounding loses: what follows is finite, and may be anything
                    raise DivergenceError(f"the run diverged before t = {end:.6g} s: {cause}")
                begin, after = np.searchsorted(samples, [first + 1, first + len(block) + 1])
                states[begin:after] = block[samples[begin:after] - first - 1]
                if recorder:
                    recorder.add(self._timestep * np.arange(first + 1, first + len(block) + 1), block)
        return states


def _warnings(data: mujoco.MjData) -> str:
    """Return what MuJoCo warns of in a run; empty if it does not."""
    kinds = [kind for name, kind in mujoco.mjtWarning.__members__.items() if name != "mjNWARNING"]
    return "; ".join(mujoco.mju_warningText(kind, 0) for kind in kinds if data.warning[kind].number)
