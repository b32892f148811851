"""Maps of timestep and damping: how runs of a damped load end, and up to which timestep theory lets them be bounded."""

from functools import partial
from typing import Any

import numpy as np

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling
from mjbeer.output.terminal import Table
from mjbeer.studies.stability.damped_runs import EXPLODED, MEANINGS, SILENT, WARNED, DampedRuns
from mjbeer.studies.stability.maps import boundary, difference
from mjbeer.studies.study import Task

GROUP = "damped"
"""The group of the study that the maps are in."""
TIMESTEPS = (2.5e-4, 1.6e-2)
"""Range of the timesteps [s]."""
DAMPINGS = (1e-4, 1e1)
"""Range of the damping [N m s]; real liquids are below 0.02."""
CELLS, QUICK_CELLS = (13, 16), (4, 6)
"""Number of timesteps and of dampings in a map; the second is for quick studies."""
PLANS: tuple[tuple[Rolling, Integrator], ...] = tuple(
    (rolling, integrator) for rolling in ROLLINGS for integrator in (*INTEGRATORS, DOP853)
)
"""Ways of rolling and integrators of a full study."""
_QUICK: tuple[tuple[Rolling, Integrator], ...] = (
    ("reduced", "Euler"), ("reduced", "RK4"), ("equality", "implicit"), ("equality", "discrete"), ("contact", "RK4"),
)  # fmt: skip
"""Those of a quick study."""
AGREEMENT = 0.04
"""Largest relative difference at which a measured boundary agrees with the predicted one; the largest of all maps is
0.033. Theory takes the load's angle as constant in parts of a run, in which the fast rate changes by some per cent."""
_IN_CONTACT = 0.12
"""The same in contact. With DOP853 runs explode up to a tenth earlier, in their first step: in its stages, which
overshoot, the can slips and parts from the ground, which the linear theory does not know."""


def tasks(quick: bool = False) -> list[Task]:
    """Return one task a map; a `quick` study has fewer and coarser ones."""
    plans, cells = (_QUICK, QUICK_CELLS) if quick else (PLANS, CELLS)
    return [Task(GROUP, name(*plan), partial(measure, *plan, cells)) for plan in plans]


def name(rolling: str, integrator: str) -> str:
    """Return the name of a map."""
    return f"{rolling}, {integrator}"


def measure(rolling: Rolling, integrator: Integrator, cells: tuple[int, int]) -> dict[str, Any]:
    """Return a map of `cells` timesteps by dampings.

    "measured" has the outcomes, "predicted" whether theory expects an explosion, and "same" the share of cells in which
    it is right. "boundaries" has for each damping the timestep [s] from which on runs explode, measured and predicted,
    or None where none does; "worst" is their largest relative difference. "warned" is the run with the drift that says
    most against it, over its error, of those which are accurate; None if there is none. "agrees" is whether no run is
    wrong and silent, and the boundaries are within `AGREEMENT`.
    """
    timesteps, dampings = (
        np.geomspace(*span, count).tolist() for span, count in zip((TIMESTEPS, DAMPINGS), cells, strict=True)
    )
    measured, predicted, boundaries, warned = [], [], [], []
    for damping in dampings:
        runs = DampedRuns(rolling, integrator, damping, timesteps)
        ended = [runs.measure(timestep) for timestep in timesteps]
        measured.append([run.outcome for run in ended])
        predicted.append([runs.predict(timestep) for timestep in timesteps])
        warned += [
            {"value": damping, "timestep": timestep, "error": run.error, "implied": run.implied}
            for timestep, run in zip(timesteps, ended, strict=True)
            if run.outcome == WARNED
        ]
        exploded = [run.outcome == EXPLODED for run in ended]
        boundaries.append(
            {"value": damping, "measured": boundary(runs.explodes, timesteps, exploded)}
            | {"predicted": boundary(runs.predict, timesteps, predicted[-1])}
        )
    differences = [difference(edge["measured"], edge["predicted"]) for edge in boundaries]
    return {
        **{"name": name(rolling, integrator), "rolling": rolling, "integrator": integrator},
        **{"timesteps": timesteps, "values": dampings, "measured": measured, "predicted": predicted},
        "boundaries": boundaries,
        "same": float(np.mean((np.array(measured) == EXPLODED) == np.array(predicted))),
        "worst": max(differences),
        "warned": max(warned, key=lambda run: run["implied"] / run["error"], default=None),
        "agrees": max(differences) <= (_IN_CONTACT if rolling == "contact" else AGREEMENT)
        and not any(SILENT in row for row in measured),
    }


def table(results: list[dict[str, Any]]) -> Table:
    """Return a table of how many runs of each map ended in which way, and how well theory knew where they explode."""
    rows: list[tuple[str, ...]] = []
    for result in results:
        cells = [outcome for row in result["measured"] for outcome in row]
        counts = (str(cells.count(outcome)) for outcome in range(len(MEANINGS)))
        agrees = "yes" if result["agrees"] else "NO"
        rows.append((result["name"], *counts, f"{result['same']:.1%}", f"{result['worst']:.1%}", agrees))
    columns = ("map", *MEANINGS, "explosions as predicted", "boundary off by", "agrees")
    return Table("Maps of timestep and damping: how runs ended", columns, rows)
