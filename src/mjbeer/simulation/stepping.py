"""What all steppers share, and the one that steps a model with MuJoCo's own integrators, in compiled code."""

import ctypes
from collections.abc import Callable, Generator
from contextlib import contextmanager, nullcontext
from copy import copy as copy_model
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import event
from numba.extending import intrinsic

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import address, quiet, untimed
from mjbeer.model.state import places
from mjbeer.theory.record import Record

DONE, BLOCK_END, TOO_SMALL, NOT_FINITE = range(4)
"""The statuses with which a kernel can end."""
LARGEST = 1e10
"""Largest state that MuJoCo does not call diverged (mjMAXVAL)."""
Watcher = Callable[[np.ndarray, np.ndarray], None]
"""What a stepper shows its steps to: the times [s] at their ends, and the states there, shape (steps, nq + nv)."""
_BLOCK = 4096
"""Steps between two returns to Python, where a long run can be interrupted. Their states fit into a processor's
cache."""
_CONSTRAINT = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_ACTUATION, _DAMPER = int(mujoco.mjtDisableBit.mjDSBL_ACTUATION), int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
_SMOOTH = ("mj_fwdKinematics", "mj_makeM", "mj_factorM", "mj_fwdVelocity", "mj_fwdAcceleration")
"""What mj_forward does for a model without constraints, whose actuators have constant forces that are computed once:
the same numbers to the last bit, in three quarters of the time."""
_WITHOUT_PASSIVE = (
    "mj_kinematics", "mj_comPos", "mj_tendon", "mj_crb", "mj_tendonArmature", "mj_factorM", "mj_comVel", "mj_rne",
    "mj_tendonBias", "mj_fwdAcceleration",
)  # fmt: skip
"""What that leaves of these in a model that has no damping either: another quarter less. Without tendons, those of the
tendons are left out, too."""
_COMPILING = "mjbeer: compiling this integrator for this machine, once: up to 4 s"


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


class _Compiling(event.Listener):
    """Says once, if somebody may see it, that numba compiles; what is read from its cache is not compiled."""

    said = False

    def on_start(self, _: Any) -> None:
        from mjbeer.output import terminal

        if not _Compiling.said and terminal.is_seen():
            _Compiling.said = True
            terminal.say(_COMPILING)

    def on_end(self, _: Any) -> None: ...


@contextmanager
def stepping(kernel: Any) -> Generator[None]:
    """Let a compiled `kernel` step in the block: MuJoCo is quiet and reads no clock."""
    heard = nullcontext() if kernel.overloads else event.install_listener("numba:compile", _Compiling())
    with quiet(), untimed(), heard:
        yield


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


@intrinsic
def call(typing_context, function, model, data, flag, result):
    """Call the C function at the address `function`; no address is compiled in, so that caching works.

    It gets two pointers, a number and a third pointer. A function that takes fewer does not look at the others: those
    that MuJoCo is built for pass them in registers.
    """

    def generate(context, builder, signature, arguments):
        pointer = ir.IntType(8 * ctypes.sizeof(ctypes.c_void_p))
        function_type = ir.FunctionType(ir.VoidType(), [pointer] * 4)
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp, types.intp, types.intp), generate


class Dynamics:
    """The forward dynamics of a model of slides and hinges, as kernels evaluate it.

    Without `data` of the model, in its initial state, it makes its own.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData | None = None) -> None:
        self._model, self.data = model, mujoco.MjData(model) if data is None else data
        data, self._actuated = self.data, model.nu > 0 and not model.opt.disableflags & _ACTUATION
        constant = not (model.na or model.actuator_gainprm.any() or model.actuator_biasprm[:, 1:].any())
        smooth = bool(model.opt.disableflags & _CONSTRAINT) and (not self._actuated or constant)
        needed, names = np.ones(model.nq, np.bool_), ("mj_forward",)
        if smooth:
            names = _WITHOUT_PASSIVE if model.opt.disableflags & _DAMPER else _SMOOTH
            names = tuple(name for name in names if model.ntendon or "endon" not in name)
            if "slide" in (joints := places(model)):
                # The acceleration does not depend on the slide, and is evaluated at its origin: MuJoCo computes torques
                # from positions in the world, whose rounding would hide a short arm far from the origin.
                needed[joints["slide"]] = False
        bias = data.qfrc_bias.__array_interface__["data"][0]
        functions = np.array([(address(name), bias if name == "mj_tendonBias" else 0) for name in names])
        views = data.qpos, data.qvel, data.qacc_smooth if smooth else data.qacc, needed
        self.kernel = (functions, model._address, data._address, bias), views
        """Addresses and views by which kernels evaluate the accelerations, as `slope` takes them."""
        self.begin()

    def begin(self) -> None:
        """Compute the actuators' forces of a model that has changed, which a smooth one then takes unchanged."""
        if self._actuated and len(self.kernel[0][0]) > 1:
            mujoco.mj_forward(self._model, self.data)
            forces = self.data.qfrc_actuator.copy()
            mujoco.mj_resetData(self._model, self.data)
            self.data.qfrc_actuator[:] = forces


