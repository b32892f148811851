"""The tables of a benchmark, and the folder that it writes: points as CSV, a diagram, and a summary."""

import math
import pathlib

from mjbeer.model.setting import ROLLINGS
from mjbeer.output import files
from mjbeer.output.terminal import Table
from mjbeer.studies.benchmark import diagrams, points
from mjbeer.studies.benchmark.peers import WHOLE
from mjbeer.studies.benchmark.points import CHOSEN, TIMESTEP, USUAL, Benchmark, milliseconds
from mjbeer.studies.benchmark.sweeps import TOLERANCE as SWEPT

COMPARED = (1e-3, 1e-6, 1e-9, 1e-11)
"""The errors [rad] at which run times are compared with that of the best setting."""
_NOTES = """
The run time is that of one call that returns 65 samples of 2.048 s of motion, in one thread and with warm caches: the
least of the rounds. The time to build and compile a model is not part of it; points.csv has it in a column of its own.
Errors are against exact theory.

![Work-precision diagram](work_precision.svg)
"""


def write(study: Benchmark, folder: pathlib.Path) -> None:
    """Write points.csv, the diagram work_precision.svg and, as the last, summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    files.write(folder / "points.csv", study.csv())
    diagrams.draw(study, folder / "work_precision")
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
    many = [sweeps(study)] if study.sweeps else []
    return [*(cheapest(study, case) for case in study.cases), others(study), tolerances(study), usual(study), *many]


def cheapest(study: Benchmark, case: str) -> Table:
    """Return the fastest setting of a case for each error and way of rolling, with its run time."""
    found = study.of(case)
    ways = [way for way in ROLLINGS if any(point.way == way for point in found)]
    rows = []
    for level in points.LEVELS:
        best = [points.cheapest([point for point in found if point.way == way], level) for way in ways]
        cells = ["not reached" if each is None else f"{each.setting}: {milliseconds(each.time)}" for each in best]
        rows.append((f"{level:.0e} rad", *cells))
    return Table(f"{case}: cheapest setting for an error, and its run time", ("error at most", *ways), rows)


def others(study: Benchmark) -> Table:
    """Return run times of RK4 and of other tools over that of the best reduced setting, at equal error."""
    names = ["MuJoCo RK4", "SciPy DOP853", "SciPy LSODA", "SciPy odeint", "heyoka"]
    rows = []
    for case in study.cases:
        reduced = [point for point in study.of(case) if point.way == "reduced"]
        curves = [[point for point in reduced if point.method == "RK4"]]
        curves += [[point for point in study.of(case) if point.way == name] for name in names[1:]]
        for level in COMPARED:
            best = points.time_for(reduced, level)
            ratios = [_ratio(points.time_for(curve, level) / best) for curve in curves]
            rows.append((f"{case}, {level:.0e} rad", milliseconds(best), *ratios))
    columns = ("error", "best reduced", *names)
    return Table("Run time of others over that of the best reduced setting; under 1 they are faster", columns, rows)


def tolerances(study: Benchmark) -> Table:
    """Return the run times to a tolerance, beside those of the best fixed timestep, and of SciPy's best method.

    A whole call is `mjbeer.simulate` from the scene to the trajectory, with all that a trajectory says about itself.
    """
    rows = []
    for case in study.cases:
        found = study.of(case)
        steps = [point for point in found if point.way == "reduced" and point.knob == TIMESTEP]
        rivals = [point for point in found if point.way in ("SciPy DOP853", "SciPy LSODA", "SciPy odeint")]
        for digits in (3, 6, 9, 12):
            to = {
                point.way: point
                for point in found
                if point.method in ("", CHOSEN) and math.isclose(point.value, 10.0**-digits, rel_tol=1e-9)
            }
            fixed, adaptive, whole = points.cheapest(steps, 10.0**-digits), to.get("reduced"), to.get(WHOLE)
            if fixed and adaptive and whole:
                row = (f"{case}, 1e-{digits}", milliseconds(fixed.time), milliseconds(adaptive.time))
                row += (f"{adaptive.time / fixed.time:.2f}", f"{adaptive.error:.1e}", milliseconds(whole.time))
                rows.append((*row, _ratio(points.time_for(rivals, 10.0**-digits) / whole.time)))
    columns = ("tolerance [rad]", "best fixed timestep", "to the tolerance", "ratio", "its error [rad]")
    title = "Run time to a tolerance, with the fastest fixed timestep that meets it, and of whole calls"
    return Table(title, (*columns, "whole call", "SciPy's best over it"), rows)


def usual(study: Benchmark) -> Table:
    """Return the errors of models as people usually write them, and by how much the tuned models are better."""
    rows = []
    for case in study.cases:
        for point in (each for name in USUAL for each in study.of(case) if each.way == name):
            tuned = [each for each in study.of(case) if each.way == USUAL[point.way]]
            share = "" if point.share is None else f"{point.share:.3g}"
            gain = point.error / points.error_for(tuned, point.time)
            cells = f"{point.error:.1e}", milliseconds(point.time), share, f"{gain:.1e}"
            rows.append((f"{case}: {point.way}", *cells))
    columns = ("as usually written, Euler, 2 ms", "error [rad]", "run time", "share of the force", "tuned is better by")
    return Table("Models as usually written, and their tuned twins at equal run time", columns, rows)


def sweeps(study: Benchmark) -> Table:
    """Return the times of a scene where many are simulated, each over that of the first way."""
    first = study.sweeps[0]["seconds"]
    rows = [
        (way["name"], milliseconds(way["seconds"]), f"{way['seconds'] / first:.2g}", f"{way['error']:.1e}")
        for way in study.sweeps
    ]
    columns = ("by", "time of a scene", "over the first", "largest error [rad]")
    return Table(f"Many scenes of sliding beer, 2 s, within {SWEPT:g} rad of exact theory, on all cores", columns, rows)


def _ratio(value: float) -> str:
    """Return a ratio of run times as text; it is 0, NaN or infinite where one of the two did not reach the error."""
    return f"{float(f'{value:.2g}'):g}" if 0 < value < math.inf else "-"
