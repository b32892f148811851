"""What is timed is exact: all ways keep the tolerance, and RK4 at about the largest timestep that does."""

import numpy as np
import pytest

from mjbeer.exceptions import ToleranceError
from mjbeer.studies.benchmark import peers, sweeps
from mjbeer.studies.benchmark.sweeps import TOLERANCE, Sample


@pytest.mark.costly
def test_all_that_is_timed_keeps_the_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeps, "Sample", lambda count: Sample(8))
    ways = sweeps.compare(quick=True)["ways"]
    names = ["mjbeer.sweep", "MuJoCo RK4", "MuJoCo RK4", *["heyoka's ensemble"] * (not peers.absent())]
    assert [way["name"].split(",")[0] for way in ways] == names
    assert all(0 < way["error"] <= TOLERANCE for way in ways)
    assert all(0 < way["seconds"] < np.inf for way in ways)


@pytest.mark.slow
def test_each_scene_has_about_the_largest_timestep_that_keeps_the_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    """With 0.85 of the timesteps RK4 errs by 0.85^-4 = 1.9 times as much."""
    sample = Sample(6)
    steps = sample.steps()
    assert (sample.errors(sample.by_rk4(steps)) <= TOLERANCE).all()
    assert (sample.errors(sample.by_rk4(np.ceil(0.85 * steps))) > TOLERANCE).all()
    monkeypatch.setattr(sweeps, "TOLERANCE", 1e-17)
    monkeypatch.setattr(sweeps, "_SEARCHED", 1)
    with pytest.raises(ToleranceError, match="RK4 does not reach 1e-17 rad in 6 scenes"):
        sample.steps()


def test_a_motion_that_is_off_has_an_error() -> None:
    """Of phi in the scene that turns farthest, more than 1 rad, and of u in another."""
    sample = Sample(8)
    phi, u = sample.by_sweep()
    assert sample.errors((phi, u)).max() <= TOLERANCE
    farthest = int(np.argmax(np.abs(phi - 1)))
    other, turned = (farthest + 1) % 8, abs(phi[farthest] - 1)
    assert turned > 1
    phi[farthest] += 1e-3
    u[other] += 1e-3
    found = sample.errors((phi, u))
    assert found[farthest] == pytest.approx(1e-3 / turned, rel=2e-3)  # what the sweep errs by itself
    assert found[other] == pytest.approx(1e-3 / max(0.033, abs(u[other])), rel=2e-3)
