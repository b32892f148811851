"""The record of all steps of a run, made while it is stepped."""

import math

import mujoco
import numpy as np
from numba import njit

from mjbeer.model.state import read
from mjbeer.theory.equations import accelerations
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene


class Recorder:
    """The record of a run of one model of a scene, a `Watcher`.

    The steps of DOP853 are so long that forces are looked for `within` them, too.
    """

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf, within: bool = False) -> None:
        self._model, self._scene, self._within, self.record = model, scene, within, Record(scene, friction)
        self._last = np.empty((7, 0))

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        motion = read(self._model, self._scene, states, times)
        if not self._within:
            self.record.add(motion)
            return
        self.record.add_conserved(motion)
        rates = motion.phi_dot, motion.u_dot
        gains = accelerations(self._scene, motion.phi, *rates)[::-1]
        ends = np.concatenate([self._last, np.stack([times, motion.phi, motion.u, *rates, *gains])], axis=1)
        self._last = ends[:, -1:]
        self.record.add_forces(*_between(ends[0], *ends[1:].reshape(3, 2, -1)))


# A polynomial of fifth degree over a step, from its change, rates and second derivatives at both ends, at parts of it.
_PART = np.arange(1, 9)[:, None] / 8  # a step of DOP853 may be half a swing long
_ENDS = np.array([[1, 1, 1, 1, 1], [1, 0, 0, 0, 0], [0, 2, 0, 0, 0], [1, 2, 3, 4, 5], [0, 2, 6, 12, 20]])
_POWER, _TERMS = np.arange(1, 6), np.linalg.inv(_ENDS)
_CHANGES, _RATES = _PART**_POWER @ _TERMS, _POWER * _PART ** (_POWER - 1) @ _TERMS


def _between(time: np.ndarray, place: np.ndarray, rate: np.ndarray, gain: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return times [s], phi, phi_dot and u_dot within steps, from both coordinates and their derivatives at the ends.

    These have shape (2, ends); a single end is returned as it is.
    """
    if len(time) == 1:
        return time, place[0], *rate
    step = np.diff(time)
    first, bend = step * rate[:, :-1], step**2 * gain[:, :-1]
    last, bent = step * rate[:, 1:], step**2 * gain[:, 1:]
    ends, step = np.stack([np.diff(place), first, bend, last, bent], axis=-1), step[:, None]
    phi, (phi_dot, u_dot) = place[0, :-1, None] + ends[0] @ _CHANGES.T, ends @ _RATES.T / step
    return tuple(each.ravel() for each in (time[:-1, None] + step * _PART.T, phi, phi_dot, u_dot))


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


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
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
