"""The work-precision diagram in small: five curves a panel, each with its name beside it."""

import math
import pathlib
from dataclasses import dataclass
from typing import Any, Literal

from matplotlib.axes import Axes

from mjbeer.model.setting import DOP853, GAUSS_JACKSON
from mjbeer.output.plots import COLOURS, chart
from mjbeer.studies.benchmark.curves import TIMESTEP, TOLERANCE, USUAL, Curve
from mjbeer.studies.benchmark.points import Benchmark
from mjbeer.studies.cases import CASES
from mjbeer.theory.named import in_degrees, in_words

_CASES = ("frozen", "sliding")


@dataclass(frozen=True)
class _Label:
    """The name of a curve, and where it stands: beside the point nearest to an error [rad]."""

    name: str
    colour: str
    error: float
    offset: tuple[int, int]
    """Distance from that point [points], to the right and up."""
    side: Literal["left", "right"]
    """Which end of the name stands there."""


_CURVES = {
    Curve("reduced", "Euler", TIMESTEP): _Label("MuJoCo Euler", COLOURS[4], 1e-5, (6, 18), "right"),
    Curve("reduced", "RK4", TIMESTEP): _Label("MuJoCo RK4", COLOURS[1], 1e-9, (-9, -4), "right"),
    Curve("reduced", DOP853, TIMESTEP): _Label("mjbeer:\nDOP853", COLOURS[0], 1e-7, (8, 0), "left"),
    Curve("reduced", GAUSS_JACKSON, TIMESTEP): _Label("Gauss-\nJackson", COLOURS[6], 2e-5, (-7, 0), "right"),
    Curve("SciPy DOP853", "", TOLERANCE): _Label("SciPy DOP853", COLOURS[3], 1e-6, (9, 0), "left"),
    Curve("heyoka", "", TOLERANCE): _Label("heyoka", COLOURS[2], 1e-10, (9, 0), "left"),
}
_FLOOR = 1e-14


def draw(study: Benchmark, path: pathlib.Path) -> None:
    """Draw the cases of the overview that a study has, as `path` with .svg and with .png; nothing if it has none.

    Raises:
      OutputError: if a file cannot be written.
    """
    cases = [case for case in _CASES if case in study.cases]
    if not cases:
        return
    title = "The same motion, ever more exactly: what accuracy costs"
    subtitle = f"each line: one tool, from coarse at its top to fine; {study.machine['processor']}"
    with chart(path, columns=len(cases), width=5.2 * len(cases), height=5.2, title=title, subtitle=subtitle) as panels:
        for axes, case in zip(panels, cases, strict=True):
            _draw_case(axes, study, case)


def _draw_case(axes: Axes, study: Benchmark, case: str) -> None:
    points = study.of(case)
    for curve, label in _CURVES.items():
        on_curve = [point for point in points if point.curve == curve and point.error < 1]
        times = [1e3 * point.time for point in on_curve]
        errors = [max(point.error, _FLOOR) for point in on_curve]
        if not times:
            continue
        axes.plot(times, errors, marker=".", color=label.colour)
        nearest = min(range(len(errors)), key=lambda rung: abs(math.log(errors[rung] / label.error)))
        place = (times[nearest], errors[nearest])
        style: dict[str, Any] = {"color": label.colour, "fontsize": 9, "ha": label.side, "va": "center"}
        axes.annotate(label.name, place, label.offset, textcoords="offset points", **style)
    usual = [point for point in points if point.way in USUAL]
    axes.plot([1e3 * point.time for point in usual], [point.error for point in usual], "k*", markersize=9)
    for point in usual[:1]:
        axes.annotate(
            "as usually written", (1e3 * point.time, point.error), (8, 3), textcoords="offset points", fontsize=9
        )
    axes.set(xscale="log", yscale="log", ylim=(_FLOOR / 3, 30), title=_title(case))
    axes.set(xlabel="run time of 2 s of motion [ms]", ylabel="largest error of φ and u/a [rad]")


def _title(case: str) -> str:
    """Return the scene of a case and its start."""
    start = CASES[case]
    return f"{in_words(start.scene)}, from {in_degrees(start.phi0)}"
