"""What is timed is exact: all ways keep the tolerance, RK4 at the largest timestep that does."""

import numpy as np
import pytest

from mjbeer.exceptions import ToleranceError
from mjbeer.studies.sweep import speed
from mjbeer.studies.sweep.ensemble import installed


@pytest.mark.slow
def test_all_that_is_timed_keeps_the_tolerance() -> None:
    ways = speed.compare(8, rounds=1, cores=2)
    names = ["mjbeer.sweep", "mjbeer.sweep", "mujoco.batch", *["heyoka's ensemble"] * installed()]
    assert [way.name.split(",")[0] for way in ways] == names
    assert all(0 < way.error <= speed.TOLERANCE for way in ways)
    assert all(0 < way.seconds < np.inf for way in ways)
    assert len(speed.table(ways).rows) == len(ways)


def test_the_timestep_is_the_largest_that_keeps_the_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    sample = speed.Sample(4)
    timestep = sample.timestep(2)
    assert sample.by_batch(timestep, 2)[1] <= speed.TOLERANCE
    assert sample.by_batch(1.2 * timestep, 2)[1] > speed.TOLERANCE  # the fourth root of 2, where the search ends
    monkeypatch.setattr(speed, "TOLERANCE", 1e-16)
    monkeypatch.setattr(speed, "_MOST", 4000)
    with pytest.raises(ToleranceError, match="RK4 does not reach 1e-16 rad with 4000 timesteps"):
        sample.timestep(2)


def test_a_motion_that_is_off_has_an_error() -> None:
    sample = speed.Sample(3)
    phi, u = sample._phi.copy(), sample._u.copy()
    assert sample.error(phi, u) == 0
    phi[1] += 1e-4
    assert sample.error(phi, u) == pytest.approx(1e-4 / max(1, abs(sample._phi[1] - 1)))
