"""Ladders whose order and floor are known."""

import math

import numpy as np
import pytest

from mjbeer.studies.convergence import convergence

STEPS = 0.016 / 2.0 ** np.arange(10)


@pytest.mark.parametrize("order", [1, 2, 4, 8])
def test_a_power_law_converges_with_its_order(order: int) -> None:
    found = convergence(STEPS, 0.1 * (STEPS / STEPS[0]) ** order)
    assert (found.kind, found.floor) == ("converging", None)
    assert found.order == pytest.approx(order, abs=1e-9)


def test_a_floor_is_seen_and_the_order_before_it() -> None:
    found = convergence(STEPS, np.maximum(1e-2 * (STEPS / STEPS[0]) ** 4, 3e-11))
    assert found.kind == "floored"
    assert found.floor == pytest.approx(3e-11)
    assert found.since == STEPS[7]  # 1e-2/16^7 is 3.7e-11, of which the floor is more than half
    assert found.order == pytest.approx(4, abs=1e-9)
    assert str(found) == "floored at 3.0e-11 rad from 0.000125 on, order 4.00"


def test_noise_is_undecided() -> None:
    noise = 10.0 ** np.array([-3, -5, -4, -7, -6.2, -8, -7.5, -9.5, -8.8, -11])
    assert str(convergence(STEPS, noise)) == "undecided"


def test_the_order_of_close_rungs_is_fitted_to_all_of_them() -> None:
    """As of a multistep method, whose rungs scatter by a factor of 1.5 about the line; no coarser ladder is fitted."""
    scatter = 1.5 ** np.array([1, -1, -1, 1, 1, -1, 1, -1, 1, -1])
    steps = 0.016 / 2.0 ** (np.arange(10) / 4)
    found = convergence(steps, 0.1 * (steps / steps[0]) ** 13 * scatter)
    assert found.order == pytest.approx(13, abs=0.05 * 13)
    assert convergence(STEPS, 0.1 * (STEPS / STEPS[0]) ** 3 * scatter).order is None
    assert convergence(steps[:7], 0.1 * (steps[:7] / steps[0]) ** 13 * scatter[:7]).order is None


def test_a_plateau_of_large_errors_is_no_floor() -> None:
    """Motions that have lost their phase differ by some radians, whatever the timestep."""
    assert convergence(STEPS, [2.0, 1.9, 2.1, 2.0, 1.8, 1.0, 0.1, 0.01, 0.001, 1e-4]).kind != "floored"


def test_the_finer_of_two_stretches_of_equal_length_counts() -> None:
    orders = [2, 2, 2, 5, 4, 4, 4]
    errors = 0.2 * 2.0 ** -np.concatenate([[0], np.cumsum(orders)])
    assert convergence(STEPS[:8], errors).order == pytest.approx(4)


def test_failed_rungs_are_left_out() -> None:
    errors = 0.1 * (STEPS / STEPS[0]) ** 4
    errors[0] = math.inf
    assert convergence(STEPS, errors).order == pytest.approx(4)


@pytest.mark.parametrize("errors", [[], [1e-3], [1e-3, 1e-4]])
def test_a_few_rungs_decide_nothing(errors: list[float]) -> None:
    assert convergence(STEPS[: len(errors)], errors).kind == "undecided"