@njit(cache=True, error_model="numpy")
def slope(pointers, views, state, out):
    """Write the time derivative of a state to `out`.

    `pointers` are the addresses of the functions that compute an acceleration, with the third argument of each, of
    model and data, and of the forces in which mj_rne puts its result; `views` are qpos, qvel and acceleration in the
    data, and which of qpos are needed.
    """
    functions, model, data, bias = pointers
    qpos, qvel, qacc, needed = views
    n = qpos.size
    for i in range(n):
        qpos[i] = state[i] if needed[i] else 0.0
        qvel[i] = state[n + i]
    for k in range(len(functions)):
        call(functions[k, 0], model, data, functions[k, 1], bias)
    for i in range(n):
        out[i] = qvel[i]
        out[n + i] = qacc[i]


@njit(cache=True)
def copy(values, out):
    """Write values to `out`, of the same size: an assignment would compile the text of an error for seconds."""
    for i in range(values.size):
        out[i] = values[i]


class Stepper:
    """A model set up to be stepped with its own timestep, which may be taken in several `parts`, whose sum is 1."""

    def __init__(self, model: mujoco.MjModel, parts: tuple[float, ...] = (), data: mujoco.MjData | None = None) -> None:
        self._timestep = model.opt.timestep
        self._models = [copy_model(model) for _ in parts] or [model]
        for changed, part in zip(self._models, parts, strict=bool(parts)):
            changed.opt.timestep = part * self._timestep
        self._data = mujoco.MjData(model) if data is None else data
        self._addresses = np.array([changed._address for changed in self._models])
        self._views = self._data.qpos, self._data.qvel, self._data.qacc
        self._states = np.empty((_BLOCK, model.nq + model.nv))

    def run(self, start: np.ndarray, samples: np.ndarray, watch: Watcher | None = None) -> np.ndarray:
        """Return the states after increasing numbers of steps, `samples`, as an array of shape (samples, nq + nv).

        Raises:
          DivergenceError: if the run stops being finite; the message names the time and MuJoCo's reason.
        """
        data, size, step = self._data, self._models[0].nq, self._timestep
        mujoco.mj_resetData(self._models[0], data)
        data.qpos[:], data.qvel[:] = start[:size], start[size:]
        states = np.empty((len(samples), len(start)))
        states[samples == 0] = start
        if watch:
            watch(np.zeros(1), start[None])
        last = int(samples[-1])
        with stepping(_advance):
            for first in range(0, last, _BLOCK):
                block = self._states[: min(_BLOCK, last - first)]
                count = _advance(address("mj_step"), self._addresses, data._address, self._views, block)
                end, cause = (first + count) * step, _warnings(data)
                if count < len(block):
                    cause = cause or "its state is no longer finite"
                    raise DivergenceError(f"the run diverged at t = {end:.6g} s: {cause}")
                if cause:  # as of an inertia that rounding loses: what follows is finite, and may be anything
                    raise DivergenceError(f"the run diverged before t = {end:.6g} s: {cause}")
                begin, after = np.searchsorted(samples, [first + 1, first + len(block) + 1])
                states[begin:after] = block[samples[begin:after] - first - 1]
                if watch:
                    watch(step * np.arange(first + 1, first + len(block) + 1), block)
        return states


def _warnings(data: mujoco.MjData) -> str:
    """Return what MuJoCo warns of in a run; empty if it does not."""
    kinds = [kind for name, kind in mujoco.mjtWarning.__members__.items() if name != "mjNWARNING"]
    return "; ".join(mujoco.mju_warningText(kind, 0) for kind in kinds if data.warning[kind].number)


@njit(cache=True, nogil=True)
def _advance(function, models, data, views, states):
    """Take a step for each row of `states`, fill it with the state at its end, and return the number of finite rows.

    `function` is the address of mj_step, `models` has those of the models with which the parts of each step are taken,
    `data` is that of their common data, and `views` are its qpos, qvel and qacc.
    """
    qpos, qvel, qacc = views
    size = qpos.size
    for row in range(len(states)):
        for model in models:
            call(function, model, data, 0, 0)
        for i in range(size):
            states[row, i] = qpos[i]
            states[row, size + i] = qvel[i]
            if not (abs(qpos[i]) < LARGEST and abs(qvel[i]) < LARGEST and abs(qacc[i]) < LARGEST):
                return row
    return len(states)
