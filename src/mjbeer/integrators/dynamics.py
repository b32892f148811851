"""MuJoCo's accelerations in compiled code, and the loop that calls a method's kernel.

A kernel is a method's compiled function that takes a block of steps: `advance(..., ends, place)`
begins at a `place`, writes up to as many `ends` of steps as there is room for, and returns a
`Block`, which says where the next one begins.
"""

import math
from contextlib import nullcontext
from functools import cached_property
from typing import Any, NamedTuple

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators import Observer
from mjbeer.integrators.compiling import announced, call_c, inlined
from mjbeer.model.mujoco_library import address

DONE = 0
"""Status of a block of steps: the last sample is reached."""
MORE = 1
"""The block is full, and the run goes on."""
STEP_TOO_SMALL = 2
"""No step is small enough for the tolerance."""
NOT_FINITE = 3
"""The motion is not finite any more."""
STEP_TOO_LONG = 4
"""The method does not converge at this timestep."""
ON_TIME = 1e-14
"""Share of the time that has passed by which a sample may lie after the end of a step: both have
been rounded."""
_CONSTRAINT = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_DAMPER = int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
_ACTUATION = int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
_SMOOTH_STAGES = (
    "mj_fwdKinematics",
    "mj_makeM",
    "mj_factorM",
    "mj_fwdVelocity",
    "mj_fwdAcceleration",
)
"""The stages of mj_forward that a model without constraints and with constant actuator forces
needs: the same numbers to the last bit, in three quarters of the time."""


class ForwardDynamics(NamedTuple):
    """What a kernel needs to evaluate MuJoCo's accelerations."""

    functions: np.ndarray  # addresses of the C functions to be called, one after the other
    model: int  # address of the mjModel
    data: int  # address of the mjData
    qpos: np.ndarray  # views of the mjData: positions, rates, and the accelerations that come out
    qvel: np.ndarray
    qacc: np.ndarray
    used: np.ndarray  # 1.0 for each position on which the accelerations depend, else 0.0


class Steps(NamedTuple):
    """Times [s], shape (rows,), and the states then, shape (rows, nq + nv)."""

    times: np.ndarray
    states: np.ndarray


class Block(NamedTuple):
    """How a block of steps has ended."""

    status: int  # one of those above
    time: float  # that the run has reached [s]
    evaluations: int  # of the dynamics in this block
    rows: int  # ends of steps that it wrote for the observer
    resume_at: tuple  # where the next block begins, in the method's own terms


