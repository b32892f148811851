"""The plot of the maps of timestep and damping, with theory's limits of stability drawn in."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.output.plots import COLOURS, GREY, chart, name_below
from mjbeer.studies.stability.damped_runs import MEANINGS
from mjbeer.studies.stability.plots import edges

NAME = "stability-damping"
"""Name of the plot's files, without an ending."""
CAPTION = (
    "timestep against the damping between can and load, for six integrators and three ways of rolling; all runs that "
    "are wrong say so."
)
_CELLS = ("#E8A27C", "#F6E3B4", "#BFDFF2", COLOURS[0], "#000000")
"""Colours of the outcomes, which differ in hue and in brightness."""
_LIQUIDS = 0.02
"""Largest damping of a real liquid in such a can [N m s], that of honey."""
_BORDER: dict[str, Any] = {"color": "black", "linewidth": 1.6}
_DOTS: dict[str, Any] = {
    "linestyle": "none", "marker": "o", "markersize": 3, "markerfacecolor": "white", "markeredgecolor": "black",
    "markeredgewidth": 0.6,
}  # fmt: skip


def draw(maps: list[dict[str, Any]], folder: Path) -> str:
    """Write the plot into a folder, as SVG and as PNG, and return a line "name: caption".

    Raises:
      OutputError: if a file cannot be written.
    """
    rollings = [name for name in ROLLINGS if any(result["rolling"] == name for result in maps)]
    integrators = [name for name in (*INTEGRATORS, DOP853) if any(result["integrator"] == name for result in maps)]
    shown = {(result["rolling"], result["integrator"]): result for result in maps}
    size = {"width": max(2.1 * len(integrators) + 1.4, 9.5), "height": 2.3 * len(rollings) + 1.7}
    title = "Damping between can and load: which timestep explodes, and which is accurate"
    subtitle = "half a can of beer, of sheet metal, let go at 1 rad; real liquids are below the dotted line"
    with chart(folder / NAME, len(rollings), len(integrators), **size, title=title, subtitle=subtitle) as panels:
        for place, axes in enumerate(panels):
            row, column = divmod(place, len(integrators))
            result = shown.get((rollings[row], integrators[column]))
            if result is None:
                axes.set_visible(False)
                continue
            _draw_map(axes, result)
            axes.set_title(result["name"], fontsize=10)
            axes.tick_params(labelleft=column == 0, labelbottom=row == len(rollings) - 1)
            if column == 0:
                axes.set_ylabel("damping [N m s]")
            if row == len(rollings) - 1:
                axes.set_xlabel("timestep h [s]")
        handles: list[Artist] = [
            Patch(facecolor=colour, label=meaning if any(code in row for result in maps for row in result["measured"])
                  else f"{meaning}: none")
            for code, (colour, meaning) in enumerate(zip(_CELLS, MEANINGS, strict=True))
        ]  # fmt: skip
        handles += [
            Line2D([], [], label="from here on runs explode, theory", **_BORDER),
            Line2D([], [], label="the same, measured", **_DOTS),
        ]
        name_below(panels, 4, handles)
    return f"{NAME}: {CAPTION}"


def _draw_map(axes: Axes, result: dict[str, Any]) -> None:
    times, values = result["timesteps"], result["values"]
    colours = ListedColormap(_CELLS)
    cells = np.array(result["measured"])
    axes.pcolormesh(edges(times), edges(values), cells, cmap=colours, vmin=0, vmax=len(_CELLS) - 1, rasterized=True)
    axes.set(xscale="log", yscale="log")
    axes.minorticks_off()
    axes.grid(visible=False)
    axes.axhline(_LIQUIDS, color=GREY, linestyle=":", linewidth=1.2)
    for kind, style in (("predicted", _BORDER), ("measured", _DOTS)):
        inside = [edge for edge in result["boundaries"] if edge[kind] and times[0] < edge[kind] < times[-1]]
        axes.plot([edge[kind] for edge in inside], [edge["value"] for edge in inside], **style)
