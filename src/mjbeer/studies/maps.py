"""Maps: how runs ended, as colours over two parameters, with the border from which on they explode."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.output.plots import chart, name_below

_THEORY: dict[str, Any] = {"color": "black", "linewidth": 1.6}
"""The look of a border that theory predicts."""
_MEASURED: dict[str, Any] = {
    "linestyle": "none", "marker": "o", "markersize": 3.5, "markerfacecolor": "white", "markeredgecolor": "black",
    "markeredgewidth": 0.7,
}  # fmt: skip


@dataclass(frozen=True)
class Map:
    """How runs ended at every value of one parameter (to the right) and of another one (upwards)."""

    title: str
    x: Sequence[float]
    y: Sequence[float]
    outcomes: Sequence[Sequence[int]]
    """A row for each value of `y`, with the number of an outcome for each value of `x`."""
    predicted: Sequence[tuple[float, float]] = ()
    """Points of the border from which on runs explode, by theory."""
    measured: Sequence[tuple[float, float]] = ()


def draw(
    path: Path, maps: Sequence[Map], columns: int, shades: Mapping[str, str], labels: tuple[str, str], **words: str
) -> None:
    """Write maps side by side, to `path` with .svg and with .png appended; `words` are a title and a subtitle.

    `shades` has the colour of each outcome by its name, in the order of their numbers, and `labels` those of the axes,
    both of which are logarithmic.

    Raises:
      OutputError: if a file cannot be written.
    """
    columns = min(columns, len(maps))
    rows = math.ceil(len(maps) / columns)
    wide = 2.3 if columns > 4 else 3.5
    size: dict[str, Any] = {"width": max(wide * columns + 0.5, 9.5), "height": 0.9 * wide * rows + 1.7}
    with chart(path, rows, columns, **size, **words) as panels:
        for place, axes in enumerate(panels):
            if place >= len(maps):
                axes.set_visible(False)
                continue
            each = maps[place]
            _colour(axes, each, list(shades.values()))
            axes.plot(*zip(*each.predicted, strict=True) if each.predicted else ([], []), **_THEORY)
            axes.plot(*zip(*each.measured, strict=True) if each.measured else ([], []), **_MEASURED)
            axes.set_title(each.title, fontsize=10)
            axes.set_xlabel(labels[0] if place + columns >= len(maps) else "")
            axes.set_ylabel(labels[1] if place % columns == 0 else "")
        handles: list[Artist] = [Patch(facecolor=shade, label=name) for name, shade in shades.items()]
        handles += [Line2D([], [], label="limit of stability, theory", **_THEORY)]
        handles += [Line2D([], [], label="the same, measured", **_MEASURED)]
        name_below(panels, 5 if columns > 2 else 3, handles)


def _colour(axes: Axes, shown: Map, shades: Sequence[str]) -> None:
    """Draw the cells of a map, whose edges are half-way between its values on the logarithmic axes."""
    edges = []
    for values in (np.log(shown.x), np.log(shown.y)):
        half = (values[1] - values[0]) / 2
        edges.append(np.exp(np.append(values - half, values[-1] + half)))
    style: dict[str, Any] = {"cmap": ListedColormap(shades), "vmin": 0, "vmax": len(shades) - 1, "rasterized": True}
    axes.pcolormesh(*edges, np.array(shown.outcomes), **style)
    axes.set(xscale="log", yscale="log")
    axes.minorticks_off()
    axes.grid(visible=False)