class Dynamics:
    """The forward dynamics of a model of slides and hinges, as kernels evaluate it.

    Without `data` of the model, in its initial state, it makes its own.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData | None = None) -> None:
        self.model = model
        self.data = mujoco.MjData(model) if data is None else data
        self.evaluations = 0
        """Number of evaluations in all runs so far."""
        self.most_evaluations = math.inf
        """The number at which a run is given up, checked after each block."""
        flags = model.opt.disableflags
        self.constrained = not flags & _CONSTRAINT
        """Whether the model may have constraints."""
        self.damped = not flags & _DAMPER
        """Whether the model may have damping."""
        self._actuated = model.nu > 0 and not flags & _ACTUATION
        feedback = model.na or model.actuator_gainprm.any() or model.actuator_biasprm[:, 1:].any()
        self._smooth = not self.constrained and not (self._actuated and feedback)
        stages = _SMOOTH_STAGES if self._smooth else ("mj_forward",)
        self.kernel_view = ForwardDynamics(
            functions=np.array([address(stage) for stage in stages]),
            model=model._address,
            data=self.data._address,
            qpos=self.data.qpos,
            qvel=self.data.qvel,
            qacc=self.data.qacc_smooth if self._smooth else self.data.qacc,
            used=self._used_positions(),
        )
        """The model and its data, as kernels take them."""
        self.model_has_changed()

    def _used_positions(self) -> np.ndarray:
        """Return 1.0 for each position on which the accelerations depend, else 0.0, shape (nq,).

        Those of a smooth model do not depend on the slide, and are evaluated with the slide at its
        origin: far from there the rounding of positions in the world, from which MuJoCo computes
        torques, would hide a short arm.
        """
        used = np.ones(self.model.nq)
        if self._smooth:
            for joint in range(self.model.njnt):
                if self.model.joint(joint).name == "slide":
                    used[self.model.jnt_qposadr[joint]] = 0.0
        return used

    def model_has_changed(self) -> None:
        """Take notice of new numbers in the model: constant actuator forces change with them."""
        vars(self).pop("corners", None)
        if self._smooth and self._actuated:
            mujoco.mj_forward(self.model, self.data)

    @cached_property
    def corners(self) -> np.ndarray:
        """Return the rates whose squares damp the model, as weights of a state's components.

        The shape is (rates, nq + nv). They are the rates of joints, and of tendons that are sums of
        joints. Where one changes its sign the drag v |v| has a corner.
        """
        model = self.model
        rates = []
        if self.damped:
            rates += list(np.eye(model.nv)[model.dof_dampingpoly[:, 0] > 0])
            for tendon in np.flatnonzero(model.tendon_dampingpoly[:, 0] > 0):
                first = model.tendon_adr[tendon]
                joints = slice(first, first + model.tendon_num[tendon])
                rate = np.zeros(model.nv)
                rate[model.jnt_dofadr[model.wrap_objid[joints]]] = model.wrap_prm[joints]
                rates.append(rate)
        weights = np.zeros((len(rates), model.nq + model.nv))
        if rates:
            weights[:, model.nq :] = rates
        return weights

    def derivative(self, state: np.ndarray) -> np.ndarray:
        """Return the time derivative of a state by MuJoCo's Python binding, called once a run."""
        qpos = state[: self.model.nq]
        qvel = state[self.model.nq :]
        self.data.qpos[:] = qpos * self.kernel_view.used
        self.data.qvel[:] = qvel
        mujoco.mj_forward(self.model, self.data)
        self.evaluations += 1
        return np.concatenate([qvel, self.kernel_view.qacc])

    def run_blocks(
        self,
        name: str,
        kernel: Any,
        arguments: tuple,
        place: Any,
        ends: Steps,
        observer: Observer | None,
    ) -> Any:
        """Call a method's kernel until its run is done, and return the last place.

        The kernel takes the `arguments`, the `ends` of steps to write for the observer, and a
        place. Between two blocks the user can interrupt a run.

        Raises:
          DivergenceError: if the motion stops being finite, its timestep is too long, no step is
            small enough, or there are too many evaluations.
        """
        status = MORE
        time = 0.0
        while status == MORE:
            if self.evaluations > self.most_evaluations:
                raise DivergenceError(
                    f"the {name} run was given up at t = {time:.6g} s "
                    f"after {self.evaluations} evaluations"
                )
            with nullcontext() if kernel.overloads else announced():
                block = kernel(*arguments, ends, place)
            status = block.status
            time = block.time
            place = block.resume_at
            self.evaluations += block.evaluations
            if observer and block.rows:
                observer(ends.times[: block.rows], ends.states[: block.rows])
        if status == NOT_FINITE:
            raise DivergenceError(
                f"the {name} run diverged at t = {time:.6g} s: its state is no longer finite"
            )
        if status == STEP_TOO_SMALL:
            raise DivergenceError(
                f"the {name} run diverged at t = {time:.6g} s: no step is small enough for it"
            )
        if status == STEP_TOO_LONG:
            raise DivergenceError(
                f"the {name} run failed at t = {time:.6g} s: take a shorter timestep"
            )
        return place


def room_for_ends(start: np.ndarray, rows: int) -> Steps:
    """Return room for so many ends of steps; the first row is the start."""
    ends = Steps(np.zeros(rows), np.empty((rows, len(start))))
    ends.states[:1] = start
    return ends


@inlined
def accelerate(dynamics):
    """Compute the accelerations `qacc` of a `ForwardDynamics` at its `qpos` and `qvel`."""
    for k in range(len(dynamics.functions)):
        call_c(dynamics.functions[k], dynamics.model, dynamics.data)


@inlined
def write_derivative(dynamics, state, out):
    """Write the time derivative of a state to `out`."""
    n = dynamics.qpos.size
    for i in range(n):
        dynamics.qpos[i] = state[i] * dynamics.used[i]
        dynamics.qvel[i] = state[n + i]
    accelerate(dynamics)
    for i in range(n):
        out[i] = state[n + i]
        out[n + i] = dynamics.qacc[i]


@inlined
def write(values, out):
    """Write values to `out`, of the same size; `out[:] = values` takes seconds to compile."""
    for i in range(values.size):
        out[i] = values[i]
