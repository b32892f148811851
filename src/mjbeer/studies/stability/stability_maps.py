"""Maps of timestep and stiffness or damping: how short runs of stiff models end, measured and by linear theory.

A can with frozen beer on level ground is the stiffer, the harder its constraint, or the stronger gravity. Beer that
slides in a can of sheet metal is the stiffer, the stronger it is damped. Both motions, MuJoCo's and theory's, begin
with the same small swing and are judged by the same rule.
"""

import json
import math
import pathlib
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import mujoco
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.checks.check import Check, Result
from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.dynamics import Dynamics
from mjbeer.integrators.mujoco_steps import MuJoCoSteps
from mjbeer.model.build import build, specify
from mjbeer.model.joints import joint_addresses
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Integrator
from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.output.terminal import Table
from mjbeer.studies import predictions
from mjbeer.studies.predictions import ACCURACY, GROWTH, spring
from mjbeer.studies.study import FAILED
from mjbeer.theory.can import Can
from mjbeer.theory.scene import frozen, sliding

MAPS = "maps"
"""The group of the study that the maps are in."""
SHIPPED = pathlib.Path(__file__).with_name("maps.json")
"""The maps that come with mjbeer; `mjbeer stability` wrote them."""
CELLS, FEW_CELLS = 20, 8
"""Number of timesteps and of values in a map, and in one of a quick study."""
_AGREEMENT = 0.05
"""Largest relative difference at which a measured border agrees with the predicted one."""
_RESOLUTION = 1.01
"""Bisection ends when the two timesteps that enclose a border have this ratio."""
EXPLODED, INACCURATE, ACCURATE = range(3)
"""Outcomes of a run, as numbers for the cells of a map."""
_IMPEDANCE = 0.9
"""dmin and dmax in the solimp of the constraints: both are MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING`. It must be tiny: a stiff constraint corrects it within one
time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a swing: within it, a growth of 2 % a step makes any initial violation visible."""
_ALL: tuple[Integrator, ...] = (*MUJOCO_INTEGRATORS, "DOP853")
PLANS: tuple[tuple[str, Integrator], ...] = (
    *(("solref", name) for name in _ALL),
    *(("direct", name) for name in _ALL if name not in ("implicit", "DOP853")),
    *(("gravity", name) for name in _ALL),
    *(("damping", name) for name in _ALL),
)
"""All maps: the cause of stiffness, which is an equality whose solref has a time constant ("solref") or a stiffness
("direct"), "gravity" without a constraint, or the "damping" between can and load; and the integrator."""
SHADES = {"exploded": "#E8A27C", "stable, inaccurate": "#BFDFF2", "stable and accurate": COLOURS[0]}
"""The outcomes, and their colours, which differ in hue and in brightness."""
_THEORY: dict[str, Any] = {"color": "black", "linewidth": 1.6}
"""The look of a border that theory predicts."""
_MEASURED: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 3.5, "color": "black"}
_MEASURED |= {"markerfacecolor": "white", "markeredgewidth": 0.7}


class Family(NamedTuple):
    """Maps that one figure shows side by side."""

    timesteps: tuple[float, float]
    """The least and the largest timestep [s]."""
    values: tuple[float, float]
    label: str
    """The quantity that the values are of, with its unit."""
    title: str
    caption: str


FAMILIES = {
    "solref": Family(
        (1e-4, 1.0),
        (1e-4, 1e-1),
        "time constant of solref [s]",
        "How stiff may a constraint be? Theory draws the line where MuJoCo's runs explode",
        "A joint equality with refsafe off: timestep against the time constant of solref.",
    ),
    "direct": Family(
        (1e-5, 1.0),
        (1e2, 1e10),
        "stiffness K of solref [1/s²]",
        "A constraint with a direct (negative) solref",
        "Timestep against K of solref = (−K, −2√K), which refsafe does not touch.",
    ),
    "gravity": Family(
        (1e-3, 10.0),
        (1e-3, 1e3),
        "gravity [m/s²]",
        "A can that swings in ever stronger gravity, which no integrator takes implicitly",
        "No constraint: timestep against gravity.",
    ),
    "damping": Family(
        (2.5e-4, 1.6e-2),
        (1e-4, 1e1),
        "damping [N m s]",
        "Damping between can and load: which timestep explodes, and which is accurate",
        "No constraint: timestep against damping, for half a metal can of beer. Real liquids have at most 0.02 N m s.",
    ),
}


