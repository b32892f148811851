"""Corners of a damped motion: where the slip rate w or the can's rate vanishes, |w| or |u_dot| in the law has one.

A step ends there, and the next one has the other sign.
"""

import math

import numpy as np
from numpy.polynomial import legendre

from mjbeer.theory.collocation import FRACTIONS, STAGES
from mjbeer.theory.place import ROUNDINGS
from mjbeer.theory.viscous_equations import ViscousEquations
from mjbeer.theory.viscous_step import State, Step, attempt

Sides = tuple[float, float]
"""The signs of w and of roll_dot."""
_CORNER = 1e-10
"""How far w or roll_dot may pass zero within a step, relative to itself. The error that this makes is its square."""
_GRID = np.linspace(-1, 1, 4 * STAGES + 1)
_GRID_VALUES = legendre.legvander(_GRID, STAGES)


def signs(equations: ViscousEquations, state: State) -> Sides:
    """Return the signs of w and roll_dot, or where they are zero, of those that follow."""
    roll_dot = state.phi_dot + state.slip
    if abs(roll_dot) <= ROUNDINGS * abs(state.slip):
        roll_dot = 0.0
    sides = math.copysign(1, state.slip), math.copysign(1, roll_dot)
    if all(equations.smooth) or (state.slip and roll_dot):
        return sides
    phi_ddot, slip_dot = equations.rates(state.phi, state.phi_dot, state.slip, sides)[0]
    return (
        sides[0] if state.slip else math.copysign(1, slip_dot),
        sides[1] if roll_dot else math.copysign(1, phi_ddot + slip_dot),
    )


def corner(equations: ViscousEquations, step: Step, sides: Sides) -> tuple[float, int] | None:
    """Return the share of the step after which w (0) or roll_dot (1) changes its sign, if there is a corner."""
    found = []
    for which, (smooth, side) in enumerate(zip(equations.smooth, sides, strict=True)):
        if smooth:
            continue
        series = side * (step.series[:, 1] if which == 0 else step.series.sum(axis=1))
        values = _GRID_VALUES @ series
        if values.min() >= -_CORNER * np.abs(values).max():
            continue
        after = int(np.argmax(values < -_CORNER * np.abs(values).max()))
        before = after - 1
        while before > 0 and values[before] <= 0:
            before -= 1
        if values[before] <= 0 or after == 0:
            found.append((0.0, which))
            continue
        low, high = _GRID[before], _GRID[after]
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if legendre.legval(middle, series) > 0 else (low, middle)
        found.append(((1 + float(high)) / 2, which))
    return min(found, default=None)


def cut_at(
    equations: ViscousEquations, state: State, step: Step, found: tuple[float, int], sides: Sides, scales: np.ndarray
) -> Step | None:
    """Return a step up to the corner that was `found`, where w (0) or roll_dot (1) vanishes; None if it fails."""
    part, which = found
    guess, length = _within(step, part), part * step.length
    for _ in range(3):  # the polynomial of the longer step has its root where this one has it, but for its tail
        cut = attempt(equations, state, length, sides, guess, scales)
        if cut is None:
            return None
        phi_dot, slip = cut.stages[:, -1]
        rates = equations.rates(state.phi + cut.ends[:1], phi_dot, slip, sides)[0][:, 0]
        value, rate = (slip, rates[1]) if which == 0 else (phi_dot + slip, rates.sum())
        late, guess = float(value / rate) if rate else 0.0, cut.stages
        if abs(late) <= ROUNDINGS * length or not 0 < length - late < step.length:
            break
        length -= late
    if which == 0:
        cut.ends[2] = -state.slip
    else:  # phi_dot bears what is left: w may be many orders smaller, and its digits matter
        cut.ends[1] = -slip - state.phi_dot
    return cut


def _within(step: Step, part: float) -> np.ndarray:
    """Return phi_dot and w at the stages of the step that is the first `part` of another one."""
    return legendre.legval(2 * FRACTIONS * part - 1, step.series)
