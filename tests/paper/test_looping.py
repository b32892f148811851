"""Ripples: amplitudes at multiples of a frequency, and those of loops against exact theory."""

import math

import numpy as np
import pytest

from mjbeer import Can, exact, simulate, sliding
from mjbeer.paper.looping import cosines, loop, sines


def test_amplitudes() -> None:
    x = 2 * math.pi * np.arange(64) / 64
    values = 0.5 * np.sin(x) - 2 * np.sin(3 * x) + 7 * np.cos(2 * x) + 1
    assert sines(values)[:4] == pytest.approx([0, 0.5, 0, -2], abs=1e-14)
    assert cosines(values)[1:4] == pytest.approx([0, 7, 0], abs=1e-14)


@pytest.mark.parametrize("can", [Can.massless(), Can.sheet_metal()])
@pytest.mark.parametrize("start", [45.0, 120.0])
def test_a_turn_is_that_of_exact_theory(can: Can, start: float) -> None:
    """DOP853 takes 64 steps a turn, which near the separatrix leaves 2e-11 rad."""
    scene = sliding(can=can)
    seen = loop(scene, start)
    turn = 2 * math.pi / seen.rate
    assert exact(scene, [turn], 0.0, start).phi[0] == pytest.approx(2 * math.pi, abs=1e-10)
    times = turn * np.arange(256) / 256
    truth = exact(scene, times, 0.0, start)
    assert seen.phi == pytest.approx(sines(truth.phi - seen.rate * times), abs=1e-10)


@pytest.mark.parametrize(("start", "loops", "presses"), [(39.3, False, True), (39.5, True, True), (47.5, True, False)])
def test_a_can_stays_on_its_incline_only_while_its_beer_loops_slowly(start: float, loops: bool, presses: bool) -> None:
    """Half-full, 10 degrees: loops from 39.4 rad/s at the bottom on, and parts from the incline from 47.4 rad/s on."""
    run = simulate(sliding(), 1.0, 0.0, start, tolerance=1e-8)
    assert (run.phi.max() > 2 * math.pi) == loops
    assert math.isinf(run.rolls_until()) == presses