class Swings:
    """Swings of one family with one integrator and one value: a time constant [s], a direct stiffness [1/s^2], a
    gravity [m/s^2], or a damping [N m s].

    A swing that grows beyond `GROWTH` times its start has exploded, and one whose error exceeds `ACCURACY` in the first
    half period is inaccurate.
    """

    def __init__(self, family: str, integrator: Integrator, value: float) -> None:
        self._integrator, self._row = integrator, None
        if family in ("solref", "direct"):
            scene, critical = frozen(0.0), 2 * math.sqrt(value)
            spec = specify(scene, "equality", integrator=integrator)
            direct = family == "direct"
            for constraint in spec.equalities:
                constraint.solref = (-value, -critical) if direct else (value, 1.0)
                constraint.solimp[:2] = _IMPEDANCE
            row = predictions.direct(value, critical, _IMPEDANCE) if direct else spring(value, 1.0, _IMPEDANCE)
            self._model, self._row = spec.compile(), row
        else:
            damped = family == "damping"
            scene = sliding(0.0, can=Can.sheet_metal(), damping=value) if damped else frozen(0.0, gravity=value)
            self._model = build(scene, "reduced", integrator=integrator)
        self._frequency, self._right = scene.frequency(), predictions.small_motion(scene)
        self._theory = predictions.small_motion(scene, constrained=self._row is not None)
        self._start = np.zeros(self._model.nq + self._model.nv)
        for name, at in joint_addresses(self._model).items():
            self._start[at] = _SWING * (scene.can.radius * (1 + _SEED) if name == "slide" else 1.0)

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome."""
        self._model.opt.timestep = timestep
        times = timestep * np.arange(self._steps(timestep) + 1)
        data = mujoco.MjData(self._model)
        if self._integrator == "DOP853":
            method = DOP853(Dynamics(self._model, data), timestep)
        else:
            method = MuJoCoSteps(self._model, data, [timestep], self._integrator)
        try:
            states = method.run(self._start, times)
        except DivergenceError:
            return EXPLODED
        return self._judge(states, timestep)

    def predict(self, timestep: float) -> int:
        """Return the outcome by linear theory, which multiplies the start by the matrix of one step again and again."""
        matrix = self._theory.step(self._integrator, timestep, self._row)
        unit = np.repeat([1.0, timestep], self._model.nq)
        states = predictions.motion(matrix, self._start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, timestep)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(math.pi / (self._frequency * timestep)))

    def _judge(self, states: np.ndarray, timestep: float) -> int:
        count = self._model.nq
        with np.errstate(invalid="ignore"):
            if not (np.abs(states[:, :count]) < GROWTH * self._start[:count]).all():
                return EXPLODED
        pace, last = self._frequency * timestep, len(self._right.mass) - 1  # phi is the last coordinate everywhere
        early = states[: max(1, math.floor(math.pi / pace)) + 1] / _SWING
        right = predictions.motion(self._right.exact(timestep), np.eye(2 * last + 2)[last], len(early) - 1)
        phi = early[:, count - 1] - right[:, last]
        rate = early[:, -1] / self._frequency - right[:, -1] / pace
        return ACCURATE if np.hypot(phi, rate).max() < ACCURACY else INACCURATE


def checks(cells: int = CELLS) -> list[Check]:
    """Return a check a map, of so many timesteps and values."""
    reason = "bisection to 1 %, and an instability has to grow before it is seen"
    measures = {", ".join(plan): partial(measure, *plan, cells) for plan in PLANS}
    return [Check(MAPS, name, of, "", _AGREEMENT, "relative", reason) for name, of in measures.items()]


def measure(family: str, integrator: Integrator, cells: int) -> dict[str, Any]:
    """Return how runs end at so many timesteps and as many values, and the border from which on they explode.

    "measured" has a string for each value and a digit for each timestep, the outcome; "same" is the share of cells
    whose outcome is the predicted one. "boundaries" has for each value the timestep [s] from which on runs explode,
    measured and predicted, or None where none does; "error" is the largest relative difference of the two.
    """
    timesteps, values = (np.geomspace(*span, cells).tolist() for span in FAMILIES[family][:2])
    measured, boundaries, same = [], [], []
    for value in values:
        runs = Swings(family, integrator, value)
        ended, expected = ([judge(timestep) for timestep in timesteps] for judge in (runs.measure, runs.predict))
        measured.append("".join(map(str, ended)))
        same.append(np.equal(ended, expected))
        boundaries.append((_border(runs.measure, timesteps, ended), _border(runs.predict, timesteps, expected)))
    return {
        "family": family,
        "integrator": integrator,
        "same": float(np.mean(same)),
        "timesteps": timesteps,
        "values": values,
        "measured": measured,
        "boundaries": boundaries,
        "error": max(difference(*borders) for borders in boundaries),
    }


def _border(outcome: Callable[[float], int], timesteps: list[float], outcomes: list[int]) -> float | None:
    """Return the least timestep [s] that explodes, by bisection beside the first that did; None if none did."""
    if EXPLODED not in outcomes:
        return None
    if (place := outcomes.index(EXPLODED)) == 0:
        return timesteps[0]
    low, high = timesteps[place - 1 : place + 1]
    while high / low > _RESOLUTION:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if outcome(middle) == EXPLODED else (middle, high)
    return math.sqrt(low * high)


def difference(measured: float | None, predicted: float | None) -> float:
    """Return the relative difference of two borders: 0 if neither exists, 1 if only one of them does."""
    if measured is None or predicted is None:
        return float(measured is not predicted)
    return abs(measured / predicted - 1)


def table(results: Sequence[Result]) -> Table:
    """Return a table of how many runs of each map ended in which way, and how well theory knew where they explode."""
    lines = []
    for result in results:
        cells, error = "".join(result.values["measured"]), "-" if result.error is None else f"{result.error:.1%}"
        counts = (str(cells.count(str(outcome))) for outcome in range(len(SHADES)))
        lines.append((result.name, *counts, f"{result.values['same']:.1%}", error + FAILED[result.passed]))
    return Table("Maps of timestep", ("map", *SHADES, "cells as predicted", "border off by"), lines)


def load(path: pathlib.Path = SHIPPED) -> dict[str, Any]:
    """Return the maps of a study with its command, its machine and a date, from the file that it wrote."""
    return json.loads(path.read_text(encoding="utf-8"))


def summary(maps: Sequence[dict[str, Any]]) -> tuple[int, float]:
    """Return the number of runs in some maps, and the relative error of the worst border."""
    return sum(len("".join(of["measured"])) for of in maps), max(of["worst"] for of in maps)


def figures(stored: dict[str, Any]) -> dict[str, Callable[[pathlib.Path], None]]:
    """Return what draws each figure of the maps in a document to a path, with .svg appended, by the figure's name."""
    maps = {family: [of for of in stored[MAPS] if of["family"] == family] for family in FAMILIES}
    return {f"stability-{name}": partial(draw, maps=of) for name, of in maps.items() if of}


