"""phi(t) of one degree of freedom, exactly: libration, rotation, and the roll down.

Each kind of motion has a phase psi in which dt/dpsi is smooth and positive, turning
points included:

- libration between phi_1 and phi_2: phi = c + d sin psi, where
  E - V = (phi - phi_1)(phi_2 - phi) D and D is the second divided difference of -V,
  so dt/dpsi = sqrt(J / 2D);
- a run that turns at phi_1 and then goes downhill for ever: phi = phi_1 + psi^2;
- a run without a turning point ahead: phi = start +- psi.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.clock import Clock
from mjbeer.exceptions import NoLibrationError
from mjbeer.oscillator import Oscillator

_SINC_TERMS = 26  # z^26/53! is under 1e-16 for z <= pi^2, the largest that a libration needs


@dataclass(frozen=True)
class Libration:
    """The swing between two turning points."""

    oscillator: Oscillator
    low: float
    high: float

    @property
    def centre(self) -> float:
        return (self.low + self.high) / 2

    @property
    def half_width(self) -> float:
        return (self.high - self.low) / 2

    def rate(self, psi: np.ndarray) -> np.ndarray:
        """dt/dpsi [s]."""
        phi = self.centre + self.half_width * np.sin(psi)
        return np.sqrt(self.oscillator.inertia(phi) / (2 * self._curvature(phi)))

    def period(self) -> float:
        """Time of one full swing [s]."""
        return Clock(self.rate, 0.0, 2 * math.pi).period

    def _curvature(self, phi: np.ndarray) -> np.ndarray:
        depth, bottom = self.oscillator.depth, self.oscillator.bottom
        x, low, high = phi - bottom, self.low - bottom, self.high - bottom
        if self.oscillator.slope == 0:  # the well is symmetric, and the difference a product
            return depth / 2 * _sinc((high + x) / 2) * _sinc((high - x) / 2)
        middle_low, middle_high = (x + low) / 2, (x + high) / 2
        half_low, half_high = (x - low) / 2, (x - high) / 2
        even = (
            np.cos((middle_low + middle_high) / 2) * _sinc((high - low) / 4) * (_sinc(half_low) + _sinc(half_high))
        )
        odd = (np.sin(middle_low) + np.sin(middle_high)) * (half_low + half_high)
        return depth / 4 * (even - odd * _sinc_difference(half_low**2, half_high**2))


def libration(oscillator: Oscillator, phi: float, kinetic: float = 0.0) -> Libration | None:
    """The libration through `phi` [rad] with `kinetic` energy [J]; None if that is rest at the bottom.

    `phi` lies in the well around the equilibrium, and the slope is not negative.
    """
    rest, top = oscillator.equilibrium(), oscillator.barrier()
    if kinetic + float(oscillator.drop(np.float64(rest), phi)) <= 0:
        return None
    low = high = phi
    if kinetic > 0 or phi < rest:
        high = oscillator.turning_point(phi, kinetic, top, rest)
    if oscillator.slope == 0:
        half_width = max(high - rest, rest - low)
        low, high = rest - half_width, rest + half_width
    elif kinetic > 0 or phi > rest:
        low = oscillator.turning_point(phi, kinetic, top - 2 * math.pi, rest)
    return Libration(oscillator, low, high)


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Period [s] of the swing released from rest `amplitude` [rad] from the equilibrium."""
    if oscillator.slope < 0:
        return period(oscillator.mirrored(), -amplitude)
    if amplitude == 0:
        return 2 * math.pi / oscillator.frequency()
    start = oscillator.equilibrium() + amplitude
    oscillator.require_libration(start)
    swing = libration(oscillator, start)
    return 2 * math.pi / oscillator.frequency() if swing is None else swing.period()


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """phi [rad] and phi_dot [rad/s] at the non-negative times `time` [s].

    Raises:
      NoLibrationError: if the start lies exactly on the separatrix, where no time is finite.
    """
    if oscillator.slope < 0:
        phi, phi_dot = solve(oscillator.mirrored(), time, -phi0, -phi_dot0)
        return -phi, -phi_dot
    kinetic = float(oscillator.inertia(np.float64(phi0))) * phi_dot0**2 / 2
    if oscillator.slope < oscillator.depth:
        # Count whole turns off, so that the start is in the well around the equilibrium.
        top = oscillator.barrier()
        turns = 2 * math.pi * math.ceil((phi0 - top) / (2 * math.pi))
        start = phi0 - turns
        spare = kinetic + float(oscillator.drop(np.float64(top), start))
        if spare < 0:
            swing = libration(oscillator, start, kinetic)
            phi, phi_dot = _rest(time, start) if swing is None else _librate(swing, time, start, phi_dot0)
            return phi + turns, phi_dot
        if kinetic == 0 and start == top:
            return _rest(time, phi0)
        if spare == 0:
            raise NoLibrationError(
                f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s lies exactly on the separatrix: the motion "
                "takes for ever to reach the unstable equilibrium"
            )
    if kinetic == 0 and (oscillator.slope == 0 or oscillator.acceleration(np.float64(phi0), np.float64(0)) == 0):
        return _rest(time, phi0)
    if oscillator.slope == 0 or phi_dot0 > 0:
        return _run(oscillator, time, phi0, kinetic, math.copysign(1.0, phi_dot0))
    return _roll_down(oscillator, time, phi0, kinetic)


