"""The tables of a benchmark, and the folder that it writes."""

import math
import pathlib
from collections.abc import Callable, Sequence

from mjbeer.model.setting import ROLLINGS
from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies.benchmark import points, work_precision
from mjbeer.studies.benchmark.other_tools import (
    COMPILED_DOP853,
    COMPILED_ODEINT,
    HEYOKA,
    ODEINT,
    WHOLE_CALL,
)
from mjbeer.studies.benchmark.points import (
    Benchmark,
    Curve,
    Point,
    Ratio,
    milliseconds,
    spread,
    two_digits,
)

COMPARED = (1e-3, 1e-6)
"""The errors [rad] at which run times are compared, as motions are usually needed to these."""
FINEST = 1e-11
"""A third error [rad], near rounding. There the order of a method alone decides, and RK4 has order
4 while Gauss-Jackson has order 13."""
RK4 = "MuJoCo RK4"
OTHERS = (RK4, ODEINT, COMPILED_ODEINT, COMPILED_DOP853, HEYOKA)
"""The settings and tools that are compared with mjbeer's best reduced setting."""
_CONTACT = (
    Curve("contact", "Euler"),
    Curve("contact", "RK4"),
    Curve("contact, defaults", "Euler"),
    Curve("equality, defaults", "Euler"),
)
"""The curves whose convergence with the timestep is shown."""
_NOTES = """
The run time is the processor's time of one call that returns 65 samples of 2.048 s of motion, in
one thread and with warm caches: the least of the rounds, and the largest where two times are given.
What is done once, to build and compile a model or to compile equations, is not in it; whole calls
and study.json have it. Errors are against exact theory. "Compiled equations" and heyoka integrate
equations that were derived by hand, without MuJoCo; odeint is LSODA.

![Work-precision diagram](work_precision.svg)
"""


