"""The record of a smooth run, in compiled code: in a tenth of the time that `Recorder` takes.

A smooth run is one of a reduced model without damping. It has many short steps, so that forces need
to be looked for at their ends and in their middles only. It makes the record that `RecordMaker`
makes, with the same formulas.
"""

import math

import mujoco
import numpy as np
from numba.extending import register_jitable

from mjbeer.integrators.compiling import inlined, kernel
from mjbeer.theory import formulas
from mjbeer.theory.equations import scene_numbers
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

for _formula in (
    formulas.inertia,
    formulas.swing_energy,
    formulas.potential_drop,
    formulas.swing_energy_change,
    formulas.phi_acceleration,
    formulas.sideways_pull,
    formulas.axis_acceleration,
    formulas.normal_force,
    formulas.friction_of_frozen,
    formulas.friction_of_sliding,
    formulas.rolling_margin,
    formulas.zero_crossing,
    formulas.kinetic_energy,
    formulas.potential_energy,
):
    register_jitable(_formula)


_EXTREMES = (
    "largest_turn",
    "largest_distance",
    "largest_rate",
    "swing_energy",
    "kinetic_energy",
    "energy_change",
    "swing_drift",
    "axis_drift",
    "lowest_normal",
    "needed_friction",
    "rolling_ends_at",
)
"""What is found, by the names of `Record`."""
_PASSED = (
    "phi0",  # at the start [rad]
    "u0",  # [m]
    "mean_u0",  # u less what the swing adds to it, (m b / M_e) sin(phi) [m]
    "mean_u_dot0",  # its rate [m/s]
    "swing0",  # kinetic energy of the swing [J]
    "energy0",  # total energy [J]
    "time",  # at the last step [s]
    "phi",  # [rad]
    "phi_dot",  # [rad/s]
    "drift",  # integral of the change of the swing's energy over the angle covered [J rad]
    "forces_time",  # when forces were last looked at [s]
    "margin",  # force by which the can then neither left the incline nor slipped [N]
)
"""What the next step needs to know of those before it."""


def _row_of(names: tuple[str, ...]) -> np.ndarray:
    """Return a row of zeros with these names, which compiled code can change; shape (1,)."""
    return np.zeros(1, [(name, np.float64) for name in names])


