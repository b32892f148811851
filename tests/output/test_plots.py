"""Plots: whole, and the same each time."""

import pathlib
import re
from xml.etree import ElementTree

import matplotlib as mpl
import pytest

from mjbeer.output import plots

pytestmark = pytest.mark.slow


def draw(path: pathlib.Path) -> None:
    with plots.chart(path, width=4, height=3) as (axes,):
        axes.plot([1, 2], [1, 4], label="a line")
        axes.legend()


def test_a_plot_repeats_to_the_byte(tmp_path: pathlib.Path) -> None:
    draw(tmp_path / "one")
    draw(tmp_path / "two.5")
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.5.svg").read_bytes()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["one.svg", "two.5.svg"]


def test_an_error_while_drawing_leaves_no_file_and_no_style(tmp_path: pathlib.Path) -> None:
    before = dict(mpl.rcParams)
    with pytest.raises(ZeroDivisionError), plots.chart(tmp_path / "plot"):
        raise ZeroDivisionError
    assert not list(tmp_path.iterdir())
    assert dict(mpl.rcParams) == before


def test_a_title_and_a_scene_stand_above_the_axes(tmp_path: pathlib.Path) -> None:
    with plots.chart(tmp_path / "plot", title="What it shows", subtitle="of which scene") as (axes,):
        axes.plot([1, 2], [1, 2], label="a line")
        axes.set(xlabel="time [s]", ylabel="u [m]")
        plots.name_below([axes], 1)
    svg = (tmp_path / "plot.svg").read_text()
    assert "<title>What it shows</title>" in svg
    assert "<dc:description>of which scene</dc:description>" in svg
    assert {"What it shows", "of which scene", "a line", "time [s]"} <= set(
        re.findall(r"<text[^>]*>([^<]*)</text>", svg)
    )


def test_a_plot_whose_points_tell_a_text_is_xml(tmp_path: pathlib.Path) -> None:
    with plots.chart(tmp_path / "plot") as (axes,):
        for texts in (("one & two", "three"), ("four", "five")):
            plots.add_tooltips(axes.plot([1, 2], [1, 2], "o-")[0], texts)
    marks = "{http://www.w3.org/2000/svg}use"
    told = [title.text for use in ElementTree.parse(tmp_path / "plot.svg").iter(marks) for title in use]
    assert told == ["one & two", "three", "four", "five"]
