"""The diagram of a benchmark: error over run time, with a panel for each scene.

Five curves are drawn for each scene of two seconds, all of compiled code; the tables have more.
With several scenes a last panel has contacts. All panels have the same axes.
"""

import math
import pathlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes

from mjbeer.output.plots import COLOURS, Picture, chart, name_below, note
from mjbeer.studies.benchmark.other_tools import COMPILED_DOP853, HEYOKA
from mjbeer.studies.benchmark.points import (
    CASES,
    TOLERANCE,
    Benchmark,
    Curve,
    Point,
    Ratio,
    time_for,
    time_ratio,
    two_digits,
)

_DARK = "#333333"


class _Line(NamedTuple):
    """How a curve is drawn."""

    name: str
    colour: str
    style: str
    """Line and marker in matplotlib's notation. A line is dashed if MuJoCo is not called."""


_RK4 = Curve("reduced", "RK4")
_SMOOTH = {
    Curve(HEYOKA, "", TOLERANCE): _Line("heyoka, without MuJoCo", COLOURS[3], "--P"),
    Curve(COMPILED_DOP853, "", TOLERANCE): _Line("DOP853, without MuJoCo", COLOURS[2], "--D"),
    Curve("reduced", "GaussJackson"): _Line("mjbeer's Gauss-Jackson", COLOURS[1], "-s"),
    Curve("reduced", "DOP853"): _Line("mjbeer's DOP853", COLOURS[0], "-o"),
    _RK4: _Line("MuJoCo's RK4", _DARK, "-^"),
}
"""The curves of a scene whose can rolls without a constraint, fastest first."""
_CONTACT_DOP853 = Curve("contact", "DOP853")
_CONTACT_RK4 = Curve("contact", "RK4")
_CONTACT = {
    Curve("contact, defaults", "Euler"): _Line("Euler, usual contact", COLOURS[1], "-*"),
    Curve("contact", "Euler"): _Line("MuJoCo's Euler", COLOURS[5], "-x"),
    _CONTACT_DOP853: _Line("mjbeer's DOP853", COLOURS[0], "-o"),
    _CONTACT_RK4: _Line("MuJoCo's RK4", _DARK, "-^"),
}
"""The curves of a scene whose can rolls by friction, largest error first."""
_COMPARED = 1e-6
"""The error [rad] at which a panel compares run times."""
_CONTACT_CASE = "frozen"
_FLOOR = 1e-13
"""Smaller errors [rad] are rounding: a curve ends with its first point at this floor."""
_CEILING = 3.0
"""Points with larger errors [rad] are not drawn."""
_X_LABEL = "run time of 2 s of motion [ms], without compiling"
_Y_LABEL = "largest error of φ and u/a [rad]"
_CONTACT_TITLE = "Frozen beer, rocking, in a can that rolls by friction"
_SUBTITLE = (
    "Each point is one setting: further left is faster, further down more exact. Dashed: equations "
    "derived by hand and compiled. Arrows: run times for an error of at most 1e-6 rad, "
    "interpolated between runs of one integrator alone."
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
    with chart(path, rows, 2, 9, 3.1 * rows + 2.2, _title(study), _subtitle(study)) as panels:
        shown = []
        for axes, case in zip(panels, cases, strict=False):
            shown += _draw(axes, study.of(case), _SMOOTH)
            _compare(axes, study.of(case))
            axes.set_title(_capital(CASES[case].story), fontsize=10)
        if has_contact:
            axes = panels[len(cases)]
            shown += _draw_contact(axes, study)
            axes.set_title(_CONTACT_TITLE, fontsize=10)
            axes.legend(loc="lower left", fontsize=9.5)
        for axes in panels[count:]:
            axes.set_visible(False)
        _set_axes(panels[:count], shown)
        for place, axes in enumerate(panels[:count]):
            is_lowest = place >= count - 2
            axes.set_xlabel(_X_LABEL if is_lowest else "")
            axes.tick_params(labelbottom=is_lowest)
            is_first = place % 2 == 0
            axes.set_ylabel(_Y_LABEL if is_first else "")
            axes.tick_params(labelleft=is_first)
        name_below(panels[: len(cases)], 3)


def _draw_single(study: Benchmark, case: str, path: pathlib.Path | Picture) -> None:
    """Draw the only scene of a study."""
    title, _, start = _capital(CASES[case].story).partition(", ")
    with chart(path, width=6.2, height=6.4, title=title, subtitle=start) as (axes,):
        shown = _draw(axes, study.of(case), _SMOOTH)
        _compare(axes, study.of(case))
        _set_axes([axes], shown)
        axes.set_xlabel(_X_LABEL)
        axes.set_ylabel(_Y_LABEL)
        name_below([axes], 2)


def draw_contact(study: Benchmark, path: pathlib.Path | Picture) -> None:
    """Draw the can that rolls by friction alone, and write it to `path` with .svg appended.

    Raises:
      OutputError: if a file cannot be written.
    """
    title, _, scene = _CONTACT_TITLE.partition(", ")
    with chart(path, width=6.2, height=6.4, title=title, subtitle=scene) as (axes,):
        _set_axes([axes], _draw_contact(axes, study))
        axes.set_xlabel(_X_LABEL)
        axes.set_ylabel(_Y_LABEL)
        name_below([axes], 2)


def _draw_contact(axes: Axes, study: Benchmark) -> list[Point]:
    """Draw the curves of the can that rolls by friction, and return the points that are shown."""
    found = study.of(_CONTACT_CASE)
    shown = _draw(axes, found, _CONTACT)
    rk4 = _on(found, _CONTACT_RK4)
    _draw_arrow(axes, rk4, _on(found, _CONTACT_DOP853), "RK4")
    return shown


def _title(study: Benchmark) -> str:
    """Return what a study found about RK4 and mjbeer's best setting in all scenes."""
    ratios = [ratio for case in study.cases if (ratio := _ratio(study.of(case))) is not None]
    if not ratios:
        return "What accuracy costs: error over run time"
    factors = f"{two_digits(min(ratios))} to {two_digits(max(ratios))}"
    return f"Without contacts RK4 takes {factors} times as long as mjbeer's best"


def _subtitle(study: Benchmark) -> str:
    """Return what the diagram shows, and what a study found about contacts."""
    ratio = contact_ratio(study)
    if ratio is None:
        return _SUBTITLE
    factor = two_digits(ratio.of_least)
    return f"With a contact (last panel) DOP853 takes {factor} times as long as RK4. {_SUBTITLE}"


def contact_ratio(study: Benchmark) -> Ratio | None:
    """Return the run time of DOP853 with a contact, divided by that of RK4, at equal error."""
    found = study.of(_CONTACT_CASE)
    return time_ratio(_on(found, _CONTACT_DOP853), _on(found, _CONTACT_RK4), _COMPARED)


def _ratio(found: Sequence[Point]) -> float | None:
    """Return the run time of RK4 divided by that of the best reduced setting, at equal error."""
    ratio = time_ratio(_on(found, _RK4), _reduced(found), _COMPARED)
    return None if ratio is None else ratio.of_least


def _compare(axes: Axes, found: Sequence[Point]) -> None:
    """Draw an arrow from mjbeer's best setting to RK4, where both have the compared error."""
    _draw_arrow(axes, _reduced(found), _on(found, _RK4), "mjbeer's best")


def _draw_arrow(axes: Axes, fast: Sequence[Point], slow: Sequence[Point], fast_name: str) -> None:
    """Draw an arrow between the run times of both for the compared error, if both reach it."""
    ratio = time_ratio(slow, fast, _COMPARED)
    if ratio is None:
        return
    start = 1e3 * time_for(fast, _COMPARED)
    end = 1e3 * time_for(slow, _COMPARED)
    arrow = {"arrowstyle": "<->", "color": _DARK, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (end, _COMPARED), (start, _COMPARED), arrowprops=arrow)
    words = f"{two_digits(ratio.of_least)} times as long\nas {fast_name}"
    note(axes, words, (end, _COMPARED), (8, 12), color=_DARK)


def _reduced(found: Sequence[Point]) -> list[Point]:
    return [point for point in found if point.model == _RK4.model]


def _on(found: Sequence[Point], curve: Curve) -> list[Point]:
    return [point for point in found if point.curve == curve]


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
