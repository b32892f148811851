"""MuJoCo's accelerations in compiled code, and a run in blocks of steps, for mjbeer's own integrators.

numba takes longer to import than all else together: what steps with MuJoCo's integrators alone does not import this.
"""

import gc
import threading
from collections.abc import Generator
from contextlib import contextmanager, nullcontext
from functools import partial
from typing import Any

import mujoco
import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import event
from numba.extending import intrinsic

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators import Observer
from mjbeer.integrators.kernel_cache import compile_and_keep
from mjbeer.model.mujoco_library import address

DONE, BLOCK_END, TOO_SMALL, NOT_FINITE = range(4)
"""The statuses with which a kernel can end."""
_HOW: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}
compiled = partial(compile_and_keep, **_HOW)
"""Compiles what allocates nothing, so that arrays need not be counted: that takes a seventh of the time of a run."""
inner = partial(njit, no_cpython_wrapper=True, **_HOW)
"""Compiles what compiled code alone may call: an entry for Python and a file in the cache take time, too."""
inline = partial(inner, forceinline=True)
"""Compiles what is called in every step into its callers: a call with so many arguments takes as long as its work."""
_CONSTRAINT = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_ACTUATION, _DAMPER = int(mujoco.mjtDisableBit.mjDSBL_ACTUATION), int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
_SMOOTH = ("mj_fwdKinematics", "mj_makeM", "mj_factorM", "mj_fwdVelocity", "mj_fwdAcceleration")
"""What mj_forward does for a model without constraints and with constant actuator forces: the same numbers to the last
bit, in three quarters of the time."""
_WITHOUT_PASSIVE = (
    "mj_kinematics", "mj_comPos", "mj_tendon", "mj_crb", "mj_tendonArmature", "mj_factorM", "mj_comVel", "mj_rne",
    "mj_tendonBias", "mj_fwdAcceleration",
)  # fmt: skip
"""The same for a model that has no damping either: another quarter less."""


@contextmanager
def _announced() -> Generator[None]:
    """Say, if somebody may see it, that numba compiles in the block, and does not read its cache, after a second."""

    def say() -> None:
        from mjbeer.output import terminal  # which takes a tenth of a second to import

        if begun.buffer and (terminal.STDERR.is_terminal or terminal.STDERR.is_jupyter):
            terminal.say("mjbeer: compiling this integrator for this machine, once: some 3 s")

    timer, collects = threading.Timer(1.0, say), gc.isenabled()
    with event.install_recorder("numba:compile") as begun:
        timer.start()
        gc.disable()  # it would take a tenth of the compiler's time, and find nothing
        try:
            yield
        finally:
            timer.cancel()
            if collects:
                gc.enable()


def run_blocks(
    name: str, kernel: Any, fixed: tuple[Any, ...], place: tuple, limit: float, observer: Observer | None
) -> tuple[int, tuple]:
    """Call a method's compiled `kernel`, a block of steps each, until a run is done; return its evaluations and place.

    The kernel takes `fixed` arguments, the last of which has room for the steps that the `observer` is shown, and a
    `place`, which begins with the time [s]. It returns the status, the new place, and how many evaluations and kept
    rows there were.

    Raises:
      DivergenceError: if the motion stops being finite, no step is small enough, or there are `limit` evaluations.
    """
    status, total = BLOCK_END, 0
    while status == BLOCK_END:
        if total > limit:
            raise DivergenceError(f"the {name} run was given up at t = {place[0]:.6g} s after {total} evaluations")
        with nullcontext() if kernel.overloads else _announced():
            status, place, evaluations, count = kernel(*fixed, place)
        total += evaluations
        if observer and count:
            observer(fixed[-1][0][:count], fixed[-1][1][:count])
    if status != DONE:
        cause = "its state is no longer finite" if status == NOT_FINITE else "no step is small enough for it"
        raise DivergenceError(f"the {name} run diverged at t = {place[0]:.6g} s: {cause}")
    return total, place


@intrinsic
def call_c(typing_context, function, model, data, flag, result):
    """Call the C function at the address `function`; no address is compiled in, so that caching works.

    A function that takes fewer arguments does not look at the others: they are in registers wherever MuJoCo runs.
    """

    def generate(context, builder, signature, arguments):
        function_type = ir.FunctionType(ir.VoidType(), [each.type for each in arguments[1:]])
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp, types.intp, types.intp), generate


@intrinsic
def small(typing_context):
    """Have the calling function compiled to little code: all its loops are short, and unrolled they take seconds."""

    def generate(context, builder, signature, arguments):
        builder.function.attributes.add("optsize")
        return context.get_dummy_value()

    return types.void(), generate


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
            if "slide" in (joints := [model.joint(joint).name for joint in range(model.njnt)]):
                # The acceleration, which does not depend on the slide, is evaluated at its origin: far from there the
                # rounding of positions in the world, from which MuJoCo computes torques, would hide a short arm.
                needed[joints.index("slide")] = False
        bias = data.qfrc_bias.__array_interface__["data"][0]
        functions = np.array([(address(name), bias if name == "mj_tendonBias" else 0) for name in names])
        views = data.qpos, data.qvel, data.qacc_smooth if smooth else data.qacc, needed
        self.kernel = (functions, model._address, data._address, bias), views
        """Addresses and views by which kernels evaluate the accelerations, as `derivative` takes them."""
        self.begin()

    def begin(self) -> None:
        """Compute the actuators' forces of a model that has changed, which a smooth one then takes unchanged."""
        if self._actuated and len(self.kernel[0][0]) > 1:
            mujoco.mj_forward(self._model, self.data)

    def rates(self, state: np.ndarray) -> np.ndarray:
        """Return the time derivative of a state, by MuJoCo's Python binding: for what is done once a run."""
        qpos, qvel, qacc, needed = self.kernel[1]
        qpos[:], qvel[:] = np.split(state, 2)
        qpos *= needed
        mujoco.mj_forward(self._model, self.data)
        return np.concatenate([qvel, qacc])


@inline
def accelerate(pointers):
    """Compute the acceleration in the data.

    `pointers` are the addresses of the functions that do so, with the third argument of each, of model and data, and of
    the forces in which mj_rne puts its result.
    """
    functions, model, data, bias = pointers
    for k in range(len(functions)):
        call_c(functions[k, 0], model, data, functions[k, 1], bias)


@inline
def derivative(pointers, views, state, out):
    """Write the time derivative of a state to `out`. `views` are qpos, qvel, acceleration and which qpos are needed."""
    qpos, qvel, qacc, needed = views
    n = qpos.size
    for i in range(n):
        qpos[i] = state[i] * needed[i]
        qvel[i] = state[n + i]
    accelerate(pointers)
    for i in range(n):
        out[i] = qvel[i]
        out[n + i] = qacc[i]


@inline
def copy(values, out):
    """Write values to `out`, of the same size: an assignment would compile the text of an error for seconds."""
    for i in range(values.size):
        out[i] = values[i]
