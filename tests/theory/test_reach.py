"""How far exact theory reaches, and that it says where it does not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mjbeer import Scene, exact, frozen, sliding
from mjbeer.exceptions import ParameterError, ToleranceError
from mjbeer.theory.motion import UNCERTAIN


def test_all_turns_on_the_level_and_all_swings_are_alike() -> None:
    """They are not followed one by one, however many there are."""
    assert exact(frozen(0.0), 1e3, 0.0, 1e9).phi[0] > 1e11
    for scene in (frozen(), frozen(-0.1), sliding()):
        assert abs(exact(scene, 1e9, 0.3).phi[0]) < 1


@pytest.mark.parametrize("scene", [frozen(), sliding()])
def test_swings_of_two_gravities_agree_as_long_as_the_phase_has_digits(scene: Scene) -> None:
    """In units of sqrt(a/g) they are the same motion, and rounding alone tells them apart."""
    times = 1e9 * np.linspace(0.9, 1, 50)
    other = exact(replace(scene, gravity=3 * scene.gravity), times / math.sqrt(3), 1.0)
    assert 1e-8 < np.abs(exact(scene, times, 1.0).phi - other.phi).max() < UNCERTAIN


@pytest.mark.parametrize("scene", [frozen(), sliding()])
def test_a_time_at_which_the_phase_has_no_digits_is_refused(scene: Scene) -> None:
    with pytest.raises(ToleranceError, match=r"phi is not known until 1e\+13 s: rounding of the scene"):
        exact(scene, 1e13 * np.linspace(0.9, 1, 50), 1.0)


@pytest.mark.parametrize("turns", [10**4, 10**7, -(10**9)])
@pytest.mark.parametrize("incline", [0.0, 0.1, 1.0])
def test_a_start_many_turns_away_moves_like_one_that_is_near(turns: int, incline: float) -> None:
    """Whole turns are the rounding of the start off: 2e-16 of it."""
    time, shift = np.linspace(0, 1, 11), 2 * math.pi * turns
    near, far = exact(frozen(incline), time, 0.3), exact(frozen(incline), time, 0.3 + shift)
    assert np.abs(far.phi - shift - near.phi).max() < 1e-14 * abs(shift)
    assert np.abs(far.phi_dot - near.phi_dot).max() < 1e-13 * abs(shift)


def test_start_angles_have_a_limit() -> None:
    with pytest.raises(ParameterError, match=r"phi0 must be between -1e\+10 and 1e\+10 \[rad\], got 1e\+50"):
        exact(frozen(), 1.0, 1e50)
