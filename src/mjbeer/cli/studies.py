"""The commands that run many motions: sweep, validate, benchmark, stability, paper and report."""

import functools
import math
import re
from argparse import Namespace
from pathlib import Path
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.cli.arguments import SCENES, make, model_arguments, scene_arguments, start_arguments
from mjbeer.exceptions import ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.folders import owned, replaced
from mjbeer.output.terminal import STDERR, say, show
from mjbeer.studies.benchmark.points import CASES

_PLOTS = (".png", ".svg")
_ENDINGS = (".png", ".svg", ".csv", ".nc")


def sweep(given: Namespace) -> None:
    """Simulate a scene for several values of its options, as 1,2,5 or 1:20:39 (39 from 1 to 20)."""
    from mjbeer.studies.sweep import sweep

    if given.output.suffix not in _ENDINGS:
        endings = " or ".join(_ENDINGS)
        raise ParameterError(f"the file's name must end in {endings}, got {str(given.output)!r}")
    options = scene_arguments(given) | start_arguments(given)
    varied = [values for values in options.values() if isinstance(values, np.ndarray)]
    if given.output.suffix in _PLOTS and len(varied) not in (1, 2):
        raise ParameterError(
            f"a plot needs one or two options with several values, got {len(varied)}: "
            "write .csv or .nc instead"
        )
    if given.tolerance is None and given.integrator is None:
        given.tolerance = 1e-6
    make_scene: Any = functools.partial(make, SCENES[given.scene])
    # The sweep writes this name of its function into its file, and resumes it under no other.
    make_scene.__module__ = "mjbeer"
    make_scene.__qualname__ = given.scene
    options |= {"quantity": given.quantity, **model_arguments(given)}
    if given.output.suffix == ".nc":
        # The sweep itself writes this file, again and again.
        result = sweep(make_scene, given.duration, output=given.output, **options)
    else:
        with files.atomic_write(given.output) as temporary:
            result = sweep(make_scene, given.duration, **options)
            if given.output.suffix == ".csv":
                _write_table(result, temporary)
            else:
                _plot(result, given.quantity, temporary)
    # There is one line for each kind of failure.
    for failure in result.attrs["failed"].splitlines():
        say(f"failed: {_with_degrees(failure, result)}", "yellow")
    say(f"wrote {given.output}")
    terminal.write("; ".join(_counts(result)) + "\n")


def validate(given: Namespace) -> int:
    """Check models and paper against exact theory; exit status 1 if a check fails."""
    from mjbeer.studies.validation.validate import validate

    validation = validate(STDERR)
    if given.json:
        terminal.write(validation.json())
    elif given.table:
        show(*validation.tables())
    return _conclude(validation)


def report(given: Namespace) -> int:
    """Validate, draw films and plots, and write a page of all; exit status 1 if a check fails."""
    from mjbeer.report.page import write

    with owned(given.output, "mjbeer report"), replaced(given.output) as folder:
        validation, not_drawn = write(folder, given.quick, STDERR)
    if not_drawn:
        say(not_drawn, "yellow")
    say(f"the report is in {given.output / 'index.html'}")
    return _conclude(validation)


def benchmark(given: Namespace) -> None:
    """Measure error against run time of integrators and other tools, in ten minutes."""
    from mjbeer.studies.benchmark import benchmark_tables, timing

    names = [require.choice("scene", name, CASES) for name in given.scenes or CASES]
    with owned(given.output, "mjbeer benchmark"), replaced(given.output) as folder:
        study = timing.run(names, given.quick, STDERR)
        benchmark_tables.write(study, folder)
    show(*benchmark_tables.tables(study))
    say(f"the study is in {given.output / 'summary.md'}")


def stability(given: Namespace) -> int:
    """Test stiff cases and limits of stability, in minutes; exit status 1 if theory disagrees."""
    from mjbeer.studies.stability import stability_study as stability

    with owned(given.output, stability.COMMAND):
        study = stability.run(given.output, given.quick, STDERR)
        with replaced(given.output) as folder:
            stability.write(study, folder)
        (given.output / stability.UNFINISHED).unlink(missing_ok=True)
    show(*stability.tables(study))
    for result in study.failed:
        say(f"not as it must be: {result.summary_line()}", "red")
    say(f"the study is in {given.output / 'summary.md'}")
    return 1 if study.failed else 0


