"""Plots: two files, whole, and the same each time."""

import pathlib

import matplotlib as mpl
import pytest
from PIL import Image

from mjbeer.exceptions import OutputError
from mjbeer.output import plots


def draw(path: pathlib.Path) -> None:
    with plots.chart(path, width=4, height=3) as (axes,):
        axes.plot([1, 2], [1, 4], label="a line")
        axes.legend()


def test_svg_and_png_repeat_to_the_byte(tmp_path: pathlib.Path) -> None:
    draw(tmp_path / "one")
    draw(tmp_path / "two.5")
    for kind in ("svg", "png"):
        assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.5.{kind}").read_bytes()
    with Image.open(tmp_path / "one.png") as picture:
        assert picture.size == (600, 450)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["one.png", "one.svg", "two.5.png", "two.5.svg"]


def test_an_error_while_drawing_leaves_no_file_and_no_style(tmp_path: pathlib.Path) -> None:
    before = dict(mpl.rcParams)
    with pytest.raises(ZeroDivisionError), plots.chart(tmp_path / "plot"):
        raise ZeroDivisionError
    assert not list(tmp_path.iterdir())
    assert dict(mpl.rcParams) == before


def test_a_folder_that_cannot_be_written_says_so(tmp_path: pathlib.Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot write"):
        draw(tmp_path / "file" / "plot")


def test_colours_differ() -> None:
    assert len(set(plots.COLOURS)) == len(plots.COLOURS)
