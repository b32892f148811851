"""V's differences from crest, rest and turning point, against V itself in 40 digits: none may cancel."""

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import MPContext

from mjbeer.theory.oscillator import Crest, reduced, sinc, sinc_gap
from mjbeer.theory.place import Place

mp = MPContext()
mp.dps = 40

# Sums of three terms of which one may be half of another, of a few roundings each. Measured: 2e-15.
ROUNDING = 5e-15

slopes = st.one_of(st.just(0.0), st.floats(-300, 0).map(lambda power: 10**power), st.floats(0, 3))
sizes = st.floats(-30, 0).map(lambda power: 10**power)
signs = st.sampled_from([-1, 1])


def below(crest: Crest, x: Any) -> Any:
    """V(crest) - V(crest + x), from the torque that defines the crest, integrated by hand."""
    x = mp.mpf(x)
    return (crest.excess + crest.ramp) * x - crest.ramp * mp.sin(x) + mp.mpf(crest.curvature) * (1 - mp.cos(x))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(slopes, sizes, signs)
def test_heights(slope: float, size: float, sign: int) -> None:
    crest, x = Crest.of(slope, 1.0, -0.2), sign * 3 * size
    with mp.workdps(400):  # 1e-300 of a slope beside 1e-60 of a cosine
        exact = below(crest, x)
        scale = (crest.excess + crest.ramp * x**2) * abs(x) + crest.curvature * x**2
        assert abs(crest.below(x) - exact) <= ROUNDING * scale
        assert crest.above(-x) == crest.below(x)
        torque = crest.excess + crest.ramp * (1 - mp.cos(mp.mpf(x))) + crest.curvature * mp.sin(mp.mpf(x))
        assert abs(crest.torque(x) - torque) <= ROUNDING * (crest.excess + crest.ramp * x**2 + crest.curvature * abs(x))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(slopes, sizes, st.floats(0, 1))
def test_chord_from_a_turning_point(slope: float, size: float, share: float) -> None:
    """Every term is positive as long as the torque is downhill, and so up to the next equilibrium."""
    crest = Crest.of(slope, 1.0, 0.0)
    turn, length = size * (math.pi - crest.well / 2), share * (math.pi - crest.well / 2)
    with mp.workdps(400):
        exact = (below(crest, mp.mpf(turn) + length) - below(crest, turn)) / length if length else crest.torque(turn)
        assert abs(crest.chord(turn, length) - exact) <= 2 * ROUNDING * exact


@pytest.mark.parametrize("slope", [0.0, 1e-20, 0.3, 1 - 1e-9, 1.0, 1.5])
def test_crest_and_rest_are_where_v_is_level(slope: float) -> None:
    crest, bottom = Crest.of(slope, 1.0, -0.2), mp.mpf(-0.2)
    lean = mp.asin(mp.mpf(slope)) if slope < 1 else mp.pi / 2
    # asin(slope) changes by eps / curvature with the rounding of 1 - slope.
    tolerance = ROUNDING + 2e-16 / max(crest.curvature, 1e-8)
    assert abs(crest.offset - (bottom - lean)) < tolerance
    assert abs(crest.rest - (bottom + lean)) < tolerance
    assert abs(crest.well - (mp.pi - 2 * lean)) < 2 * tolerance
    assert crest.step == 2 * math.pi * slope


@pytest.mark.parametrize("angle", [math.pi, -math.pi, 3.0, 1e-9, 1e3, 12345 * math.pi, -1e15, 1e15, 1e50])
def test_angles_of_any_size_are_reduced_exactly(angle: float) -> None:
    with mp.workdps(120):
        for reduced, offset in ((past_zero(angle), mp.mpf(0)), (past_pi(angle), mp.pi)):
            turned = mp.mpf(angle) - offset
            exact = turned - 2 * mp.pi * mp.nint(turned / (2 * mp.pi))
            assert abs(reduced - exact) <= 4e-16 * abs(exact)


