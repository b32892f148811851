"""phi(t) of one degree of freedom, exactly, for three kinds of motion: libration, rotation and roll-down.

Each kind has a phase psi in which dt/dpsi is smooth and positive, at turning points too:

- a libration swings between two turning points: phi = c + d sin psi;
- a rotation meets no turning point, or none before the last time asked for: phi = phi_0 +- psi;
- a roll-down turns once, at phi_1, or could have come from a turn there, and goes downhill ever after:
  phi = phi_1 + psi^2.

dt/dpsi divides by E - V. Near a turning point that is computed as the slope of a chord of V
from that point, and near a barrier as a height from the barrier's top: the plain difference
would lose its digits at both.
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import NoLibrationError
from mjbeer.theory.oscillator import Oscillator, sinc, sinc_gap
from mjbeer.theory.quadrature import Clock

_HARMONIC = 1e-8
"""Amplitude over the half-width of the well up to which the period is that of small swings, to rounding."""
_ROUNDING = 4 * float(np.finfo(float).eps)
"""A start at rest that is this near the barrier, relative beyond 1 rad, is on it: doubles cannot tell the two apart."""


@dataclass(frozen=True)
class Libration:
    """A swing between two turning points."""

    oscillator: Oscillator
    low: float
    """The lower turning point [rad]."""
    high: float
    """The upper turning point [rad]."""

    @property
    def centre(self) -> float:
        """Return c, the angle midway between the turning points [rad]."""
        return (self.low + self.high) / 2

    @property
    def half_width(self) -> float:
        """Return d, half of the angle between the turning points [rad]."""
        return (self.high - self.low) / 2

    def rate(self, psi: np.ndarray) -> np.ndarray:
        """Return dt/dpsi [s] at the phases `psi` [rad]."""
        width = 2 * self.half_width
        return self._rate(width * np.sin(math.pi / 4 + psi / 2) ** 2, width * np.sin(math.pi / 4 - psi / 2) ** 2)

    def phase(self, phi: float, phi_dot: float) -> float:
        """Return the phase psi [rad] at `phi` [rad] and `phi_dot` [rad/s], well defined at the turning points too."""
        rate = float(self._rate(phi - self.low, self.high - phi))
        return math.atan2(phi - self.centre, phi_dot * rate)

    def period(self) -> float:
        """Return the time of one full swing [s]."""
        return Clock(self.rate, 0.0, 2 * math.pi).period

    def _rate(self, above_low: np.ndarray | float, below_high: np.ndarray | float) -> np.ndarray:
        # dt/dpsi = sqrt(J / 2D) with E - V = D above_low below_high. The chord of V from an end gives an accurate D
        # near that end; the weights q^2 (q + 3p) and p^2 (p + 3q), whose sum is 1, blend the two smoothly.
        width = above_low + below_high
        p, q = above_low / width, below_high / width
        from_low = _chord(self.oscillator, end=self.low, sign=1, length=above_low) * q * (q + 3 * p)
        from_high = _chord(self.oscillator, end=self.high, sign=-1, length=below_high) * p * (p + 3 * q)
        return np.sqrt(self.oscillator.inertia(self.low + above_low) * width / (2 * (from_low + from_high)))


def libration_through(oscillator: Oscillator, phi: float, kinetic: float = 0.0) -> Libration | None:
    """Return the libration that passes `phi` [rad] with `kinetic` energy [J]; None if it is rest at the equilibrium.

    `phi` must lie in the well around the equilibrium, and the slope must not be negative.
    """
    rest, top = oscillator.equilibrium(), oscillator.barrier()
    if oscillator.surplus(rest, phi, kinetic) <= 0:
        return None
    low = high = phi
    if kinetic > 0 or phi < rest:
        high = oscillator.turning_point(phi, kinetic, forbidden=top, allowed=rest)
    if oscillator.slope == 0:
        half_width = max(high - rest, rest - low)
        low, high = rest - half_width, rest + half_width
    elif kinetic > 0 or phi > rest:
        low = oscillator.turning_point(phi, kinetic, forbidden=top - 2 * math.pi, allowed=rest)
    # Doubles cannot tell a swing that is narrower than their spacing from rest.
    return Libration(oscillator, low, high) if min(high - rest, rest - low) > 0 else None


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of the swing released from rest `amplitude` [rad] from the equilibrium.

    Raises:
      NoLibrationError: if `amplitude` is at or beyond the separatrix.
    """
    rest = oscillator.equilibrium()
    start = rest + amplitude
    oscillator.require_libration(start)
    low, high = oscillator.separatrix()
    if oscillator.slope < 0:
        oscillator, start = oscillator.mirror(), -start
    small = abs(amplitude) <= _HARMONIC * min(high - rest, rest - low)
    libration = None if small else libration_through(oscillator, start)
    return 2 * math.pi / oscillator.frequency() if libration is None else libration.period()


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and phi_dot [rad/s] at the times `time` [s], none of them negative.

    Raises:
      NoLibrationError: if the start lies exactly on the separatrix.
    """
    if oscillator.slope < 0:
        phi, phi_dot = solve(oscillator.mirror(), time, phi0=-phi0, phi_dot0=-phi_dot0)
        return -phi, -phi_dot
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    if oscillator.slope < oscillator.depth:
        # Subtract whole turns, so that the start is in the well around the equilibrium.
        top = oscillator.barrier()
        turns = 2 * math.pi * math.ceil((phi0 - top) / (2 * math.pi))
        start = phi0 - turns
        if kinetic == 0 and abs(math.remainder(phi0 - top, 2 * math.pi)) <= _ROUNDING * max(1, abs(phi0)):
            return _rest(time, phi0)
        at_barrier = oscillator.surplus(top, start, kinetic)
        if at_barrier < 0:
            libration = libration_through(oscillator, start, kinetic)
            if libration is None:
                phi, phi_dot = _rest(time, start)
            else:
                phi, phi_dot = _librate(libration, time, phi0=start, phi_dot0=phi_dot0)
            return phi + turns, phi_dot
        if at_barrier == 0:
            raise NoLibrationError(
                f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s lies exactly on the separatrix: the motion "
                "takes for ever to reach the unstable equilibrium"
            )
    if kinetic == 0 and (oscillator.slope == 0 or oscillator.acceleration(phi0, 0) == 0):
        return _rest(time, phi0)
    # On a slope a motion is computed as a rotation if its turning point does not matter: downhill if that is a radian
    # or more behind, and uphill if it is out of reach, for it may be 1e12 rad away. The clock looks ahead up to three
    # times the angle that it needs.
    reach = math.sqrt(2 * (kinetic + 2 * oscillator.depth) / oscillator.base) * float(np.max(time, initial=0.0))
    clear = 1 if phi_dot0 > 0 else 3 * reach + 4
    if oscillator.slope == 0 or kinetic > 2 * oscillator.depth + oscillator.slope * clear:
        return _rotate(oscillator, time, phi0=phi0, kinetic=kinetic, sign=math.copysign(1.0, phi_dot0))
    return _roll_down(oscillator, time, phi0=phi0, phi_dot0=phi_dot0, kinetic=kinetic)


def _rest(time: np.ndarray, phi: float) -> tuple[np.ndarray, np.ndarray]:
    return np.full_like(time, phi), np.zeros_like(time)


def _librate(libration: Libration, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    psi = Clock(libration.rate, libration.phase(phi0, phi_dot0), 2 * math.pi).phase(time)
    phi_dot = libration.half_width * np.cos(psi) / libration.rate(psi)
    return libration.centre + libration.half_width * np.sin(psi), phi_dot


def _rotate(
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

    def rate_from_turn(phi: np.ndarray | float, square: np.ndarray | float) -> np.ndarray:
        """Return dt/dpsi [s] at `phi` [rad], which is the `square` of psi past the turn."""
        chord = _chord(oscillator, end=turn, sign=1, length=square)
        if oscillator.slope < oscillator.depth:  # nearer to a barrier than to the turn, the surplus is more accurate
            past = np.remainder(phi - oscillator.barrier() + math.pi, 2 * math.pi) - math.pi
            surplus = oscillator.surplus(phi, phi0, kinetic)
            chord = np.where(np.abs(past) < square, surplus / np.maximum(square, 1e-300), chord)
        return np.sqrt(2 * oscillator.inertia(phi) / chord)

    # psi0 comes from phi_dot0, because phi0 - turn may have no digits. The clock counts psi - psi0, because beside a
    # large psi0 a small difference has no digits.
    psi0 = phi_dot0 / 2 * float(rate_from_turn(phi0, phi0 - turn))

    def angle(advance: np.ndarray) -> np.ndarray:
        """Return phi [rad] at `advance` = psi - psi0."""
        return phi0 + advance * (2 * psi0 + advance)

    def rate(advance: np.ndarray) -> np.ndarray:
        """Return dt/dpsi [s] at `advance` = psi - psi0."""
        return rate_from_turn(angle(advance), (psi0 + advance) ** 2)

    one_radian = 1 / (1 + 2 * abs(psi0))  # of phi, or less
    advance = Clock(rate, 0.0, stretch=one_radian).phase(time)
    return angle(advance), 2 * (psi0 + advance) / rate(advance)


def _uphill_turn(oscillator: Oscillator, phi0: float, kinetic: float) -> float:
    """Return the turning point of a roll-down [rad], whether ahead or behind: the first zero of E - V below `phi0`."""
    if oscillator.slope >= oscillator.depth:
        forbidden = phi0 - (kinetic + 2 * oscillator.depth) / oscillator.slope - 1
        return oscillator.turning_point(phi0, kinetic, forbidden=forbidden, allowed=phi0)
    top, rest = oscillator.barrier(), oscillator.equilibrium()
    top -= 2 * math.pi * math.ceil((top - phi0) / (2 * math.pi))
    at_barrier = float(oscillator.surplus(top, phi0, kinetic))
    top -= 2 * math.pi * max(0, math.ceil(at_barrier / (2 * math.pi * oscillator.slope)))
    well = rest + 2 * math.pi * math.ceil((top - rest) / (2 * math.pi))
    return oscillator.turning_point(phi0, kinetic, forbidden=top, allowed=min(phi0, well))


def _chord(oscillator: Oscillator, end: float, sign: int, length: np.ndarray | float) -> np.ndarray:
    """Return (V(end) - V(end + sign length)) / length [N m], which is smooth through length 0."""
    linear = sign * (oscillator.force(end) * sinc(length) + oscillator.slope * sinc_gap(length))
    return linear - oscillator.depth * np.cos(end - oscillator.bottom) * length / 2 * sinc(length / 2) ** 2
