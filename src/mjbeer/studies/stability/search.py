"""A search, with seeded random numbers, for runs that are trusted although they are wrong."""

import dataclasses
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

import numpy as np

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError, ParameterError
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.stability.outcome import ACCURATE, SILENT, VERDICTS, Outcome, judge
from mjbeer.studies.study import Task
from mjbeer.theory.can import Can
from mjbeer.theory.load import Load
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene
from mjbeer.theory.trajectory import Trajectory

NUMBERS = 36
"""How many random numbers define a random run."""
_LONGEST = 100.0
"""Longest run, in turns or falls through the radius: exact theory has to follow each of them."""
_SAMPLES = 200
"""Largest number of samples of a run after its start."""


@dataclass(frozen=True)
class RandomRun:
    """A scene, its start, and how it is simulated; units are those of `simulate`."""

    scene: Scene
    phi0: float
    phi_dot0: float
    rolling: Rolling
    integrator: Integrator
    timestep: float
    steps: int
    tolerance: float | None
    friction: float

    @property
    def times(self) -> np.ndarray:
        """Times of the samples [s]."""
        chosen = np.unique(np.linspace(0, self.steps, min(self.steps, _SAMPLES) + 1).astype(int))
        return self.timestep * chosen

    def simulate(self) -> Trajectory:
        """Return the simulated motion at the times of its samples."""
        return simulate(
            self.scene,
            duration=self.timestep * self.steps,
            phi0=self.phi0,
            phi_dot0=self.phi_dot0,
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            tolerance=self.tolerance,
            times=self.times,
            friction=self.friction,
        )


T = TypeVar("T")


class _Numbers:
    """Makes choices out of numbers between 0 and 1, of which it uses each once and in order."""

    def __init__(self, numbers: Sequence[float]) -> None:
        self._left = iter(numbers)

    def between(self, low: float, high: float) -> float:
        """Return a number between two others, from an even distribution."""
        return low + (high - low) * next(self._left)

    def decades(self, low: float, high: float) -> float:
        """Return a number between two others whose logarithm is evenly distributed."""
        return float(10 ** self.between(math.log10(low), math.log10(high)))

    def one(self, *options: T) -> T:
        """Return one of the options; all are equally likely."""
        return options[min(int(next(self._left) * len(options)), len(options) - 1)]


def random_run(numbers: Sequence[float]) -> RandomRun:
    """Return the run that `NUMBERS` numbers between 0 and 1 define.

    Sizes, masses, gravities and timesteps are spread over their decades. Special cases (an empty can, the top, a full
    can, a point load, no gravity, no incline, a start beside the separatrix) are about as frequent as general ones.

    Raises:
      ParameterError: if the numbers define a scene that cannot be.
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
        tolerance = None  # a stiff contact would need too many steps to reach it
    friction = pick.one(1.0, 1.0, pick.decades(1e-3, 1e3))
    return RandomRun(
        scene,
        phi0,
        phi_dot0=spin / slow,
        rolling=rolling,
        integrator=integrator,
        timestep=timestep,
        steps=steps,
        tolerance=tolerance,
        friction=friction,
    )


def _top(scene: Scene) -> float:
    """Return the phi [rad] at which the largest swing ends; pi where nothing swings."""
    try:
        return scene.separatrix()[1]
    except NoEquilibriumError:
        return math.pi


def _scene(pick: _Numbers) -> Scene:
    """Return a random scene.

    Raises:
      ParameterError: if the numbers define a scene that cannot be.
    """
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
"""Number of runs in a task, which takes some ten seconds."""
_BATCHES, _QUICK_BATCHES = 30, 2
"""Number of tasks; the second is for a quick study."""
_ROUNDING = 1e-9
"""Errors below this [rad] do not count as overconfident: a second run at half the timestep cannot see rounding."""
_IMPOSSIBLE = "no such scene"
"""Counted instead of a verdict where the random numbers define a scene that cannot be."""


def tasks(quick: bool) -> list[Task]:
    """Return the search as tasks of a batch each; each has its own seed, so that it does not depend on the others."""
    count = _QUICK_BATCHES if quick else _BATCHES
    return [Task("search", f"{_BATCH} random runs, seed {seed}", partial(batch, seed)) for seed in range(count)]


def batch(seed: int, size: int = _BATCH) -> dict[str, Any]:
    """Return how many runs of a batch ended in which way, and everything about those that were wrong and silent.

    "overconfident" has the trusted runs whose error is small enough to be trusted, but larger than their own
    diagnostics allow for. "flagged" counts accurate runs that carry a warning.
    """
    counts, silent, overconfident, flagged = Counter(dict.fromkeys(VERDICTS, 0)), [], [], 0
    generator = np.random.default_rng(seed)
    for number in range(size):
        numbers = generator.random(NUMBERS).tolist()
        try:
            run = random_run(numbers)
        except ParameterError:
            counts[_IMPOSSIBLE] += 1
            continue
        outcome = check(run)
        counts[outcome.verdict] += 1
        flagged += outcome.verdict == ACCURATE and bool(outcome.says)
        about = {"number": number, **dataclasses.asdict(outcome), "trial": repr(run)}
        if outcome.verdict == SILENT:
            silent.append(about)
        elif not outcome.says and (outcome.error or 0) > (outcome.admitted or 0) + _ROUNDING:
            overconfident.append(about)
    return {
        "seed": seed,
        "verdicts": dict(counts),
        "flagged": flagged,
        "silent": silent,
        "overconfident": overconfident,
    }


def check(run: RandomRun) -> Outcome:
    """Simulate a run and return how it ended.

    A start on the separatrix, the only one without an exact motion to judge by, counts as refused.
    """
    try:
        return judge(run.simulate)
    except NoLibrationError as error:
        return Outcome("refused", None, None, str(error))