def write(study: Benchmark, folder: pathlib.Path) -> None:
    """Write study.json, the diagram work_precision.svg and summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "study.json", study.json())
    if study.cases:
        work_precision.draw(study, folder / "work_precision")
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
    """Return the tables of a study that have rows, in the order in which they are shown."""
    all_tables = [
        ratios(study, COMPARED),
        ratios(study, (FINEST,)),
        evaluations(study),
        whole_calls(study),
        *(drift(study, case) for case in study.long_cases),
        *(cheapest(study, case) for case in study.cases),
        *(convergence(study, case) for case in study.cases),
    ]
    return [table for table in all_tables if table.rows]


def ratios(study: Benchmark, errors: Sequence[float]) -> Table:
    """Return run times of RK4 and of other tools divided by that of the best reduced setting.

    The errors [rad] are equal. The smallest and the largest ratio of single rounds stand in
    brackets.
    """

    def cell(best: Sequence[Point], other: Sequence[Point], error: float) -> str:
        ratio = points.time_ratio(other, best, error)
        if ratio is None:
            return "-"
        rounds = f"{two_digits(ratio.smallest)} to {two_digits(ratio.largest)}"
        return f"{two_digits(ratio.of_least)} ({rounds})"

    def best_cell(best: Sequence[Point], error: float) -> str:
        return spread(points.times_in_rounds(best, error))

    at = " and ".join(f"{error:.0e}" for error in errors)
    title = (
        "Run time divided by that of mjbeer's best reduced setting, "
        f"at an equal error of {at} rad (below 1 is faster)"
    )
    return _comparison(study, errors, title, best_cell, cell)


def evaluations(study: Benchmark) -> Table:
    """Return the number of evaluations of the fastest settings within each error."""

    def count(other: Sequence[Point], error: float) -> str:
        best = points.cheapest(other, error)
        return "-" if best is None or best.evaluations is None else f"{best.evaluations:,}"

    title = "Evaluations of the accelerations"
    return _comparison(study, COMPARED, title, count, lambda _, other, error: count(other, error))


def _comparison(
    study: Benchmark,
    errors: Sequence[float],
    title: str,
    best_cell: Callable[[Sequence[Point], float], str],
    cell: Callable[[Sequence[Point], Sequence[Point], float], str],
) -> Table:
    """Return a table with a row for each case and error, and a column for each of `OTHERS`."""
    rows = []
    for case in study.cases:
        best = _reduced(study, case)
        others = [_of(study, case, name) for name in OTHERS]
        for error in errors:
            cells = [cell(best, other, error) for other in others]
            rows.append((f"{case}, {error:.0e} rad", best_cell(best, error), *cells))
    return Table(title, ("error", "best reduced", *OTHERS), rows)


def _reduced(study: Benchmark, case: str) -> list[Point]:
    """Return the points of a case on a model without a constraint."""
    return [point for point in study.of(case) if point.model == "reduced"]


def _of(study: Benchmark, case: str, name: str) -> list[Point]:
    """Return the points of a case on the curve of one of `OTHERS`."""
    if name == RK4:
        return [point for point in _reduced(study, case) if point.method == "RK4"]
    return [point for point in study.of(case) if point.model == name]


def time_ratio(study: Benchmark, case: str, name: str, error: float) -> Ratio | None:
    """Return the run time of one of `OTHERS` divided by that of the best reduced setting.

    The errors [rad] are equal. It is None if one of both does not reach the error.
    """
    return points.time_ratio(_of(study, case, name), _reduced(study, case), error)


def ratio_range(study: Benchmark, name: str, error: float) -> str:
    """Return the least and the largest run time of one of `OTHERS` over all cases of two seconds.

    They are divided by that of mjbeer's best reduced setting, at equal error [rad].
    """
    known = []
    for case in study.cases:
        ratio = time_ratio(study, case, name, error)
        if ratio is not None:
            known.append(ratio.of_least)
    if not known:
        return "-"
    return f"{two_digits(min(known))} to {two_digits(max(known))}"


def whole_calls(study: Benchmark) -> Table:
    """Return the times of whole calls of `mjbeer.simulate` to a tolerance, and of other tools.

    A call of mjbeer goes from the scene to a trajectory that judges itself. For the other tools the
    fastest setting within the error is shown, although nobody knows it beforehand. Two of them
    compile the equations of each scene anew.
    """
    rows = []
    for case in study.cases:
        for error in COMPARED:
            calls = [
                point
                for point in study.of(case)
                if point.model == WHOLE_CALL and math.isclose(point.value, error)
            ]
            if not calls:
                continue
            call = calls[0]
            interpreted = points.cheapest(_of(study, case, ODEINT), error)
            cells = [spread(call.times), f"{call.error:.1e}"]
            cells.append("-" if interpreted is None else spread(interpreted.times))
            for name in (COMPILED_DOP853, HEYOKA):
                best = points.cheapest(_of(study, case, name), error)
                cells.append("-" if best is None else _with_setup(best))
            rows.append((f"{case}, {error:.0e} rad", *cells))
    columns = (
        "tolerance",
        WHOLE_CALL,
        "its error [rad]",
        ODEINT,
        f"{COMPILED_DOP853}: compiling + run",
    )
    return Table("Whole calls, with all set-up", (*columns, f"{HEYOKA}: compiling + run"), rows)


def _with_setup(point: Point) -> str:
    """Return the set-up time and the run time of a point, as text."""
    setup = math.nan if point.setup is None else point.setup
    return f"{milliseconds(setup)} + {milliseconds(point.time)}"


def drift(study: Benchmark, case: str) -> Table:
    """Return the settings of a long case with their run times, errors and drifts of energy."""
    rows = []
    for point in study.of(case):
        energy = math.nan if point.energy_drift is None else point.energy_drift
        setting = (
            f"{point.model}, {point.setting}" if point.method else f"{point.model} {point.setting}"
        )
        rows.append((setting, _seconds(point.times), f"{point.error:.1e}", f"{energy:.1e}"))
    columns = ("setting", "run time [s]", "largest error [rad]", "drift of energy")
    return Table(f"{case}: a motion of 1,000 s", columns, rows)


def _seconds(times: Sequence[float]) -> str:
    """Return the least and the largest of some times [s]."""
    return f"{min(times):.2g} to {max(times):.2g}"


def cheapest(study: Benchmark, case: str) -> Table:
    """Return the fastest setting of a case for each error and way of rolling, with its run time."""
    of_case = study.of(case)
    rollings = [name for name in ROLLINGS if any(point.model == name for point in of_case)]
    rows = []
    for level in points.LEVELS:
        cells = []
        for rolling in rollings:
            best = points.cheapest([point for point in of_case if point.model == rolling], level)
            cells.append("not reached" if best is None else f"{best.setting}: {spread(best.times)}")
        rows.append((f"{level:.0e} rad", *cells))
    title = f"{case}: fastest setting for an error, and its run time"
    return Table(title, ("error at most", *rollings), rows)


def convergence(study: Benchmark, case: str, step_ratio: int = 2) -> Table:
    """Return the errors of constraints at timesteps that are halved, with the order in brackets.

    The order is the power of the timestep by which the error has fallen since a timestep
    `step_ratio` times as long.
    """
    of_case = study.of(case)
    curves = [curve for curve in _CONTACT if any(point.curve == curve for point in of_case)]
    errors = {
        curve: {point.value: point.error for point in of_case if point.curve == curve}
        for curve in curves
    }
    timesteps = sorted({step for of_curve in errors.values() for step in of_curve}, reverse=True)
    rows = []
    for step in timesteps:
        cells = []
        for curve in curves:
            error = errors[curve].get(step)
            before = errors[curve].get(step_ratio * step)
            if error is None:
                cells.append("-")
            elif before is None:
                cells.append(f"{error:.1e}")
            else:
                order = round(math.log(before / error, step_ratio), 1) + 0.0  # and no -0.0
                cells.append(f"{error:.1e} ({order:.1f})")
        rows.append((milliseconds(step), *cells))
    title = f"{case}: largest error [rad] by timestep, with the order of its convergence"
    return Table(title, ("timestep", *(curve.label for curve in curves)), rows)
