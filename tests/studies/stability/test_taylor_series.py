"""The reference against Lagrange's equations in extended precision, and against what a motion
conserves."""

import numpy as np
import pytest

from mjbeer import Can, Scene, frozen, hoop, pendulum, sliding
from mjbeer.exceptions import ToleranceError
from mjbeer.studies.stability import taylor_series as module
from mjbeer.studies.stability.taylor_series import series
from mjbeer.theory.can import Load
from mjbeer.theory.equations import kinetic_energy, potential_energy
from tests.support import taylor

pytestmark = pytest.mark.slow

METAL = Can.sheet_metal()
BESIDE = 1e-6
FEW = 3e-15
"""A few roundings of an angle of some radians."""
LIGHT_HOOP = Scene(Can.hoop(mass=0.2e-3), Load.point(0.2, 0.033), 0.0, "frozen")
HEAVY_CAN = Scene(Can(0.033, 0.1, 1e2, 0.1), Load.point(0.1, 0.02), 0.1)
CASES: dict[str, tuple[Scene, float, float, float, float]] = {
    "sliding": (sliding(), 0.4, 1.0, 0.0, FEW),
    "sliding, metal, spun": (sliding(can=METAL), 0.4, 2.0, 3.0, FEW),
    "frozen": (frozen(), 0.4, 1.0, 0.0, FEW),
    "frozen, steep, rolling up": (frozen(-1.48), 0.2, 1.0, 30.0, FEW),
    "pendulum": (pendulum(), 0.4, 1.0, -2.0, FEW),
    "hoop": (hoop(), 0.3, 1.0, 0.0, FEW),
    "hoop of 1e-3 of its load": (LIGHT_HOOP, 0.09, 1.5, 0.0, FEW),
    "can of 1e3 of its load": (HEAVY_CAN, 0.3, 1.0, 0.0, FEW),
    # The spacing of doubles there is 1.8e-12.
    "1e4 rad away": (frozen(), 0.3, 1e4, 3.0, 1.8e-12),
    "1e5 rad/s": (sliding(can=METAL), 1e-4, 0.3, 1e5, FEW),
    # A rounding of the start, 4e-16 rad, grows with the swing from there: as the angle itself, from
    # 1e-6 to 3 rad.
    "beside the separatrix": (
        pendulum(),
        1.0,
        pendulum().separatrix()[1] - BESIDE,
        0.0,
        4e-16 * 3 / BESIDE,
    ),
    "weak gravity": (frozen(gravity=1e-3), 30.0, 1.0, 0.0, FEW),
}


@taylor.NEEDED
@pytest.mark.parametrize("name", CASES)
def test_it_solves_lagranges_equations(name: str) -> None:
    scene, duration, phi0, phi_dot0, bound = CASES[name]
    times = np.array([0.0, 0.37, 1.0]) * duration
    turned, u, *_ = taylor.motion(scene, times[1:], phi0, phi_dot0).astype(float).T
    found = series(scene, times, phi0, phi_dot0)
    assert np.abs(found.phi[1:] - phi0 - turned).max() <= bound
    assert np.abs(found.u[1:] - u).max() / scene.can.radius <= bound


def test_energy_is_kept_over_a_hundred_swings() -> None:
    """Its rounding: that of twenty steps a swing, which add up like a random walk."""
    scene = sliding(incline=0.0, can=METAL)
    found = series(scene, np.linspace(0, 100 * scene.period(1.0), 1001), 1.0)
    total, depth = (
        kinetic_energy(scene, found) + potential_energy(scene, found),
        scene.oscillator.depth,
    )
    assert np.abs(total - total[0]).max() / depth < 2e-14


def test_a_motion_that_is_too_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_STEPS", 100)
    with pytest.raises(ToleranceError, match="more than 100 steps"):
        series(sliding(), np.array([100.0]), 1.0)
