"""Maps of timestep and stiffness or damping: where runs explode, measured and by linear theory."""

import datetime
import json
import math
import pathlib
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling
from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.output.terminal import Table
from mjbeer.studies.rows import PASSED, Result, Row, Study
from mjbeer.studies.stability.limits import bisected
from mjbeer.studies.stability.stiff_runs import EXPLODED, SILENT, DampedRuns, Plan, ShortRuns

STIFF, DAMPED = "maps", "damped"
"""The groups of the study with maps of stiffness, and with those of damping."""
SHIPPED = pathlib.Path(__file__).with_name("maps.json")
"""The maps that come with mjbeer; `mjbeer stability --maps` wrote them."""
CELLS, QUICK_CELLS = (20, 20), (8, 8)
"""Number of timesteps in a map, and of stiffnesses; the second is for quick studies."""
DAMPED_CELLS, QUICK_DAMPED_CELLS = (13, 16), (4, 6)
"""Number of timesteps and of dampings."""
AXES = {
    "equality": ((1e-4, 1.0), (1e-4, 1e-1), "time constant of solref [s]"),
    "direct": ((1e-5, 1.0), (1e2, 1e10), "stiffness K of solref [1/s²]"),
    "contact": ((1e-4, 1e-1), (1e-4, 1e-1), "time constant of solref [s]"),
    "gravity": ((1e-3, 10.0), (1e-3, 1e3), "gravity [m/s²]"),
    "spring": ((1e-3, 10.0), (1e-3, 1e3), "spring, as gravity [m/s²]"),
    "damping": ((2.5e-4, 1.6e-2), (1e-4, 1e1), "damping [N m s]"),
}
"""The timesteps [s] of a map by family, its values, and what these are; dampings of real liquids are below 0.02."""
AGREEMENT = {STIFF: 0.05, DAMPED: 0.04, "contact": 0.12}
"""Largest relative difference at which a measured border agrees with the predicted one. The largest of the damped maps
is 0.033: theory takes the load's angle as constant in parts of a run, in which the fast rate changes by some per cent.
In contact, where DOP853's stages overshoot, the damped can slips and parts from the ground, which linear theory does
not know: runs explode up to a tenth earlier, in their first step."""
_RESOLUTION = 1.01
"""Bisection ends when the two timesteps that enclose a border have this ratio."""
_MOSTLY = ("Euler", "implicitfast", "discrete", "RK4")
"""Integrators of the families that are not mapped for all of them."""
_ALL: tuple[Integrator, ...] = (*INTEGRATORS, DOP853)
PLANS = (
    *(Plan("equality", name, refsafe) for refsafe in (False, True) for name in _ALL),
    *(Plan("equality", "Euler", refsafe, dampratio=0.1) for refsafe in (False, True)),
    *(Plan("equality", "Euler", written=first) for first in ("slide", "hinge")),
    *(Plan("direct", name) for name in _MOSTLY),
    Plan("direct", "Euler", dampratio=0.1),
    Plan("direct", "Euler", refsafe=True),
    *(Plan("contact", name, refsafe) for refsafe in (False, True) for name in _MOSTLY),
    *(Plan("gravity", name) for name in _ALL),
    *(Plan("spring", name) for name in _MOSTLY),
)
"""Maps of stiffness of a full study."""
_QUICK = {
    STIFF: "equality, Euler; equality, RK4; equality, discrete; equality, implicitfast, refsafe; direct, Euler; "
    "equality, Euler, refsafe, damping ratio 0.1; equality, Euler, slide first; contact, Euler; contact, RK4; "
    "gravity, Euler; gravity, RK4; spring, discrete",
    DAMPED: "reduced, Euler; reduced, RK4; equality, implicit; equality, discrete; contact, RK4",
}
"""Names of the maps of a quick study."""
DAMPED_PLANS: tuple[tuple[Rolling, Integrator], ...] = tuple((way, name) for way in ROLLINGS for name in _ALL)
"""Ways of rolling and integrators of the maps of damping of a full study."""
SHADES = {"unstable": "#E8A27C", "stable, error above 1 %": "#BFDFF2", "stable and accurate": COLOURS[0]}
"""The outcomes of a map of stiffness, and their colours, which differ in hue and in brightness."""
DAMPED_SHADES = {
    "exploded": "#E8A27C",
    "inaccurate, and says so": "#F6E3B4",
    "accurate, but warns": "#BFDFF2",
    "accurate and trusted": COLOURS[0],
    "wrong and silent": "#000000",
}
_THEORY: dict[str, Any] = {"color": "black", "linewidth": 1.6}
"""The look of a border that theory predicts."""
_MEASURED: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 3.5, "color": "black"}
_MEASURED |= {"markerfacecolor": "white", "markeredgewidth": 0.7}


