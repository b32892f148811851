"""The time along a path, and its inverse: there and back to rounding, or refused."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.travel_time import TravelTime

# Times and phases are sums of a few dozen panels, each good to its rounding. Measured: 1e-15.
TIME = 1e-14


@pytest.mark.parametrize(
    ("rate", "time"),
    [
        (
            lambda psi: np.exp(np.sin(psi)) * np.cos(psi) + 3,
            lambda psi: np.exp(np.sin(psi)) + 3 * psi,
        ),
        # A peak as a motion has that hardly passes a barrier, and another one much sharper.
        (lambda psi: 1 / np.hypot(psi, 1e-3), lambda psi: np.arcsinh(psi / 1e-3)),
        (lambda psi: 1 / np.hypot(psi, 1e-18), lambda psi: np.arcsinh(psi / 1e-18)),
        # A small fast ripple is no rounding noise, however alike they look at first.
        (lambda psi: 1 + 1e-6 * np.cos(500 * psi), lambda psi: psi + 2e-9 * np.sin(500 * psi)),
    ],
    ids=["waves", "peak", "needle", "ripple"],
)
def test_round_trip(rate: Callable, time: Callable) -> None:
    """From edges at which doubles are dense: the peaks are at 0."""
    clock = TravelTime(rate, -3.0, 0.0, 30.0)
    psi = np.linspace(-3, 30, 67)[::-1]
    elapsed = time(psi) - time(-3.0)
    slowest = np.array([float(rate(np.array(place))) for place in psi])
    # What the times themselves are rounded by comes back divided by the rate.
    tolerance = TIME * (30 + 1 / slowest + elapsed.max() / slowest)
    assert (np.abs(clock.psi_at(elapsed)[0] - psi) < tolerance).all()
    backwards = np.array([clock.time_at(float(place)) for place in psi])
    assert (np.abs(backwards - elapsed) < tolerance * slowest).all()


@pytest.mark.parametrize(
    "rate",
    [
        lambda psi: 1 + 1e-6 * np.cos(1e12 * psi),
        # Beside its peaks, which are 1e-6 wide, 1 - m sin^2 psi as it stands has only four digits.
        lambda psi: 1 / np.sqrt(1 - (1 - 1e-12) * np.sin(psi) ** 2),
        lambda psi: 1 / psi,
        lambda psi: np.where(psi > 1, math.inf, 1.0),
        lambda psi: np.full_like(psi, math.nan),
    ],
    ids=["noise", "cancellation", "pole", "infinite", "not a number"],
)
def test_what_is_no_smooth_function_is_refused(rate: Callable) -> None:
    """A number that is wrong and says nothing would be worse; and halving panels must come to an
    end."""
    with (
        np.errstate(over="ignore"),
        pytest.raises(ToleranceError, match="too many different orders of magnitude"),
    ):
        TravelTime(rate, 0.0, 2 * math.pi)
