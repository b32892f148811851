"""Laws towards the extremes, each with a bound that a wrong law would break."""

import math

import pytest

from mjbeer import Scene, frozen, pendulum, sliding
from mjbeer.studies.check import Check
from mjbeer.studies.stability import laws
from mjbeer.studies.stability.laws import fall_slope

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("law", list(laws.laws()), ids=lambda law: f"{law.quantity}, {law.by}")
def test_laws_hold(law: Check) -> None:
    assert law.measure().passed


def test_the_fold_has_no_other_exponent() -> None:
    """omega^2, not omega, goes with the root of the distance: the bound is far below the difference."""
    law = next(law for law in laws.laws() if "fold" in law.quantity)
    assert abs(law.deviation() - 0.25) > 100 * law.bound


@pytest.mark.parametrize("scene", [sliding(), frozen(), frozen(0.0), pendulum()])
def test_a_fall_takes_longer_by_its_slope(scene: Scene) -> None:
    """Exact periods have two falls and two rises, from one end of the swing or from both."""
    top, rest = scene.separatrix()[1], scene.equilibrium()
    near, far = (scene.period(top - beside - rest) for beside in (1e-7, 1e-5))
    ends = 2 if scene.oscillator.slope == 0 else 1
    assert (near - far) / math.log(1e-2) == pytest.approx(2 * ends * fall_slope(scene), rel=1e-5)
