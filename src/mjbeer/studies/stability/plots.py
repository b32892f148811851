"""Plots of the limits of stability: what was measured, with the boundary that linear theory predicts over it."""

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
from mjbeer.output.plots import COLOURS, chart
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import RUNGE_KUTTA
from mjbeer.studies.cases import CASES

_CELLS = ("#E8A27C", "#BFDFF2", COLOURS[0])
"""Colours of unstable, inaccurate and accurate cells: apart in hue as in brightness."""
_FLOOR = 1e-16
"""Least share of energy that the plot of endurance shows: rounding."""
_SEMI_IMPLICIT = "semi-implicit"
_KIN_COLOURS = dict(zip((_SEMI_IMPLICIT, *RUNGE_KUTTA), COLOURS, strict=False))
_MEANINGS = ("unstable", "stable, error above 1 %", "stable and accurate")


@dataclass(frozen=True)
class _Figure:
    """Maps that are drawn together."""

    name: str
    columns: int
    title: str
    caption: str
    holds: Callable[[dict[str, Any]], bool]
    """Whether a map belongs to it."""


def _usual(each: dict[str, Any]) -> bool:
    return each["family"] == "equality" and each["dampratio"] == 1 and each["written"] == "exact"


_FIGURES = (
    _Figure(
        "stability-solref", 3, "How stiff may a constraint be? Theory draws the line where MuJoCo's runs explode",
        "A joint equality with refsafe off: timestep against the time constant of solref.",
        lambda each: _usual(each) and not each["refsafe"],
    ),
    _Figure(
        "stability-refsafe", 3, "With refsafe, short time constants are replaced without a word: stable, but softer",
        "A joint equality with refsafe on: timestep against the time constant of solref.",
        lambda each: _usual(each) and each["refsafe"],
    ),
    _Figure(
        "stability-exceptions", 2, "A light damper explodes in spite of refsafe; a mistaken inertia moves the limit",
        "A joint equality with a damping ratio of 0.1, and with MuJoCo's default diagonal, slide or hinge first.",
        lambda each: each["family"] == "equality" and not _usual(each),
    ),
    _Figure(
        "stability-direct", 3, "A constraint with a direct (negative) solref, which refsafe does not touch",
        "Timestep against stiffness K of solref = (-K, -2 zeta sqrt(K)).", lambda each: each["family"] == "direct",
    ),
    _Figure(
        "stability-contact", 4, "A can that lies on the ground: its friction halves the timestep that RK4 bears",
        "Contact with friction: timestep against the time constant of solref.",
        lambda each: each["family"] == "contact",
    ),
    _Figure(
        "stability-gravity", 3, "A can that swings in ever stronger gravity, which no integrator takes implicitly",
        "No constraint: timestep against gravity.", lambda each: each["family"] == "gravity",
    ),
    _Figure(
        "stability-spring", 4, "A can that swings on a spring: only \"discrete\" takes it implicitly, and stays stable",
        "No constraint: timestep against a joint's spring, by the gravity that has its frequency.",
        lambda each: each["family"] == "spring",
    ),
)  # fmt: skip
_VALUES = {
    "equality": "time constant of solref [s]",
    "contact": "time constant of solref [s]",
    "direct": "stiffness K of solref [1/s²]",
    "gravity": "gravity [m/s²]",
    "spring": "spring, as gravity [m/s²]",
}
LIMITS = "stability-limits"
"""Name of the plot of the limits."""


def draw(limits: list[dict[str, Any]], maps: list[dict[str, Any]], folder: Path) -> list[str]:
    """Write the plots into a folder, each as SVG and as PNG; returned are lines "name: caption".

    Raises:
      OutputError: if a file cannot be written.
    """
    drawn = []
    if limits:
        _limits(limits, folder / LIMITS)
        drawn.append(f"{LIMITS}: largest timesteps of small swings, as omega h, against linear theory.")
    for figure in _FIGURES:
        found = [each for each in maps if figure.holds(each)]
        if found:
            _maps(figure, found, folder / figure.name)
            drawn.append(f"{figure.name}: {figure.caption}")
    return drawn


def _maps(figure: _Figure, maps: list[dict[str, Any]], path: Path) -> None:
    columns = min(figure.columns, len(maps))
    rows = math.ceil(len(maps) / columns)
    with chart(path, rows, columns, max(3.5 * columns, 9), 3.1 * rows + 1.1) as panels:
        for axes, each in zip(panels, maps, strict=False):
            _panel(axes, each)
        for axes in panels[len(maps) :]:
            axes.set_visible(False)
        for place, axes in enumerate(panels[: len(maps)]):
            if place + columns >= len(maps):
                axes.set_xlabel("timestep h [s]")
            if place % columns == 0:
                axes.set_ylabel(_VALUES[maps[place]["family"]])
        whole = panels[0].figure
        handles: list[Artist] = [
            Patch(facecolor=colour, label=name) for colour, name in zip(_CELLS, _MEANINGS, strict=True)
        ]
        dots: dict[str, Any] = {"linestyle": "none", "marker": "o", "color": "white", "markeredgecolor": "black"}
        handles += [
            Line2D([], [], color="black", linewidth=1.6, label="limit of stability, theory"),
            Line2D([], [], markersize=5, label="the same, measured", **dots),
        ]
        whole.legend(handles=handles, loc="outside lower center", ncols=5 if columns > 2 else 3, fontsize=10)
        whole.suptitle(figure.title, fontsize=13)


