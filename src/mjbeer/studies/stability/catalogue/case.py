"""A case of the catalogue: why it is stiff or extreme, what theory expects, and in which ways it is simulated."""

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import DOP853, INTEGRATORS, Integrator, supported
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.outcome import ACCURATE, NEVER, REFUSED, judge
from mjbeer.studies.study import Task
from mjbeer.theory.scene import Scene

SWINGS = 5.0
"""Length of a run, in natural periods."""
_STEPS, _LARGE_STEPS = 300, 100
"""Timesteps a natural period; the second number is for DOP853."""
_DESK = (0.1, 30.0)
"""Shortest and longest run with the default settings [s], chosen as for a can on a desk, whatever the scene."""
TOLERANCE = 1e-9
"""Tolerance of the runs that are made to a tolerance [rad]."""


@dataclass(frozen=True)
class Attempt:
    """One way to simulate a case."""

    setting: str
    """Name of the way: of rolling, integrator, and timestep or tolerance."""
    simulate: Callable[[], Run]
    expected: tuple[str, ...] = ()
    """Outcomes that theory allows. If empty, every outcome is allowed that is not in `outcome.NEVER`."""
    within: float = math.inf
    """Largest error that a run may have to be as expected [rad]."""
    sample: bool = True
    """Whether a quick study includes it."""


@dataclass(frozen=True)
class CatalogueCase:
    """A stiff or extreme case."""

    kind: str
    """Part of the catalogue: "stiff", "extreme" or "found"."""
    name: str
    why: str
    """Why it is stiff or extreme."""
    theory: str
    """What theory expects."""
    attempts: tuple[Attempt, ...]

    def task(self, quick: bool) -> Task:
        """Return the task of trying the case in all its ways, or in a sample of them."""
        return Task("catalogue", f"{self.kind}: {self.name}", partial(self.measure, quick))

    def measure(self, quick: bool) -> dict[str, Any]:
        """Simulate the case in all its ways, or in a sample if `quick`, and return the outcomes in a form for JSON."""
        about = {name: getattr(self, name) for name in ("kind", "name", "why", "theory")}
        return about | {"runs": [_check(attempt) for attempt in self.attempts if attempt.sample or not quick]}


def _check(attempt: Attempt) -> dict[str, Any]:
    """Return the outcome of a run, and whether it is among those that theory allows."""
    outcome = judge(attempt.simulate)
    allowed = outcome.verdict in attempt.expected if attempt.expected else outcome.verdict not in NEVER
    allowed = allowed and (outcome.error is None or outcome.error <= attempt.within)
    about = dataclasses.asdict(outcome)
    return {"setting": attempt.setting, **about, "expected": list(attempt.expected), "as_expected": allowed}


def natural_period(scene: Scene, phi_dot0: float = 0.0) -> float:
    """Return the time scale of a motion [s]: a small swing or a turn, or else a fall through the radius."""
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
    """Return attempts at a motion in every way of rolling, with every integrator, at timesteps that suit the scene.

    `expected` gives the allowed outcomes by way of rolling, or for "tolerance". Where it does not, a reduced model must
    be accurate with RK4, with DOP853 and to a tolerance, and an equality with RK4 and to a tolerance. A model that
    MuJoCo cannot have must be refused. A contact, which may part, and methods of first order may end in any way that
    is not in `outcome.NEVER`.
    """
    period = natural_period(scene, phi_dot0)
    start = partial(simulate, scene, swings * period, phi0, phi_dot0)
    tries = []
    for rolling in ("reduced", "equality", "contact"):
        possible = supported(scene, rolling)
        usual = expected.get(rolling, (ACCURATE,) if rolling != "contact" else ()) if possible else (REFUSED,)
        steps: dict[Integrator, float] = dict.fromkeys((*INTEGRATORS, DOP853), period / _STEPS)
        steps[DOP853] = period / _LARGE_STEPS
        for integrator, timestep in steps.items():
            first_order = integrator not in ("RK4", DOP853)
            run = partial(start, rolling, integrator, timestep)
            wanted = () if possible and (first_order or (rolling != "reduced" and integrator == DOP853)) else usual
            label = f"{rolling}, {integrator}, T/{round(period / timestep)}"
            tries.append(Attempt(label, run, wanted, sample=integrator == "RK4"))
        if rolling != "contact":
            run = partial(start, rolling, timestep=period / _STEPS, tolerance=TOLERANCE)
            label = f"{rolling}, to a tolerance of {TOLERANCE:g}"
            wanted = expected.get("tolerance", usual) if possible else usual
            tries.append(Attempt(label, run, wanted, TOLERANCE if wanted == (ACCURATE,) else math.inf))
    duration = min(max(swings * period, _DESK[0]), _DESK[1])
    tries.append(Attempt("reduced, RK4, 1 ms", partial(simulate, scene, duration, phi0, phi_dot0)))
    return tuple(tries)