def _rest(time: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray]:
    return np.full_like(time, phi), np.zeros_like(time)


def _librate(swing: Libration, time: np.ndarray, start: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    sine = max(-1.0, min(1.0, (start - swing.centre) / swing.half_width))
    psi0 = math.asin(sine) if phi_dot0 >= 0 else math.pi - math.asin(sine)
    if phi_dot0 == 0:
        psi0 = math.copysign(math.pi / 2, sine)
    psi = Clock(swing.rate, psi0, 2 * math.pi).phase(time)
    phi_dot = swing.half_width * np.cos(psi) / swing.rate(psi)
    return swing.centre + swing.half_width * np.sin(psi), phi_dot


def _run(
    oscillator: Oscillator, time: np.ndarray, phi0: float, kinetic: float, sign: float
) -> tuple[np.ndarray, np.ndarray]:
    def rate(psi: np.ndarray) -> np.ndarray:
        phi = phi0 + sign * psi
        return np.sqrt(oscillator.inertia(phi) / (2 * (kinetic + oscillator.drop(phi, phi0))))

    psi = Clock(rate, 0.0, 2 * math.pi if oscillator.slope == 0 else None).phase(time)
    return phi0 + sign * psi, sign / rate(psi)


def _roll_down(
    oscillator: Oscillator, time: np.ndarray, phi0: float, kinetic: float
) -> tuple[np.ndarray, np.ndarray]:
    turn = phi0 if kinetic == 0 else _uphill_turn(oscillator, phi0, kinetic)

    def rate(psi: np.ndarray) -> np.ndarray:
        middle = turn + psi**2 / 2 - oscillator.bottom
        fall = oscillator.slope - oscillator.depth * np.sin(middle) * _sinc(psi**2 / 2)
        return np.sqrt(2 * oscillator.inertia(turn + psi**2) / fall)

    psi = Clock(rate, -math.sqrt(phi0 - turn)).phase(time)
    return turn + psi**2, 2 * psi / rate(psi)


def _uphill_turn(oscillator: Oscillator, phi0: float, kinetic: float) -> float:
    """Where a run up the incline turns [rad]: the first zero of E - V below `phi0`."""
    if oscillator.slope >= oscillator.depth:
        outer = phi0 - (kinetic + 2 * oscillator.depth) / oscillator.slope - 1
        return oscillator.turning_point(phi0, kinetic, outer, phi0)
    top, rest = oscillator.barrier(), oscillator.equilibrium()
    top -= 2 * math.pi * math.ceil((top - phi0) / (2 * math.pi))
    spare = kinetic + float(oscillator.drop(np.float64(top), phi0))
    top -= 2 * math.pi * max(0, math.ceil(spare / (2 * math.pi * oscillator.slope)))
    well = rest + 2 * math.pi * math.ceil((top - rest) / (2 * math.pi))
    return oscillator.turning_point(phi0, kinetic, top, min(phi0, well))


def _sinc(x: np.ndarray | float) -> np.ndarray:
    """sin(x)/x, to full relative precision at its zeros as well, unlike np.sinc."""
    x = np.where(x == 0, 1e-300, x)
    return np.sin(x) / x


def _sinc_difference(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(s(p) - s(q)) / (p - q) for s(z) = sin(sqrt z)/sqrt z, by its series, for 0 <= p, q <= pi^2."""
    total, power, mixed, factor = np.zeros_like(p), np.ones_like(q), np.ones_like(p), 1.0
    for k in range(1, _SINC_TERMS):
        factor /= -(2 * k) * (2 * k + 1)
        total += factor * mixed
        power = power * q
        mixed = mixed * p + power
    return total
