"""The record of all steps of a smooth run, in compiled code: numba is imported only where it steps."""

import math

import numpy as np

from mjbeer.integrators.dynamics import compiled, inner
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene

_NAMES = (
    "largest_turn", "largest_distance", "angle_covered", "largest_rate", "swing_energy", "axis_drift", "lowest_normal",
    "needed_friction", "rolling_ends_at", "_kinetic", "_energy_change", "_swing_change", "_swing_drift",
    "_largest_swing_drift",
)  # fmt: skip
"""What a recorder finds, by the names of `Record`."""
_FOUND = np.dtype([(name, float) for name in (
    *_NAMES, "phi0", "u0", "speed0", "swing0", "energy0", "last_phi", "last_rate", "last_time",
)])  # fmt: skip
"""That, and at the start phi, u, the speed of the axis less its swing, J phi_dot^2 / 2 and the energy; and of the last
state phi, its rate and time."""
_HALVINGS = 50  # of the time between two states in which rolling ends


class SmoothRecorder:
    """The record of a run of a reduced model without damping: what `Recorder` makes, in a tenth of the time.

    It is an `Observer` of steps so short that forces need not be looked for within them.
    """

    def __init__(self, scene: Scene, friction: float = math.inf) -> None:
        self._record, shape, can, load = Record(scene, friction), scene.oscillator, scene.can, scene.load
        mass, turning, sliding = scene.effective_mass, can.inertia / can.radius**2, scene.attachment == "sliding"
        numbers = (
            *(shape.base, shape.chord, shape.coupling, shape.ramp),
            *(shape.depth * math.sin(shape.bottom), shape.depth * math.cos(shape.bottom)),
            *(can.radius, can.effective_mass, load.mass, load.offset, load.inertia),
            *(scene.gravity * math.sin(scene.incline), scene.gravity * math.cos(scene.incline)),
            *(scene.mass, mass, scene.downhill_weight, friction),
            # Friction over drive, over the force of the swinging load, and over phi_ddot.
            *((turning / mass, turning / mass, 0.0) if sliding else (1.0, 1.0, -scene.mass * can.radius)),
        )
        found = np.zeros(1, _FOUND)
        found[["lowest_normal", "rolling_ends_at"]] = math.inf
        self._numbers, self._found = numbers, found

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        _update(self._numbers, self._found, times, states)

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        vars(self._record).update(zip(_NAMES, self._found[0].item(), strict=False))
        return self._record


@compiled()
def _update(numbers, found, times, states):
    """Add states at `times` [s] to what was `found`."""
    for row in range(times.size):
        _add(numbers, found[0], times[row], states[row])


@inner
def _add(numbers, found, time, state):
    """Add a state at a time [s], as `Record.add_conserved` and `Record.add_forces` do."""
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
        found.phi0, found.u0, found.speed0 = phi, u, speed - arm * cos * rate
        found.swing0, found.energy0, found.last_phi = swings, energy, phi
    phi0 = found.phi0
    found.largest_turn, found.largest_distance = (
        max(found.largest_turn, abs(phi - phi0)),
        max(found.largest_distance, abs(u - found.u0)),
    )
    found.largest_rate, found.swing_energy = max(found.largest_rate, abs(rate)), max(found.swing_energy, swings)
    found._kinetic = max(found._kinetic, kinetic)
    covered = abs(phi - found.last_phi)
    found.angle_covered += covered
    middle = (phi + phi0) / 2
    pulled = weight * math.sin(middle) - lean * math.cos(middle)
    gained = swings - found.swing0 - slope * (phi - phi0) + 2 * pulled * math.sin((phi - phi0) / 2)
    found._energy_change = max(found._energy_change, abs(energy - found.energy0))
    found._swing_change = max(found._swing_change, abs(gained))
    found._swing_drift += gained * covered
    found._largest_swing_drift = max(found._largest_swing_drift, abs(found._swing_drift))
    if size > 1:
        moved = u - arm * sin - (found.u0 - arm * math.sin(phi0))
        found.axis_drift = max(found.axis_drift, abs(moved - time * (found.speed0 + drive / mass * time / 2)))
    normal, pull, margin = _forces(numbers, sin, cos, square)
    found.lowest_normal = min(found.lowest_normal, normal)
    found.needed_friction = max(found.needed_friction, pull / normal if normal > 0 else math.inf)
    if margin < 0 and found.rolling_ends_at == math.inf:
        found.rolling_ends_at = _end_of_rolling(numbers, found, phi, rate, time) if time > 0 else 0.0
    found.last_phi, found.last_rate, found.last_time = phi, rate, time


@inner
def _end_of_rolling(numbers, found, phi, rate, time):
    """Return when rolling stopped being possible since the last state; phi is the cubic between the two meanwhile."""
    begin, step, low, high = found.last_phi, time - found.last_time, 0.0, 1.0
    first, last, change = step * found.last_rate, step * rate, phi - found.last_phi
    square, cube = 3 * change - 2 * first - last, first + last - 2 * change
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        angle = begin + middle * (first + middle * (square + middle * cube))
        turning = (first + middle * (2 * square + 3 * middle * cube)) / step
        if _forces(numbers, math.sin(angle), math.cos(angle), turning * turning)[2] < 0:
            high = middle
        else:
            low = middle
    return found.last_time + high * step


@inner
def _forces(numbers, sin, cos, square):
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
