"""The style that all plots share, and writing each plot as SVG and PNG."""

import pathlib
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjbeer.output import files

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""M. Okabe and K. Ito's palette for colour-blind readers, without its yellow, which is hard to see on white."""
_STYLE: Any = {
    "axes.grid": True,
    "axes.prop_cycle": cycler(color=COLOURS),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.constrained_layout.use": True,
    "font.size": 11.0,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "mjbeer",  # with this and no date, equal plots are equal files
}


@contextmanager
def chart(
    path: pathlib.Path, rows: int = 1, columns: int = 1, width: float = 8, height: float = 5
) -> Generator[list[Axes]]:
    """Yield the axes to draw into, row by row; at the end write `path` with .svg and .png, whole or not at all.

    `width` and `height` are the size of the whole plot [inches].

    Raises:
      OutputError: if a file cannot be written.
    """
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(width, height))
        yield list(figure.subplots(rows, columns, squeeze=False).flat)
        for kind in (".svg", ".png"):
            metadata = {"Date": None} if kind == ".svg" else {}
            with files.whole(path.with_name(path.name + kind)) as temporary:
                figure.savefig(temporary, facecolor="white", dpi=150, metadata=metadata)
