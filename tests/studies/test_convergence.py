"""Ladders whose order and floor are known."""

import math

import numpy as np
import pytest
from mjbeer.studies.convergence import convergence, observed_order

STEPS = 0.016 / 2.0 ** np.arange(10)


@pytest.mark.parametrize("order", [1, 4, 8])
def test_a_power_law_converges_with_its_order(order: int) -> None:
    errors = 0.1 * (STEPS / STEPS[0]) ** order
    assert convergence(STEPS, errors).order == pytest.approx(order, abs=1e-9)
    assert observed_order(STEPS, errors) == pytest.approx(order, abs=1e-9)
    errors[0] = math.inf  # a rung that failed
    assert convergence(STEPS, errors).order == pytest.approx(order, abs=1e-9)


def test_a_floor_is_seen_and_the_order_before_it() -> None:
    found = convergence(STEPS, np.maximum(1e-2 * (STEPS / STEPS[0]) ** 4, 3e-11))
    assert found.floor == pytest.approx(3e-11)
    assert found.since == STEPS[7]  # 1e-2/16^7 is 3.7e-11, of which the floor is more than half
    assert found.order == pytest.approx(4, abs=1e-9)


@pytest.mark.parametrize(
    "errors",
    [
        10.0 ** np.array([-3, -5, -4, -7, -6.2, -8, -7.5, -9.5, -8.8, -11]),
        [2.0, 1.9, 2.1, 2.0, 1.8, 1.0, 0.1, 0.01, 0.001, 3e-5],  # a plateau of radians: motions that lost their phase
        [],
        [1e-3, 1e-4],
    ],
    ids=["noise", "lost phase", "none", "few"],
)
def test_other_ladders_have_neither(errors: list[float]) -> None:
    found = convergence(STEPS[: len(errors)], errors)
    assert (found.order, found.floor) == (None, None)


def test_the_finer_of_two_stretches_of_equal_length_counts() -> None:
    errors = 0.2 * 2.0 ** -np.cumsum([0, 2, 2, 2, 5, 4, 4, 4])
    assert convergence(STEPS[:8], errors).order == pytest.approx(4)
