"""The two kinds of path of which the motions without damping are made.

Energy is conserved: J phi_dot^2 / 2 + V = E, and therefore dt = sqrt(J / (2 (E - V))) dphi.

An `Arc` leads to a turning point phi_t and back. There E - V = 0, and the integrand is infinite.
With phi = phi_t + s^2, or phi_t - s^2, |dphi| is 2 s ds, and E - V = V(phi_t) - V(phi) is
s^2 |torque|, where `torque` is the mean of -V' between phi_t and phi. The factor s cancels:

    dt/ds = 2 s sqrt(J / (2 s^2 |torque|)) = sqrt(2 J / |torque|).

`Turns` are whole turns in a row, each with a crest of V in its middle. There E - V is positive
throughout. If it is `energy` at the crest, then at the angle x past the crest

    dt/dx = sqrt(J / (2 (energy + V(crest) - V(crest + x)))).
"""

import math
from typing import Literal, NamedTuple

import numpy as np

from mjbeer.theory.launch import Launch
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.travel_time import TravelTime


class Place(NamedTuple):
    """Where on a path a motion is at some times."""

    passage: np.ndarray
    """The turn of the path in which it is; the most uphill one is 0."""
    angle: np.ndarray
    """How far it is past the crest of that turn, or past the rest in a swing [rad]."""
    phi_dot: np.ndarray
    """[rad/s]"""


class Arc:
    """The path from an angle `end` to the turning point and back.

    Both are measured past a landmark, the crest or the rest [rad]. The angle of this landmark, as
    the angles of legs are counted, is `origin` [rad].
    """

    def __init__(
        self,
        oscillator: Oscillator,
        landmark: Literal["crest", "rest"],
        turning_point: float,
        end: float,
        origin: float = 0.0,
    ) -> None:
        self._oscillator = oscillator
        self._landmark = landmark
        self._turning_point = turning_point
        self._origin = origin
        self._side = 1 if end > turning_point else -1  # phi = turning point + side s^2
        length = abs(end - turning_point)
        self._travel_time = TravelTime(self._dt_ds, 0.0, math.sqrt(length))  # of the way back
        self.duration = 2 * self._travel_time.duration

    def _dt_ds(self, s: np.ndarray) -> np.ndarray:
        """Return sqrt(2 J / |mean torque|) [s]."""
        length = self._side * s**2
        past = self._turning_point + length
        potential = self._oscillator.potential
        phi = potential.rest + past
        if self._landmark == "crest":
            phi = potential.phi_at(past)
        return np.sqrt(2 * self._oscillator.inertia(phi) / self._mean_torque(length))

    def _mean_torque(self, length: np.ndarray | float) -> np.ndarray:
        """Return the size of the mean -V' [N m] along a `length` [rad] from the turning point."""
        turning_point = self._turning_point
        if self._landmark == "rest":  # V looks the same upside down: x = -y
            turning_point = -turning_point
            length = -length
        return np.abs(self._oscillator.potential.mean_torque(turning_point, length))

    def time_of(self, launch: Launch) -> float:
        """Return how long this path had lasted when the motion started on it [s]."""
        past = launch.past_rest
        if self._landmark == "crest":
            past = launch.past_crest
            # `Launch` measures from the nearest crest, which may be the one ahead. This arc then
            # measures from the one behind, a turn further back.
            if past < 0 < self._turning_point:
                past += math.tau
        # The kinetic energy is E - V = s^2 |mean torque|.
        s = math.sqrt(launch.kinetic / float(self._mean_torque(past - self._turning_point)))
        since_turning = math.copysign(self._travel_time.time_at(s), self._side * launch.phi_dot)
        return self.duration / 2 + since_turning

    def place_at(self, time: np.ndarray) -> Place:
        """Return where the motion is at times [s] since the path began."""
        since_turning = time - self.duration / 2
        s, passage = self._travel_time.psi_at(np.abs(since_turning))
        angle = self._origin + (self._turning_point + self._side * s**2)
        # phi_dot = side 2 s ds/dt, and s falls before the turning point.
        phi_dot = self._side * np.copysign(2 * s / self._dt_ds(s), since_turning)
        return Place(passage, angle, phi_dot)


class Turns:
    """The path through whole turns in a row, downhill, or uphill with the time reversed.

    The `energies` are E - V at their crests [J]. They rise, as the ramp gives the load more in each
    turn downhill.
    """

    def __init__(self, oscillator: Oscillator, energies: np.ndarray, uphill: bool = False) -> None:
        self._oscillator = oscillator
        self._energies = energies
        self._uphill = uphill
        # A load that hardly passes the crest spends its time there. x = 0 is an edge of panels, as
        # doubles are dense beside it.
        self._travel_time = TravelTime(self._dt_dx, -math.pi, 0.0, math.pi)
        self.duration = self._travel_time.duration

    def _dt_dx(self, x: np.ndarray) -> np.ndarray:
        """Return 1 / speed [s] at angles `x` past the crests, of shape (turns, *x.shape)."""
        return 1 / self._speed(x, self._energies[:, None, None])

    def _speed(self, x: np.ndarray, energy: np.ndarray) -> np.ndarray:
        """Return |phi_dot| [rad/s] at angles `x` past a crest that is passed with `energy` [J]."""
        potential = self._oscillator.potential
        inertia = self._oscillator.inertia(potential.phi_at(x))
        return np.sqrt(2 * (energy + potential.below(x)) / inertia)

    def time_of(self, launch: Launch) -> float:
        """Return how long this path had lasted when the motion started on it [s]."""
        if self._uphill:
            lowest_turn = len(self._energies) - 1
            return self.duration - self._travel_time.time_at(launch.past_crest, lowest_turn)
        return self._travel_time.time_at(launch.past_crest)

    def place_at(self, time: np.ndarray) -> Place:
        """Return where the motion is at times [s] since the path began."""
        x, passage = self._travel_time.psi_at(self.duration - time if self._uphill else time)
        speed = self._speed(x, self._energies[passage])
        return Place(passage, x, -speed if self._uphill else speed)
