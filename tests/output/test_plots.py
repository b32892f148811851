"""Plots: whole, and the same each time."""

import pathlib
import re

import pytest

from mjbeer.output import plots

pytestmark = pytest.mark.slow


def test_a_plot_repeats_to_the_byte(tmp_path: pathlib.Path) -> None:
    for name in ("one", "two.5"):
        with plots.chart(tmp_path / name, width=4, height=3) as (axes,):
            axes.plot([1, 2], [1, 4], label="a line")
            axes.legend()
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.5.svg").read_bytes()


def test_a_title_and_a_scene_stand_above_the_axes(tmp_path: pathlib.Path) -> None:
    with plots.chart(tmp_path / "plot", title="What it shows", subtitle="of which scene") as (
        axes,
    ):
        axes.plot([1, 2], [1, 2], label="a line")
        axes.set(xlabel="time [s]", ylabel="u [m]")
        plots.name_below([axes], 1)
    svg = (tmp_path / "plot.svg").read_text()
    assert "<title>What it shows</title>" in svg
    assert "<dc:description>of which scene</dc:description>" in svg
    assert {"What it shows", "of which scene", "a line", "time [s]"} <= set(
        re.findall(r"<text[^>]*>([^<]*)</text>", svg)
    )
