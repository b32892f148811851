"""Eighth-order integration of a model, set up once and run often."""

import copy
import math

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import address, quiet, untimed
from mjbeer.model.state import places
from mjbeer.simulation import dop853_kernel

_CONSTRAINT = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_ACTUATION = int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
_EVERYTHING = ("mj_forward",)
_SMOOTH = ("mj_fwdKinematics", "mj_makeM", "mj_factorM", "mj_fwdVelocity", "mj_fwdAcceleration")
"""What mj_forward calls to find the acceleration where nothing is constrained or actuated: the same to the last bit,
in three quarters of the time."""


class Integrator:
    """The DOP853 method around the forward dynamics of one model."""

    def __init__(self, model: mujoco.MjModel) -> None:
        if model.nq != model.nv:
            raise ValueError("only slide and hinge joints can be integrated component by component")
        self._size = model.nq + model.nv
        self._model, self._data = _with_constant_forces(model)
        smooth = bool(self._model.opt.disableflags & _CONSTRAINT) and not _acts(self._model)
        functions = np.array([address(each) for each in (_SMOOTH if smooth else _EVERYTHING)])
        self._pointers = (functions, self._model._address, self._data._address)
        acceleration = self._data.qacc_smooth if smooth else self._data.qacc
        self._views = (self._data.qpos, self._data.qvel, acceleration, _matters(self._model, smooth))
        self.evaluations = 0
        """Evaluations of the forward dynamics that the last run took."""

    def run(
        self,
        start: np.ndarray,
        times: np.ndarray,
        timestep: float | None = None,
        tolerance: float = 1e-10,
        scale: np.ndarray | None = None,
        limit: float = math.inf,
    ) -> np.ndarray:
        """States at the increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        A `timestep` [s] fixes the step. Otherwise each step keeps its local error below `tolerance` times
        (`scale` + |state|), with `scale` of shape (nq + nv,). More than `limit` evaluations are given up.

        Raises:
          DivergenceError: if the motion stops being finite, the step vanishes, or the limit is reached.
        """
        state, samples = start.copy(), np.empty((len(times), self._size))
        slopes = np.zeros((dop853_kernel.ROWS, self._size))
        scale = np.ones(self._size) if scale is None else scale
        place = (0.0, timestep or 0.0, 0, 0, 1.0)
        self.evaluations, status = 0, dop853_kernel.BLOCK_END
        with quiet(), untimed():
            while status == dop853_kernel.BLOCK_END:
                status, place, spent = dop853_kernel.advance(
                    self._pointers, self._views, state, slopes, times, samples, place,
                    timestep is not None, tolerance, scale,
                )  # fmt: skip
                self.evaluations += spent
                if status == dop853_kernel.BLOCK_END and self.evaluations > limit:
                    raise DivergenceError(
                        f"the DOP853 run was given up at t = {place[0]:.6g} s after {self.evaluations} evaluations"
                    )
        if status != dop853_kernel.DONE:
            not_finite = status == dop853_kernel.NOT_FINITE
            cause = "its state is no longer finite" if not_finite else "no step is small enough for it"
            raise DivergenceError(f"the DOP853 run diverged at t = {place[0]:.6g} s: {cause}")
        return samples


def integrate(model: mujoco.MjModel, start: np.ndarray, times: np.ndarray, timestep: float) -> np.ndarray:
    """States at the increasing `times` [s] of one run with a fixed `timestep` [s], as `Integrator.run`."""
    return Integrator(model).run(start, times, timestep)


def _matters(model: mujoco.MjModel, smooth: bool) -> np.ndarray:
    """Which components of qpos an acceleration depends on: all but the slide, where nothing ties it to the others.

    Evaluations are made at the origin of the slide then. MuJoCo computes torques from positions in the world, in whose
    rounding a short arm is lost after a long way.
    """
    matters = np.ones(model.nq, np.bool_)
    if smooth and "slide" in (joints := places(model)):
        matters[joints["slide"]] = False
    return matters


def _acts(model: mujoco.MjModel) -> bool:
    return model.nu > 0 and not model.opt.disableflags & _ACTUATION


def _with_constant_forces(model: mujoco.MjModel) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A model and its data; forces of actuators that depend on nothing are applied once and for all.

    An actuator takes a tenth of an evaluation of the frozen load's reduced model.
    """
    if not _acts(model) or model.na or model.actuator_gainprm.any() or model.actuator_biasprm[:, 1:].any():
        return model, mujoco.MjData(model)
    free = copy.copy(model)
    free.opt.disableflags |= _ACTUATION
    once, data = mujoco.MjData(model), mujoco.MjData(free)
    mujoco.mj_forward(model, once)
    data.qfrc_applied[:] = once.qfrc_actuator
    return free, data