class Figure(NamedTuple):
    """A figure that shows several maps side by side; its files have its name without an ending."""

    columns: int
    title: str
    caption: str


FIGURES = {
    "stability-solref": Figure(
        3,
        "How stiff may a constraint be? Theory draws the line where MuJoCo's runs explode",
        "A joint equality with refsafe off: timestep against the time constant of solref.",
    ),
    "stability-refsafe": Figure(
        3,
        "With refsafe, short time constants are replaced without a word: stable, but softer",
        "A joint equality with refsafe on: timestep against the time constant of solref.",
    ),
    "stability-exceptions": Figure(
        2,
        "A light damper explodes in spite of refsafe; a mistaken inertia moves the limit",
        "An equality with a damping ratio of 0.1, or with MuJoCo's default diagonal, slide or hinge first.",
    ),
    "stability-direct": Figure(
        3,
        "A constraint with a direct (negative) solref, which refsafe does not touch",
        "Timestep against stiffness K of solref = (−K, −2ζ√K).",
    ),
    "stability-contact": Figure(
        4,
        "A can that lies on the ground: its friction halves the timestep that RK4 bears",
        "Contact with friction: timestep against the time constant of solref.",
    ),
    "stability-gravity": Figure(
        3,
        "A can that swings in ever stronger gravity, which no integrator takes implicitly",
        "No constraint: timestep against gravity.",
    ),
    "stability-spring": Figure(
        4,
        'A can that swings on a spring: only "discrete" takes it implicitly, and stays stable',
        "No constraint: timestep against a joint's spring, by the gravity that has its frequency.",
    ),
    "stability-damping": Figure(
        6,
        "Damping between can and load: which timestep explodes, and which is accurate",
        "Half a can of beer, of sheet metal, let go at 1 rad; real liquids have a damping of at most 0.02 N m s.",
    ),
}


def rows(quick: bool = False) -> list[Row]:
    """Return a row a map; a `quick` study has fewer and coarser ones."""
    cells, damped_cells = (QUICK_CELLS, QUICK_DAMPED_CELLS) if quick else (CELLS, DAMPED_CELLS)
    row = partial(Row, unit="relative", reason="bisection to 1 %, and an instability has to grow before it is seen")
    found = [row(STIFF, plan.name, partial(measure, plan, cells), bound=AGREEMENT[STIFF]) for plan in PLANS]
    for rolling, integrator in DAMPED_PLANS:
        measured = partial(measure_damped, rolling, integrator, damped_cells)
        bound = AGREEMENT.get(rolling, AGREEMENT[DAMPED])
        found.append(row(DAMPED, f"{rolling}, {integrator}", measured, bound=bound))
    return [each for each in found if not quick or each.name in _QUICK[each.group].split("; ")]


def measure(plan: Plan, cells: tuple[int, int]) -> dict[str, Any]:
    """Return a map of so many timesteps by stiffnesses, as `_measure` does."""
    about = {name: getattr(plan, name) for name in ("family", "integrator", "refsafe", "dampratio", "written")}
    return about | _measure(plan.family, cells, lambda value, _: ShortRuns(plan, value))


