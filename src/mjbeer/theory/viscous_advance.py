"""The next step of a damped motion: as long as its polynomial, what is below rounding, and corners allow.

Each step is a collocation polynomial whose last terms are below rounding.
"""

import math

import numpy as np
from numpy.polynomial import legendre

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.collocation import FRACTIONS, STAGES
from mjbeer.theory.viscous_corners import Sides, corner, cut_at, signs
from mjbeer.theory.viscous_equations import ViscousEquations
from mjbeer.theory.viscous_step import State, Step, attempt

_TAIL = 1e-14
"""Size of the terms of a step's polynomials that may be missing, relative to the rates. The step's end is far better
than that, as the method's order is twice the degree."""
_GROWTH = 10.0
"""Largest ratio of a step to the one before."""
_REJECTED = 0.8
"""A step is taken again if it should have been shorter by more than this factor; its terms are then below 1e-12."""
_UNSTABLE = 3.0
"""Largest growth, as the exponent, of what is below rounding in a step. The method would damp it in a longer one."""
_TINY = np.finfo(float).tiny


def first_length(equations: ViscousEquations, state: State) -> float:
    """Return a first step [s] that is short beside every time the motion has."""
    slopes = _rates(equations, state, signs(equations, state))[1]
    fastest = abs(slopes[1, 2]) + abs(slopes[0, 1]) + abs(state.phi_dot) + equations.natural
    fastest += math.sqrt(abs(equations.drive))
    return 1 / fastest if fastest > 0 else math.inf


def advance(
    equations: ViscousEquations, state: State, now: float, length: float, before: Step | None
) -> tuple[Step, float]:
    """Return the next step, and a length [s] for the one after it."""
    sides = signs(equations, state)
    slopes = _rates(equations, state, sides)[1]
    growth = _growth(slopes)
    steep = float(np.abs(slopes[1, 2]))
    forcing = equations.forcing(state.phi_dot)
    rate = max(equations.natural, abs(state.phi_dot))
    scales = np.array([rate, min(rate, forcing / steep) if steep > 0 else rate])
    flipped = False
    while True:
        length = min(length, _UNSTABLE / growth) if growth > 0 else length
        if not now + length > now:
            raise ToleranceError(f"the motion is too fast to be followed at {now:.6g} s")
        then = now + length
        step = attempt(equations, state, then - now, sides, _guess(state, then - now, before), scales)
        if step is None:
            length, before = length / 4, None
            continue
        factor = _factor(step, scales)
        if factor < _REJECTED:
            length *= max(factor, 0.1)
            continue
        found = corner(equations, step, sides)
        if found is None:
            return step, step.length * factor
        part, which = found
        if part == 0 and not flipped:
            sides = (-sides[0], sides[1]) if which == 0 else (sides[0], -sides[1])
            flipped = True
        elif part == 0:
            return step, step.length * factor
        else:
            cut = cut_at(equations, state, step, found, sides, scales)
            if cut is None:
                length *= part / 2
                continue
            return cut, step.length * factor


def _rates(equations: ViscousEquations, state: State, sides: Sides) -> tuple[np.ndarray, np.ndarray]:
    return equations.rates(state.phi, state.phi_dot, state.slip, sides)


def _growth(slopes: np.ndarray) -> float:
    """Return a bound on the rate [1/s] at which what is below rounding may grow; 0 if it does not.

    The roots of s^3 + A s^2 + B s + C are not computed, which are of very different sizes where the damping is strong:
    a coefficient that is negative allows a positive root, which each that is positive holds down.
    """
    (phi_phi, phi_rate, phi_slip), (slip_phi, slip_rate, slip_slip) = slopes.tolist()
    square = -(phi_rate + slip_slip)
    linear = phi_rate * slip_slip - phi_slip * slip_rate - phi_phi
    constant = phi_phi * slip_slip - phi_slip * slip_phi
    growth = max(0.0, -square)
    if linear < 0:
        growth += min(math.sqrt(-linear), -linear / square if square > 0 else math.inf)
    if constant < 0:
        by_square = math.sqrt(-constant / square) if square > 0 else math.inf
        growth += min(math.cbrt(-constant), by_square, -constant / linear if linear > 0 else math.inf)
    return growth


def _guess(state: State, length: float, before: Step | None) -> np.ndarray:
    """Return phi_dot and w at the stages of a step, as the one before goes on, if this one is not much longer."""
    if before is None or length > 1.5 * before.length:
        return np.repeat([[state.phi_dot], [state.slip]], STAGES, axis=1)
    return legendre.legval(1 + 2 * FRACTIONS * (length / before.length), before.series)


def _factor(step: Step, scales: np.ndarray) -> float:
    """Return by what factor the step might be longer, from how fast the terms of its polynomials fall."""
    sizes = np.abs(step.series) / (np.maximum(scales, np.abs(step.stages).max(axis=1)) + _TINY)
    tails = np.maximum.accumulate(sizes[:STAGES].max(axis=1)[::-1])[::-1]
    small = np.flatnonzero(tails <= _TAIL)
    if not len(small):
        return 0.9 * float((_TAIL / tails[-1]) ** (1 / STAGES))
    return min(_GROWTH, 0.95 * STAGES / max(float(small[0]), 1.0))
