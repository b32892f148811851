"""The integrator DOP853: an eighth-order Runge-Kutta method around MuJoCo's forward dynamics."""

import math
from typing import Any

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import address
from mjbeer.model.setting import DOP853
from mjbeer.model.state import places
from mjbeer.simulation import dop853_kernel
from mjbeer.simulation.dop853_kernel import BLOCK_END, DONE, NOT_FINITE
from mjbeer.simulation.stepping import Watcher, stepping

_CONSTRAINT = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_ACTUATION = int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
_SMOOTH = ("mj_fwdKinematics", "mj_makeM", "mj_factorM", "mj_fwdVelocity", "mj_fwdAcceleration")
"""What mj_forward does for a model without constraints, whose actuators have constant forces that are computed once:
the same numbers to the last bit, in three quarters of the time."""


class Integrator:
    """The DOP853 method around the forward dynamics of one model, set up once and run often.

    Without `data` of the model, in its initial state, it makes its own.

    Raises:
      ValueError: if the model has joints other than slides and hinges.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData | None = None) -> None:
        if model.nq != model.nv:
            raise ValueError("only slide and hinge joints can be integrated component by component")
        self._size = model.nq + model.nv
        self._model, self._data = model, mujoco.MjData(model) if data is None else data
        actuated = model.nu > 0 and not model.opt.disableflags & _ACTUATION
        constant = not (model.na or model.actuator_gainprm.any() or model.actuator_biasprm[:, 1:].any())
        smooth = bool(model.opt.disableflags & _CONSTRAINT) and (not actuated or constant)
        needed = np.ones(model.nq, np.bool_)
        if smooth:
            if actuated:  # their forces at the start, which _SMOOTH takes unchanged
                mujoco.mj_forward(model, self._data)
                forces = self._data.qfrc_actuator.copy()
                mujoco.mj_resetData(model, self._data)
                self._data.qfrc_actuator[:] = forces
            if "slide" in (joints := places(model)):
                # The acceleration does not depend on the slide, and is evaluated at its origin: MuJoCo computes torques
                # from positions in the world, whose rounding would hide a short arm far from the origin.
                needed[joints["slide"]] = False
        functions = np.array([address(name) for name in (_SMOOTH if smooth else ("mj_forward",))])
        acceleration = self._data.qacc_smooth if smooth else self._data.qacc
        self.dynamics = (
            (functions, model._address, self._data._address),
            (self._data.qpos, self._data.qvel, acceleration, needed),
        )
        """Addresses and views by which the kernels evaluate the accelerations."""
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float | None = None,
        tolerance: float = 1e-10,
        scale: np.ndarray | None = None,
        limit: float = math.inf,
        watch: Watcher | None = None,
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        With a `timestep` [s] the step is fixed. Without it each step keeps its local error below `tolerance` times
        (`scale` + |state|), with `scale` of shape (nq + nv,). The run is given up after `limit` evaluations.

        Raises:
          DivergenceError: if the motion stops being finite, no step is small enough, or the limit is reached.
        """
        state, samples = start.copy(), np.empty((len(times), self._size))
        slopes = np.zeros((dop853_kernel.ROWS, self._size))
        scale = np.ones(self._size) if scale is None else scale
        rows, place = dop853_kernel.KEPT if watch else 0, (0.0, timestep or 0.0, 0, 0, 1.0)
        kept = np.empty(rows), np.empty((rows, self._size))
        fixed = *self.dynamics, state, slopes, times, samples, timestep is not None, tolerance, scale, kept
        self.evaluations = drive(DOP853, dop853_kernel.advance, fixed, place, limit, watch)
        return samples


def drive(name: str, kernel: Any, fixed: tuple[Any, ...], place: tuple, limit: float, watch: Watcher | None) -> int:
    """Call the compiled `kernel` of a method, a block of steps each, until a run is done; return its evaluations.

    It takes `fixed` arguments, the last of which has room for what is shown to `watch`, and a `place`, which begins
    with the time [s]. It returns the status, the new place, and the numbers of evaluations and of kept rows.

    Raises:
      DivergenceError: if the motion stops being finite, no step is small enough, or there are `limit` evaluations.
    """
    status, total = BLOCK_END, 0
    with stepping(kernel):
        while status == BLOCK_END:
            if total > limit:
                raise DivergenceError(f"the {name} run was given up at t = {place[0]:.6g} s after {total} evaluations")
            status, place, evaluations, count = kernel(*fixed, place)
            total += evaluations
            if watch and count:
                watch(*(rows[:count] for rows in fixed[-1]))
    if status != DONE:
        cause = "its state is no longer finite" if status == NOT_FINITE else "no step is small enough for it"
        raise DivergenceError(f"the {name} run diverged at t = {place[0]:.6g} s: {cause}")
    return total


def integrate(model: mujoco.MjModel, start: np.ndarray, times: np.ndarray, timestep: float) -> np.ndarray:
    """Return the states at increasing `times` [s] of one run with a fixed `timestep` [s], as `Integrator.run` does."""
    return Integrator(model).run(start, times, timestep)
