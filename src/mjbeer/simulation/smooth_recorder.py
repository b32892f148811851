"""The record of a smooth run, in compiled code: in a tenth of the time that `Recorder` takes.

A smooth run is one of a reduced model without damping. It has many short steps, so that forces need to be looked for
at their ends and in their middles only. It makes the record that `RecordMaker` makes, with the same formulas.
"""

import math
from typing import NamedTuple

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
    formulas.phi_acceleration,
    formulas.axis_acceleration,
    formulas.normal_force,
    formulas.friction_of_frozen,
    formulas.friction_of_sliding,
    formulas.kinetic_energy,
    formulas.potential_energy,
):
    register_jitable(_formula)


class Passed(NamedTuple):
    """What has to be known of the steps so far to go on."""

    phi0: float  # at the start [rad]
    u0: float  # [m]
    mean_u0: float  # u less what the swing adds to it, (m b / M_e) sin(phi) [m]
    mean_u_dot0: float  # its rate [m/s]
    swing0: float  # kinetic energy of the swing [J]
    energy0: float  # total energy [J]
    time: float  # at the last step [s]
    phi: float  # [rad]
    phi_dot: float  # [rad/s]
    drift: float  # integral of the change of the swing's energy over the angle covered [J rad]
    margin: float  # force by which the can neither left the incline nor slipped [N]


class Forces(NamedTuple):
    """The extremes of forces, by the names of `Record`."""

    lowest_normal: float
    needed_friction: float
    rolling_ends_at: float


class Extremes(NamedTuple):
    """The other extremes, by the names of `Record`."""

    largest_turn: float = 0.0
    largest_distance: float = 0.0
    angle_covered: float = 0.0
    largest_rate: float = 0.0
    swing_energy: float = 0.0
    kinetic_energy: float = 0.0
    energy_change: float = 0.0
    swing_change: float = 0.0
    swing_drift: float = 0.0
    axis_drift: float = 0.0


class SmoothRecorder:
    """Makes the record of a run of a scene's reduced model without damping: an `Observer`."""

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf) -> None:
        self._scene = scene
        self._friction = friction
        self._slides = model.nv == 2
        self._numbers = scene_numbers(scene)
        self._passed: Passed | None = None
        self._forces = Forces(math.inf, 0.0, math.inf)
        self._extremes = Extremes()

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        return Record(self._scene, self._friction, **self._extremes._asdict(), **self._forces._asdict())

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        first = 0
        if self._passed is None:
            first = 1
            self._begin(states[0])
        self._passed, self._forces, self._extremes = _add(
            self._numbers, self._friction, self._slides, times[first:], states[first:],
            self._passed, self._forces, self._extremes,
        )  # fmt: skip

    def _begin(self, start: np.ndarray) -> None:
        """Begin with the state in which the run starts."""
        numbers = self._numbers
        u, phi, u_dot, phi_dot = (float(value) for value in _coordinates.py_func(numbers, self._slides, start))
        arm = self._scene.load.moment / numbers.effective_mass
        swing = float(formulas.swing_energy(numbers, phi, phi_dot))
        kinetic = float(formulas.kinetic_energy(numbers, phi, phi_dot, u_dot, u_dot / numbers.radius, 0.0))
        self._extremes = Extremes(largest_rate=abs(phi_dot), swing_energy=swing, kinetic_energy=kinetic)
        self._forces, margin = _look.py_func(
            numbers, self._friction, 0.0, phi, phi_dot, 0.0, math.nan, self._forces
        )
        self._passed = Passed(
            phi0=phi,
            u0=u,
            mean_u0=u - arm * math.sin(phi),
            mean_u_dot0=u_dot - arm * math.cos(phi) * phi_dot,
            swing0=swing,
            energy0=kinetic + float(formulas.potential_energy(numbers, phi, u, 0.0)),
            time=0.0,
            phi=phi,
            phi_dot=phi_dot,
            drift=0.0,
            margin=margin,
        )


