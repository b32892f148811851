"""The largest timestep that stays stable, and the largest that stays accurate, of small swings of every scene.

Both are found from the small side: timesteps rise by a fifth until one fails, and bisection follows. What may be stable
again beyond is not looked for. Constraints are tuned to every timestep, as `build` does.
"""

import math
from collections.abc import Callable
from typing import Any

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.output.table import Table
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import RUNGE_KUTTA
from mjbeer.studies.cases import CASES
from mjbeer.studies.stability.small_swings import Swings
from mjbeer.studies.study import Task

AGREEMENT = 0.05
"""How far a measured limit may be from the predicted one, as a share of it."""
_SAMPLE = (("sliding", "reduced"), ("frozen", "reduced"), ("pendulum", "equality"), ("frozen", "contact"))
"""Scenes and ways of rolling of a quick study."""
_RESOLUTION = 1.004
"""Ratio of the two timesteps at which bisection ends."""
_RISE = 1.2
"""Ratio of two timesteps on the way up to the first that fails."""
_FROM, _TO = 0.2, 12.0
"""Least and largest omega h of the search for a limit of stability."""
_ACCURATE_FROM = {True: 0.1, False: 0.01}
"""Least omega h of that for a limit of accuracy; lower where the method is not of Runge and Kutta."""


def measure(case: str, rolling: str, integrator: str, settled: bool = True) -> dict[str, Any]:
    """Return the two limits of one way to simulate one scene, measured and predicted, all as omega h.

    "agrees" says whether they are within `AGREEMENT` of what is predicted. A can in contact that is not `settled`
    starts where `simulate` starts it, 1e-9 radii deep, and only its stability is looked at: "lost_a_stage" says
    whether, where it fails, one of RK4's stages in the first step has no contact, which linear theory does not know.
    """
    swings = Swings(CASES[case].scene, rolling, integrator, settled)
    stable, unstable = _limit(swings.bounded, _FROM, _TO)
    predicted = linear_stability.stable_limit(integrator)
    found = {
        **{"case": case, "rolling": rolling, "integrator": integrator, "settled": settled},
        **{"frequency": CASES[case].scene.frequency(), "stable": stable, "stable_predicted": predicted},
        "stable_ratio": stable / predicted,
    }
    if not settled:
        lost = not _close(stable, predicted) and swings.loses_a_stage(unstable)
        return found | {"lost_a_stage": lost, "agrees": _close(stable, predicted) or lost}
    accurate, _ = _limit(swings.accurate, _ACCURATE_FROM[integrator in RUNGE_KUTTA], stable)
    expected = swings.accurate_limit()
    return found | {
        **{"accurate": accurate, "accurate_predicted": expected, "accurate_ratio": accurate / expected},
        "agrees": _close(stable, predicted) and _close(accurate, expected),
    }


def tasks(quick: bool = False) -> list[Task]:
    """Return one task a scene, way of rolling and integrator; a `quick` study has a sample of them."""
    found = []
    for case, rolling, integrator, settled in _combinations():
        if quick and not (integrator in ("Euler", "RK4", DOP853) and (case, rolling) in _SAMPLE and settled):
            continue

        def take(case=case, rolling=rolling, integrator=integrator, settled=settled) -> dict[str, Any]:
            return measure(case, rolling, integrator, settled)

        name = f"{case}, {rolling}, {integrator}" + ("" if settled else ", not settled")
        found.append(Task("limits", name, take))
    return found


def table(results: list[dict[str, Any]]) -> Table:
    """Return the limits as a table, measured over predicted in brackets."""
    rows = []
    for each in results:
        accurate = f"{each['accurate']:.3g} ({each['accurate_ratio']:.3f})" if "accurate" in each else "-"
        verdict = "yes" if each["agrees"] else "NO"
        rows.append((
            f"{each['case']}, {each['rolling']}" + ("" if each["settled"] else ", not settled"),
            each["integrator"],
            f"{each['stable']:.3f} ({each['stable_ratio']:.3f})",
            accurate,
            "a stage of RK4 loses the contact" if each.get("lost_a_stage") else verdict,
        ))  # fmt: skip
    columns = ("scene", "integrator", "stable to ωh (over theory)", "accurate to ωh (over theory)", "agrees")
    return Table("Largest timesteps of a small swing", columns, rows)


def _combinations() -> list[tuple[str, str, str, bool]]:
    found = []
    for case, kind in CASES.items():
        for rolling in ROLLINGS:
            if rolling != "reduced" and kind.scene.attachment == "sliding" and kind.scene.can.mass == 0:
                continue  # MuJoCo has no massless moving body
            found += [(case, rolling, integrator, True) for integrator in (*INTEGRATORS, DOP853)]
            if rolling == "contact":
                found.append((case, rolling, "RK4", False))
    return found


def _limit(holds: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """The largest value at which something holds and the least at which it does not, of those tried."""
    if not holds(low):
        return 0.0, low
    while holds(low * _RISE):
        low *= _RISE
        if low > high:
            return low, math.inf
    above = low * _RISE
    while above / low > _RESOLUTION:
        middle = math.sqrt(low * above)
        low, above = (middle, above) if holds(middle) else (low, middle)
    return low, above


def _close(measured: float, predicted: float) -> bool:
    return abs(measured / predicted - 1) <= AGREEMENT
