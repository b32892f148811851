"""How far exact theory reaches: how many turns it can follow, and how long rounding leaves the phase its digits."""

import math

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.trust import ERROR

_FARTHEST = 1e6
"""Largest angle [rad] through which a load may turn on a slope, where no two turns are alike: to follow each of them
takes half a minute and a gigabyte."""
_ROUNDINGS = 2
"""Largest error of a period over the spacing of doubles (measured, at periods that differ by factors of sqrt(3) and
more)."""


def check_turns(oscillator: Oscillator, end: float, phi0: float, phi_dot0: float) -> None:
    """Check that a motion on a slope does not turn so far until `end` [s] that its turns are too many to follow.

    The angle is estimated with the mean of J, which after many turns is right to a fourth.

    Raises:
      ParameterError: if it does.
    """
    if oscillator.slope < 0:
        oscillator, phi0 = oscillator.mirror(), -phi0
    mean = oscillator.base + oscillator.chord / 2
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    turned = math.sqrt(2 * (kinetic + 2 * oscillator.depth) / mean) * end + oscillator.slope / mean * end**2 / 2
    if oscillator.slope == 0 or turned <= _FARTHEST:
        return
    if oscillator.slope < oscillator.depth:
        top = oscillator.barrier()
        start = phi0 - 2 * math.pi * math.ceil((phi0 - top) / (2 * math.pi))
        if oscillator.surplus(top, start, kinetic) < 0:
            return  # it swings in a well, and all swings are alike
    raise ParameterError(
        f"on a slope exact theory follows a load through at most {_FARTHEST:g} rad, got {end!r} s from phi_dot0 = "
        f"{phi_dot0!r} rad/s, in which it turns by about {turned:.1g} rad"
    )


def check_phase(time: np.ndarray, phi: np.ndarray, phi_dot: np.ndarray) -> None:
    """Check that phi [rad] is right to `ERROR` at all `time` [s], whatever the rounding of the period.

    The error of the period is some roundings. The phase is then off by as many roundings of the time, and phi by that
    times `phi_dot` [rad/s]. For a can on Earth this takes a hundred thousand years.

    Raises:
      ParameterError: if it is not.
    """
    end, eps = float(time.max()), float(np.finfo(float).eps)
    error = _ROUNDINGS * eps * float(np.abs(phi_dot).max()) * end / max(1.0, float(np.ptp(phi)))
    if error > ERROR:
        raise ParameterError(
            f"time must be so short that rounding makes phi wrong by {ERROR:g} rad at most, got {end!r} s, after which "
            f"it is wrong by about {error:.1g} rad"
        )