@inlined
def _coordinates(numbers, slides, state):
    """Return u, phi and their rates in a state of a reduced model, whose can `slides` or follows phi."""
    if slides:
        return state[0], state[1], state[2], state[3]
    return numbers.radius * state[0], state[0], numbers.radius * state[1], state[1]


@inlined
def _look(numbers, friction, time, phi, phi_dot, earlier, margin_before, forces):
    """Return the extremes with the `forces` in a state, and the margin [N] there.

    The margin `earlier` [s] was `margin_before`.
    """
    phi_ddot = formulas.phi_acceleration(numbers, phi, phi_dot, 0.0)
    normal = formulas.normal_force(numbers, phi, phi_dot, phi_ddot)
    if numbers.frozen:
        pull = abs(formulas.friction_of_frozen(numbers, phi, phi_dot, phi_ddot))
    else:
        u_ddot = formulas.axis_acceleration(numbers, phi, phi_dot, phi_ddot, 0.0)
        pull = abs(formulas.friction_of_sliding(numbers, u_ddot, 0.0))
    margin = normal
    if friction < np.inf:
        margin = min(normal, friction * normal - pull)
    ends_at = forces.rolling_ends_at
    if margin < 0 and ends_at == np.inf:
        ends_at = time
        if margin_before >= 0:
            ends_at = earlier + margin_before / (margin_before - margin) * (time - earlier)
    needed = forces.needed_friction
    if pull > needed * normal:
        needed = pull / normal if normal > 0 else np.inf
    return Forces(min(forces.lowest_normal, normal), needed, ends_at), margin


@kernel
def _add(numbers, friction, slides, times, states, passed, forces, extremes):
    """Return what has passed, and both kinds of extremes, with the next steps added."""
    arm = numbers.load_mass * numbers.offset / numbers.effective_mass
    steady = numbers.total_mass * numbers.along / numbers.effective_mass
    for row in range(times.size):
        time = times[row]
        u, phi, u_dot, phi_dot = _coordinates(numbers, slides, states[row])
        step = time - passed.time
        middle = passed.time + step / 2
        # In the middle of the cubic with the angles and the rates at both ends.
        middle_phi = (phi + passed.phi) / 2 + step * (passed.phi_dot - phi_dot) / 8
        middle_rate = 1.5 * (phi - passed.phi) / step - (phi_dot + passed.phi_dot) / 4
        forces, between = _look(
            numbers, friction, middle, middle_phi, middle_rate, passed.time, passed.margin, forces
        )
        forces, margin = _look(numbers, friction, time, phi, phi_dot, middle, between, forces)
        kinetic = formulas.kinetic_energy(numbers, phi, phi_dot, u_dot, u_dot / numbers.radius, 0.0)
        energy = kinetic + formulas.potential_energy(numbers, phi, u, 0.0)
        swing = formulas.swing_energy(numbers, phi, phi_dot)
        change = swing - (passed.swing0 + formulas.potential_drop(numbers, phi, passed.phi0))
        covered = abs(phi - passed.phi)
        drift = passed.drift + change * covered
        axis_drift = 0.0
        if slides:
            expected = passed.mean_u0 + time * (passed.mean_u_dot0 + steady * time / 2)
            axis_drift = u - arm * math.sin(phi) - expected
        extremes = Extremes(
            max(extremes.largest_turn, abs(phi - passed.phi0)),
            max(extremes.largest_distance, abs(u - passed.u0)),
            extremes.angle_covered + covered,
            max(extremes.largest_rate, abs(phi_dot)),
            max(extremes.swing_energy, swing),
            max(extremes.kinetic_energy, kinetic),
            max(extremes.energy_change, abs(energy - passed.energy0)),
            max(extremes.swing_change, abs(change)),
            max(extremes.swing_drift, abs(drift)),
            max(extremes.axis_drift, abs(axis_drift)),
        )
        passed = Passed(
            passed.phi0,
            passed.u0,
            passed.mean_u0,
            passed.mean_u_dot0,
            passed.swing0,
            passed.energy0,
            time,
            phi,
            phi_dot,
            drift,
            margin,
        )
    return passed, forces, extremes
