"""phi(t) of one degree of freedom, exactly: libration, rotation, and the roll down.

Each kind of motion has a phase psi in which dt/dpsi is smooth and positive, turning
points included:

- libration between two turning points: phi = c + d sin psi;
- a run that turns at phi_1 and goes downhill ever after: phi = phi_1 + psi^2;
- a run far from any turning point: phi = start +- psi.

E - V, which dt/dpsi divides by, is taken as a chord of V from a turning point, or from
the barrier that is near: as the plain difference it would lose its digits there.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.oscillator import Oscillator, sinc, sinc_gap
from mjbeer.theory.quadrature import Clock

_HARMONIC = 1e-8  # share of the well up to which the period is that of small swings, to an eps
_ROUNDING = 4 * float(np.finfo(float).eps)  # a start this near the barrier is on it, for all that doubles can tell


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
        width = 2 * self.half_width
        return self._rate(width * np.sin(math.pi / 4 + psi / 2) ** 2, width * np.sin(math.pi / 4 - psi / 2) ** 2)

    def phase(self, phi: float, phi_dot: float) -> float:
        """The phase psi at `phi` [rad] and `phi_dot` [rad/s]; beside a turning point it is phi_dot that tells."""
        rate = float(self._rate(phi - self.low, self.high - phi))
        return math.atan2(phi - self.centre, phi_dot * rate)

    def period(self) -> float:
        """Time of one full swing [s]."""
        return Clock(self.rate, 0.0, 2 * math.pi).period

    def _rate(self, above_low: np.ndarray | float, below_high: np.ndarray | float) -> np.ndarray:
        # dt/dpsi = sqrt(J / 2D) with E - V = D above_low below_high. The chord of V from an end gives D well on that
        # side; the weights q^2 (q + 3p) and p^2 (p + 3q) of the shares p + q = 1 lead over from one to the other.
        width = above_low + below_high
        p, q = above_low / width, below_high / width
        from_low = _chord(self.oscillator, self.low, 1, above_low) * q * (q + 3 * p)
        from_high = _chord(self.oscillator, self.high, -1, below_high) * p * (p + 3 * q)
        return np.sqrt(self.oscillator.inertia(self.low + above_low) * width / (2 * (from_low + from_high)))


def libration(oscillator: Oscillator, phi: float, kinetic: float = 0.0) -> Libration | None:
    """The libration through `phi` [rad] with `kinetic` energy [J]; None if that is rest at the bottom.

    `phi` lies in the well around the equilibrium, and the slope is not negative.
    """
    rest, top = oscillator.equilibrium(), oscillator.barrier()
    if oscillator.surplus(rest, phi, kinetic) <= 0:
        return None
    low = high = phi
    if kinetic > 0 or phi < rest:
        high = oscillator.turning_point(phi, kinetic, top, rest)
    if oscillator.slope == 0:
        half_width = max(high - rest, rest - low)
        low, high = rest - half_width, rest + half_width
    elif kinetic > 0 or phi > rest:
        low = oscillator.turning_point(phi, kinetic, top - 2 * math.pi, rest)
    # A swing of less than an ulp is rest, for all that doubles can tell.
    return Libration(oscillator, low, high) if min(high - rest, rest - low) > 0 else None


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Period [s] of the swing released from rest `amplitude` [rad] from the equilibrium."""
    rest = oscillator.equilibrium()
    start = rest + amplitude
    oscillator.require_libration(start)
    low, high = oscillator.separatrix()
    if oscillator.slope < 0:
        oscillator, start = oscillator.mirrored(), -start
    swing = libration(oscillator, start) if abs(amplitude) > _HARMONIC * min(high - rest, rest - low) else None
    return 2 * math.pi / oscillator.frequency() if swing is None else swing.period()


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """The angle phi [rad] and phi_dot [rad/s] at the non-negative times `time` [s].

    Raises:
      NoLibrationError: if the start lies exactly on the separatrix, where no time is finite.
    """
    if oscillator.slope < 0:
        phi, phi_dot = solve(oscillator.mirrored(), time, -phi0, -phi_dot0)
        return -phi, -phi_dot
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    if oscillator.slope < oscillator.depth:
        # Count whole turns off, so that the start is in the well around the equilibrium.
        top = oscillator.barrier()
        turns = 2 * math.pi * math.ceil((phi0 - top) / (2 * math.pi))
        start = phi0 - turns
        if kinetic == 0 and abs(math.remainder(phi0 - top, 2 * math.pi)) <= _ROUNDING * max(1, abs(phi0)):
            return _rest(time, phi0)
        spare = oscillator.surplus(top, start, kinetic)
        if spare < 0:
            swing = libration(oscillator, start, kinetic)
            phi, phi_dot = _rest(time, start) if swing is None else _librate(swing, time, start, phi_dot0)
            return phi + turns, phi_dot
        if spare == 0:
            raise NoLibrationError(
                f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s lies exactly on the separatrix: the motion "
                "takes for ever to reach the unstable equilibrium"
            )
    if kinetic == 0 and (oscillator.slope == 0 or oscillator.acceleration(phi0, 0) == 0):
        return _rest(time, phi0)
    # A run downhill that started a radian or more from its turn, and one uphill that will not have turned by then
    # (the turn may be 1e12 rad away; the clock looks ahead to up to three times the angle it needs), needs no turn.
    reach = math.sqrt(2 * (kinetic + 2 * oscillator.depth) / oscillator.base) * float(np.max(time, initial=0.0))
    clear = 1 if phi_dot0 > 0 else 3 * reach + 4
    if oscillator.slope == 0 or kinetic > 2 * oscillator.depth + oscillator.slope * clear:
        return _run(oscillator, time, phi0, kinetic, math.copysign(1.0, phi_dot0))
    return _roll_down(oscillator, time, phi0, phi_dot0, kinetic)


