"""Maps of timestep and stiffness: where small motions are stable and accurate, measured and as linear theory has it."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mjbeer.model.setting import DOP853, INTEGRATORS
from mjbeer.output.table import Table
from mjbeer.studies.stability.short_runs import UNSTABLE, Plan, ShortRuns
from mjbeer.studies.study import Task

AGREEMENT = 0.05
"""How far a measured boundary may be from the predicted one, as a share of it."""
CELLS, QUICK_CELLS = 20, 8
"""Timesteps, and stiffnesses, of a map."""
SPANS = {
    "equality": ((1e-4, 1.0), (1e-4, 1e-1)),
    "direct": ((1e-5, 1.0), (1e2, 1e10)),
    "contact": ((1e-4, 1e-1), (1e-4, 1e-1)),
    "gravity": ((1e-4, 10.0), (1e-2, 1e6)),
    "spring": ((1e-4, 10.0), (1e-2, 1e6)),
}
"""Of each family the timesteps [s], and the time constants [s], stiffnesses [1/s^2] or gravities [m/s^2]."""
_MOSTLY = ("Euler", "implicitfast", "discrete", "RK4")
PLANS = (
    *(Plan("equality", each, refsafe) for refsafe in (False, True) for each in (*INTEGRATORS, DOP853)),
    *(Plan("equality", "Euler", refsafe, 0.1) for refsafe in (False, True)),
    *(Plan("equality", "Euler", written=first) for first in ("slide", "hinge")),
    *(Plan("direct", each) for each in _MOSTLY),
    Plan("direct", "Euler", dampratio=0.1),
    Plan("direct", "Euler", refsafe=True),
    *(Plan("contact", each, refsafe) for refsafe in (False, True) for each in _MOSTLY),
    *(Plan("gravity", each) for each in (*INTEGRATORS, DOP853)),
    *(Plan("spring", each) for each in _MOSTLY),
)
_QUICK = (
    Plan("equality", "Euler"), Plan("equality", "RK4"), Plan("equality", "discrete"),
    Plan("equality", "implicitfast", refsafe=True), Plan("equality", "Euler", refsafe=True, dampratio=0.1),
    Plan("equality", "Euler", written="slide"), Plan("direct", "Euler"), Plan("contact", "Euler"),
    Plan("contact", "RK4"), Plan("gravity", "Euler"), Plan("gravity", "RK4"), Plan("spring", "discrete"),
)  # fmt: skip
_RESOLUTION = 1.01
"""Ratio of two timesteps at which the bisection of a boundary ends."""


def tasks(quick: bool = False) -> list[Task]:
    """Return one task a map; a `quick` study has fewer and coarser ones."""
    plans, cells = (_QUICK, QUICK_CELLS) if quick else (PLANS, CELLS)
    return [Task("maps", plan.name, lambda plan=plan: measure(plan, cells)) for plan in plans]


def measure(plan: Plan, cells: int) -> dict[str, Any]:
    """Return a map of `cells` timesteps by as many stiffnesses, each cell measured and predicted, and its boundary.

    "boundaries" has, for each stiffness, the timestep [s] up to which the motion is stable, measured and predicted, or
    None where it is throughout. "agrees" says whether all are within `AGREEMENT`; "same" is the share of cells that
    are what theory says.
    """
    times, stiffnesses = (np.geomspace(*span, cells).tolist() for span in SPANS[plan.family])
    measured, predicted, boundaries = [], [], []
    for value in stiffnesses:
        runs = ShortRuns(plan, value)
        seen, said = ([judge(h) for h in times] for judge in (runs.measure, runs.predict))
        measured.append(seen)
        predicted.append(said)
        boundaries.append({
            "value": value,
            "measured": _boundary(runs.measure, times, seen),
            "predicted": _boundary(runs.predict, times, said),
        })  # fmt: skip
    off = [_off(each["measured"], each["predicted"]) for each in boundaries]
    return {
        **{"name": plan.name, "family": plan.family, "integrator": plan.integrator, "refsafe": plan.refsafe},
        **{"dampratio": plan.dampratio, "written": plan.written},
        **{"timesteps": times, "values": stiffnesses, "measured": measured, "predicted": predicted},
        "boundaries": boundaries,
        "same": float(np.mean(np.array(measured) == np.array(predicted))),
        "worst": max(off),
        "agrees": max(off) <= AGREEMENT,
    }


def table(results: list[dict[str, Any]]) -> Table:
    """Return how well the maps agree with theory."""
    rows: list[tuple[str, ...]] = [
        (each["name"], f"{each['same']:.1%}", f"{each['worst']:.1%}", "yes" if each["agrees"] else "NO")
        for each in results
    ]
    return Table("Maps of timestep and stiffness", ("map", "cells as predicted", "boundary off by", "agrees"), rows)


def _boundary(judge: Callable[[float], int], timesteps: list[float], known: list[int]) -> float | None:
    """Where the first unstable timestep begins, by bisection; None if all are stable."""
    if UNSTABLE not in known:
        return None
    place = known.index(UNSTABLE)
    if place == 0:
        return timesteps[0]
    low, high = timesteps[place - 1], timesteps[place]
    while high / low > _RESOLUTION:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if judge(middle) == UNSTABLE else (middle, high)
    return math.sqrt(low * high)


def _off(measured: float | None, predicted: float | None) -> float:
    """By how much two boundaries differ, as a share; wholly where only one of them exists."""
    if measured is None or predicted is None:
        return float(measured is not predicted)
    return abs(measured / predicted - 1)