def _panel(axes: Axes, found: dict[str, Any]) -> None:
    colours = ListedColormap(_CELLS)
    cells = np.array(found["measured"])
    axes.pcolormesh(
        _edges(found["timesteps"]), _edges(found["values"]), cells, cmap=colours, vmin=0, vmax=2, rasterized=True
    )
    axes.set(xscale="log", yscale="log")
    axes.grid(visible=False)
    first, last = found["timesteps"][0], found["timesteps"][-1]
    inside = [each for each in found["boundaries"] if each["predicted"] and first < each["predicted"] < last]
    axes.plot([each["predicted"] for each in inside], [each["value"] for each in inside], color="black", linewidth=1.6)
    seen = [each for each in found["boundaries"] if each["measured"] and first < each["measured"] < last]
    axes.plot(
        [each["measured"] for each in seen], [each["value"] for each in seen], linestyle="none", marker="o",
        markersize=3.5, markerfacecolor="white", markeredgecolor="black", markeredgewidth=0.7,
    )  # fmt: skip
    axes.set_title(found["name"].partition(", ")[2], fontsize=10.5)


def _edges(centres: list[float]) -> np.ndarray:
    """Edges of cells about centres in geometric progression."""
    half = math.sqrt(centres[1] / centres[0])
    return np.append(np.array(centres) / half, centres[-1] * half)


def _limits(limits: list[dict[str, Any]], path: Path) -> None:
    names = [each for each in (*INTEGRATORS, DOP853) if any(found["integrator"] == each for found in limits)]
    cases = [each for each in CASES if any(found["case"] == each for found in limits)]
    markers = dict(zip(ROLLINGS, "os^", strict=True))
    with chart(path, width=10, height=6) as [axes]:
        for place, name in enumerate(names):
            for limit in (linear_stability.stable_limit(name), linear_stability.accurate_limit(name)):
                axes.plot([place - 0.45, place + 0.45], [limit] * 2, color="black", linewidth=1.2, zorder=1)
        for found in limits:
            offset = (cases.index(found["case"]) - (len(cases) - 1) / 2) * 0.16
            offset += (ROLLINGS.index(found["rolling"]) - 1) * 0.045
            colour = COLOURS[list(CASES).index(found["case"])]
            x = names.index(found["integrator"]) + offset
            style: dict[str, Any] = {"linestyle": "none", "color": colour, "markersize": 6}
            if not found["settled"]:
                axes.plot([x], [found["stable"]], marker="x", **style)
                continue
            axes.plot([x], [found["stable"]], marker=markers[found["rolling"]], **style)
            axes.plot([x], [found["accurate"]], marker=markers[found["rolling"]], markerfacecolor="white", **style)
        style = {"linestyle": "none", "color": "#555555"}
        handles: list[Artist] = [Patch(facecolor=COLOURS[list(CASES).index(each)], label=each) for each in cases]
        handles += [Line2D([], [], marker=marker, label=name, **style) for name, marker in markers.items()]
        handles += [
            Line2D([], [], marker="o", label="largest stable timestep", **style),
            Line2D([], [], marker="o", markerfacecolor="white", label="largest accurate timestep (1 %)", **style),
            Line2D([], [], marker="x", label="stable, contact not settled", **style),
            Line2D([], [], color="black", label="linear theory of the scene"),
        ]
        axes.set_xticks(range(len(names)), names)
        axes.set(yscale="log", ylabel="frequency of the swing times timestep, ωh", ylim=(1e-2, 12))
        axes.set_title("How long may a timestep be? Limits of small swings, and what linear theory says", fontsize=13)
        axes.figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=10)


def draw_endurance(found: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw how energy drifts with the number of swings, as `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    lines: dict[tuple[str, int, str], list[dict[str, Any]]] = {}
    for each in found:
        kin = each["integrator"] if each["integrator"] in RUNGE_KUTTA else _SEMI_IMPLICIT
        lines.setdefault((kin, each["steps"], each["name"]), []).append(each)
    styles = {kin: iter(("-", "--", ":")) for kin in _KIN_COLOURS}
    with chart(path, width=9, height=6.5) as (axes,):
        for (kin, steps, name), runs in lines.items():
            shown = max(runs, key=lambda each: each["swings"])  # the others of its kin lie under it
            law = " or ".join({each["law"] or "no law": None for each in runs})
            size = np.maximum(np.abs(shown["width" if shown["law"] == "bounded" else "drift"]), _FLOOR)
            style = next(styles[kin])
            label = f"{', '.join(each['integrator'] for each in runs)}: {steps} steps a swing, {name} ({law})"
            axes.plot(shown["counts"], size, style, color=_KIN_COLOURS[kin], label=label)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(_FLOOR, 2)
        axes.set_xlabel("number of swings of 1 rad")
        axes.set_ylabel("energy of the swing gained or lost, as a share of it")
        axes.set_title("How much energy a swing gains or loses by being simulated")
        axes.figure.legend(loc="outside lower center", fontsize=8)
