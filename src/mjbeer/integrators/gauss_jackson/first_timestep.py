"""The first guess of the timestep of Gauss-Jackson that a tolerance allows; it need not be good."""

import math
from typing import NamedTuple

from mjbeer.integrators.gauss_jackson.swing_law import SwingLaw

_ORDER = 14
"""Power of the timestep with which the error of a cycle is assumed to grow.

The method's order is 13. One more suits random motions as well, to 4% of the timestep from 1e-5 to
1e-11 rad, and gives tight tolerances slightly longer steps, over which less rounding adds up."""
_SHARE = 0.34
"""The timestep at which the error of a cycle would be 1 rad, if it grew with this power so far,
divided by the distance of the nearest pole.

It was fitted to random motions. In 90 others, of sliding and frozen beer and of pendulums in
wheels, for 0.5 to 4 s from rest at up to 3 rad, the timestep that just reached a tolerance of 1e-11
to 1e-5 rad was 0.8 to 2.2 times the one given here; the median was 1.1 times."""
_LOOSEST = 1e-5
"""Tolerance [rad] above which the timestep grows no more: the method would become unstable."""
_FEWEST = 8
"""Least number of steps of a run."""
_FEWEST_CYCLES = 0.5
"""Least number of cycles over which an error is assumed to grow, however short a run is."""
_SMALLEST_SWING = 1e-3
"""Sine of half the amplitude below which a swing is as even as with this one."""


class FirstTimestep(NamedTuple):
    """A timestep in Sundman time, and how far the load turns in it."""

    timestep: float  # [s]
    largest_turn: float  # angle by which phi turns in a timestep, at most [rad]


def first_timestep(
    law: SwingLaw, phi0: float, phi_dot0: float, duration: float, tolerance: float
) -> FirstTimestep:
    """Return a timestep for runs of some `duration` [s] that should err by a `tolerance` [rad].

    The motion starts at `phi0` [rad] with the rate `phi_dot0` [rad/s], where Sundman time passes as
    fast as t. In that time phi is a pendulum, and its motion an elliptic function. Its Taylor
    series converges as far as its nearest pole, and this limits the steps of every method. Without
    a slope the pole lies at the imaginary time K'(k)/omega. Here omega is the rate of small swings,
    and k^2 the largest kinetic energy divided by that which turns the load over.
    """
    inertia = law.inertia(phi0)
    kinetic = _largest_kinetic_energy(law, phi0, phi_dot0, duration)
    largest_rate = math.sqrt(2 * kinetic / inertia)
    timestep = duration / _FEWEST
    if law.depth > 0:
        modulus = max(math.sqrt(kinetic / (2 * law.depth)), _SMALLEST_SWING)
        pole = _complementary_integral(modulus) * math.sqrt(inertia / law.depth)
        cycles = math.sqrt(law.depth / law.mean_inertia()) * duration / math.tau
        allowed = min(tolerance, _LOOSEST) / max(_FEWEST_CYCLES, cycles)
        timestep = min(timestep, _SHARE * pole * allowed ** (1 / _ORDER))
    return FirstTimestep(timestep, timestep * largest_rate)


def _largest_kinetic_energy(law: SwingLaw, phi0: float, phi_dot0: float, duration: float) -> float:
    """Return the largest kinetic energy of a motion [J], or a little more."""
    # V' = -ramp + depth sin(phi - bottom) vanishes at the rest, bottom + lean, and at the crests,
    # bottom + pi - lean and a turn before, where sin(lean) = ramp/depth. The middle between these
    # two crests is bottom - lean. Take the middle that is nearest to the start.
    has_well = law.depth > abs(law.ramp)
    lean = math.asin(law.ramp / law.depth) if has_well else math.copysign(math.pi / 2, law.ramp)
    middle = law.bottom - lean
    middle += math.tau * round((phi0 - middle) / math.tau)
    rest = middle + 2 * lean
    lower_crest = middle + math.copysign(math.pi, law.ramp)  # the one downhill
    energy = law.inertia(phi0) * phi_dot0**2 / 2 + law.potential(phi0)
    kinetic = max(0.0, energy - law.potential(rest))
    if has_well and energy <= law.potential(lower_crest):
        return kinetic
    # It turns over and over. In each turn, which takes 2 pi sqrt(J) / sqrt(2 E), the energy E grows
    # by 2 pi |ramp|: sqrt(2 E) grows by |ramp| / sqrt(J) a second.
    speed = math.sqrt(2 * (kinetic + 2 * law.depth))
    speed += abs(law.ramp) * duration / math.sqrt(law.mean_inertia())
    return speed**2 / 2


def _complementary_integral(modulus: float) -> float:
    """Return the complete elliptic integral K'(k).

    It is pi/2 divided by the arithmetic-geometric mean of 1 and k, and good to a thousandth: a
    first guess needs no more.
    """
    arithmetic = 1.0
    geometric = modulus
    while abs(arithmetic - geometric) > 1e-3 * arithmetic:
        mean = (arithmetic + geometric) / 2
        geometric = math.sqrt(arithmetic * geometric)
        arithmetic = mean
    return math.pi / (2 * arithmetic)
