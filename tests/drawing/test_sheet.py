"""Lines, arrows and texts are where they are put, and only there."""

import numpy as np
import pytest

from mjbeer.drawing.sheet import Sheet


def dark(sheet: Sheet) -> np.ndarray:
    """Rows and columns of the pixels that are at least half covered by black, shape (2, pixels)."""
    return np.stack(np.nonzero(sheet.picture().max(axis=2) < 128))


def test_a_line_is_where_it_is_put() -> None:
    sheet = Sheet(60, 40)
    sheet.line(np.array([[10.0, 20.5], [50.0, 20.5]]), 3, "black")
    rows, columns = dark(sheet)
    assert (rows.min(), rows.max()) == (19, 21)
    assert (columns.min(), columns.max()) == (9, 50)  # with round ends


def test_an_arrow_ends_where_it_points() -> None:
    sheet = Sheet(60, 80)
    sheet.arrow(np.array([30.0, 10.0]), np.array([30.0, 70.0]), 4, "black")
    rows, columns = dark(sheet)
    assert rows.min() == 10
    assert 67 <= rows.max() <= 70
    assert columns.mean() == pytest.approx(29.5, abs=0.1)
    assert 55 <= rows[np.argmax(np.abs(columns - 30))] <= 58  # its head
    assert columns.max() - columns.min() == pytest.approx(12, abs=1)


@pytest.mark.parametrize("anchor", [(0.0, 0.0), (1.0, 0.5), (0.5, 1.0)])
def test_a_text_is_in_its_box(anchor: tuple[float, float]) -> None:
    sheet = Sheet(200, 100)
    left, top, right, bottom = sheet.text((100, 50), "φ = 60°", 20, "black", anchor=anchor)
    assert (left, top) == pytest.approx(
        (100 - anchor[0] * (right - left), 50 - anchor[1] * (bottom - top)), abs=0.5
    )
    rows, columns = dark(sheet)
    assert len(rows) > 50
    assert left <= columns.min() <= columns.max() < right
    assert top <= rows.min() <= rows.max() < bottom