def draw(path: pathlib.Path, maps: Sequence[dict[str, Any]]) -> None:
    """Write maps of one family side by side, to `path` with .svg appended."""
    name = maps[0]["family"]
    family, columns = FAMILIES[name], 3 if len(maps) > 4 else min(2, len(maps))
    rows = math.ceil(len(maps) / columns)
    size = 3.2 * columns + 0.4, 2.9 * rows + 1.7
    with chart(path, rows, columns, *size, family.title, family.caption) as panels:
        for axes in panels[len(maps) :]:
            axes.set_visible(False)
        for place, (axes, of) in enumerate(zip(panels, maps, strict=False)):
            _colour(axes, of, list(SHADES.values()))
            for border, style in ((1, _THEORY), (0, _MEASURED)):
                edges = [(edges[border], value) for value, edges in zip(of["values"], of["boundaries"], strict=True)]
                inside = [edge for edge in edges if edge[0] and of["timesteps"][0] < edge[0] < of["timesteps"][-1]]
                axes.plot(*zip(*inside, strict=True) if inside else ([], []), **style)
            axes.set_title(of["integrator"])
            axes.set_xlabel("timestep h [s]" if place + columns >= len(maps) else "")
            axes.set_ylabel(family.label if place % columns == 0 else "")
        handles: list[Artist] = [Patch(facecolor=shade, label=name) for name, shade in SHADES.items()]
        handles += [Line2D([], [], label="limit of stability, theory", **_THEORY)]
        handles += [Line2D([], [], label="the same, measured", **_MEASURED)]
        name_below(panels, 3, handles)


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
