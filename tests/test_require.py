"""Checks of arguments: numbers, names and samples that are refused, and how messages show them."""

import math
from fractions import Fraction

import numpy as np
import pytest

from mjbeer import require
from mjbeer.exceptions import ParameterError

NO_NUMBERS = [math.nan, math.inf, "0.3", b"1", None, True, np.True_, 1j, [1.0], np.array([1.0])]
NO_SAMPLES = [[], [[0.0]], ["0"], [0.0, None], {0.0: 1.0}, np.array([1j]), 0.3]


@pytest.mark.parametrize("value", NO_NUMBERS, ids=lambda value: require.format_value(value)[:20])
def test_a_number_is_finite_and_real(value: object) -> None:
    with pytest.raises(ParameterError) as caught:
        require.number("mass", value, "kg")
    assert (
        str(caught.value) == f"mass must be a finite number [kg], got {require.format_value(value)}"
    )


def test_numbers_and_samples_of_any_kind_become_doubles() -> None:
    for value in (1, np.int8(1), np.float32(1), np.array(1.0), Fraction(1), np.longdouble(1)):
        assert type(require.number("mass", value)) is float
        assert require.number("mass", value) == 1
    for several in ([0, 1], (0.0, 1), range(2), np.arange(2), np.array([0, 1], np.float32)):
        assert require.samples("time", several).tolist() == [0.0, 1.0]
        assert require.samples("time", several).dtype == float


@pytest.mark.parametrize("value", NO_SAMPLES, ids=str)
def test_samples_are_one_list_of_numbers(value: object) -> None:
    with pytest.raises(
        ParameterError,
        match="time must be a list or a one-dimensional array of one or more numbers",
    ):
        require.samples("time", value)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([0.0, math.nan], r"time\[1\] must be a finite number \[s\], got nan"),
        ([0.0, -0.1], r"time\[1\] must be 0 or greater \[s\], got -0.1"),
        ([0.0, 0.2, 0.1], r"time must increase, but time\[2\] is 0.1 s after 0.2 s"),
    ],
)
def test_an_error_names_the_entry_that_is_wrong(value: list[float], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        require.times("time", value, increasing=True)


@pytest.mark.parametrize("value", ["EULER", b"RK4", "implicitfas"])
def test_an_error_lists_the_names(value: str) -> None:
    """And does not guess which of them was meant."""
    with pytest.raises(ParameterError) as caught:
        require.choice("integrator", value, ("Euler", "implicit", "implicitfast", "RK4"))
    assert (
        str(caught.value)
        == f"integrator must be one of 'Euler', 'implicit', 'implicitfast', 'RK4'; got {value!r}"
    )


@pytest.mark.parametrize("value", ["", b"run.csv", None, 1])
def test_a_path_is_the_name_of_a_file(value: object) -> None:
    with pytest.raises(ParameterError) as caught:
        require.path(value)
    assert (
        str(caught.value) == f"path must be the name of a file, got {require.format_value(value)}"
    )


@pytest.mark.parametrize("value", ["x" * 1000, [["deep"] * 100] * 100])
def test_a_value_is_shown_in_one_short_line_and_a_number_as_a_plain_one(value: object) -> None:
    assert len(require.format_value(value)) < 500
    for tenth in (np.float64(0.1), np.array(0.1), 0.1):
        assert require.format_value(tenth) == "0.1"
