"""Plots of the limits of stability, measured and predicted by linear theory, and of how energy drifts."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import RUNGE_KUTTA
from mjbeer.studies.cases import CASES

_CELLS = ("#E8A27C", "#BFDFF2", COLOURS[0])
"""Colours of unstable, inaccurate and accurate cells, which differ in hue and in brightness."""
_FLOOR = 1e-16
"""Smallest share of energy that the plot of endurance shows: below it all is rounding."""
_SEMI_IMPLICIT = "semi-implicit"
_METHOD_COLOURS = dict(zip((_SEMI_IMPLICIT, *RUNGE_KUTTA), COLOURS, strict=False))
"""Colours of the plot of endurance; the semi-implicit integrators share one, because their drift is the same."""
MEANINGS = ("unstable", "stable, error above 1 %", "stable and accurate")


@dataclass(frozen=True)
class _Figure:
    """A figure that shows several maps side by side."""

    name: str
    """Name of its files, without an ending."""
    columns: int
    title: str
    caption: str
    holds: Callable[[dict[str, Any]], bool]
    """Returns whether a map belongs to the figure."""


def _usual(result: dict[str, Any]) -> bool:
    """Return whether a map is of an equality with critical damping and its exact diagonal."""
    return result["family"] == "equality" and result["dampratio"] == 1 and result["written"] == "exact"


FIGURES = (
    _Figure(
        name="stability-solref",
        columns=3,
        title="How stiff may a constraint be? Theory draws the line where MuJoCo's runs explode",
        caption="A joint equality with refsafe off: timestep against the time constant of solref.",
        holds=lambda result: _usual(result) and not result["refsafe"],
    ),
    _Figure(
        name="stability-refsafe",
        columns=3,
        title="With refsafe, short time constants are replaced without a word: stable, but softer",
        caption="A joint equality with refsafe on: timestep against the time constant of solref.",
        holds=lambda result: _usual(result) and result["refsafe"],
    ),
    _Figure(
        name="stability-exceptions",
        columns=2,
        title="A light damper explodes in spite of refsafe; a mistaken inertia moves the limit",
        caption="An equality with a damping ratio of 0.1, or with MuJoCo's default diagonal, slide or hinge first.",
        holds=lambda result: result["family"] == "equality" and not _usual(result),
    ),
    _Figure(
        name="stability-direct",
        columns=3,
        title="A constraint with a direct (negative) solref, which refsafe does not touch",
        caption="Timestep against stiffness K of solref = (−K, −2ζ√K).",
        holds=lambda result: result["family"] == "direct",
    ),
    _Figure(
        name="stability-contact",
        columns=4,
        title="A can that lies on the ground: its friction halves the timestep that RK4 bears",
        caption="Contact with friction: timestep against the time constant of solref.",
        holds=lambda result: result["family"] == "contact",
    ),
    _Figure(
        name="stability-gravity",
        columns=3,
        title="A can that swings in ever stronger gravity, which no integrator takes implicitly",
        caption="No constraint: timestep against gravity.",
        holds=lambda result: result["family"] == "gravity",
    ),
    _Figure(
        name="stability-spring",
        columns=4,
        title='A can that swings on a spring: only "discrete" takes it implicitly, and stays stable',
        caption="No constraint: timestep against a joint's spring, by the gravity that has its frequency.",
        holds=lambda result: result["family"] == "spring",
    ),
)
VALUES = {
    "equality": "time constant of solref [s]",
    "contact": "time constant of solref [s]",
    "direct": "stiffness K of solref [1/s²]",
    "gravity": "gravity [m/s²]",
    "spring": "spring, as gravity [m/s²]",
}
"""Labels of the vertical axis, by family."""
LIMITS = "stability-limits"
"""Name of the plot of the limits."""


def draw(limits: list[dict[str, Any]], maps: list[dict[str, Any]], folder: Path) -> list[str]:
    """Write the plots into a folder, each as SVG and as PNG, and return a line "name: caption" for each.

    Raises:
      OutputError: if a file cannot be written.
    """
    drawn = []
    if limits:
        _draw_limits(limits, folder / LIMITS)
        drawn.append(f"{LIMITS}: largest timesteps of small swings, as ωh, against linear theory.")
    for figure in FIGURES:
        shown = [result for result in maps if figure.holds(result)]
        if shown:
            _draw_maps(figure, shown, folder / figure.name)
            drawn.append(f"{figure.name}: {figure.caption}")
    return drawn


def _draw_maps(figure: _Figure, maps: list[dict[str, Any]], path: Path) -> None:
    columns = min(figure.columns, len(maps))
    rows = math.ceil(len(maps) / columns)
    size = {"width": max(3.5 * columns, 9.5), "height": 3.1 * rows + 1.5}
    with chart(path, rows, columns, **size, title=figure.title, subtitle=figure.caption) as panels:
        for axes, result in zip(panels, maps, strict=False):
            _draw_map(axes, result)
        for axes in panels[len(maps) :]:
            axes.set_visible(False)
        for place, axes in enumerate(panels[: len(maps)]):
            if place + columns >= len(maps):
                axes.set_xlabel("timestep h [s]")
            if place % columns == 0:
                axes.set_ylabel(VALUES[maps[place]["family"]])
        handles: list[Artist] = [
            Patch(facecolor=colour, label=name) for colour, name in zip(_CELLS, MEANINGS, strict=True)
        ]
        dots: dict[str, Any] = {"linestyle": "none", "marker": "o", "color": "white", "markeredgecolor": "black"}
        handles += [
            Line2D([], [], color="black", linewidth=1.6, label="limit of stability, theory"),
            Line2D([], [], markersize=5, label="the same, measured", **dots),
        ]
        name_below(panels, 5 if columns > 2 else 3, handles)


def _draw_map(axes: Axes, result: dict[str, Any]) -> None:
    colours = ListedColormap(_CELLS)
    cells = np.array(result["measured"])
    axes.pcolormesh(
        edges(result["timesteps"]), edges(result["values"]), cells, cmap=colours, vmin=0, vmax=2, rasterized=True
    )
    axes.set(xscale="log", yscale="log")
    axes.minorticks_off()
    axes.grid(visible=False)
    first, last = result["timesteps"][0], result["timesteps"][-1]
    predicted, measured = (
        [boundary for boundary in result["boundaries"] if boundary[kind] and first < boundary[kind] < last]
        for kind in ("predicted", "measured")
    )
    axes.plot(
        [boundary["predicted"] for boundary in predicted],
        [boundary["value"] for boundary in predicted],
        color="black",
        linewidth=1.6,
    )
    axes.plot(
        [boundary["measured"] for boundary in measured],
        [boundary["value"] for boundary in measured],
        linestyle="none",
        marker="o",
        markersize=3.5,
        markerfacecolor="white",
        markeredgecolor="black",
        markeredgewidth=0.7,
    )
    axes.set_title(result["name"].partition(", ")[2], fontsize=10.5)


def edges(centres: list[float]) -> np.ndarray:
    """Return the edges of cells whose centres are in geometric progression."""
    half = math.sqrt(centres[1] / centres[0])
    return np.append(np.array(centres) / half, centres[-1] * half)


def _draw_limits(limits: list[dict[str, Any]], path: Path) -> None:
    names = [name for name in (*INTEGRATORS, DOP853) if any(result["integrator"] == name for result in limits)]
    cases = [case for case in CASES if any(result["case"] == case for result in limits)]
    markers = dict(zip(ROLLINGS, "os^", strict=True))
    title = "How long may a timestep be? Limits of small swings, and linear theory"
    subtitle = "reduced: rolling is built into the coordinates; equality: a constraint of two joints; contact: friction"
    with chart(path, width=10, height=6.5, title=title, subtitle=subtitle) as [axes]:
        for place, name in enumerate(names):
            for limit in (linear_stability.stable_limit(name), linear_stability.accurate_limit(name)):
                axes.plot([place - 0.45, place + 0.45], [limit] * 2, color="black", linewidth=1.2, zorder=1)
        for result in limits:
            offset = (cases.index(result["case"]) - (len(cases) - 1) / 2) * 0.16
            offset += (ROLLINGS.index(result["rolling"]) - 1) * 0.045
            colour = COLOURS[list(CASES).index(result["case"])]
            x = names.index(result["integrator"]) + offset
            style: dict[str, Any] = {"linestyle": "none", "color": colour, "markersize": 6}
            if not result["settled"]:
                axes.plot([x], [result["stable"]], marker="x", **style)
                continue
            axes.plot([x], [result["stable"]], marker=markers[result["rolling"]], **style)
            axes.plot([x], [result["accurate"]], marker=markers[result["rolling"]], markerfacecolor="white", **style)
        style = {"linestyle": "none", "color": "#555555"}
        handles: list[Artist] = [Patch(facecolor=COLOURS[list(CASES).index(case)], label=case) for case in cases]
        handles += [Line2D([], [], marker=marker, label=name, **style) for name, marker in markers.items()]
        handles += [
            Line2D([], [], marker="o", label="largest stable timestep", **style),
            Line2D([], [], marker="o", markerfacecolor="white", label="largest accurate timestep (1 %)", **style),
            Line2D([], [], marker="x", label="stable, contact not settled", **style),
            Line2D([], [], color="black", label="linear theory of the scene"),
        ]
        axes.set_xticks(range(len(names)), names)
        axes.set(yscale="log", ylabel="frequency of the swing × timestep, ωh", ylim=(1e-2, 12))
        axes.set_xlabel("integrator")
        name_below([axes], 4, handles)


def draw_endurance(results: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw how energy drifts with the number of swings, to `path` with .svg and with .png appended.

    Raises:
      OutputError: if a file cannot be written.
    """
    lines: dict[tuple[str, int, str], list[dict[str, Any]]] = {}
    for result in results:
        method = result["integrator"] if result["integrator"] in RUNGE_KUTTA else _SEMI_IMPLICIT
        lines.setdefault((method, result["steps"], result["name"]), []).append(result)
    styles = {method: iter(("-", "--", ":")) for method in _METHOD_COLOURS}
    title = "How much energy a swing gains or loses by being simulated"
    subtitle = "swings of 1 rad of beer that slides in its can"
    with chart(path, width=9, height=7, title=title, subtitle=subtitle) as (axes,):
        for (method, steps, name), runs in lines.items():
            shown = max(runs, key=lambda run: run["swings"])  # the lines of the similar integrators coincide with it
            law = " or ".join({run["law"] or "no law": None for run in runs})
            size = np.maximum(np.abs(shown["width" if shown["law"] == "bounded" else "drift"]), _FLOOR)
            style = next(styles[method])
            label = f"{', '.join(run['integrator'] for run in runs)}: {steps} steps a swing, {name} ({law})"
            axes.plot(shown["counts"], size, style, color=_METHOD_COLOURS[method], label=label)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(_FLOOR, 2)
        axes.set_xlabel("number of swings")
        axes.set_ylabel("energy gained or lost, share of the swing's")
        name_below([axes], 1)
