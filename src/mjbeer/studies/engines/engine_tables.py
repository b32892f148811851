"""The tables of the can test, for the documents and for the page of the report."""

from collections.abc import Sequence
from typing import NamedTuple

from mjbeer.output.numbers import number
from mjbeer.output.terminal import Table
from mjbeer.studies.can_test import CASES
from mjbeer.studies.engines.results import (
    EQUATION,
    CurveKey,
    Engine,
    Order,
    Results,
    Row,
    order_of,
)

COARSE = 1e-3
"""The timestep [s] that tables compare, and of their run times."""
FINE = 1e-4
"""The shorter timestep [s] of the tables."""
SENSITIVE_MARK = "*"
"""Stands behind the error of a row that a start aside changes."""


class Way(NamedTuple):
    """An engine with a shape and a setting."""

    engine: str
    shape: str
    setting: str

    def key(self, case: str) -> CurveKey:
        """Return the key of its curve in a case."""
        return CurveKey(case, *self)


def ways(results: Results) -> list[Way]:
    """Return all engines with their shapes and settings, in the order of the results."""
    found = [Way(*row.key[1:]) for row in results.rows]
    return list(dict.fromkeys(found))


def row_at(rows: Sequence[Row], timestep: float) -> Row:
    """Return the row of a curve with a timestep [s]."""
    (found,) = [row for row in rows if row.timestep == timestep]
    return found


def coarse_rows(results: Results, way: Way) -> list[Row]:
    """Return the rows of both cases at a timestep of 1 ms."""
    of_way = [row for row in results.rows if way.key(row.case) == row.key]
    return [row for row in of_way if row.timestep == COARSE]


def worst_error(results: Results, way: Way) -> float:
    """Return the larger error of both cases at a timestep of 1 ms [rad]."""
    return max(row.error for row in coarse_rows(results, way))


def closest(results: Results) -> dict[str, Way]:
    """Return, for each engine, the shape and setting whose `worst_error` is the least.

    Settings that choose their own steps are left out.
    """
    with_timestep = [
        way for way in ways(results) if all(row.has_timestep for row in coarse_rows(results, way))
    ]
    return _least(results, with_timestep)


def closest_defaults(results: Results) -> dict[str, Way]:
    """Return, for each engine, the shape whose `worst_error` at the defaults is the least."""
    at_defaults = [
        way for way in ways(results) if not any(row.tuned for row in coarse_rows(results, way))
    ]
    return _least(results, [way for way in at_defaults if way.engine != EQUATION])


def _least(results: Results, candidates: Sequence[Way]) -> dict[str, Way]:
    """Return the candidate of each engine whose `worst_error` is the least."""
    found: dict[str, Way] = {}
    for way in candidates:
        best = found.setdefault(way.engine, way)
        if worst_error(results, way) < worst_error(results, best):
            found[way.engine] = way
    return found


def main_ways(results: Results) -> list[Way]:
    """Return the rows of the main table.

    An engine has the shape that its file names first, at its defaults; what is `closest`; and what
    chooses its own steps.
    """
    firsts: dict[str, Way] = {}
    for way in ways(results):
        firsts.setdefault(way.engine, way)
    chosen = {*firsts.values(), *closest(results).values()}
    return [
        way
        for way in ways(results)
        if way in chosen or not all(row.has_timestep for row in coarse_rows(results, way))
    ]


def errors(results: Results, shown: Sequence[Way] = ()) -> Table:
    """Return the errors of both cases, how they fall with the timestep, and run times.

    The rows are those `shown`, or without them all.
    """
    columns = ["engine", "shape", "setting"]
    for case in CASES:
        columns += [f"{case}, 1 ms", "0.1 ms", "falls as"]
    columns.append("run time [ms]")
    curves = {case: results.curves(case) for case in CASES}
    lines = []
    for way in shown or ways(results):
        cells = list(way)
        for case, of_case in curves.items():
            rows = of_case[way.key(case)]
            cells += [error_cell(row_at(rows, COARSE)), error_cell(row_at(rows, FINE))]
            cells.append(order_cell(order_of(rows)))
        cells.append(time_cell(row_at(curves["roll"][way.key("roll")], COARSE)))
        lines.append(tuple(cells))
    return Table("Largest error of φ and u/a in 2 s [rad]", tuple(columns), lines, left=(0, 1, 2))


def error_cell(row: Row) -> str:
    """Return the error of a row [rad] as text, marked if a start aside changes it."""
    return f"{number(row.error)}{SENSITIVE_MARK if row.is_sensitive else ''}"


def order_cell(order: Order | None) -> str:
    """Return how an error falls with the timestep h: a power of it, or the floor [rad]."""
    if order is None:
        return ""
    if order.converges:
        return f"h^{order.order:.1f}"
    return f"floor {number(order.floor)}"


def time_cell(row: Row) -> str:
    """Return the least and the largest run time of a row as text [ms]; one if they look alike."""
    if not row.seconds:
        return ""
    extremes = (number(1e3 * min(row.seconds)), number(1e3 * max(row.seconds)))
    return " to ".join(dict.fromkeys(extremes))


def conservation(results: Results) -> Table:
    """Return what else should not change: energy, slip and the lane, at a timestep of 1 ms."""
    columns = ["engine", "shape", "setting"]
    for case in CASES:
        columns += [f"{case}: energy", "slip [mm]", "drift [mm]"]
    curves = {case: results.curves(case) for case in CASES}
    lines = []
    for way in ways(results):
        cells = list(way)
        for case, of_case in curves.items():
            row = row_at(of_case[way.key(case)], COARSE)
            values = (row.energy_error, 1e3 * row.slip, 1e3 * row.lateral)
            cells += [number(value) for value in values]
        lines.append(tuple(cells))
    return Table("Energy, slip and drift at 1 ms", tuple(columns), lines, left=(0, 1, 2))


def tuning(results: Results) -> Table:
    """Return what differs from the defaults in each setting that is tuned."""
    lines = []
    for engine in results.engines:
        for setting in engine.settings:
            if setting["tuned"]:
                lines.append((engine.name, setting["shape"], setting["name"], setting["about"]))
    columns = ("engine", "shape", "setting", "what differs from the defaults")
    return Table("What was tuned", columns, lines, left=(0, 1, 2, 3))


def versions(engine: Engine) -> str:
    """Return an engine with the versions of its packages as text."""
    packages = ", ".join(f"{name} {version}" for name, version in engine.versions.items())
    return f"{engine.name} ({packages})"


def measured(results: Results) -> str:
    """Return versions and machine as sentences."""
    machines = [
        f"{engine.machine['cores']} cores of an {engine.machine['processor']}"
        for engine in results.engines
    ]
    places = " and ".join(dict.fromkeys(machines))
    pythons = " and ".join(sorted({engine.python for engine in results.engines}))
    names = ", ".join(versions(engine) for engine in results.engines)
    text = f"Measured on {places}, of which a run uses one, with Python {pythons}: {names}."
    for file, reason in results.absent.items():
        text += f" Left out: {file}, as {reason}."
    return text
