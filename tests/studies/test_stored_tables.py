"""Tables of studies that are stored say what the studies say."""

import pytest

from mjbeer.output.terminal import Table
from mjbeer.studies import contact_creep, polygon, stored_tables


def columns_of(table: Table, names: list[str]) -> list[list[str]]:
    """The cells of some columns."""
    places = [table.columns.index(name) for name in names]
    return [[row[place] for place in places] for row in table.rows]


def test_what_physx_did_is_stored_as_it_is_told() -> None:
    stored = stored_tables.load(polygon.STORED, "physx")
    names = ["asked for", "kept at the ends", "PhysX, 1 ms", "0.1 ms"]
    assert columns_of(stored, names) == columns_of(polygon.physx_table(), names)


@pytest.mark.costly
def test_the_table_of_meshes_is_that_of_the_study() -> None:
    """The last digit is a tenth of a radian, and a start 1e-9 rad aside moves an end by 0.2 rad."""
    stored = stored_tables.load(polygon.STORED, "mujoco")
    for row, again in zip(stored.rows, polygon.mujoco_table().rows, strict=True):
        assert [float(cell) for cell in row] == pytest.approx(
            [float(cell) for cell in again], rel=0.01
        )


@pytest.mark.costly
def test_the_table_of_contacts_is_that_of_the_study() -> None:
    """But for the cost, which is a time. The least errors are 1e-8 rad, not far above rounding."""
    stored = stored_tables.load(contact_creep.STORED, "errors")
    measured = contact_creep.error_table(contact_creep.measure())
    for row, again in zip(stored.rows, measured.rows, strict=True):
        assert row[0] == again[0]
        assert [float(cell) for cell in row[1:5]] == pytest.approx(
            [float(cell) for cell in again[1:5]], rel=0.1
        )


@pytest.mark.costly
def test_the_table_of_the_law_is_that_of_the_study() -> None:
    stored = stored_tables.load(contact_creep.STORED, "law")
    for row, again in zip(stored.rows, contact_creep.law_table().rows, strict=True):
        assert row[:2] == again[:2]
        assert [float(cell) for cell in row[2:]] == pytest.approx(
            [float(cell) for cell in again[2:]], abs=2e-3
        )