def _rest(time: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray]:
    return np.full_like(time, phi), np.zeros_like(time)


def _librate(swing: Libration, time: np.ndarray, start: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    psi = Clock(swing.rate, swing.phase(start, phi_dot0), 2 * math.pi).phase(time)
    phi_dot = swing.half_width * np.cos(psi) / swing.rate(psi)
    return swing.centre + swing.half_width * np.sin(psi), phi_dot


def _run(
    oscillator: Oscillator, time: np.ndarray, phi0: float, kinetic: float, sign: float
) -> tuple[np.ndarray, np.ndarray]:
    def rate(psi: np.ndarray) -> np.ndarray:
        phi = phi0 + sign * psi
        return np.sqrt(oscillator.inertia(phi) / (2 * oscillator.surplus(phi, phi0, kinetic)))

    psi = Clock(rate, 0.0, 2 * math.pi if oscillator.slope == 0 else None).phase(time)
    return phi0 + sign * psi, sign / rate(psi)


def _roll_down(
    oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float, kinetic: float
) -> tuple[np.ndarray, np.ndarray]:
    turn = phi0 if kinetic == 0 else _uphill_turn(oscillator, phi0, kinetic)

    def pace(phi: np.ndarray | float, rolled: np.ndarray | float) -> np.ndarray:  # dt/dpsi, `rolled` being psi^2
        fall = _chord(oscillator, turn, 1, rolled)
        if oscillator.slope < oscillator.depth:  # nearer to a barrier than to the turn, its surplus is the better one
            past = np.remainder(phi - oscillator.barrier() + math.pi, 2 * math.pi) - math.pi
            surplus = oscillator.surplus(phi, phi0, kinetic)
            fall = np.where(np.abs(past) < rolled, surplus / np.maximum(rolled, 1e-300), fall)
        return np.sqrt(2 * oscillator.inertia(phi) / fall)

    # From phi_dot0: phi0 - turn may have no digits. And psi - psi0 is the clock's phase: psi0 may be large.
    psi0 = phi_dot0 / 2 * float(pace(phi0, phi0 - turn))

    def angle(phase: np.ndarray) -> np.ndarray:
        return phi0 + phase * (2 * psi0 + phase)

    def rate(phase: np.ndarray) -> np.ndarray:
        return pace(angle(phase), (psi0 + phase) ** 2)

    phase = Clock(rate, 0.0, stretch=1 / (1 + 2 * abs(psi0))).phase(time)  # a radian or less
    return angle(phase), 2 * (psi0 + phase) / rate(phase)


def _uphill_turn(oscillator: Oscillator, phi0: float, kinetic: float) -> float:
    """Where a run up the incline turns, or a run down it came from [rad]: the first zero of E - V below `phi0`."""
    if oscillator.slope >= oscillator.depth:
        outer = phi0 - (kinetic + 2 * oscillator.depth) / oscillator.slope - 1
        return oscillator.turning_point(phi0, kinetic, outer, phi0)
    top, rest = oscillator.barrier(), oscillator.equilibrium()
    top -= 2 * math.pi * math.ceil((top - phi0) / (2 * math.pi))
    spare = float(oscillator.surplus(top, phi0, kinetic))
    top -= 2 * math.pi * max(0, math.ceil(spare / (2 * math.pi * oscillator.slope)))
    well = rest + 2 * math.pi * math.ceil((top - rest) / (2 * math.pi))
    return oscillator.turning_point(phi0, kinetic, top, min(phi0, well))


def _chord(oscillator: Oscillator, end: float, sign: int, length: np.ndarray | float) -> np.ndarray:
    """(V(end) - V(end + sign length)) / length [N m], smooth through length 0."""
    pull = sign * (oscillator.force(end) * sinc(length) + oscillator.slope * sinc_gap(length))
    return pull - oscillator.depth * np.cos(end - oscillator.bottom) * length / 2 * sinc(length / 2) ** 2
