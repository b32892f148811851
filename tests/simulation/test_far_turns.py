"""A start whole turns away: the same motion, as accurate as a double near so large an angle is."""

import math

import numpy as np
import pytest

from mjbeer import (
    frozen,
    simulate,
    sliding,
)
from mjbeer.exceptions import (
    NoLibrationError,
    ToleranceError,
)
from mjbeer.model.setting import Rolling
from mjbeer.theory.oscillator import reduced
from tests.support.scenes import METAL, error


@pytest.mark.parametrize("phi0", [-8498.008127960406, 9424.77796076938, 700.1, 4.0])
@pytest.mark.parametrize("rolling", ["reduced", "equality", "contact"])
def test_whole_turns_at_the_start_change_nothing_but_the_angle(
    rolling: Rolling, phi0: float
) -> None:
    """The first start, beside a crest, was trusted with an estimate of 9.6e-4 rad and an error of
    0.067 rad."""
    scene = frozen(0.0, fill=0.3556509365075645, can=METAL)
    times = [0.0, 0.5, 1.0]
    turns = phi0 - reduced(phi0)
    rounding = 4 * np.spacing(abs(phi0))

    far = simulate(scene, phi0=phi0, rolling=rolling, times=times)
    near = simulate(scene, phi0=reduced(phi0), rolling=rolling, times=times)

    assert far.phi == pytest.approx(near.phi + turns, rel=0, abs=rounding)
    assert far.roll == pytest.approx(near.roll + turns, rel=0, abs=rounding)
    assert far.u / METAL.radius == pytest.approx(near.u / METAL.radius + turns, rel=0, abs=rounding)
    assert far.u[0] == pytest.approx(scene.initial_axis(phi0, 0.0)[0], rel=1e-15)
    assert far.error_estimate == pytest.approx(near.error_estimate, rel=1e-12, abs=rounding)
    assert far.error_estimate > 0
    error_far = error(far)
    assert error_far <= far.error_estimate


def test_a_run_whole_turns_away_keeps_to_its_tolerance_or_is_refused() -> None:
    """Beside a crest, 100 to 1,500 turns away, 10 of 120 tolerances were broken."""
    generator = np.random.default_rng(20261124)
    kept = 0
    for _ in range(60):
        scene = frozen(0.0, float(generator.uniform(0.2, 0.8)), METAL)
        turns = int(generator.integers(100, 1500)) * float(generator.choice([-1, 1]))
        phi0 = (2 * turns + 1) * math.pi + 10 ** float(generator.uniform(-9, -2))
        tolerance = 10 ** float(generator.uniform(-11, -4))
        try:
            run = simulate(scene, 1.0, phi0, tolerance=tolerance)
            truth = error(run)
        except (ToleranceError, NoLibrationError):
            continue
        assert truth <= run.error_estimate <= tolerance
        kept += 1
    assert kept >= 30


def test_a_tolerance_below_the_rounding_of_a_far_start_is_refused() -> None:
    with pytest.raises(
        ToleranceError,
        match=r"doubles near an angle as large as phi0 have errors of up to 7\.3e-12 rad",
    ):
        simulate(sliding(), 1.0, 8498.0, tolerance=1e-12)
