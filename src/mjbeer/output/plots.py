"""The style that all plots share, and writing each plot as SVG."""

import io
import pathlib
import textwrap
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from mjbeer.output import files

# M. Okabe and K. Ito's palette for colour-blind readers, without its yellow, which is hard to see on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
GREY = "#666666"  # of notes, and of lines that something is compared with: dark enough to be read on white
# Lines: a motion by exact theory is wide and pale, so that the simulation's lies on it; then a motion by MuJoCo, what
# cannot happen, and a level or a time to compare with.
THEORY: dict[str, Any] = {"color": "#C4C4C4", "linewidth": 5, "zorder": 1.5}
SIMULATED: dict[str, Any] = {"color": COLOURS[0]}
UNPHYSICAL: dict[str, Any] = {"color": "#8C8C8C", "linestyle": ":"}
REFERENCE: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "zorder": 1.2}

STYLE: Any = {
    "axes.grid": True,
    "axes.labelsize": 10.5,
    "axes.prop_cycle": cycler(color=COLOURS),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 11,
    "font.sans-serif": ["DejaVu Sans", "Verdana"],  # where there is no DejaVu Sans, Verdana has the same widths
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "mjbeer",  # with this and no date, equal plots are equal files
}
_TITLE: dict[str, Any] = {"fontsize": 13.5, "weight": "bold"}
_SUBTITLE: dict[str, Any] = {"fontsize": 10.5, "color": GREY}
_LETTERS = 8.3  # letters of the title in an inch; the subtitle's are narrower


@dataclass
class Picture:
    """Where a plot goes that is no file: an SVG without title and subtitle, which are texts of their own."""

    name: str
    title: str = ""
    subtitle: str = ""
    svg: str = ""


@contextmanager
def chart(
    path: pathlib.Path | Picture,
    rows: int = 1,
    columns: int = 1,
    width: float = 8,
    height: float = 5,
    title: str = "",
    subtitle: str = "",
) -> Generator[list[Axes]]:
    """Yield the axes to draw into, row by row; at the end write `path` with .svg, whole or not at all, or a `Picture`.

    `width` and `height` are the size of the whole plot [inches]. The title says what is shown, and the subtitle, a
    smaller line below it, of which scene.

    Raises:
      OutputError: if a file cannot be written.
    """
    with mpl.rc_context(STYLE):
        heads = [(line, 0.32, _TITLE) for line in textwrap.wrap(title, round(_LETTERS * width))]
        heads += [(line, 0.24, _SUBTITLE) for line in textwrap.wrap(subtitle, round(1.7 * _LETTERS * width))]
        if isinstance(path, Picture):
            height, heads = height - sum(line for _, line, _ in heads), []
        figure = FigureCanvasSVG(Figure(figsize=(width, height), dpi=72)).figure
        used = 0.0  # height of title and subtitle at the top left [inches]
        for text, line, look in heads:
            figure.text(0.1 / width, 1 - (0.05 + used) / height, text, ha="left", va="top", **look)
            used += line
        panels = list(figure.subplots(rows, columns, squeeze=False).flat)
        yield panels
        # Set out here and not by `savefig`, which would draw the whole plot for it first.
        ConstrainedLayoutEngine(rect=(0, 0, 1, 1 - used / height)).execute(figure)
        named = {"Date": None, "Title": title, "Description": subtitle}
        file = io.StringIO()
        figure.savefig(file, format="svg", facecolor="white", dpi=150, metadata=named)
        if isinstance(path, Picture):
            path.title, path.subtitle, path.svg = title, subtitle, file.getvalue()
        else:
            files.write(path.with_name(path.name + ".svg"), file.getvalue())


def note(axes: Axes, text: str, place: tuple[float, float], offset: tuple[float, float], **style: Any) -> None:
    """Write a note or the name of a line, `offset` [points] to the right of and above a `place` in the data."""
    style = {"color": GREY, "fontsize": 9.5, "va": "center"} | style
    axes.annotate(text, place, offset, textcoords="offset points", **style)


def name_below(axes: Sequence[Axes], columns: int, handles: Sequence[Artist] = ()) -> None:
    """Name what the axes show in one legend below the plot: their lines with a label, each name once, or `handles`."""
    if not handles:
        shown = [zip(*panel.get_legend_handles_labels(), strict=True) for panel in axes]
        handles = list({name: handle for pairs in shown for handle, name in pairs}.values())
    axes[0].figure.legend(handles=list(handles), loc="outside lower center", ncols=columns)
