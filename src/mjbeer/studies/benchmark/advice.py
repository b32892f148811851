"""Advice from a stored study: which setting to take for a tolerance."""

import pathlib

from mjbeer import require
from mjbeer.studies.benchmark import frontier
from mjbeer.studies.benchmark.curves import TOLERANCE
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.benchmark.tables import milliseconds
from mjbeer.studies.cases import CASES

SHIPPED = pathlib.Path(__file__).with_name("study.json")
"""The study that comes with mjbeer: what advice and tables read, errors to six digits, and of run times the least."""


def advise(name: str, tolerance: float, rolling: str | None = None, path: pathlib.Path | None = None) -> str:
    """Return the setting to take for a scene and a `tolerance` [rad] as text: lines to use, and what it cost.

    Raises:
      ParameterError: if the study has no such scene, or no setting meets the tolerance.
    """
    require.positive("tolerance", tolerance, "rad")
    stored = Benchmark.load(SHIPPED if path is None else path)
    require.choice("scene", name, stored.cases)
    point = frontier.advise(stored.of(name), tolerance, rolling)
    case = CASES[name]
    return "\n".join([
        f"mjbeer.simulate(scene, duration, phi0, {_arguments(point)})",
        f"mjbeer simulate {case.command} {_options(point)}",
        f"{case.story}: {point.error:.1e} rad in 2.048 s, {milliseconds(point.time)} on {stored.machine['processor']}",
        *_softness(point),
    ])  # fmt: skip


def _arguments(point: Point) -> str:
    if point.knob == TOLERANCE:
        return f"rolling={point.way!r}, tolerance={point.value:g}"
    return f"rolling={point.way!r}, integrator={point.method!r}, timestep={point.value:.6g}"


def _options(point: Point) -> str:
    return " ".join(f"--{part.replace('=', ' ')}" for part in _arguments(point).replace("'", "").split(", "))


def _softness(point: Point) -> list[str]:
    """What `build` sets for it, for models written elsewhere."""
    if point.timeconst is None or point.impedance is None:
        return []
    if point.way == "equality":
        return [f'solref="{point.timeconst:.6g} 1", and the row solved exactly: dof_invweight0 = 0, solver PGS']
    hard = f"{point.impedance:.4g}"
    return [
        f'solref="{point.timeconst:.6g} 1" solimp="{hard} {hard} 0.001 0.5 2", impratio="100" cone="elliptic", '
        "diagexact enabled, refsafe disabled"
    ]
