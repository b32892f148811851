"""Plots of the maps of timestep and stiffness: how each run ends, and where stability ends."""

import math
import pathlib
import textwrap
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.output.plots import GREY, Picture, chart, name_below
from mjbeer.studies.stability.stability_maps import (
    FAMILIES,
    RESOLUTION,
    SHADES,
    StabilityMap,
    StoredMaps,
)

_THEORY: dict[str, Any] = {"color": "black", "linewidth": 1.6}
"""The style of a border that theory predicts."""
_MEASURED: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.5,
    "color": "black",
    "markerfacecolor": "white",
    "markeredgewidth": 0.7,
}


def figures(stored: StoredMaps) -> dict[str, Callable[[pathlib.Path], None]]:
    """Return, by the names of figures, functions that draw them to a path with .svg appended."""
    drawings = {}
    for family in FAMILIES:
        maps = [one_map for one_map in stored.maps if one_map.family == family]
        if maps:
            drawings[f"stability-{family}"] = partial(draw, maps=maps)
    return drawings


def draw(path: pathlib.Path | Picture, maps: Sequence[StabilityMap]) -> None:
    """Write maps of one family side by side, to `path` with .svg appended.

    Integrators whose runs all end alike share a panel.
    """
    family = FAMILIES[maps[0].family]
    alike: dict[tuple[str, ...], list[StabilityMap]] = {}
    for one_map in maps:
        alike.setdefault(tuple(one_map.measured), []).append(one_map)
    groups = list(alike.values())
    columns = 3 if len(groups) == 3 else min(2, len(groups))
    rows = math.ceil(len(groups) / columns)
    width = 9.0 if columns > 1 else 5.0
    height = 2.7 * rows + 2.3
    near = max(RESOLUTION - 1, *(one_map.worst for one_map in maps))
    subtitle = f"{family.caption} Runs explode where linear theory says, within {100 * near:.0f} %."
    with chart(path, rows, columns, width, height, family.title, subtitle) as panels:
        for axes in panels[len(groups) :]:
            axes.set_visible(False)
        for place, (axes, group) in enumerate(zip(panels, groups, strict=False)):
            shown = group[0]
            _draw_cells(axes, shown)
            predicted = [border.predicted for border in shown.boundaries]
            measured = [border.measured for border in shown.boundaries]
            _draw_border(axes, shown, predicted, _THEORY)
            _draw_border(axes, shown, measured, _MEASURED)
            names = textwrap.fill(", ".join(one_map.integrator for one_map in group), 72 // columns)
            axes.set_title(f"{names}\n{_limit(shown)}")
            is_lowest = place + columns >= len(groups)
            axes.set_xlabel("timestep h [s]" if is_lowest else "")
            axes.tick_params(labelbottom=is_lowest)
            is_first = place % columns == 0
            axes.set_ylabel(family.label if is_first else "")
            axes.tick_params(labelleft=is_first)
        handles: list[Artist] = []
        for name, shade in SHADES.items():
            # With an edge, as on a dark page a pale shade becomes as dark as the page.
            handles.append(Patch(facecolor=shade, edgecolor=GREY, linewidth=0.8, label=name))
        handles.append(Line2D([], [], label="limit of stability, theory", **_THEORY))
        handles.append(Line2D([], [], label="limit of stability, MuJoCo", **_MEASURED))
        name_below(panels, 3, handles)


def _limit(one_map: StabilityMap) -> str:
    """Return the timesteps that are stable by theory, as a law of the family's quantity.

    It is the law of most values: of others, something else may set the limit.
    """
    family = FAMILIES[one_map.family]
    values = []
    timesteps = []
    for value, border in zip(one_map.values, one_map.boundaries, strict=True):
        if border.predicted is not None:
            values.append(value)
            timesteps.append(border.predicted)
    if not values:
        return "stable with every timestep"
    found = [
        _Law(np.array(timesteps) * np.array(values) ** power, text)
        for power, text in ((family.power, family.law), (0.0, "{} s"))
    ]
    law = max(found, key=lambda law: law.share)
    return f"stable below h = {law.text.format(f'{np.median(law.constants):.2g}')}"


class _Law(NamedTuple):
    """What may be constant along a border."""

    constants: np.ndarray
    text: str

    @property
    def share(self) -> float:
        """The share of constants that differ by less than 2 % from their median."""
        return float(np.mean(np.abs(self.constants / np.median(self.constants) - 1) < 0.02))


def _draw_border(
    axes: Axes, one_map: StabilityMap, timesteps: Sequence[float | None], style: dict[str, Any]
) -> None:
    """Draw a border where it lies inside the map."""
    least = one_map.timesteps[0]
    largest = one_map.timesteps[-1]
    x = []
    y = []
    for timestep, value in zip(timesteps, one_map.values, strict=True):
        if timestep is not None and least < timestep < largest:
            x.append(timestep)
            y.append(value)
    axes.plot(x, y, **style)


def _draw_cells(axes: Axes, one_map: StabilityMap) -> None:
    """Draw the cells, whose edges lie half-way between the values on logarithmic axes."""
    outcomes = [[int(cell) for cell in row] for row in one_map.measured]
    colours = ListedColormap(list(SHADES.values()))
    axes.pcolormesh(
        _edges(one_map.timesteps),
        _edges(one_map.values),
        outcomes,
        cmap=colours,
        vmin=0,
        vmax=len(SHADES) - 1,
        rasterized=True,
    )
    axes.set(xscale="log", yscale="log")
    first = math.ceil(math.log10(one_map.timesteps[0]))
    last = math.floor(math.log10(one_map.timesteps[-1]))
    decades = np.arange(first, last + 1)
    # Of many decades every other one has a label, so that those of neighbours do not touch.
    axes.set_xticks(10.0 ** (decades[1::2] if len(decades) > 4 else decades))
    axes.minorticks_off()
    axes.grid(visible=False)


def _edges(values: Sequence[float]) -> np.ndarray:
    """Return the edges of cells around values that are evenly spaced on a logarithmic axis."""
    logarithms = np.log(values)
    half = (logarithms[1] - logarithms[0]) / 2
    return np.exp(np.append(logarithms - half, logarithms[-1] + half))
