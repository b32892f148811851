"""The diagram of a benchmark, error over run time: a panel a scene, with mjbeer's own integrators in colour."""

import pathlib
from collections.abc import Sequence

from matplotlib.axes import Axes

from mjbeer.model.setting import DOP853, GAUSS_JACKSON
from mjbeer.output.plots import COLOURS, add_tooltips, chart, name_below
from mjbeer.studies.benchmark.points import CASES, CHOSEN, TOLERANCE, USUAL, Benchmark, Curve, Point, milliseconds

_DARK, _SCIPY, _HEYOKA = "#333333", COLOURS[4], COLOURS[3]
_LINES: dict[Curve, tuple[str, str, str]] = {
    Curve("reduced", DOP853): ("mjbeer's DOP853", COLOURS[0], "-o"),
    Curve("reduced", GAUSS_JACKSON): ("mjbeer's Gauss-Jackson (multistep)", COLOURS[1], "-s"),
    Curve("reduced", CHOSEN, TOLERANCE): ("mjbeer to a tolerance", COLOURS[2], "-D"),
    Curve("contact", DOP853): ("mjbeer's DOP853, in contact", COLOURS[5], ":o"),
    Curve("reduced", "RK4"): ("MuJoCo's RK4", _DARK, "-^"),
    Curve("contact", "RK4"): ("MuJoCo's RK4, in contact", _DARK, ":^"),
    Curve("reduced", "Euler"): ("MuJoCo's Euler", _DARK, "-x"),
    Curve("equality, slide first", "Euler"): ("equality as usually written", "black", "*"),
    Curve("equality, hinge first", "Euler"): ("the same, hinge first", "black", "p"),
    Curve("contact, defaults", "Euler"): ("contact as usually written", "black", "X"),
    Curve("SciPy DOP853", "", TOLERANCE): ("SciPy's DOP853, interpreted", _SCIPY, "--v"),
    Curve("SciPy odeint", "", TOLERANCE): ("SciPy's odeint (LSODA), interpreted", _SCIPY, "--<"),
    Curve("heyoka", "", TOLERANCE): ("heyoka", _HEYOKA, "-P"),
}
"""The curves that are drawn, each with its name, its colour, and its line and marker: those that somebody would choose,
and single points of models as people usually write them, at 2 ms. SciPy calls interpreted Python, drawn with dashes;
all other curves are of compiled code. The tables have what the others cost."""
_FLOOR, _CEILING = 1e-15, 10.0
"""Smaller errors [rad] are drawn at the floor, since a logarithmic axis has no zero; larger ones are no motion."""


def draw(study: Benchmark, path: pathlib.Path) -> None:
    """Draw the scenes of a study, each in a panel, and write them to `path` with .svg appended.

    In the SVG a point has its setting, its error and its run time as a tooltip.

    Raises:
      OutputError: if a file cannot be written.
    """
    cases = study.cases
    columns = min(2, len(cases))
    rows = -(-len(cases) // columns)
    stories = [(story := CASES[case].story)[0].upper() + story[1:] for case in cases]
    title, subtitle = "What accuracy costs: mjbeer, MuJoCo, SciPy and heyoka", ""
    if len(cases) == 1:
        title, _, subtitle = stories[0].partition(", ")
    width, height = (6.2, 6.4) if len(cases) == 1 else (11, 4.4 * rows + 1.5)
    with chart(path, rows, columns, width, height, title, subtitle) as panels:
        for axes in panels[len(cases) :]:
            axes.set_visible(False)
        for axes, case, story in zip(panels, cases, stories, strict=False):
            _draw(axes, study.of(case))
            axes.set(xscale="log", yscale="log", ylim=(_FLOOR / 3, _CEILING), title=story if len(cases) > 1 else "")
            axes.set(xlabel="run time of 2 s of motion [ms]", ylabel="largest error of φ and u/a [rad]")
            axes.minorticks_off()
        name_below(panels, 3 if len(cases) > 1 else 2)


def _draw(axes: Axes, found: Sequence[Point]) -> None:
    """Draw the curves of a scene that have points, and give each point a tooltip."""
    for curve, (name, colour, line) in _LINES.items():
        if shown := [point for point in found if point.curve == curve and point.error < _CEILING]:
            times, errors = [1e3 * point.time for point in shown], [max(point.error, _FLOOR) for point in shown]
            size = 9 if curve.model in USUAL else 5
            (drawn,) = axes.plot(times, errors, line, label=name, color=colour, markersize=size, linewidth=1.3)
            add_tooltips(drawn, [_tooltip(point, name) for point in shown])


def _tooltip(point: Point, name: str) -> str:
    """Return what a point is: its curve, timestep or tolerance, error and run time."""
    value = f"{point.value:g}" if point.parameter == TOLERANCE else milliseconds(point.value)
    return f"{name}, {point.parameter} {value}: error {point.error:.1e} rad, run time {milliseconds(point.time)}"
