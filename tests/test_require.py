"""A name that is none of those allowed: the error lists them, and asks after one that is spelled alike."""

import pytest

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import ROLLINGS


@pytest.mark.parametrize(
    ("value", "end"),
    [
        ("contac", "'contact'; got 'contac': did you mean 'contact'?"),
        ("Reduced", "'contact'; got 'Reduced': did you mean 'reduced'?"),
        ("gears", "'contact'; got 'gears'"),
        (b"contact", "'contact'; got b'contact'"),
    ],
)
def test_an_error_lists_the_names_and_asks_after_one_of_them(value: str, end: str) -> None:
    with pytest.raises(ParameterError) as caught:
        require.choice("rolling", value, ROLLINGS)
    assert str(caught.value) == f"rolling must be one of 'reduced', 'equality', {end}"
