"""The diagram of a benchmark: error over run time, with a panel for each scene.

Six curves are drawn for each scene of two seconds, all of compiled code. With several scenes a
last panel has contacts. All panels have the same axes.
"""

import math
import pathlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes

from mjbeer.output.plots import COLOURS, Picture, chart, name_below
from mjbeer.studies.benchmark.other_tools import COMPILED_DOP853, COMPILED_ODEINT, HEYOKA
from mjbeer.studies.benchmark.points import CASES, TOLERANCE, Benchmark, Curve, Point

_DARK = "#333333"


class _Line(NamedTuple):
    """How a curve is drawn."""

    name: str
    colour: str
    style: str
    """Line and marker in matplotlib's notation. A line is dashed if MuJoCo is not called."""


_SMOOTH = {
    Curve("reduced", "RK4"): _Line("MuJoCo's RK4", _DARK, "-^"),
    Curve("reduced", "DOP853"): _Line("mjbeer's DOP853 on MuJoCo", COLOURS[0], "-o"),
    Curve("reduced", "GaussJackson"): _Line("mjbeer's Gauss-Jackson on MuJoCo", COLOURS[1], "-s"),
    Curve(COMPILED_ODEINT, "", TOLERANCE): _Line(
        "SciPy's odeint (LSODA) on compiled equations", COLOURS[4], "--v"
    ),
    Curve(COMPILED_DOP853, "", TOLERANCE): _Line("DOP853 on compiled equations", COLOURS[2], "--D"),
    Curve(HEYOKA, "", TOLERANCE): _Line("heyoka, compiled equations", COLOURS[3], "--P"),
}
"""The curves of a scene whose can rolls without a constraint."""
_CONTACT = {
    Curve("contact", "DOP853"): _Line("mjbeer's DOP853", COLOURS[0], "-o"),
    Curve("contact", "RK4"): _Line("MuJoCo's RK4", _DARK, "-^"),
    Curve("contact", "Euler"): _Line("MuJoCo's Euler", COLOURS[5], "-x"),
    Curve("contact, defaults", "Euler"): _Line(
        "Euler, contact as usually written", COLOURS[1], "-*"
    ),
}
"""The curves of a scene whose can rolls by friction."""
_CONTACT_CASE = "frozen"
_FLOOR = 1e-13
"""Smaller errors [rad] are rounding: a curve ends with its first point at this floor."""
_CEILING = 3.0
"""Points with larger errors [rad] are not drawn."""
_X_LABEL = "run time of 2 s of motion [ms], without compiling"
_Y_LABEL = "largest error of φ and u/a [rad]"
_SUBTITLE = (
    "Each point is one setting. Further left is faster, further down is more exact. Setting up and "
    "compiling are not in the run time. Solid lines call MuJoCo; dashed lines integrate equations "
    "that were derived by hand and compiled."
)


def draw(study: Benchmark, path: pathlib.Path | Picture) -> None:
    """Draw the scenes of a study, each in a panel, and write them to `path` with .svg appended.

    Raises:
      OutputError: if a file cannot be written.
    """
    cases = study.cases
    if len(cases) == 1:
        _draw_single(study, cases[0], path)
        return
    has_contact = _CONTACT_CASE in cases
    count = len(cases) + has_contact
    rows = math.ceil(count / 2)
    title = "What accuracy costs: error over run time"
    with chart(path, rows, 2, 11, 3.7 * rows + 1.8, title, _SUBTITLE) as panels:
        shown = []
        for axes, case in zip(panels, cases, strict=False):
            shown += _draw(axes, study.of(case), _SMOOTH)
            axes.set_title(_capital(CASES[case].story))
        if has_contact:
            axes = panels[len(cases)]
            shown += _draw(axes, study.of(_CONTACT_CASE), _CONTACT)
            axes.set_title("Frozen beer, rocking, in a can that rolls by friction")
            axes.legend(loc="lower left", fontsize=9)
        for axes in panels[count:]:
            axes.set_visible(False)
        _set_axes(panels[:count], shown)
        for axes in panels[count - 2 : count]:
            axes.set_xlabel(_X_LABEL)
        for axes in panels[0:count:2]:
            axes.set_ylabel(_Y_LABEL)
        name_below(panels[: len(cases)], 3)


def _draw_single(study: Benchmark, case: str, path: pathlib.Path | Picture) -> None:
    """Draw the only scene of a study."""
    title, _, start = _capital(CASES[case].story).partition(", ")
    with chart(path, width=6.2, height=6.4, title=title, subtitle=start) as (axes,):
        shown = _draw(axes, study.of(case), _SMOOTH)
        _set_axes([axes], shown)
        axes.set_xlabel(_X_LABEL)
        axes.set_ylabel(_Y_LABEL)
        name_below([axes], 2)


def _draw(axes: Axes, found: Sequence[Point], lines: Mapping[Curve, _Line]) -> list[Point]:
    """Draw the curves of a scene that have points, and return the points that are shown."""
    all_shown = []
    for curve, line in lines.items():
        shown = _to_the_floor([point for point in found if point.curve == curve])
        if not shown:
            continue
        times = [1e3 * point.time for point in shown]
        errors = [max(point.error, _FLOOR) for point in shown]
        axes.plot(
            times,
            errors,
            line.style,
            label=line.name,
            color=line.colour,
            markersize=5,
            linewidth=1.3,
        )
        all_shown += shown
    return all_shown


def _to_the_floor(points: Sequence[Point]) -> list[Point]:
    """Return the points of a curve that are motions, up to the first one at the floor."""
    shown = []
    for point in points:
        if point.error < _CEILING:
            shown.append(point)
        if point.error <= _FLOOR:
            break
    return shown


def _set_axes(panels: Sequence[Axes], shown: Sequence[Point]) -> None:
    """Give panels the same logarithmic axes, in which all points lie."""
    times = [1e3 * point.time for point in shown]
    for axes in panels:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(_FLOOR / 3, _CEILING)
        if times:
            axes.set_xlim(min(times) / 1.5, 1.5 * max(times))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]