def measure_damped(rolling: Rolling, integrator: Integrator, cells: tuple[int, int]) -> dict[str, Any]:
    """Return a map of so many timesteps by dampings, as `_measure` does; with a run that is wrong and silent, no theory
    agrees, and "error" is None.
    """
    about = {"rolling": rolling, "integrator": integrator}
    found = _measure("damping", cells, lambda value, times: DampedRuns(rolling, integrator, value, times))
    if any(str(SILENT) in row for row in found["measured"]):
        found["error"] = None
    return about | found


def _measure(family: str, cells: tuple[int, int], make: Callable[[float, list[float]], Any]) -> dict[str, Any]:
    """Return how runs end at so many timesteps and values, and the border from which on they explode.

    "measured" has a string for each value and a digit for each timestep, the outcome; "same" is the share of cells
    whose outcome is the predicted one. "boundaries" has for each value the timestep [s] from which on runs explode,
    measured and predicted, or None where none does; "error" is the largest relative difference of the two.
    """
    spans = zip(AXES[family][:2], cells, strict=True)
    timesteps, values = (np.geomspace(*span, count).tolist() for span, count in spans)
    measured, boundaries, same, worst = [], [], [], 0.0
    for value in values:
        runs = make(value, timesteps)
        ended, expected = ([judge(timestep) for timestep in timesteps] for judge in (runs.measure, runs.predict))
        measured.append("".join(map(str, ended)))
        # Where theory only says that a run does not explode, any other outcome is as predicted.
        same += [
            (each == wanted) if wanted >= 0 else each != EXPLODED for each, wanted in zip(ended, expected, strict=True)
        ]
        edges = (
            _border(runs.explodes, timesteps, ended),
            _border(lambda timestep, runs=runs: runs.predict(timestep) == EXPLODED, timesteps, expected),
        )
        boundaries.append(edges)
        worst = max(worst, difference(*edges))
    found = {"same": float(np.mean(same)), "timesteps": timesteps, "values": values, "measured": measured}
    return found | {"boundaries": boundaries, "error": worst}


def _border(explodes: Callable[[float], bool], timesteps: list[float], outcomes: list[int]) -> float | None:
    """Return the least timestep [s] that explodes, by bisection beside the first that did; None if none did."""
    if EXPLODED not in outcomes:
        return None
    if (place := outcomes.index(EXPLODED)) == 0:
        return timesteps[0]
    low, high = bisected(lambda step: not explodes(step), timesteps[place - 1], timesteps[place], _RESOLUTION)
    return math.sqrt(low * high)


def difference(measured: float | None, predicted: float | None) -> float:
    """Return the relative difference of two borders: 0 if neither exists, 1 if only one of them does."""
    if measured is None or predicted is None:
        return float(measured is not predicted)
    return abs(measured / predicted - 1)


def table(title: str, results: Sequence[Result], meanings: Sequence[str]) -> Table:
    """Return a table of how many runs of each map ended in which way, and how well theory knew where they explode."""
    lines = []
    for result in results:
        cells, error = "".join(result.values["measured"]), "-" if result.error is None else f"{result.error:.1%}"
        counts = (str(cells.count(str(outcome))) for outcome in range(len(meanings)))
        lines.append((result.name, *counts, f"{result.values['same']:.1%}", error, PASSED[result.passed]))
    return Table(title, ("map", *meanings, "cells as predicted", "border off by", "verdict"), lines)


def to_json(study: Study, date: datetime.date) -> str:
    """Return the maps of a study as a JSON document, a line each, with its command, its machine and a date.

    Numbers have six digits; a border is known to a hundredth.
    """
    extent = study.settings["extent"]
    command = study.command + ("" if extent == "usual" else f" --{extent}")
    head = json.dumps({"command": command, "date": date.isoformat(), "machine": study.machine}, indent=1)
    parts = []
    for group in (STIFF, DAMPED):
        kept = [
            json.dumps({"name": of.name, "agrees": of.passed, "worst": of.error, **of.values}) for of in study.of(group)
        ]
        rounded = [json.loads(of, parse_float=lambda digits: float(f"{float(digits):.6g}")) for of in kept]
        parts.append(f' "{group}": [\n' + ",\n".join(map(json.dumps, rounded)) + "\n]")
    return head[: head.rindex("}")].rstrip() + ",\n" + ",\n".join(parts) + "}\n"


