"""The tables of a benchmark: fastest settings, comparisons, orders of convergence, and the cost of a step's stages."""

import math

from mjbeer.model.setting import DOP853, ROLLINGS
from mjbeer.output.terminal import Table
from mjbeer.studies.benchmark import frontier
from mjbeer.studies.benchmark.curves import TIMESTEP, TOLERANCE, USUAL, Curve, aligned
from mjbeer.studies.benchmark.peers.whole_call import NAME as WHOLE
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.convergence import Convergence, convergence

COMPARED = (1e-3, 1e-6, 1e-9, 1e-11)
"""The errors [rad] at which run times are compared with that of the best setting."""


def tables(study: Benchmark) -> list[Table]:
    """Return the tables of a study, in the order in which they are shown."""
    return [
        *(cheapest(study, case) for case in study.cases),
        others(study),
        tolerances(study),
        usual(study),
        *(ladders(study, case) for case in study.cases),
        stages(study),
    ]


def setting(point: Point) -> str:
    """Return the setting of a point in a few words: its method, and its timestep [ms] or its tolerance."""
    knob = f"{point.value:g}" if point.knob == TOLERANCE else milliseconds(point.value)
    return f"{point.method} {'to ' if point.knob == TOLERANCE else ''}{knob}".strip()


def milliseconds(time: float) -> str:
    """Return a time [s] as text, in milliseconds."""
    return f"{1e3 * time:.3g} ms"


def cheapest(study: Benchmark, case: str) -> Table:
    """Return the fastest setting of a case for each error and way of rolling, with its run time."""
    points = study.of(case)
    ways = [way for way in ROLLINGS if any(point.way == way for point in points)]
    rows = []
    for level in frontier.LEVELS:
        cells = [f"{level:.0e} rad"]
        for way in ways:
            best = frontier.cheapest([point for point in points if point.way == way], level)
            cells.append("not reached" if best is None else f"{setting(best)}: {milliseconds(best.time)}")
        rows.append(tuple(cells))
    return Table(f"{case}: cheapest setting for an error, and its run time", ("error at most", *ways), rows)


def others(study: Benchmark) -> Table:
    """Return run times of RK4 and of other tools over that of the best reduced setting, at equal error."""
    names = ["MuJoCo RK4", "SciPy DOP853", "SciPy LSODA", "SciPy odeint", "heyoka"]
    rows = []
    for case in study.cases:
        points = study.of(case)
        reduced = [point for point in points if point.way == "reduced"]
        curves = {"MuJoCo RK4": [point for point in reduced if point.method == "RK4"]}
        curves |= {name: [point for point in points if point.way == name] for name in names[1:]}
        for level in COMPARED:
            best = frontier.time_for(reduced, level)
            ratios = [frontier.time_for(curves[name], level) / best for name in names]
            rows.append((f"{case}, {level:.0e} rad", milliseconds(best), *(_ratio(ratio) for ratio in ratios)))
    columns = ("error", "best reduced", *names)
    return Table("Run time of others over that of the best reduced setting; under 1 they are faster", columns, rows)


def tolerances(study: Benchmark) -> Table:
    """Return the run times to a tolerance, beside those of the best fixed timestep, and of SciPy's best method.

    A whole call is `mjbeer.simulate` from the scene to the trajectory, with all that a trajectory says about itself.
    """
    rows = []
    for case in study.cases:
        points = study.of(case)
        rivals = [point for point in points if point.way in ("SciPy DOP853", "SciPy LSODA")]
        for digits in (3, 6, 9, 12):
            tolerance = 10.0**-digits
            fixed, adaptive = frontier.fixed_and_global(points, tolerance)
            whole = frontier.at(points, Curve(WHOLE, "", TOLERANCE), tolerance)
            if fixed and adaptive and whole:
                row = (f"{case}, 1e-{digits}", milliseconds(fixed.time), milliseconds(adaptive.time))
                row += (f"{adaptive.time / fixed.time:.2f}", f"{adaptive.error:.1e}", milliseconds(whole.time))
                rows.append((*row, _ratio(frontier.time_for(rivals, tolerance) / whole.time)))
    columns = ("tolerance [rad]", "best fixed timestep", "to the tolerance", "ratio", "its error [rad]")
    title = "Run time to a tolerance, with the fastest fixed timestep that meets it, and of whole calls"
    return Table(title, (*columns, "whole call", "SciPy's best over it"), rows)


def usual(study: Benchmark) -> Table:
    """Return the errors of models as people usually write them, and by how much the tuned models are better."""
    rows = []
    for case in study.cases:
        points = study.of(case)
        for written in USUAL:
            gain = frontier.gain_over_usual(points, written)
            if gain is None:
                continue
            point = next(point for point in points if point.way == written)
            share = "" if point.effective_impedance is None else f"{point.effective_impedance:.3g}"
            cells = f"{point.error:.1e}", milliseconds(point.time), share, f"{gain:.1e}"
            rows.append((f"{case}: {written}", *cells))
    columns = ("as usually written, Euler, 2 ms", "error [rad]", "run time", "share of the force", "tuned is better by")
    return Table("Models as usually written, and their tuned twins at equal run time", columns, rows)


def ladders(study: Benchmark, case: str) -> Table:
    """Return the order and the floor of each ladder of timesteps, and the parts of the error at its finest rung."""
    rows = []
    for curve in dict.fromkeys(point.curve for point in study.points if point.case == case):
        points = [point for point in study.of(case) if point.curve == curve]
        if not points or curve.knob != TIMESTEP or curve.way in USUAL:
            continue
        last = ([point for point in points if point.model_error is not None] or points)[-1]
        split = [f"{milliseconds(last.value)}: {last.error:.1e}"]
        split += ["" if error is None else f"{error:.1e}" for error in (last.model_error, last.integrator_error)]
        rows.append((curve.label, str(convergence_of(points)), *split))
    columns = ("curve", "verdict", "at a rung: error [rad]", "of the model", "of the integrator")
    return Table(f"{case}: verdicts", columns, rows)


def convergence_of(points: list[Point]) -> Convergence:
    """Return order and floor of the points of a curve, from the rungs whose samples need no interpolation."""
    exact = [point for point in points if point.method != DOP853 or aligned(point.value)]
    return convergence([point.value for point in exact], [point.error for point in exact])


def stages(study: Benchmark) -> Table:
    """Return how much longer a step takes with stages that the scene does not need."""
    names = list(dict.fromkeys(name for row in study.ablation for name in row if name not in ("case", "integrator")))
    rows = []
    for row in study.ablation:
        cells = [f"{1e6 * row['step']:.2f} us"] + [
            f"{row[name]:.2f}" if name in row else "needed" for name in names if name != "step"
        ]
        rows.append((f"{row['case']}, {row['integrator']}", *cells))
    columns = ("reduced model", "a step", *(f"with {name}" for name in names if name != "step"))
    return Table("Time of a step with one stage more over that of a step without", columns, rows)


def _ratio(value: float) -> str:
    return "-" if not math.isfinite(value) else f"{value:.2g}"
