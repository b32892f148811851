"""Numerical errors that theory gives in advance, against simulations; each fails on a wrong theory."""

import numpy as np
import pytest

from mjbeer import Can, sliding
from mjbeer.predictions import semi_implicit_euler, soft_constraint, soft_rolling
from mjbeer.studies.benchmark.predicted import predictions, table
from mjbeer.studies.cases import CASES

# What each prediction leaves out, relative to it.
NEXT_ORDER = 2e-3  # frequency: (omega h)^2 of 4 ms; error of phi: the next power of a timestep of 1/16 ms
SETTLING = 1e-2  # slip: the can still sinks and creeps a little
ROUNDING = 1e-9  # distance and shares are exact
MARGINS = {"frequency": NEXT_ORDER, "largest": NEXT_ORDER, "slip": SETTLING, "distance": ROUNDING, "share": ROUNDING}


@pytest.mark.parametrize("prediction", predictions(), ids=lambda each: f"{each.what}: {each.of}")
def test_it_is_as_predicted(prediction) -> None:
    margin = MARGINS[prediction.what.split()[0]]
    assert prediction.measure() == pytest.approx(prediction.predict(), rel=margin)


def test_the_margins_tell_wrong_predictions() -> None:
    """The factors of theory that one might get wrong are all larger: 1/12 for 1/24, delta/a for delta/2a, b for a."""
    assert max(MARGINS.values()) < 0.1


def test_the_error_of_euler_is_the_limit_of_small_steps() -> None:
    """Not a fit: halving the step halves what the prediction misses, relative to it."""
    from mjbeer import simulate
    from mjbeer.theory.exact import phi_error

    case = CASES["frozen"]
    slope = np.abs(semi_implicit_euler.euler_error(case.scene, case.times, case.phi0)).max()
    missed = [
        phi_error(simulate(case.scene, case.times[-1], 0.0, integrator="Euler", timestep=h, times=case.times))
        / h
        / slope
        - 1
        for h in (1e-3, 5e-4)
    ]
    assert missed[0] / missed[1] == pytest.approx(2, abs=0.3)


@pytest.mark.parametrize("integrator", ["Euler", "implicit"])
def test_the_motion_of_euler_is_right_to_second_order(integrator: str) -> None:
    """Rolling down: halving the step halves the error, and quarters what is missed of it."""
    from mjbeer import exact, frozen, simulate

    scene, times, missed, first = frozen(), np.array([0.0, 1.0]), [], []
    for h in (5e-4, 2.5e-4):
        predicted = semi_implicit_euler.euler_motion(scene, times, h, integrator, np.pi)[-1]
        run = simulate(scene, 1.0, np.pi, rolling="equality", integrator=integrator, timestep=h, times=times)
        missed.append(run.phi[-1] - predicted)
        first.append(run.phi[-1] - exact(scene, times, np.pi).phi[-1])
    assert np.sign(first[0]) == {"Euler": -1, "implicit": 1}[integrator]
    assert abs(missed[0] / first[0]) < NEXT_ORDER
    assert first[0] / first[1] == pytest.approx(2, abs=0.05)
    assert missed[0] / missed[1] == pytest.approx(4, abs=0.2)


def test_the_diagonal_is_right_where_metres_and_radians_do_not_mix() -> None:
    """A can of radius 1 m."""
    scene = sliding(can=Can.hoop(1.0, 1.0, 2.0))
    assert soft_rolling.diagonal_excess(scene) == pytest.approx(1, rel=1e-12)
    assert soft_constraint.reached_share(0.9, 1.0) == pytest.approx(0.9, rel=1e-15)


def test_the_table_has_a_row_each() -> None:
    assert len(table().rows) == len(predictions())
