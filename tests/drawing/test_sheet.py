"""Lines, arrows and texts are where they are put, and only there."""

import numpy as np
import pytest

from mjbeer.drawing.sheet import Sheet


def dark(sheet: Sheet) -> np.ndarray:
    """Return rows and columns of the pixels that black covers at least half, shape (2, pixels)."""
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

    box = sheet.text((100, 50), "φ = 60°", 20, "black", anchor=anchor)

    right, down = anchor
    rows, columns = dark(sheet)
    assert box.left + right * (box.right - box.left) == pytest.approx(100, abs=0.5)
    assert box.top + down * (box.bottom - box.top) == pytest.approx(50, abs=0.5)
    assert len(rows) > 50
    assert box.left <= columns.min() <= columns.max() < box.right
    assert box.top <= rows.min() <= rows.max() < box.bottom


def test_a_plate_is_as_large_as_its_lines_and_lies_with_its_anchor_at_the_place() -> None:
    sheet = Sheet(400, 340)

    sheet.plate(np.array([300.0, 100.0]), ["a name", "a longer line"], "black", (1, 0.5), "red")

    red = np.abs(sheet.picture().astype(int) - [255, 0, 0]).max(axis=2) < 10
    rows, columns = np.nonzero(red)
    assert columns.max() == 299
    assert (rows.min() + rows.max() + 1) / 2 == pytest.approx(100, abs=1)
    # Two lines of 1.5 units and a quarter of a unit above and below.
    assert np.ptp(rows) + 1 == pytest.approx(3.5 * sheet.unit, abs=1)
