"""The record of all steps of a smooth run, with compiled code: numba is imported only where it steps."""

import math

import mujoco
import numpy as np

from mjbeer.integrators.compiling import kernel, optimize_for_size
from mjbeer.model.joints import to_coordinates
from mjbeer.simulation.fixed_step import Recorder
from mjbeer.theory.scene import Scene

_NAMES = (
    "largest_turn", "largest_distance", "_energy_change", "_swing_change", "axis_drift", "largest_rate", "swing_energy",
    "_kinetic", "needed_friction", "lowest_normal", "angle_covered", "_swing_drift", "_largest_swing_drift",
)  # fmt: skip
"""What `_update` finds, by the names of `Record`: first those that count from the start, then other largest sizes."""
_CHANGES, _SIZES, _NEEDED, _LOWEST, _COVERED, _DRIFT, _LARGEST_DRIFT = 5, 8, 8, 9, 10, 11, 12


class SmoothRecorder(Recorder):
    """The record of a run of a reduced model without damping: what `Recorder` makes, in a quarter of the time.

    Its steps are so short that forces need to be looked for at their ends and in their middles only.
    """

    def __init__(self, model: mujoco.MjModel, scene: Scene, friction: float = math.inf) -> None:
        super().__init__(model, scene, friction, within=True)
        shape, can, load, sliding = scene.oscillator, scene.can, scene.load, scene.attachment == "sliding"
        mass, turning = scene.effective_mass, can.inertia / can.radius**2
        arm = load.moment / mass if sliding else 0.0
        self._numbers = (
            *(shape.base, shape.chord, shape.coupling, shape.ramp),
            *(shape.depth * math.sin(shape.bottom), shape.depth * math.cos(shape.bottom)),
            *(1.0 if model.nv > 1 else can.radius, can.effective_mass, load.mass, load.offset, load.inertia),
            *(scene.gravity * math.sin(scene.incline), scene.gravity * math.cos(scene.incline)),
            *(scene.mass, arm, scene.downhill_weight, scene.downhill_weight / mass if sliding else 0.0, friction),
            # Friction over drive, over the force of the swinging load, and over phi_ddot.
            *((turning / mass, turning / mass, 0.0) if sliding else (1.0, 1.0, -scene.mass * can.radius)),
        )
        self._found, self._work, self._before = np.zeros(len(_NAMES)), np.zeros((2, _SIZES)), (0.0,) * 5
        self._found[_LOWEST] = math.inf
        self._end = np.empty(0), np.empty((0, 2 * model.nv))

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        record, last = self.record, self._end
        row, self._before = _update(self._numbers, times, states, self._found, *self._work, self._before)
        vars(record).update(zip(_NAMES, self._found.tolist(), strict=True))
        self._end = times[-1:].copy(), states[-1:].copy()
        if row < len(times) and record.rolling_ends_at == math.inf:
            before = (times[row - 1 : row], states[row - 1 : row]) if row else last
            for at, state in (before, (times[row : row + 1], states[row : row + 1])):
                if len(at):
                    self.add_forces(to_coordinates(self._model, self._scene, state, at))
            record.rolling_ends_at = min(record.rolling_ends_at, float(times[row]))


@kernel
def _update(numbers, times, states, found, start, now, before):
    """Add states at `times` [s] to what was `found`, as `Record.add` does, and return the first row that cannot roll.

    The forces are those of a state and of the middle since the one before. `now` is space for what a state has, and
    `start` for what the first one had. What was `before`, and is returned anew, are phi0, the speed of the axis at the
    start less its swing, and time, phi and its rate at the last state.
    """
    optimize_for_size()
    base, chord, coupling, ramp, lean, weight, unit, can_mass, load_mass, offset, load_inertia = numbers[:11]
    down, normally, all_mass, arm, drive, steady, friction, by_drive, by_swing, by_turning = numbers[11:]
    size, moment, slips = states.shape[1] // 2, load_mass * offset, times.size
    phi0, speed0, last, last_phi, last_rate = before
    for row in range(times.size):
        time, phi, rate = times[row], states[row, size - 1], states[row, 2 * size - 1]
        u, speed = unit * states[row, 0], unit * states[row, size]
        if time == 0.0:
            phi0, speed0, last, last_phi, last_rate = phi, speed - arm * math.cos(phi) * rate, time, phi, rate
        sin = cos = square = inertia = 0.0
        for part in range(2):  # in the middle since the last state, and at this one
            angle, turning = phi, rate
            if part == 0:  # which the start has not: its numbers are NaN, and do not count
                step = time - last
                angle = (phi + last_phi) / 2 + step * (last_rate - rate) / 8
                turning = 1.5 * (phi - last_phi) / step - (rate + last_rate) / 4
            sin, cos, square = math.sin(angle), math.cos(angle), turning * turning
            inertia = base + chord * (1 - cos) / 2 + coupling * sin * sin
            torque = ramp - weight * sin + lean * cos - sin * (chord / 4 + coupling * cos) * square
            gain = torque / inertia
            normal = all_mass * normally + moment * (sin * gain + cos * square)
            pull = abs(by_drive * drive + by_swing * moment * (cos * gain - sin * square) + by_turning * gain)
            if normal < found[_LOWEST]:
                found[_LOWEST] = normal
            if pull > found[_NEEDED] * normal:
                found[_NEEDED] = pull / normal if normal > 0 else np.inf
            if pull > friction * normal and slips == times.size:
                slips = row
        along, across = speed - offset * cos * rate, offset * sin * rate
        kinetic = (can_mass * speed * speed + load_mass * (along * along + across * across) + load_inertia * square) / 2
        middle, half = (phi + phi0) / 2, (phi - phi0) / 2
        torque = weight * math.sin(middle) - lean * math.cos(middle)
        now[0], now[1], now[5], now[6], now[7] = phi, u, rate, inertia * square / 2, kinetic
        now[2] = kinetic - all_mass * u * down - moment * (normally * cos - down * sin)
        now[3] = now[6] - 2 * ramp * half + 2 * torque * math.sin(half)
        now[4] = u - arm * sin - time * (speed0 + steady * time / 2) if size > 1 else 0.0
        for k in range(now.size):
            if time == 0.0 and k < _CHANGES:
                start[k] = now[k]
            now[k] -= start[k]
            found[k] = max(found[k], abs(now[k]))
        covered = abs(phi - last_phi)
        found[_COVERED] += covered
        found[_DRIFT] += now[3] * covered
        found[_LARGEST_DRIFT] = max(found[_LARGEST_DRIFT], abs(found[_DRIFT]))
        last, last_phi, last_rate = time, phi, rate
    return slips, (phi0, speed0, last, last_phi, last_rate)
