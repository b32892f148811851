"""Time by quadrature and its inverse, on integrals known in closed form."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from mpmath import MPContext

from mjbeer.theory.quadrature import Clock

mp = MPContext()
mp.dps = 30

# Times and phases are sums of a few dozen panels, each good to its rounding, and beside a peak to that of the
# angle. Measured: 8e-15 of the period with a gap of 1e-6, else 1e-15.
ROUNDING = 1e-14


class Counted:
    """A rate that counts how often it is evaluated."""

    def __init__(self, rate: Callable[[np.ndarray], np.ndarray]) -> None:
        self.rate, self.evaluations = rate, 0

    def __call__(self, psi: np.ndarray) -> np.ndarray:
        self.evaluations += psi.size
        return self.rate(psi)


@pytest.mark.parametrize("period", [None, 2 * math.pi])
def test_constant_rate(period: float | None) -> None:
    clock = Clock(lambda psi: np.full_like(psi, 2.5), -1.0, period)
    time = np.array([0.0, 1.0, 0.3, 40.0, 1e4])
    assert clock.phase(time) == pytest.approx(-1 + time / 2.5, rel=ROUNDING)
    if period is not None:
        assert clock.period == pytest.approx(2.5 * period, rel=ROUNDING)


def test_start_is_at_time_zero() -> None:
    for period in (None, 1.0):
        clock = Clock(lambda psi: 2 + np.cos(2 * math.pi * psi), 0.7, period)
        assert clock.phase(np.zeros(2)) == pytest.approx([0.7, 0.7], abs=ROUNDING)
        assert clock.phase(np.empty(0)).shape == (0,)


@pytest.mark.parametrize("gap", [0.9, 0.1, 1e-3, 1e-6])
def test_pendulum(gap: float) -> None:
    """dt/dpsi = 1/sqrt(1 - m sin^2 psi): a period of 4 K(m), and psi the amplitude function."""
    # 1 - m sin^2 psi, arranged not to cancel where m = 1 - gap is near 1
    rate = Counted(lambda psi: 1 / np.sqrt(np.cos(psi) ** 2 + gap * np.sin(psi) ** 2))
    clock, m = Clock(rate, 0.0, 2 * math.pi), 1 - mp.mpf(gap)
    quarter = mp.ellipk(m)
    assert abs(clock.period / (4 * quarter) - 1) < ROUNDING
    time = np.array([0.05, 0.5, 0.99, 1.01, 2.7, 3.9, 41.3]) * float(quarter)
    for t, psi in zip(time, clock.phase(time), strict=True):
        # A turn of the phase is 2 pi rounded, and a phase that is off by so much is off by its rate in time.
        slowest = float(rate(np.array(psi)))
        assert abs(mp.ellipf(mp.mpf(psi), m) - t) < ROUNDING * (t + psi * slowest)
    assert rate.evaluations < 10_000


def test_a_million_turns() -> None:
    clock = Clock(lambda psi: 1 + 0.5 * np.cos(psi), 0.0, 2 * math.pi)
    time = 1e6 * 2 * math.pi + 1.0
    psi = mp.findroot(lambda x: x + mp.sin(x) / 2 - (mp.mpf(time) - 2_000_000 * mp.pi), 0.7)
    assert float(clock.phase(np.array([time]))[0]) == pytest.approx(2e6 * math.pi + float(psi), rel=ROUNDING)


@pytest.mark.parametrize(
    ("rate", "time"),
    [
        (lambda psi: 1 + psi**2, lambda psi: psi + psi**3 / 3),
        (lambda psi: np.exp(np.sin(psi)) * np.cos(psi) + 3, lambda psi: np.exp(np.sin(psi)) + 3 * psi),
        # A peak as a motion has that hardly passes a barrier, and another a million times as sharp.
        (lambda psi: 1 / np.hypot(psi, 1e-3), lambda psi: np.arcsinh(psi / 1e-3)),
        (lambda psi: 1 / np.hypot(psi, 1e-9), lambda psi: np.arcsinh(psi / 1e-9)),
        # A small fast ripple is no rounding noise, however alike they look at first.
        (lambda psi: 1 + 1e-6 * np.cos(500 * psi), lambda psi: psi + 2e-9 * np.sin(500 * psi)),
    ],
    ids=["cubic", "waves", "peak", "needle", "ripple"],
)
def test_round_trip(rate: Callable, time: Callable) -> None:
    clock, psi = Clock(rate, -3.0), np.linspace(-3, 30, 67)[::-1]
    elapsed = time(psi) - time(-3.0)
    slowest = np.array([float(rate(np.array(each))) for each in psi])
    # What the times themselves are rounded by comes back divided by the rate.
    tolerance = ROUNDING * (30 + 1 / slowest + elapsed.max() / slowest)
    assert (np.abs(clock.phase(elapsed) - psi) < tolerance).all()


def test_asked_again_further_on() -> None:
    clock = Clock(lambda psi: 1 + psi**2, 0.0)
    for psi in (0.5, 40.0, 3.0):
        assert float(clock.phase(np.array([psi + psi**3 / 3]))[0]) == pytest.approx(psi, rel=ROUNDING)


def test_first_stretch_is_all_that_is_needed() -> None:
    """A rate that takes pains only far ahead costs nothing if no time that late is asked for."""
    rate = Counted(lambda psi: 2 + np.sin(psi**2))
    assert float(Clock(rate, 0.0, stretch=1e-3).phase(np.array([1e-4]))[0]) == pytest.approx(5e-5, rel=1e-8)
    assert rate.evaluations < 100


@pytest.mark.parametrize("noise", [1e-13, 1e-12])
def test_noise_is_not_chased(noise: float) -> None:
    """The rounding of a large angle makes a rate noisy: halving intervals for ever would not help."""
    rate = Counted(lambda psi: 1 + 0.3 * np.cos(psi) + noise * np.sin(1e12 * psi))
    clock = Clock(rate, 0.0, 2 * math.pi)
    assert clock.period == pytest.approx(2 * math.pi, rel=noise)
    assert rate.evaluations < 10_000


def test_noisy_peak_is_not_chased() -> None:
    """1 - m sin^2 psi as it stands: beside the peak, 1e-6 wide, only four digits of it are right."""
    rate = Counted(lambda psi: 1 / np.sqrt(1 - (1 - 1e-12) * np.sin(psi) ** 2))
    clock = Clock(rate, 0.0, 2 * math.pi)
    # Both peaks are 1e-6 wide and hold their share, about 1/30, of the time; rounding there is 2e-16 / 1e-12.
    assert clock.period == pytest.approx(float(4 * mp.ellipk(1 - mp.mpf(1e-12))), rel=1e-5)
    assert rate.evaluations < 1_000_000


def test_only_what_repeats_has_a_period() -> None:
    with pytest.raises(ValueError, match="not periodic"):
        _ = Clock(lambda psi: 1 + psi**2, 0.0).period
