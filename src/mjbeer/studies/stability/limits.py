"""The largest timesteps at which small swings of every scene are stable, and those at which they are accurate.

Each limit is the first that is reached from small timesteps: they rise by a fifth until one fails, and bisection
follows. Larger timesteps might be stable again; they are not tried. Constraints are tuned to every timestep, as `build`
does.
"""

import math
from collections.abc import Callable
from typing import Any

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling
from mjbeer.output.terminal import Table
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import RUNGE_KUTTA
from mjbeer.studies.cases import CASES
from mjbeer.studies.stability.small_swings import Swings
from mjbeer.studies.study import Task

AGREEMENT = 0.05
"""Largest relative difference at which a measured limit agrees with the predicted one."""
_SAMPLE = (("sliding", "reduced"), ("frozen", "reduced"), ("pendulum", "equality"), ("frozen", "contact"))
"""Scenes and ways of rolling in a quick study."""
_RESOLUTION = 1.004
"""Bisection ends when the two timesteps that enclose the limit have this ratio."""
_RISE = 1.2
"""Ratio of successive timesteps in the search for the first that fails."""
_FROM, _TO = 0.2, 12.0
"""Smallest and largest omega h in the search for a limit of stability."""
_ACCURATE_FROM = {True: 0.1, False: 0.01}
"""Smallest omega h in the search for a limit of accuracy, by whether the method is a Runge-Kutta method."""


def measure(case: str, rolling: Rolling, integrator: Integrator, settled: bool = True) -> dict[str, Any]:
    """Return the two limits of one way to simulate one scene, measured and predicted, all as omega h.

    "agrees" is whether both are within `AGREEMENT` of the prediction. A can in contact that is not `settled` starts
    where `simulate` starts it, 1e-9 radii deep, and only its stability is measured. For it, "lost_a_stage" is whether
    one of RK4's stages in the first step has no contact at the limit; linear theory does not cover that.
    """
    swings = Swings(CASES[case].scene, rolling, integrator, settled)
    stable, unstable = _limit(swings.bounded, _FROM, _TO)
    predicted = linear_stability.stable_limit(integrator)
    result = {
        **{"case": case, "rolling": rolling, "integrator": integrator, "settled": settled},
        **{"frequency": CASES[case].scene.frequency(), "stable": stable, "stable_predicted": predicted},
        "stable_ratio": stable / predicted,
    }
    if not settled:
        lost = not _close(stable, predicted) and swings.loses_a_stage(unstable)
        return result | {"lost_a_stage": lost, "agrees": _close(stable, predicted) or lost}
    accurate, _ = _limit(swings.accurate, _ACCURATE_FROM[integrator in RUNGE_KUTTA], stable)
    expected = swings.accurate_limit()
    return result | {
        **{"accurate": accurate, "accurate_predicted": expected, "accurate_ratio": accurate / expected},
        "agrees": _close(stable, predicted) and _close(accurate, expected),
    }


def tasks(quick: bool = False) -> list[Task]:
    """Return one task a scene, way of rolling and integrator; a `quick` study has a sample of them."""
    chosen = []
    for case, rolling, integrator, settled in _combinations():
        if quick and not (integrator in ("Euler", "RK4", DOP853) and (case, rolling) in _SAMPLE and settled):
            continue

        def take(case=case, rolling=rolling, integrator=integrator, settled=settled) -> dict[str, Any]:
            return measure(case, rolling, integrator, settled)

        name = f"{case}, {rolling}, {integrator}" + ("" if settled else ", not settled")
        chosen.append(Task("limits", name, take))
    return chosen


def table(results: list[dict[str, Any]]) -> Table:
    """Return the limits as a table, each with measured over predicted in brackets."""
    rows = []
    for result in results:
        accurate = f"{result['accurate']:.3g} ({result['accurate_ratio']:.3f})" if "accurate" in result else "-"
        verdict = "yes" if result["agrees"] else "NO"
        row = (
            f"{result['case']}, {result['rolling']}" + ("" if result["settled"] else ", not settled"),
            result["integrator"],
            f"{result['stable']:.3f} ({result['stable_ratio']:.3f})",
            accurate,
            "a stage of RK4 loses the contact" if result.get("lost_a_stage") else verdict,
        )
        rows.append(row)
    columns = ("scene", "integrator", "stable to ωh (over theory)", "accurate to ωh (over theory)", "agrees")
    return Table("Largest timesteps of a small swing", columns, rows)


def _combinations() -> list[tuple[str, Rolling, Integrator, bool]]:
    """Return all scenes, ways of rolling and integrators, and whether a can in contact starts settled."""
    combinations: list[tuple[str, Rolling, Integrator, bool]] = []
    for case, kind in CASES.items():
        for rolling in ROLLINGS:
            if rolling != "reduced" and kind.scene.attachment == "sliding" and kind.scene.can.mass == 0:
                continue  # in MuJoCo every moving body needs mass
            combinations += [(case, rolling, integrator, True) for integrator in (*INTEGRATORS, DOP853)]
            if rolling == "contact":
                combinations.append((case, rolling, "RK4", False))
    return combinations


def _limit(holds: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """Return two neighbouring values, of which a condition holds at the first and not at the second.

    The first is 0 if it does not hold at `low`, the second is infinite if it holds up to `high`.
    """
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
