"""The style that all plots share, and writing each plot as SVG."""

import io
import pathlib
import textwrap
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import matplotlib as mpl
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from mjbeer.output import files

# M. Okabe and K. Ito's palette for colour-blind readers, without its yellow, which is hard to see
# on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
GREY = "#666666"
"""The grey of notes and of reference lines, dark enough to be read on white."""
# Styles of lines. A motion by exact theory is wide and pale, so that the simulated one is visible
# on top of it. Dotted motions cannot happen; references are levels or times to compare with.
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
    # Verdana has the same widths, where DejaVu Sans is missing.
    "font.sans-serif": ["DejaVu Sans", "Verdana"],
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "mjbeer",  # this, and no date, makes files of equal plots equal
}
_TITLE: dict[str, Any] = {"fontsize": 13.5, "weight": "bold"}
_SUBTITLE: dict[str, Any] = {"fontsize": 10.5, "color": GREY}
_LETTERS = 8.3
"""Number of letters of the title in an inch; those of the subtitle are narrower."""


@dataclass
class Picture:
    """A plot that is not written to a file: its SVG, and title and subtitle as separate texts."""

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
    """Yield the axes to draw into, row by row; at the end write `path` with .svg, or a `Picture`.

    `width` and `height` are the size of the whole plot [inches]. The title says what is shown. The
    subtitle, in smaller letters below it, says for which scene.

    Raises:
      OutputError: if a file cannot be written.
    """
    with mpl.rc_context(STYLE):
        headings = _headings(title, subtitle, width)
        if isinstance(path, Picture):
            height -= sum(heading.height for heading in headings)
            headings = []
        figure = FigureCanvasSVG(Figure(figsize=(width, height), dpi=72)).figure
        used = 0.0  # height of title and subtitle at the top left [inches]
        for heading in headings:
            place = (0.1 / width, 1 - (0.05 + used) / height)
            figure.text(*place, heading.text, ha="left", va="top", **heading.style)
            used += heading.height
        panels = list(figure.subplots(rows, columns, squeeze=False).flat)
        yield panels
        # The layout is done here, as `savefig` would draw the whole plot once more for it.
        ConstrainedLayoutEngine(rect=(0, 0, 1, 1 - used / height)).execute(figure)
        metadata = {"Date": None, "Title": title, "Description": subtitle}
        file = io.StringIO()
        figure.savefig(file, format="svg", facecolor="white", dpi=150, metadata=metadata)
        if isinstance(path, Picture):
            path.title = title
            path.subtitle = subtitle
            path.svg = file.getvalue()
        else:
            files.write(path.with_name(path.name + ".svg"), file.getvalue())


class _Heading(NamedTuple):
    """A line above the axes."""

    text: str
    height: float
    """[inches]"""
    style: dict[str, Any]


def _headings(title: str, subtitle: str, width: float) -> list[_Heading]:
    """Return the lines of title and subtitle above a plot of this width [inches]."""
    letters = round(_LETTERS * width)
    smaller_letters = round(1.5 * _LETTERS * width)
    headings = [_Heading(line, 0.28, _TITLE) for line in textwrap.wrap(title, letters)]
    for line in textwrap.wrap(subtitle, smaller_letters):
        headings.append(_Heading(line, 0.22, _SUBTITLE))
    return headings


def note(
    axes: Axes, text: str, place: tuple[float, float], offset: tuple[float, float], **style: Any
) -> None:
    """Write a note, or the name of a line, beside a `place` in the data.

    It stands `offset` [points] to the right of the place and above it.
    """
    style = {"color": GREY, "fontsize": 9.5, "va": "center"} | style
    axes.annotate(text, place, offset, textcoords="offset points", **style)


def name_below(axes: Sequence[Axes], columns: int, handles: Sequence[Artist] = ()) -> None:
    """Name what the axes show in one legend below the plot.

    The legend has the `handles`, or without them the labelled lines of the axes, each label once.
    """
    if not handles:
        by_label: dict[str, Artist] = {}
        for panel in axes:
            for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
                by_label[label] = handle
        handles = list(by_label.values())
    axes[0].figure.legend(handles=list(handles), loc="outside lower center", ncols=columns)
