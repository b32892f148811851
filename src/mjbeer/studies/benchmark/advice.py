"""The fastest setting that met a tolerance in a stored benchmark, as text."""

import pathlib

from mjbeer import require
from mjbeer.studies.benchmark import frontier
from mjbeer.studies.benchmark.curves import TOLERANCE
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.benchmark.tables import milliseconds
from mjbeer.studies.cases import CASES

SHIPPED = pathlib.Path(__file__).with_name("study.json")
"""The benchmark that comes with mjbeer. It has what advice and tables need: errors to six digits, least run times."""


def advise(name: str, tolerance: float, rolling: str | None = None, path: pathlib.Path | None = None) -> str:
    """Return the fastest setting for a scene and a `tolerance` [rad], as lines of text.

    The lines are a call in Python, a command, the error and the run time that were measured, and for a soft constraint
    what to write in MJCF. `name` is a case of the study in `path`, by default the one that comes with mjbeer.

    Raises:
      ParameterError: if the study has no such scene, or no setting meets the tolerance.
    """
    require.positive("tolerance", tolerance, "rad")
    stored = Benchmark.load(SHIPPED if path is None else path)
    require.choice("scene", name, stored.cases)
    point = frontier.advise(stored.of(name), tolerance, rolling)
    case = CASES[name]
    lines = [
        f"mjbeer.simulate(scene, duration, phi0, {_arguments(point)})",
        f"mjbeer simulate {case.command} {_options(point)}",
        f"{case.story}: {point.error:.1e} rad in 2.048 s, {milliseconds(point.time)} on {stored.machine['processor']}",
        *_softness(point),
    ]
    return "\n".join(lines)


def _arguments(point: Point) -> str:
    """Return the setting of a point as arguments in Python."""
    if point.knob == TOLERANCE:
        return f"rolling={point.way!r}, tolerance={point.value:g}"
    return f"rolling={point.way!r}, integrator={point.method!r}, timestep={point.value:.6g}"


def _options(point: Point) -> str:
    """Return the setting of a point as options of the command line."""
    return " ".join(f"--{part.replace('=', ' ')}" for part in _arguments(point).replace("'", "").split(", "))


def _softness(point: Point) -> list[str]:
    """Return what to write in MJCF for the softness of a point: a line, or none for a reduced model."""
    if point.timeconst is None or point.impedance is None:
        return []
    if point.way == "equality":
        return [f'solref="{point.timeconst:.6g} 1", and the row solved exactly: dof_invweight0 = 0, solver PGS']
    hard = f"{point.impedance:.4g}"
    return [
        f'solref="{point.timeconst:.6g} 1" solimp="{hard} {hard} 0.001 0.5 2", impratio="100" cone="elliptic", '
        "diagexact enabled, refsafe disabled"
    ]