def load(path: pathlib.Path = SHIPPED) -> dict[str, Any]:
    """Return the document in a file that `to_json` wrote.

    Raises:
      ParameterError: if the file is missing, or is not such a document.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if not {"command", "date", "machine", STIFF, DAMPED} <= set(document):
            raise ValueError("it has no maps")
    except (OSError, ValueError, TypeError) as error:
        raise ParameterError(f"{path} was not written by `mjbeer stability`: {error}") from error
    return document


def figures(document: dict[str, Any]) -> dict[str, Callable[[pathlib.Path], None]]:
    """Return what draws each figure of the maps in a document to a path, with .svg appended, by the figure's name."""
    maps: dict[str, list[dict[str, Any]]] = {name: [] for name in FIGURES}
    for of in (*document[STIFF], *document[DAMPED]):
        maps[_figure(of)].append(of)
    return {name: partial(draw, figure=FIGURES[name], maps=shown) for name, shown in maps.items() if shown}


def _figure(of: dict[str, Any]) -> str:
    """Return the name of the figure that a map belongs to."""
    family = of.get("family", "damping")
    if family == "equality" and of["dampratio"] == 1 and of["written"] == "exact":
        return "stability-refsafe" if of["refsafe"] else "stability-solref"
    return f"stability-{'exceptions' if family == 'equality' else family}"


def draw(path: pathlib.Path, figure: Figure, maps: Sequence[dict[str, Any]]) -> None:
    """Write maps of one family side by side, to `path` with .svg appended."""
    family = maps[0].get("family", "damping")
    shades = SHADES if "family" in maps[0] else DAMPED_SHADES
    columns = min(figure.columns, len(maps))
    rows = math.ceil(len(maps) / columns)
    wide = 2.3 if columns > 4 else 3.5
    size, height = max(wide * columns + 0.5, 9.5), 0.9 * wide * rows + 1.7
    with chart(path, rows, columns, size, height, figure.title, figure.caption) as panels:
        for axes in panels[len(maps) :]:
            axes.set_visible(False)
        for place, (axes, of) in enumerate(zip(panels, maps, strict=False)):
            _colour(axes, of, list(shades.values()))
            for border, style in ((1, _THEORY), (0, _MEASURED)):
                edges = [(edges[border], value) for value, edges in zip(of["values"], of["boundaries"], strict=True)]
                inside = [edge for edge in edges if edge[0] and of["timesteps"][0] < edge[0] < of["timesteps"][-1]]
                axes.plot(*zip(*inside, strict=True) if inside else ([], []), **style)
            axes.set_title(of["name"].removeprefix(f"{family}, "), fontsize=10)
            axes.set_xlabel("timestep h [s]" if place + columns >= len(maps) else "")
            axes.set_ylabel(AXES[family][2] if place % columns == 0 else "")
        handles: list[Artist] = [Patch(facecolor=shade, label=name) for name, shade in shades.items()]
        handles += [Line2D([], [], label="limit of stability, theory", **_THEORY)]
        handles += [Line2D([], [], label="the same, measured", **_MEASURED)]
        name_below(panels, 5 if columns > 2 else 3, handles)


def _colour(axes: Axes, of: dict[str, Any], shades: Sequence[str]) -> None:
    """Draw the cells of a map, whose edges are half-way between its values on the logarithmic axes."""
    edges = []
    for values in (np.log(of["timesteps"]), np.log(of["values"])):
        half = (values[1] - values[0]) / 2
        edges.append(np.exp(np.append(values - half, values[-1] + half)))
    style: dict[str, Any] = {"cmap": ListedColormap(shades), "vmin": 0, "vmax": len(shades) - 1, "rasterized": True}
    axes.pcolormesh(*edges, [[int(cell) for cell in row] for row in of["measured"]], **style)
    axes.set(xscale="log", yscale="log")
    axes.minorticks_off()
    axes.grid(visible=False)
