"""What the compiled code of mjbeer's own integrators shares: the accelerations, a run in blocks, and the record.

numba, which compiles it, takes longer to import than all else together: what steps with MuJoCo's integrators alone
does not import this.
"""

import ctypes
import math
from contextlib import nullcontext
from functools import partial
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
from mjbeer.simulation.stepping import Watcher
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

DONE, BLOCK_END, TOO_SMALL, NOT_FINITE = range(4)
"""The statuses with which a kernel can end."""
compiled = partial(njit, cache=True, error_model="numpy", nogil=True, _nrt=False)
"""Compiles what allocates nothing, so that arrays need not be counted: that takes a seventh of the time of a run."""
inner = partial(compiled, no_cpython_wrapper=True, no_cfunc_wrapper=True, forceinline=True)
"""Compiles what compiled code alone may call, into its callers: a call with so many arguments takes as long as what it
does, and an entry for Python a seventh of the compiler's time."""
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
_NAMES = (
    "turned", "rolled", "path", "fastest", "swing", "axis_drift", "lowest_normal", "needed", "fails_at", "_kinetic",
    "_energy_change", "_swing_change", "_swing_drift", "_largest_swing_drift",
)  # fmt: skip
"""The first numbers that `see` finds, by the names of `Record`."""
(
    TURNED, ROLLED, PATH, FASTEST, SWING, AXIS, LOWEST, NEEDED, FAILS_AT, KINETIC, ENERGY_CHANGE, SWING_CHANGE, DRIFT,
    LARGEST_DRIFT, PHI0, U0, SPEED0, SWING0, ENERGY0, LAST_PHI, LAST_MARGIN, LAST_TIME,
) = range(22)  # fmt: skip
"""The places of all of them. What is not in a record is phi, u, the speed of the axis less its swing, J phi_dot^2 / 2
and the energy at the start; and the last phi, margin of the forces and time."""


class _Compiling(event.Listener):
    """Says once, if somebody may see it, that numba compiles; what is read from its cache is not compiled."""

    said = False

    def on_start(self, _: Any) -> None:
        from mjbeer.output import terminal

        if not _Compiling.said and terminal.is_seen():
            _Compiling.said = True
            terminal.say(_COMPILING)

    def on_end(self, _: Any) -> None: ...


def drive(name: str, kernel: Any, fixed: tuple[Any, ...], place: tuple, limit: float, watch: Watcher | None) -> int:
    """Call the compiled `kernel` of a method, a block of steps each, until a run is done; return its evaluations.

    It takes `fixed` arguments, the last of which has room for what is shown to `watch`, and a `place`, which begins
    with the time [s]. It returns the status, the new place, and the numbers of evaluations and of kept rows.

    Raises:
      DivergenceError: if the motion stops being finite, no step is small enough, or there are `limit` evaluations.
    """
    status, total = BLOCK_END, 0
    heard = nullcontext() if kernel.overloads else event.install_listener("numba:compile", _Compiling())
    with quiet(), untimed(), heard:
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


@compiled(forceinline=True)
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


@inner
def copy(values, out):
    """Write values to `out`, of the same size: an assignment would compile the text of an error for seconds."""
    for i in range(values.size):
        out[i] = values[i]


class SmoothRecorder:
    """The record of a run of a reduced model without damping, as `Recorder` makes it, for compiled code."""

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        self._record, form, can, load = Record(scene, friction), scene.oscillator, scene.can, scene.load
        mass, turning, sliding = scene.effective_mass, can.inertia / can.radius**2, scene.attachment == "sliding"
        numbers = (
            *(form.base, form.chord, form.swing, form.slope),
            *(form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)),
            *(can.radius, can.effective_mass, load.mass, load.offset, load.inertia),
            *(scene.gravity * math.sin(scene.incline), scene.gravity * math.cos(scene.incline)),
            *(scene.mass, mass, scene.drive, friction),
            # Friction over drive, over the force of the swinging load, and over phi_ddot.
            *((turning / mass, turning / mass, 0.0) if sliding else (1.0, 1.0, -scene.mass * can.radius)),
        )
        found = np.zeros(LAST_TIME + 1)
        found[LOWEST] = found[FAILS_AT] = math.inf
        self.kernel = numbers, found
        """The numbers of the scene, and what `see` has found so far."""

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        vars(self._record).update(zip(_NAMES, self.kernel[1].tolist(), strict=False))
        return self._record


