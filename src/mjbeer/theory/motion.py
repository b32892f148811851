"""phi(t) of one degree of freedom, exactly: a swing, or a motion that passes crests.

Each is computed by quadrature, in a phase in which dt/dpsi is smooth and positive; see `libration` and `roll_down`.
E - V is never a plain difference of heights, which would lose its digits beside turning points and crests. So the
result is that of a start and a scene that are changed by their rounding only. Where even that changes the motion, there
is an error instead.
"""

import math

import numpy as np

from mjbeer.exceptions import NoLibrationError, ToleranceError
from mjbeer.theory.certainty import UNCERTAIN, period_uncertainty, require_certain
from mjbeer.theory.libration import libration_through
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.start import Start

_LAST = 1e100
"""Latest time [s]: the square of a later one, to which the angle grows on a slope, may overflow."""


def solve(oscillator: Oscillator, time: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and phi_dot [rad/s] at the times `time` [s], none of them negative.

    phi is right to rounding, relative to the angle turned. Where that angle is so large that its rounding is a radian,
    nothing is known of the angle in its turn, and phi_dot is that of an angle so near.

    Raises:
      NoLibrationError: if the start is so near a separatrix that its rounding decides how the motion goes on.
      ToleranceError: if the times are so long that rounding of the scene changes phi, or if sizes, masses, gravity or
        speeds are of too many different orders of magnitude.
    """
    behind = oscillator.slope < 0 or (oscillator.slope == 0 and phi_dot0 < 0)
    sign, seen = (-1, oscillator.mirror()) if behind else (1, oscillator)
    start = Start.at(seen, sign * phi0, sign * phi_dot0)
    if start.kinetic == 0 and _unpulled(start, phi0):
        return np.full_like(time, phi0), np.zeros_like(time)
    try:
        turned, phi_dot = _move(start, time)
    except NoLibrationError as error:
        raise NoLibrationError(f"phi0 = {phi0!r} rad, phi_dot0 = {phi_dot0!r} rad/s {error}") from None
    return phi0 + sign * turned, sign * phi_dot


def _unpulled(start: Start, phi0: float) -> bool:
    """Return whether no torque acts at the start, as far as doubles can tell: on a barrier, or anywhere without one."""
    return start.oscillator.crest.excess == 0 and (start.place.on_top(phi0) or start.oscillator.depth == 0)


def _move(start: Start, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far phi has turned [rad], and phi_dot [rad/s], if rounding leaves that certain."""
    if np.max(time, initial=0.0) > _LAST:
        raise ToleranceError(f"phi cannot be computed later than at {_LAST:g} s, got {np.max(time):g} s")
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):  # what is not finite becomes an error
        try:
            turned, phi_dot = start.move(time)
        except NoLibrationError:  # exactly on the separatrix: until the motion nears the crest, both sides are alike
            turned, phi_dot = start.rounded(1).move(time)
        require_certain(start, time, turned=turned, phi_dot=phi_dot)
    return turned, phi_dot


def period(oscillator: Oscillator, amplitude: float) -> float:
    """Return the period [s] of the swing released from rest `amplitude` [rad] from the equilibrium.

    Raises:
      NoLibrationError: if `amplitude` is at or beyond the separatrix, or so near it that its rounding changes the
        period.
      ToleranceError: if sizes, masses and gravity are of too many different orders of magnitude.
    """
    oscillator.require_libration(oscillator.equilibrium() + amplitude)
    start = Start.beside_rest(*((oscillator.mirror(), -amplitude) if oscillator.slope < 0 else (oscillator, amplitude)))
    if start.level_ahead < 0:
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            libration = libration_through(start.oscillator, start.place)
            if libration is None:
                return 2 * math.pi / oscillator.frequency()
            if period_uncertainty(start, libration.period) <= UNCERTAIN:
                return libration.period
    raise NoLibrationError(
        f"amplitude {amplitude!r} rad is too near the separatrix: rounding of the scene changes the period "
        f"by more than {UNCERTAIN:g} of itself"
    )
