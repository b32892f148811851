"""A case of the catalogue of stiff and extreme scenes: why it is one, what theory expects, and how it is tried."""

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import DOP853, INTEGRATORS, supported
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.outcome import ACCURATE, REFUSED, SILENT, judge
from mjbeer.studies.study import Task
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

SWINGS = 5.0
"""Length of a run, in natural periods."""
_STEPS, _LARGE_STEPS = 300, 100
"""Timesteps a natural period; the second for DOP853."""
_DESK = (0.1, 30.0)
"""Shortest and longest run with the default timestep, as somebody would make it who thinks of a can on a desk [s]."""
TOLERANCE = 1e-9
"""Tolerance of the runs that have one [rad]."""


@dataclass(frozen=True)
class Attempt:
    """One run of a case."""

    setting: str
    simulate: Callable[[], Trajectory]
    expected: tuple[str, ...] = ()
    """Outcomes that theory allows. If empty, every outcome but "wrong and silent" is allowed."""
    within: float = math.inf
    """Largest error that is expected of an accurate run [rad]."""
    sample: bool = True
    """Whether it is part of a quick study."""


@dataclass(frozen=True)
class CatalogueCase:
    """A stiff or extreme case."""

    kind: str
    """The list that it is on."""
    name: str
    why: str
    """Why it is extreme."""
    theory: str
    """What theory expects."""
    attempts: tuple[Attempt, ...]

    def task(self, quick: bool) -> Task:
        """Return the task of trying the case in all its ways, or in a sample of them."""
        return Task("catalogue", f"{self.kind}: {self.name}", partial(self.measure, quick))

    def measure(self, quick: bool) -> dict[str, Any]:
        """Try the case, in a sample of its ways if `quick`, and return what came of it as JSON has it."""
        about = {name: getattr(self, name) for name in ("kind", "name", "why", "theory")}
        return about | {"runs": [_check(attempt) for attempt in self.attempts if attempt.sample or not quick]}


def _check(attempt: Attempt) -> dict[str, Any]:
    outcome = judge(attempt.simulate)
    allowed = outcome.verdict in attempt.expected if attempt.expected else outcome.verdict != SILENT
    allowed = allowed and (outcome.error is None or outcome.error <= attempt.within)
    ended = dataclasses.asdict(outcome)
    return {"setting": attempt.setting, **ended, "expected": list(attempt.expected), "as_expected": allowed}


def natural_period(scene: Scene, phi_dot0: float = 0.0) -> float:
    """Return the time in which something happens [s]: a small swing, a turn, or a fall through the radius."""
    turn = 2 * math.pi / abs(phi_dot0) if phi_dot0 else math.inf
    try:
        frequency = scene.frequency()
    except NoEquilibriumError:
        frequency = 0.0
    if frequency > 0:
        return min(turn, 2 * math.pi / frequency)
    fall = 2 * math.pi * math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else math.inf
    return min(turn, fall) if math.isfinite(min(turn, fall)) else 1.0


def attempts(
    scene: Scene,
    phi0: float,
    phi_dot0: float = 0.0,
    expected: Mapping[str, tuple[str, ...]] = MappingProxyType({}),
    swings: float = SWINGS,
) -> tuple[Attempt, ...]:
    """Return attempts at a start in every way of rolling, with every integrator, at timesteps that suit the scene.

    Without another word in `expected` (by way of rolling, or "tolerance"), a reduced model is expected to be accurate
    under RK4, DOP853 and to a tolerance, an equality under RK4 and to a tolerance where MuJoCo has such a model, and
    nothing is expected of a contact, which may part, or of methods of first order.
    """
    period = natural_period(scene, phi_dot0)
    go = partial(simulate, scene, swings * period, phi0, phi_dot0)
    found = []
    for rolling in ("reduced", "equality", "contact"):
        able = supported(scene, rolling)
        good = expected.get(rolling, (ACCURATE,) if rolling != "contact" else ()) if able else (REFUSED,)
        steps = dict.fromkeys(INTEGRATORS, period / _STEPS) | {DOP853: period / _LARGE_STEPS}
        for integrator, timestep in steps.items():
            first_order = integrator not in ("RK4", DOP853)
            run = partial(go, rolling, integrator, timestep)
            hopes = () if able and (first_order or (rolling != "reduced" and integrator == DOP853)) else good
            label = f"{rolling}, {integrator}, T/{round(period / timestep)}"
            found.append(Attempt(label, run, hopes, sample=integrator == "RK4"))
        if rolling != "contact":
            run = partial(go, rolling, timestep=period / _STEPS, tolerance=TOLERANCE)
            label = f"{rolling}, to a tolerance of {TOLERANCE:g}"
            wanted = expected.get("tolerance", good) if able else good
            found.append(Attempt(label, run, wanted, TOLERANCE if wanted == (ACCURATE,) else math.inf))
    shown = min(max(swings * period, _DESK[0]), _DESK[1])
    found.append(Attempt("reduced, RK4, 1 ms", partial(simulate, scene, shown, phi0, phi_dot0)))
    return tuple(found)