@compiled(forceinline=True)
def see(numbers, found, time, state):
    """Add a state at a time [s] to what was `found`, as `Record.add_conserved` and `Record.add_forces` do."""
    base, chord, swing, slope, lean, weight, radius, can_mass, load_mass, offset, load_inertia = numbers[:11]
    down, normally, all_mass, mass, drive = numbers[11:16]
    size, moment, arm = state.size // 2, load_mass * offset, load_mass * offset / mass
    phi, rate = state[size - 1], state[2 * size - 1]
    u, speed = (state[0], state[2]) if size > 1 else (radius * phi, radius * rate)
    sin, cos, square = math.sin(phi), math.cos(phi), rate * rate
    inertia = base + chord * (1 - cos) / 2 + swing * sin * sin
    along, across = speed - offset * cos * rate, offset * sin * rate
    kinetic = (can_mass * speed * speed + load_mass * (along * along + across * across) + load_inertia * square) / 2
    energy = kinetic - all_mass * u * down - moment * (normally * cos - down * sin)
    swings = inertia * square / 2
    if time == 0.0:
        found[PHI0], found[U0], found[SPEED0] = phi, u, speed - arm * cos * rate
        found[SWING0], found[ENERGY0], found[LAST_PHI] = swings, energy, phi
    phi0 = found[PHI0]
    found[TURNED], found[ROLLED] = max(found[TURNED], abs(phi - phi0)), max(found[ROLLED], abs(u - found[U0]))
    found[FASTEST], found[SWING] = max(found[FASTEST], abs(rate)), max(found[SWING], swings)
    found[KINETIC] = max(found[KINETIC], kinetic)
    covered = abs(phi - found[LAST_PHI])
    found[PATH] += covered
    middle = (phi + phi0) / 2
    pulled = weight * math.sin(middle) - lean * math.cos(middle)
    gained = swings - found[SWING0] - slope * (phi - phi0) + 2 * pulled * math.sin((phi - phi0) / 2)
    found[ENERGY_CHANGE] = max(found[ENERGY_CHANGE], abs(energy - found[ENERGY0]))
    found[SWING_CHANGE] = max(found[SWING_CHANGE], abs(gained))
    found[DRIFT] += gained * covered
    found[LARGEST_DRIFT] = max(found[LARGEST_DRIFT], abs(found[DRIFT]))
    if size > 1:
        moved = u - arm * sin - (found[U0] - arm * math.sin(phi0))
        found[AXIS] = max(found[AXIS], abs(moved - time * (found[SPEED0] + drive / mass * time / 2)))
    normal, pull, margin = forces(numbers, sin, cos, square)
    found[LOWEST] = min(found[LOWEST], normal)
    found[NEEDED] = max(found[NEEDED], pull / normal if normal > 0 else math.inf)
    if margin < 0 and found[FAILS_AT] == math.inf:
        share = found[LAST_MARGIN] / (found[LAST_MARGIN] - margin) if time > 0 else 0.0
        found[FAILS_AT] = found[LAST_TIME] + share * (time - found[LAST_TIME])
    found[LAST_PHI], found[LAST_MARGIN], found[LAST_TIME] = phi, margin, time


@inner
def forces(numbers, sin, cos, square):
    """Return N and |F| [N] that rolling needs, and the lesser of N and what F leaves until the can would slip.

    Where the load is they depend on the sine and cosine of phi, and on the square of its rate.
    """
    base, chord, swing, slope, lean, weight = numbers[:6]
    moment, normally, all_mass, drive = numbers[8] * numbers[9], numbers[12], numbers[13], numbers[15]
    friction, by_drive, by_swing, by_turning = numbers[16:]
    torque = slope - weight * sin + lean * cos
    gain = (torque - sin * (chord / 4 + swing * cos) * square) / (base + chord * (1 - cos) / 2 + swing * sin * sin)
    normal = all_mass * normally + moment * (sin * gain + cos * square)
    pull = abs(by_drive * drive + by_swing * moment * (cos * gain - sin * square) + by_turning * gain)
    return normal, pull, min(normal, friction * normal - pull) if friction < math.inf else normal