class SmoothRecorder:
    """Makes the record of a run of a scene's reduced model without damping: an `Observer`."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf) -> None:
        self._scene = scene
        self._friction = friction
        self._slides = model.nv == 2
        self._numbers = scene_numbers(scene)
        self._passed = _row_of(_PASSED)
        self._extremes = _row_of(_EXTREMES)
        self._extremes["lowest_normal"] = math.inf
        self._extremes["rolling_ends_at"] = math.inf
        self._begun = False

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        values = self._extremes[0].tolist()
        return Record(self._scene, self._friction, **dict(zip(_EXTREMES, values, strict=True)))

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        _add(
            self._numbers,
            self._friction,
            self._slides,
            self._begun,
            times,
            states,
            self._passed,
            self._extremes,
        )
        self._begun = True


@inlined
def _coordinates(numbers, slides, state):
    """Return u, phi and their rates in a state of a model whose can `slides` or follows phi."""
    if slides:
        return state[0], state[1], state[2], state[3]
    return numbers.radius * state[0], state[0], numbers.radius * state[1], state[1]


@inlined
def _add_forces(numbers, friction, time, phi, phi_dot, passed, extremes):
    """Add the forces that rolling needs in a state."""
    phi_ddot = formulas.phi_acceleration(numbers, phi, phi_dot, 0.0)
    normal = formulas.normal_force(numbers, phi, phi_dot, phi_ddot)
    if numbers.frozen:
        pull = abs(formulas.friction_of_frozen(numbers, phi, phi_dot, phi_ddot))
    else:
        u_ddot = formulas.axis_acceleration(numbers, phi, phi_dot, phi_ddot, 0.0)
        pull = abs(formulas.friction_of_sliding(numbers, u_ddot, 0.0))
    extremes.lowest_normal = min(extremes.lowest_normal, normal)
    if pull > extremes.needed_friction * normal:
        extremes.needed_friction = pull / normal if normal > 0 else np.inf
    margin = formulas.rolling_margin(normal, pull, friction)
    if margin < 0 and extremes.rolling_ends_at == np.inf:
        extremes.rolling_ends_at = formulas.zero_crossing(
            passed.forces_time, passed.margin, time, margin
        )
    passed.forces_time = time
    passed.margin = margin


@inlined
def _begin(numbers, friction, slides, state, passed, extremes):
    """Begin with the state in which the run starts."""
    u, phi, u_dot, phi_dot = _coordinates(numbers, slides, state)
    kinetic = formulas.kinetic_energy(numbers, phi, phi_dot, u_dot, u_dot / numbers.radius, 0.0)
    passed.phi0 = phi
    passed.u0 = u
    passed.mean_u0 = u - numbers.arm * math.sin(phi)
    passed.mean_u_dot0 = u_dot - numbers.arm * math.cos(phi) * phi_dot
    passed.swing0 = formulas.swing_energy(numbers, phi, phi_dot)
    passed.energy0 = kinetic + formulas.potential_energy(numbers, phi, u, 0.0)
    passed.phi = phi
    passed.phi_dot = phi_dot
    extremes.largest_rate = abs(phi_dot)
    extremes.swing_energy = passed.swing0
    extremes.kinetic_energy = kinetic
    _add_forces(numbers, friction, 0.0, phi, phi_dot, passed, extremes)


@inlined
def _add_step(numbers, friction, slides, time, state, passed, extremes):
    """Add a step that ends at a time [s] in a state."""
    u, phi, u_dot, phi_dot = _coordinates(numbers, slides, state)
    step = time - passed.time
    # In the middle of the cubic that has the angles and the rates at both ends.
    middle_phi = (phi + passed.phi) / 2 + step * (passed.phi_dot - phi_dot) / 8
    middle_rate = 1.5 * (phi - passed.phi) / step - (phi_dot + passed.phi_dot) / 4
    middle_time = passed.time + step / 2
    _add_forces(numbers, friction, middle_time, middle_phi, middle_rate, passed, extremes)
    _add_forces(numbers, friction, time, phi, phi_dot, passed, extremes)

    kinetic = formulas.kinetic_energy(numbers, phi, phi_dot, u_dot, u_dot / numbers.radius, 0.0)
    energy = kinetic + formulas.potential_energy(numbers, phi, u, 0.0)
    swing = formulas.swing_energy(numbers, phi, phi_dot)
    change = formulas.swing_energy_change(numbers, swing, phi, passed.swing0, passed.phi0)
    passed.drift += change * abs(phi - passed.phi)
    extremes.largest_turn = max(extremes.largest_turn, abs(phi - passed.phi0))
    extremes.largest_distance = max(extremes.largest_distance, abs(u - passed.u0))
    extremes.largest_rate = max(extremes.largest_rate, abs(phi_dot))
    extremes.swing_energy = max(extremes.swing_energy, swing)
    extremes.kinetic_energy = max(extremes.kinetic_energy, kinetic)
    extremes.energy_change = max(extremes.energy_change, abs(energy - passed.energy0))
    extremes.swing_drift = max(extremes.swing_drift, abs(passed.drift))
    if slides:  # a frozen load conserves no momentum
        steady = numbers.total_mass * numbers.along / numbers.effective_mass
        expected = passed.mean_u0 + time * (passed.mean_u_dot0 + steady * time / 2)
        mean_u = u - numbers.arm * math.sin(phi)
        extremes.axis_drift = max(extremes.axis_drift, abs(mean_u - expected))
    passed.time = time
    passed.phi = phi
    passed.phi_dot = phi_dot


@kernel
def _add(numbers, friction, slides, begun, times, states, passed_row, extremes_row):
    """Add steps to what has passed and to the extremes; the start is first if not yet `begun`."""
    passed = passed_row[0]
    extremes = extremes_row[0]
    first = 0
    if not begun:
        _begin(numbers, friction, slides, states[0], passed, extremes)
        first = 1
    for row in range(first, times.size):
        _add_step(numbers, friction, slides, times[row], states[row], passed, extremes)
