"""A check is judged by its bound, and its result survives as JSON."""

import json
import math

import pytest

from mjbeer.checks.as_json import document
from mjbeer.checks.check import Check, Measured, Result


@pytest.mark.parametrize(
    ("error", "bound", "passed"),
    [
        (1.0, 1.0, True),
        (1.1, 1.0, False),
        (math.nan, 1.0, False),
        (None, 0.0, False),
        (None, math.inf, True),
    ],
)
def test_a_result_passes_within_its_bound(error: float | None, bound: float, passed: bool) -> None:
    result = Result("g", "n", bound=bound, error=error)

    again = Result(**json.loads(json.dumps(result.as_json())))

    assert result.passed is passed
    assert again.passed is passed


def test_a_deviation_has_a_sign_and_an_error_none() -> None:
    assert Check("g", "n", lambda: -2.0).result().error == 2.0


def test_a_check_may_measure_more_than_its_error() -> None:
    result = Check("g", "n", lambda: Measured(-2, {"of": 3})).result()

    assert (result.error, result.values) == (2.0, {"of": 3})


def test_a_document_has_a_line_a_row_with_six_digits_and_no_infinity() -> None:
    text = document({"command": "mjbeer test"}, "rows", [{"x": 1 / 3}, {"x": math.inf}])

    assert text == '{"command": "mjbeer test", "rows": [\n{"x": 0.333333},\n{"x": null}\n]}\n'
