"""Maps of timestep and stiffness: where small motions are stable and accurate, measured and by linear theory."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mjbeer.model.setting import DOP853, INTEGRATORS
from mjbeer.output.terminal import Table
from mjbeer.studies.stability.short_runs import UNSTABLE, Plan, ShortRuns
from mjbeer.studies.study import Task

AGREEMENT = 0.05
"""Largest relative difference at which a measured boundary agrees with the predicted one."""
CELLS, QUICK_CELLS = 20, 8
"""Number of timesteps in a map, and of stiffnesses; the second is for quick studies."""
SPANS = {
    "equality": ((1e-4, 1.0), (1e-4, 1e-1)),
    "direct": ((1e-5, 1.0), (1e2, 1e10)),
    "contact": ((1e-4, 1e-1), (1e-4, 1e-1)),
    "gravity": ((1e-3, 10.0), (1e-3, 1e3)),
    "spring": ((1e-3, 10.0), (1e-3, 1e3)),
}
"""Ranges of a map, by family: timesteps [s], and time constants [s], stiffnesses [1/s^2] or gravities [m/s^2]."""
_MOSTLY = ("Euler", "implicitfast", "discrete", "RK4")
"""Integrators of the families that are not mapped for all of them."""
PLANS = (
    *(Plan("equality", name, refsafe) for refsafe in (False, True) for name in (*INTEGRATORS, DOP853)),
    *(Plan("equality", "Euler", refsafe, dampratio=0.1) for refsafe in (False, True)),
    *(Plan("equality", "Euler", written=first) for first in ("slide", "hinge")),
    *(Plan("direct", name) for name in _MOSTLY),
    Plan("direct", "Euler", dampratio=0.1),
    Plan("direct", "Euler", refsafe=True),
    *(Plan("contact", name, refsafe) for refsafe in (False, True) for name in _MOSTLY),
    *(Plan("gravity", name) for name in (*INTEGRATORS, DOP853)),
    *(Plan("spring", name) for name in _MOSTLY),
)
"""Maps of a full study."""
_QUICK = (
    Plan("equality", "Euler"), Plan("equality", "RK4"), Plan("equality", "discrete"),
    Plan("equality", "implicitfast", refsafe=True), Plan("equality", "Euler", refsafe=True, dampratio=0.1),
    Plan("equality", "Euler", written="slide"), Plan("direct", "Euler"), Plan("contact", "Euler"),
    Plan("contact", "RK4"), Plan("gravity", "Euler"), Plan("gravity", "RK4"), Plan("spring", "discrete"),
)  # fmt: skip
"""Maps of a quick study."""
_RESOLUTION = 1.01
"""Bisection ends when the two timesteps that enclose a boundary have this ratio."""


def tasks(quick: bool = False) -> list[Task]:
    """Return one task a map; a `quick` study has fewer and coarser ones."""
    plans, cells = (_QUICK, QUICK_CELLS) if quick else (PLANS, CELLS)
    return [Task("maps", plan.name, lambda plan=plan: measure(plan, cells)) for plan in plans]


def measure(plan: Plan, cells: int) -> dict[str, Any]:
    """Return a map of `cells` timesteps by as many stiffnesses, each cell measured and predicted, and its boundary.

    "boundaries" has, for each stiffness, the timestep [s] up to which the motion is stable, measured and predicted, or
    None where every timestep of the map is stable. "agrees" is whether all boundaries are within `AGREEMENT`, and
    "same" the share of cells whose outcome is the predicted one.
    """
    times, stiffnesses = (np.geomspace(*span, cells).tolist() for span in SPANS[plan.family])
    measured, predicted, boundaries = [], [], []
    for value in stiffnesses:
        runs = ShortRuns(plan, value)
        measured.append([runs.measure(timestep) for timestep in times])
        predicted.append([runs.predict(timestep) for timestep in times])
        boundaries.append(
            {"value": value, "measured": _edge(runs.measure, times, measured[-1])}
            | {"predicted": _edge(runs.predict, times, predicted[-1])}
        )
    differences = [difference(edge["measured"], edge["predicted"]) for edge in boundaries]
    return {
        **{"name": plan.name, "family": plan.family, "integrator": plan.integrator, "refsafe": plan.refsafe},
        **{"dampratio": plan.dampratio, "written": plan.written},
        **{"timesteps": times, "values": stiffnesses, "measured": measured, "predicted": predicted},
        "boundaries": boundaries,
        "same": float(np.mean(np.array(measured) == np.array(predicted))),
        "worst": max(differences),
        "agrees": max(differences) <= AGREEMENT,
    }


def table(results: list[dict[str, Any]]) -> Table:
    """Return a table of how well the maps agree with theory."""
    rows: list[tuple[str, ...]] = [
        (result["name"], f"{result['same']:.1%}", f"{result['worst']:.1%}", "yes" if result["agrees"] else "NO")
        for result in results
    ]
    return Table("Maps of timestep and stiffness", ("map", "cells as predicted", "boundary off by", "agrees"), rows)


def _edge(judge: Callable[[float], int], timesteps: list[float], outcomes: list[int]) -> float | None:
    """Return the least unstable timestep [s]; None if all are stable."""
    return boundary(lambda h: judge(h) == UNSTABLE, timesteps, [outcome == UNSTABLE for outcome in outcomes])


def boundary(explodes: Callable[[float], bool], timesteps: list[float], exploded: list[bool]) -> float | None:
    """Return the least timestep [s] that explodes, by bisection beside the first that did; None if none did."""
    if True not in exploded:
        return None
    place = exploded.index(True)
    if place == 0:
        return timesteps[0]
    low, high = timesteps[place - 1], timesteps[place]
    while high / low > _RESOLUTION:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if explodes(middle) else (middle, high)
    return math.sqrt(low * high)


def difference(measured: float | None, predicted: float | None) -> float:
    """Return the relative difference of two boundaries: 0 if neither exists, 1 if only one of them does."""
    if measured is None or predicted is None:
        return float(measured is not predicted)
    return abs(measured / predicted - 1)
