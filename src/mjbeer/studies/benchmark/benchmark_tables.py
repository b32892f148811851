"""The tables and the diagram of a benchmark, and the folder that it writes.

The diagram is error over run time: a panel a scene, with mjbeer's own integrators in colour.
"""

import math
import pathlib
from collections.abc import Sequence

from matplotlib.axes import Axes

from mjbeer.model.setting import ROLLINGS
from mjbeer.output import files
from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.output.terminal import Table
from mjbeer.studies.benchmark import points
from mjbeer.studies.benchmark.other_tools import WHOLE
from mjbeer.studies.benchmark.points import CASES, CHOSEN, TOLERANCE, USUAL, Benchmark, Curve, Point, milliseconds

COMPARED = (1e-3, 1e-6, 1e-9, 1e-11)
"""The errors [rad] at which run times are compared with that of the best setting."""
OTHERS = ("MuJoCo RK4", "SciPy DOP853", "SciPy odeint", "heyoka")
"""Compared with mjbeer's best reduced setting."""
_NOTES = """
The run time is that of one call that returns 65 samples of 2.048 s of motion, in one thread and with warm caches: the
least of the rounds. What is done once, to build and compile a model or to compile equations, is not in it; whole calls
and study.json have it. SciPy calls equations in interpreted Python; all else is compiled. Errors are against exact
theory.

![Work-precision diagram](work_precision.svg)
"""
_DARK, _SCIPY, _HEYOKA = "#333333", COLOURS[4], COLOURS[3]
_LINES: dict[Curve, tuple[str, str, str]] = {
    Curve("reduced", "DOP853"): ("mjbeer's DOP853", COLOURS[0], "-o"),
    Curve("reduced", "GaussJackson"): ("mjbeer's Gauss-Jackson (multistep)", COLOURS[1], "-s"),
    Curve("reduced", CHOSEN, TOLERANCE): ("mjbeer to a tolerance", COLOURS[2], "-D"),
    Curve("contact", "DOP853"): ("mjbeer's DOP853, in contact", COLOURS[5], ":o"),
    Curve("reduced", "RK4"): ("MuJoCo's RK4", _DARK, "-^"),
    Curve("contact", "RK4"): ("MuJoCo's RK4, in contact", _DARK, ":^"),
    Curve("reduced", "Euler"): ("MuJoCo's Euler", _DARK, "-x"),
    Curve("equality, defaults", "Euler"): ("equality as usually written", "black", "*"),
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


def write(study: Benchmark, folder: pathlib.Path) -> None:
    """Write study.json, the diagram work_precision.svg and summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "study.json", study.json())
    draw(study, folder / "work_precision")
    machine = study.machine
    versions = ", ".join(f"{name} {number}" for name, number in machine["versions"].items())
    absent = [f"\n{name} is absent: {reason}" for name, reason in study.settings["absent"].items()]
    lines = [
        "# mjbeer: error against run time\n",
        f"{machine['processor']}, {machine['system']}, Python {machine['python']}; {versions}.",
        *absent,
        _NOTES,
        *(table.markdown() for table in tables(study)),
    ]
    files.write(folder / "summary.md", "\n".join(lines))


def tables(study: Benchmark) -> list[Table]:
    """Return the tables of a study, in the order in which they are shown."""
    return [*(cheapest(study, case) for case in study.cases), others(study), whole_calls(study)]


def cheapest(study: Benchmark, case: str) -> Table:
    """Return the fastest setting of a case for each error and way of rolling, with its run time and evaluations."""
    found = study.of(case)
    rollings = [rolling for rolling in ROLLINGS if any(point.model == rolling for point in found)]
    rows = []
    for level in points.LEVELS:
        best = [points.cheapest([point for point in found if point.model == each], level) for each in rollings]
        cells = ["not reached" if each is None else f"{each.setting}: {milliseconds(each.time)}" for each in best]
        rows.append((f"{level:.0e} rad", *cells))
    return Table(f"{case}: cheapest setting for an error, and its run time", ("error at most", *rollings), rows)


def _by(study: Benchmark, case: str, name: str) -> list[Point]:
    """Return the points of a case on the curve of one of `OTHERS`."""
    curve = ("reduced", "RK4") if name == "MuJoCo RK4" else (name, "")
    return [point for point in study.of(case) if (point.model, point.method) == curve]


def ratio(study: Benchmark, case: str, name: str, error: float) -> float | None:
    """Return the run time of one of `OTHERS` over that of mjbeer's best reduced setting, at equal error [rad].

    It is None if one of the two does not reach the error.
    """
    best = points.time_for((point for point in study.of(case) if point.model == "reduced"), error)
    found = points.time_for(_by(study, case, name), error) / best
    return found if 0 < found < math.inf else None


def span(study: Benchmark, name: str) -> tuple[float, float]:
    """Return the least and the largest of these ratios over all cases and `COMPARED` errors."""
    found = [ratio(study, case, name, error) for case in study.cases for error in COMPARED]
    known = [each for each in found if each is not None]
    return min(known, default=math.nan), max(known, default=math.nan)


def others(study: Benchmark) -> Table:
    """Return run times of RK4 and of other tools over that of the best reduced setting, at equal error.

    In brackets are evaluations of accelerations, of the fastest setting that keeps the error.
    """
    rows = []
    for case in study.cases:
        reduced = [point for point in study.of(case) if point.model == "reduced"]
        for level in COMPARED:
            cells = [milliseconds(points.time_for(reduced, level)) + _evaluations(reduced, level)]
            for name in OTHERS:
                found = ratio(study, case, name, level)
                cells.append("-" if found is None else two_digits(found) + _evaluations(_by(study, case, name), level))
            rows.append((f"{case}, {level:.0e} rad", *cells))
    title = "Run time of others over that of the best reduced setting (under 1 they are faster), and evaluations"
    return Table(title, ("error", "best reduced", *OTHERS), rows)


def whole_calls(study: Benchmark) -> Table:
    """Return the times of whole calls: of `mjbeer.simulate` to a tolerance, and of other tools with all set-up counted.

    mjbeer's goes from the scene to a trajectory that judges itself. Of SciPy the fastest setting counts that keeps the
    error, which nobody knows beforehand; heyoka compiles each scene's equations anew.
    """
    rows = []
    for case in study.cases:
        for error in COMPARED[:3]:
            whole = [point for point in study.of(case) if point.model == WHOLE and math.isclose(point.value, error)]
            if not whole:
                continue
            best = points.cheapest([point for name in OTHERS[1:3] for point in _by(study, case, name)], error)
            compiled = points.cheapest(_by(study, case, "heyoka"), error)
            scipy = over = heyoka = "-"
            if best is not None:
                scipy = f"{milliseconds(best.time)} ({best.model.removeprefix('SciPy ')})"
                over = two_digits(best.time / whole[0].time)
            if compiled is not None and compiled.setup is not None:
                heyoka = f"{milliseconds(compiled.setup)} + {milliseconds(compiled.time)}"
            mine = milliseconds(whole[0].time), f"{whole[0].error:.1e}"
            rows.append((f"{case}, {error:.0e} rad", *mine, scipy, over, heyoka))
    columns = "mjbeer.simulate", "its error [rad]", "SciPy's best", "over mjbeer's", "heyoka, compiling + run"
    return Table("Whole calls, with all set-up", ("tolerance", *columns), rows)


def two_digits(value: float) -> str:
    """Return a positive number with two digits."""
    return f"{float(f'{value:.2g}'):g}"


def _evaluations(found: list[Point], error: float) -> str:
    best = points.cheapest(found, error)
    return "" if best is None or best.evaluations is None else f" ({best.evaluations:,})"


def draw(study: Benchmark, path: pathlib.Path) -> None:
    """Draw the scenes of a study, each in a panel, and write them to `path` with .svg appended.

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
    """Draw the curves of a scene that have points."""
    for curve, (name, colour, line) in _LINES.items():
        if shown := [point for point in found if point.curve == curve and point.error < _CEILING]:
            times, errors = [1e3 * point.time for point in shown], [max(point.error, _FLOOR) for point in shown]
            size = 9 if curve.model in USUAL else 5
            axes.plot(times, errors, line, label=name, color=colour, markersize=size, linewidth=1.3)
