"""A seeded search for runs that are wrong and silent."""

import dataclasses
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

import numpy as np

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.outcome import ACCURATE, SILENT, VERDICTS, Outcome, judge
from mjbeer.studies.study import Task
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene
from mjbeer.theory.trajectory import Trajectory

NUMBERS = 36
"""How many numbers make a random run."""
_LONGEST = 100.0
"""Turns and falls through the radius that a run may last: exact theory follows each of them."""
_SAMPLES = 200


@dataclass(frozen=True)
class RandomRun:
    """A scene, its start, and how it is simulated."""

    scene: Scene
    phi0: float
    phi_dot0: float
    rolling: str
    integrator: str
    timestep: float
    steps: int
    tolerance: float | None
    friction: float

    @property
    def times(self) -> np.ndarray:
        """Its samples [s]."""
        chosen = np.unique(np.linspace(0, self.steps, min(self.steps, _SAMPLES) + 1).astype(int))
        return self.timestep * chosen

    def simulate(self) -> Trajectory:
        """Return its motion at its samples."""
        return simulate(
            self.scene, self.timestep * self.steps, self.phi0, self.phi_dot0, rolling=self.rolling,
            integrator=self.integrator, timestep=self.timestep, tolerance=self.tolerance, times=self.times,
            friction=self.friction,
        )  # fmt: skip


T = TypeVar("T")


class _Numbers:
    """Numbers between 0 and 1, each used once."""

    def __init__(self, numbers: Sequence[float]) -> None:
        self._left = iter(numbers)

    def between(self, low: float, high: float) -> float:
        return low + (high - low) * next(self._left)

    def decades(self, low: float, high: float) -> float:
        return float(10 ** self.between(math.log10(low), math.log10(high)))

    def one(self, *options: T) -> T:
        return options[min(int(next(self._left) * len(options)), len(options) - 1)]


def random_run(numbers: Sequence[float]) -> RandomRun:
    """Return the run that `NUMBERS` numbers between 0 and 1 stand for.

    Sizes, masses, gravities and timesteps are spread over their decades; what is special (an empty can, the top, a
    fill of one, a point load, no gravity, no incline, a start beside the separatrix) comes up as often as what is not.

    Raises:
      ParameterError: if there is no such scene.
    """
    pick = _Numbers(numbers)
    scene = _scene(pick)
    slow = math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else 1.0
    beside = _top(scene) - pick.decades(1e-12, 1)
    phi0 = pick.one(0.0, math.pi, 1.0, pick.between(-4, 4), pick.decades(1e-9, 1), beside)
    spin = pick.one(0.0, 0.0, pick.between(-3, 3), pick.decades(1e-3, 1e3))
    haste = max(1.0, abs(spin))
    timestep = slow / haste * pick.decades(1e-4, 3)
    steps = max(4, int(min(pick.decades(10, 2e4), _LONGEST * slow / haste / timestep)))
    rolling, integrator = pick.one(*ROLLINGS), pick.one(*INTEGRATORS, DOP853)
    tolerance = pick.one(None, None, None, 10.0 ** -round(pick.between(3, 12)))
    if rolling == "contact":
        tolerance = None  # a stiff contact takes more steps to it than one would wait for
    friction = pick.one(1.0, 1.0, pick.decades(1e-3, 1e3))
    return RandomRun(
        scene, phi0, phi_dot0=spin / slow, rolling=rolling, integrator=integrator, timestep=timestep, steps=steps,
        tolerance=tolerance, friction=friction,
    )  # fmt: skip


def _top(scene: Scene) -> float:
    """Where the largest swing ends [rad]; pi where nothing swings."""
    try:
        return scene.separatrix()[1]
    except NoEquilibriumError:
        return math.pi


def _scene(pick: _Numbers) -> Scene:
    radius, load_mass = pick.decades(1e-6, 100), pick.decades(1e-9, 1e6)
    mass = pick.one(0.0, load_mass * pick.decades(1e-6, 1e6))
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.0, 0.5, 1.0, pick.between(0, 1)))
    fill = pick.one(1e-6, 1 - 1e-6, 1.0, 0.5, pick.between(1e-6, 1))
    segment = Load.segment(radius, 3 * radius, fill, load_mass / (3 * math.pi * radius**3))
    offset = radius * pick.one(0.0, 1.0, pick.decades(1e-9, 1), pick.between(0, 1))
    inertia = load_mass * radius**2 * pick.one(0.0, pick.decades(1e-12, 1), pick.between(0, 1))
    load = pick.one(segment, Load(load_mass, offset, inertia))
    incline = pick.one(0.0, 1e-8, 10.0, 89.9, pick.between(-30, 30), pick.between(-89.9, 89.9))
    gravity = pick.one(GRAVITY, GRAVITY, GRAVITY, 0.0, pick.decades(1e-6, 1e6))
    return Scene(can, load, math.radians(incline), pick.one(*ATTACHMENTS), gravity)


_BATCH = 100
"""Runs of a task: some ten seconds."""
_BATCHES, _QUICK_BATCHES = 30, 2
_ROUNDING = 1e-9
"""Errors below this [rad] do not count as overconfident: a second run at half the timestep cannot see rounding."""
_IMPOSSIBLE = "no such scene"


def tasks(quick: bool) -> list[Task]:
    """Return the search in batches; each has its own seed, so that it does not depend on those before."""
    count = _QUICK_BATCHES if quick else _BATCHES
    return [Task("search", f"{_BATCH} random runs, seed {seed}", partial(batch, seed)) for seed in range(count)]


def batch(seed: int, size: int = _BATCH) -> dict[str, Any]:
    """Return how many of a batch of runs ended in which way, and all about those that were wrong and silent.

    `overconfident` has trusted runs whose error is greater than what the run admits: within what is trusted, but not
    what it said.
    """
    found, silent, overconfident, flagged = Counter(dict.fromkeys(VERDICTS, 0)), [], [], 0
    generator = np.random.default_rng(seed)
    for number in range(size):
        numbers = generator.random(NUMBERS).tolist()
        try:
            run = random_run(numbers)
        except ParameterError:
            found[_IMPOSSIBLE] += 1
            continue
        outcome = check(run)
        found[outcome.verdict] += 1
        flagged += outcome.verdict == ACCURATE and bool(outcome.says)
        about = {"number": number, **dataclasses.asdict(outcome), "trial": repr(run)}
        if outcome.verdict == SILENT:
            silent.append(about)
        elif not outcome.says and (outcome.error or 0) > (outcome.admitted or 0) + _ROUNDING:
            overconfident.append(about)
    return {"seed": seed, "verdicts": dict(found), "flagged": flagged, "silent": silent, "overconfident": overconfident}


def check(run: RandomRun) -> Outcome:
    """Simulate a run and return how it ended; the one start without an exact motion, the separatrix, is refused."""
    try:
        return judge(run.simulate)
    except NoLibrationError as error:
        return Outcome("refused", None, None, str(error))