@pytest.mark.parametrize("slope", [0.0, 1e-12, 0.3, 0.99, 2.0])
@pytest.mark.parametrize("angle", [0.3, -0.3, math.pi, -3.0, 2.9, -1.0, 40.0, -1e15, 1e9])
def test_place(slope: float, angle: float) -> None:
    """Both distances are those of the angle, and lie in the well and in the turn that belong together."""
    crest = Crest.of(slope, 1.0, -0.1)
    place, behind = Place.of(crest, angle), 2 * math.pi - crest.well
    with mp.workdps(60):
        for distance, origin in ((place.past, mp.pi + crest.offset), (place.from_rest, mp.mpf(crest.rest))):
            turns = (mp.mpf(angle) - origin - distance) / (2 * mp.pi)
            assert abs(turns - mp.nint(turns)) < ROUNDING
    with mp.workdps(60):  # the crests on both sides, and V(crest) - V(place) by the torque
        ahead = below(crest, place.past if place.past < 0 else mp.mpf(place.from_rest) - crest.well)
        behind_it = below(crest, mp.mpf(place.past) + (2 * mp.pi if place.past < 0 else 0))
    if slope < 1:
        assert abs(place.below_ahead(crest) - ahead) < 4 * ROUNDING
        assert abs(place.below_behind(crest) - behind_it) < 4 * ROUNDING
    assert -crest.well <= place.past <= behind
    assert -behind <= place.from_rest <= crest.well
    assert (place.past < 0) == (place.from_rest > 0)


@pytest.mark.parametrize("slope", [0.0, 1e-12, 0.3, 0.99])
@pytest.mark.parametrize("at_crest", [True, False])
@pytest.mark.parametrize("by", [1e-3, -1e-3, 1e-17, -1e-17])
def test_a_place_moves_into_the_next_well_and_the_next_turn(slope: float, at_crest: bool, by: float) -> None:
    crest, little = Crest.of(slope, 1.0, -0.1), math.copysign(1e-18, -by)
    ahead, behind = crest.well, crest.well - 2 * math.pi
    if at_crest:
        place = Place(little, ahead if little < 0 else behind)
    else:
        place = Place(-behind if little < 0 else -ahead, little)
    moved = place.moved(crest, by)
    assert (moved.past < 0) == (moved.from_rest > 0)
    assert (moved.past < 0) != (place.past < 0)
    for after, before in ((moved.past, place.past), (moved.from_rest, place.from_rest)):
        assert abs(math.remainder(after - before - by, 2 * math.pi)) < ROUNDING


@pytest.mark.parametrize("k", [1, -3, 7, 1001, 1999])
def test_an_odd_multiple_of_pi_is_the_top(k: int) -> None:
    crest = Crest.of(0.0, 1.0, 0.0)
    for angle in (k * math.pi, math.radians(180 * k)):
        assert Place.of(crest, angle).on_top(angle)
    for ulps in (-3, 3):
        angle = k * math.pi + ulps * math.ulp(k * math.pi)
        assert not Place.of(crest, angle).on_top(angle)


def test_far_out_a_double_is_itself() -> None:
    """An eps of 1e15 rad is 0.2 rad: too far from a top to be meant as one."""
    crest = Crest.of(0.0, 1.0, 0.0)
    for angle in (math.pi * (2 * round(1e15 / (2 * math.pi)) + 1) + k / 8 for k in range(-2, 3)):
        assert not Place.of(crest, angle).on_top(angle)


@pytest.mark.parametrize("x", [0.0, 1e-100, 1e-8, 0.5, 0.999, 1.0, 1.001, 3.0, 6.0])
def test_sinc(x: float) -> None:
    exact = mp.sin(mp.mpf(x)) / x if x else mp.mpf(1)
    assert abs(sinc(x) - exact) <= 3e-16
    with mp.workdps(700):
        gap = 1 - mp.sin(mp.mpf(x)) / x if x else mp.mpf(0)
        assert abs(sinc_gap(x) - gap) <= 1e-15 * gap
