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
"""What `_extremes` finds, by the names of `Record`."""


class SmoothRecorder:
    """The record of a run of a reduced model without damping, as `Recorder` makes it, in compiled code."""

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        self._record, form, can, load = Record(scene, friction), scene.oscillator, scene.can, scene.load
        mass, turning = scene.effective_mass, can.inertia / can.radius**2
        self._numbers = (
            *(form.base, form.chord, form.swing, form.slope, form.depth, form.bottom),
            *(can.radius, can.effective_mass, load.mass, load.offset, load.inertia, scene.gravity, scene.incline),
            *(scene.mass, mass, scene.drive, friction),
            # Friction over drive, over the force of the swinging load, and over phi_ddot.
            *((turning / mass,) * 2 if scene.attachment == "sliding" else (1.0, 1.0)),
            0.0 if scene.attachment == "sliding" else -scene.mass * can.radius,
        )
        self._found = (*(0.0,) * 6, math.inf, 0.0, math.inf, *(0.0,) * (len(_NAMES) - 9), *(0.0,) * 8)
        assert vars(self._record).keys() >= set(_NAMES)

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        self._found = _extremes(self._numbers, times, states, self._found)

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        vars(self._record).update(zip(_NAMES, self._found[: len(_NAMES)], strict=True))
        return self._record


@njit(cache=True, nogil=True, error_model="numpy")
def _extremes(numbers, times, states, found):
    """Return what was `found` so far with more steps, as `Record.add_conserved` and `Record.add_forces` find it.

    It has the values of `_NAMES` and what the next call needs: phi, u, the speed of the axis without that of the load,
    J phi_dot^2 / 2 and the energy at the start, and the last phi, margin of the forces and time, 0 at the start.
    """
    base, chord, swing, slope, depth, bottom = numbers[:6]
    radius, can_mass, load_mass, offset, load_inertia, gravity, incline, all_mass, mass, drive = numbers[6:16]
    friction, by_drive, by_swing, by_turning = numbers[16:]
    turned, rolled, path, fastest, swing_most, axis, lowest, needed, fails_at, kinetic_most = found[:10]
    energy_change, swing_change, drift, drift_most = found[10:14]
    phi0, u0, speed0, swing0, energy0, last_phi, last_margin, last_time = found[14:]
    size, moment, arm = states.shape[1] // 2, load_mass * offset, load_mass * offset / mass
    sin_incline, cos_incline = math.sin(incline), math.cos(incline)
    sin_bottom, cos_bottom = math.sin(bottom), math.cos(bottom)
    weight = all_mass * gravity * cos_incline
    for row in range(times.size):
        time, phi, rate = times[row], states[row, size - 1], states[row, 2 * size - 1]
        u, speed = (states[row, 0], states[row, 2]) if size > 1 else (radius * phi, radius * rate)
        sin, cos = math.sin(phi), math.cos(phi)
        inertia = base + chord * (1 - cos) / 2 + swing * sin * sin
        along, across = speed - offset * cos * rate, offset * sin * rate
        kinetic = can_mass * speed**2 + load_mass * (along**2 + across**2) + load_inertia * rate**2
        kinetic /= 2
        energy = kinetic - gravity * (all_mass * u * sin_incline + moment * (cos_incline * cos - sin_incline * sin))
        swings = inertia * rate**2 / 2
        if time == 0.0:
            phi0, u0, speed0, swing0, energy0, last_phi = phi, u, speed - arm * cos * rate, swings, energy, phi
        turned, rolled = max(turned, abs(phi - phi0)), max(rolled, abs(u - u0))
        fastest, swing_most, kinetic_most = max(fastest, abs(rate)), max(swing_most, swings), max(kinetic_most, kinetic)
        covered = abs(phi - last_phi)
        path += covered
        drop = slope * (phi - phi0) - 2 * depth * math.sin((phi + phi0) / 2 - bottom) * math.sin((phi - phi0) / 2)
        gained = swings - swing0 - drop
        energy_change, swing_change = max(energy_change, abs(energy - energy0)), max(swing_change, abs(gained))
        drift += gained * covered
        drift_most = max(drift_most, abs(drift))
        if size > 1:
            moved = u - arm * sin - (u0 - arm * math.sin(phi0))
            axis = max(axis, abs(moved - speed0 * time - drive / mass * time**2 / 2))
        bend = chord * sin / 2 + 2 * swing * sin * cos
        gain = (slope - depth * (sin * cos_bottom - cos * sin_bottom) - bend * rate**2 / 2) / inertia
        normal = weight + moment * (sin * gain + cos * rate**2)
        pull = by_drive * drive + by_swing * moment * (cos * gain - sin * rate**2) + by_turning * gain
        lowest, needed = min(lowest, normal), max(needed, abs(pull) / normal if normal > 0 else math.inf)
        margin = normal
        if friction < math.inf:
            margin = min(margin, friction * normal - abs(pull))
        if margin < 0 and fails_at == math.inf:
            fails_at = time
            if time > 0:
                fails_at = last_time + last_margin / (last_margin - margin) * (time - last_time)
        last_phi, last_margin, last_time = phi, margin, time
    extremes = turned, rolled, path, fastest, swing_most, axis, lowest, needed, fails_at, kinetic_most
    drifts = energy_change, swing_change, drift, drift_most
    return extremes + drifts + (phi0, u0, speed0, swing0, energy0, last_phi, last_margin, last_time)
