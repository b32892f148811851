"""Values, units and names as messages show them."""

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from mjbeer import messages

INTEGRATORS = ("Euler", "implicit", "implicitfast", "RK4")


class Unprintable:
    def __repr__(self) -> str:
        raise RuntimeError


class OfTwoLines:
    def __repr__(self) -> str:
        return "two\nlines"


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: 0.1, "0.1"),
        (lambda: np.float64(0.1), "0.1"),
        (lambda: np.array(0.5), "0.5"),
        (lambda: [np.float32(0.5), None], "[0.5, None]"),
        (lambda: np.ma.masked, "masked"),
        (lambda: Fraction(10**20, 3), "Fraction(100000000000000000000, 3)"),
        (lambda: -(10**5000), "an integer of about 5001 digits"),
        (lambda: np.arange(6.0), "ndarray of shape (6,) and type float64: [0.0, 1.0, 2.0, 3.0, ...]"),
        (lambda: np.zeros((1, 2), int), "ndarray of shape (1, 2) and type int64: [0, 0]"),
    ],
)
def test_a_value_is_shown_in_a_short_line(make: Callable[[], object], text: str) -> None:
    assert messages.shown(make()) == text


@pytest.mark.parametrize("value", ["x" * 1000, [["deep"] * 100] * 100, OfTwoLines(), Unprintable()])
def test_no_value_takes_two_lines_or_a_long_one(value: object) -> None:
    shown = messages.shown(value)
    assert "\n" not in shown
    assert len(shown) < 500


@pytest.mark.parametrize(("unit", "text"), [("kg", " [kg]"), ("", "")])
def test_a_unit_stands_in_brackets(unit: str, text: str) -> None:
    assert messages.in_unit(unit) == text


@pytest.mark.parametrize(
    ("word", "alike"),
    [
        ("rk4", ["RK4"]),
        ("EULER", ["Euler"]),
        ("implicitfas", ["implicitfast", "implicit"]),
        ("RK", ["RK4"]),
        ("leapfrog", []),
        ("", []),
    ],
)
def test_words_that_are_spelled_alike(word: str, alike: list[str]) -> None:
    assert messages.spelled_alike(word, INTEGRATORS) == alike