def paper(given: Namespace) -> None:
    """Plot each of the paper's scenarios, and write a folder with a summary."""
    from mjbeer.paper import stories

    with owned(given.output, "mjbeer paper"), replaced(given.output) as folder:
        not_drawn = stories.write(folder, given.films, STDERR)
    say(f"the stories are in {given.output / 'stories.md'}")
    if not_drawn:
        say(not_drawn, "yellow")


def _conclude(validation: Any) -> int:
    """Print each failure and, on the last line, how much passed; return the exit status."""
    for failure in validation.failures:
        say(f"FAILED: {failure}", "red")
    say(validation.sentence, "green" if validation.passed else "red")
    return 0 if validation.passed else 1


def _counts(result: Any) -> list[str]:
    """Return how many scenes of a sweep have each status, and how many are not trusted."""
    from mjbeer.studies.sweep_runs import STATUSES, WELL

    status = result["status"].values
    counts = []
    for number, meaning in STATUSES.items():
        if number in status:
            counts.append(f"{np.count_nonzero(status == number)}: {meaning}")
    doubted = np.count_nonzero((status == WELL) & ~result["trusted"].values)
    if doubted:
        counts.append(f"{doubted}: not trusted")
    return counts


def _write_table(result: Any, path: Path) -> None:
    """Write a sweep as CSV, in SI units and radians; a heading ends with the unit, if any."""
    # A single scene has no dimensions, and xarray would refuse to make a table of it.
    table = result.expand_dims("scene").to_dataframe().reset_index().drop(columns="scene")
    units = {name: variable.attrs.get("units") for name, variable in result.variables.items()}
    headings = {name: f"{name} [{unit}]" for name, unit in units.items() if unit}
    table.rename(columns=headings).to_csv(path, float_format="%.17g", index=False)


def _with_degrees(failure: str, result: Any) -> str:
    """Return a line about a scene that failed, with degrees where `sweep` writes radians.

    The line names the scene as "incline[1] = 0.0349066, fill[0] = 0.3".
    """

    def rewritten(assignment: re.Match[str]) -> str:
        name, place = assignment.groups()
        angles = _in_degrees(result[name])
        unit = angles.attrs["units"].replace("°", "degrees")
        return f"{name}[{place}] = {angles.values[int(place)]:.6g} {unit}"

    for name in result.dims:
        if "rad" in result[name].attrs.get("units", ""):
            failure = re.sub(rf"\b({name})\[(\d+)\] = [^,)]+", rewritten, failure)
    return failure


def _plot(result: Any, quantity: str, path: Path) -> None:
    """Plot a quantity against one parameter, or as a map of two, with angles in degrees."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    from mjbeer.output.plots import STYLE

    shown = _in_degrees(result[quantity].where(np.isfinite(result[quantity])))
    shown = shown.assign_coords(
        {name: _in_degrees(coordinate) for name, coordinate in shown.coords.items()}
    )
    with mpl.rc_context(STYLE | {"axes.grid": shown.ndim == 1}):
        figure = Figure((7, 4.5), layout="constrained")
        axes = figure.subplots()
        if shown.ndim == 2:
            shown.plot(ax=axes, x=shown.dims[0], cmap="cividis", center=False)
        else:
            shown.plot(ax=axes, marker=".")
        axes.set_title(_heading(shown, result))
        figure.savefig(path, dpi=150)


def _heading(shown: Any, result: Any) -> str:
    """Return the range of what a plot shows, and in a second line what was simulated."""
    name = shown.attrs.get("long_name", shown.name)
    unit = shown.attrs.get("units", "")
    known = shown.values[np.isfinite(shown.values)]
    found = f"{known.min():.3g} to {known.max():.3g} {unit}".strip() if known.size else "no value"
    runs = f"{result.attrs['make']}, {result.attrs['duration']:.6g} s each"
    absent = "; white cells have no value" if shown.ndim == 2 and known.size < shown.size else ""
    return f"{name[0].upper()}{name[1:]}: {found}\n{runs}{absent}"


def _in_degrees(values: Any) -> Any:
    """Return values in degrees if they are angles or their rates."""
    unit = values.attrs.get("units", "")
    if "rad" not in unit:
        return values
    in_degrees = math.degrees(1) * values
    return in_degrees.assign_attrs(values.attrs | {"units": unit.replace("rad", "°")})
