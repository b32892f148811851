"""Cases of a benchmark, points on curves, and the Pareto front of the points that none beats."""

import json
import math
import pathlib
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple, TypeVar

import numpy as np

from mjbeer.checks.as_json import document
from mjbeer.model.setting import Rolling
from mjbeer.theory.can import Can
from mjbeer.theory.paper_scenes import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact

COMMAND = "mjbeer benchmark"
SHIPPED = pathlib.Path(__file__).with_name("study.json")
"""The benchmark that comes with mjbeer: `mjbeer benchmark` wrote it."""
INTERVAL = 32e-3
"""Time between two samples [s].

It is a power of two times each timestep that is tried with MuJoCo's integrators, so that all runs
have the same samples without interpolation.
"""
_SHORT = INTERVAL * np.arange(65)
"""Times of the samples of a short motion [s]: 2.048 s."""
_LONG = 32 * INTERVAL * np.arange(978)
"""Times of the samples of a long one [s]: 1,000.448 s."""


@dataclass(frozen=True, eq=False)
class Case:
    """A motion to be computed: a scene, a start, and the times of samples."""

    name: str
    scene: Scene
    phi0: float
    """Initial phi [rad]."""
    story: str
    """The case in a few words, for a title."""
    phi_dot0: float = 0.0
    """Initial phi_dot [rad/s]."""
    times: np.ndarray = field(default_factory=lambda: _SHORT)
    """The times of the samples [s]."""

    @property
    def is_long(self) -> bool:
        """Whether this is a motion of 1,000 s, which shows drift, and is run with few settings."""
        return self.times is _LONG

    def truth(self) -> Trajectory:
        """Return the exact motion at the times of the samples."""
        return exact(self.scene, self.times, self.phi0, self.phi_dot0)


_FROZEN = "frozen beer, rocking from its surface along the incline"
_ALL = (
    Case("sliding", sliding(), 1.0, "beer that slides in a massless can, from 1 rad"),
    Case(
        "sliding-metal",
        sliding(can=Can.sheet_metal()),
        1.0,
        "beer that slides in a metal can, from 1 rad",
    ),
    Case("frozen", frozen(), 0.0, _FROZEN),
    Case("frozen-wide", frozen(), 1.0, "frozen beer, rocking widely from 1 rad"),
    Case("pendulum", pendulum(), 1.0, "a pendulum on the axle of a wheel, from 1 rad"),
    Case("frozen-long", frozen(), 0.0, f"{_FROZEN}, for 1,000 s", times=_LONG),
)
CASES = {case.name: case for case in _ALL}
"""All cases."""
TIMESTEP = "timestep"
TOLERANCE = "tolerance"
CHOSEN = "mjbeer"
"""The method of runs to a tolerance, in which mjbeer chooses the integrator and its steps."""
LEVELS = tuple(10.0**-k for k in range(2, 13, 2))
"""The errors [rad] for which tables show the fastest setting."""
STOCK: dict[str, Rolling] = {"equality, defaults": "equality", "contact, defaults": "contact"}
"""Models as people usually write them, each with its way of rolling."""


class Curve(NamedTuple):
    """A way of rolling and a method, to be run at several timesteps or tolerances."""

    model: str
    """A way of rolling, a model as people usually write it, or another tool, by name."""
    method: str
    """The integrator, or `CHOSEN`; empty for another tool, which has its own."""
    parameter: str = TIMESTEP
    """The parameter that varies along the curve: "timestep" [s] or "tolerance"."""

    @property
    def label(self) -> str:
        """The name of the curve, which no other curve has."""
        return ", ".join(part for part in (self.model, self.method) if part)


@dataclass
class Point:
    """A setting of a case with what was measured with it; errors are against exact theory."""

    case: str
    model: str
    method: str
    parameter: str
    value: float
    """Timestep [s] or tolerance."""
    phi_max: float = math.inf
    u_max: float = math.inf
    """Largest errors of phi and of u/a, with a the can's radius [rad]."""
    energy_drift: float | None = None
    """Largest change of the energy at a sample, divided by the swing's kinetic energy."""
    evaluations: int | None = None
    """Number of evaluations of the accelerations; None if the tool does not count them."""
    setup: float | None = None
    """Time to build the model, and to do all else that is done once [s]."""
    failure: str | None = None
    """The message of the exception if the run failed."""
    times: list[float] = field(default_factory=list)
    """Processor times of the run in the rounds [s]."""

    @property
    def curve(self) -> Curve:
        """The curve that the point is on."""
        return Curve(self.model, self.method, self.parameter)

    @property
    def error(self) -> float:
        """Largest error of phi and u/a over the run [rad]; infinite if the run failed."""
        return max(self.phi_max, self.u_max)

    @property
    def time(self) -> float:
        """Least run time [s]; NaN if it was not timed."""
        return min(self.times, default=math.nan)

    @property
    def setting(self) -> str:
        """The setting in a few words: its method, and its timestep [ms] or its tolerance."""
        if self.parameter == TOLERANCE:
            return f"{self.method} to {self.value:g}".strip()
        return f"{self.method} {milliseconds(self.value)}"


class Timing(NamedTuple):
    """A point as it was timed in one round."""

    curve: Curve
    """The curve that the point is on."""
    error: float
    """Largest error of phi and u/a over the run [rad]."""
    time: float
    """Run time [s]."""


Timed = TypeVar("Timed", Point, Timing)


def milliseconds(time: float) -> str:
    """Return a time [s] as text, in milliseconds.

    An infinite time is that of what no setting reached.
    """
    return f"{1e3 * time:.3g} ms" if math.isfinite(time) else "not reached"


def spread(times: Sequence[float]) -> str:
    """Return the least and the largest of some times [s] as text, in milliseconds.

    Infinite times are those of what no setting reached.
    """
    if not math.isfinite(max(times)):
        return milliseconds(math.inf)
    least = f"{1e3 * min(times):.3g}"
    largest = f"{1e3 * max(times):.3g}"
    return f"{least} ms" if least == largest else f"{least} to {largest} ms"


def two_digits(value: float) -> str:
    """Return a positive number with two digits, such as 3.0."""
    rounded = float(f"{value:.2g}")
    if rounded >= 10:
        return f"{rounded:.0f}"
    return f"{rounded:#.2g}"


@dataclass
class Benchmark:
    """A study of error against run time; its points are in the order of their measurement."""

    settings: dict[str, Any]
    machine: dict[str, Any]
    points: list[Point]

    @classmethod
    def load(cls, path: pathlib.Path) -> "Benchmark":
        """Return the benchmark in a file that `json` is in."""
        content = json.loads(path.read_text(encoding="utf-8"))
        points = []
        for row in content["points"]:
            known = {name: value for name, value in row.items() if value is not None}
            points.append(Point(**known))
        return cls(content["settings"], content["machine"], points)

    def json(self) -> str:
        """Return the study as JSON, with a line a point."""
        about = {"command": COMMAND, "settings": self.settings, "machine": self.machine}
        return document(about, "points", map(asdict, self.points))

    def of(self, case: str) -> list[Point]:
        """Return the points of a case that have an error and a run time."""
        return [
            point
            for point in self.points
            if point.case == case and point.error < math.inf and point.times
        ]

    @property
    def cases(self) -> list[str]:
        """The cases of two seconds, in their order."""
        return [name for name in self._names if not CASES[name].is_long]

    @property
    def long_cases(self) -> list[str]:
        """The cases of 1,000 s."""
        return [name for name in self._names if CASES[name].is_long]

    @property
    def _names(self) -> list[str]:
        return list(dict.fromkeys(point.case for point in self.points))


def pareto_front(points: Iterable[Timed]) -> list[Timed]:
    """Return the points, fastest first, than which no other has less error and less run time."""
    best: list[Timed] = []
    for point in sorted(points, key=lambda point: (point.time, point.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def cheapest(points: Iterable[Point], error: float) -> Point | None:
    """Return the fastest point whose error is at most `error` [rad]; None if there is none."""
    exact_enough = [point for point in points if point.error <= error]
    return min(exact_enough, key=lambda point: point.time, default=None)


def time_for(points: Iterable[Timed], error: float) -> float:
    """Return the least run time [s] for an `error` [rad] on the curves that the points are on.

    Between two runs of a curve it is interpolated as a power law, and never between two curves. A
    curve that has no run with so large an error counts with its fastest run. The time is infinite
    if no point reaches the error.
    """
    curves: dict[Curve, list[Timed]] = {}
    for point in points:
        curves.setdefault(point.curve, []).append(point)
    return min((_time_on_curve(curve, error) for curve in curves.values()), default=math.inf)


def _time_on_curve(points: Iterable[Timed], error: float) -> float:
    """Return the run time [s] for an `error` [rad] on one curve; infinite if it is not reached."""
    best = pareto_front(points)
    if best[-1].error > error:
        return math.inf
    digits = [-math.log(point.error) for point in best]
    times = [math.log(point.time) for point in best]
    return math.exp(np.interp(-math.log(error), digits, times))


def times_in_rounds(points: Sequence[Point], error: float) -> list[float]:
    """Return the run time [s] for an `error` [rad] in each round, as `time_for` has it."""
    rounds = min((len(point.times) for point in points), default=0)
    return [
        time_for([Timing(point.curve, point.error, point.times[k]) for point in points], error)
        for k in range(rounds)
    ]


class Ratio(NamedTuple):
    """Run time of some settings divided by that of others, at equal error."""

    of_least: float
    """Ratio of the least times of all rounds."""
    smallest: float
    """The smallest of the ratios in single rounds."""
    largest: float
    """The largest of them."""


def time_ratio(points: Sequence[Point], reference: Sequence[Point], error: float) -> Ratio | None:
    """Return the run time of `points` divided by that of `reference`, at equal error [rad].

    It is None if one of both does not reach the error.
    """
    if cheapest(points, error) is None or cheapest(reference, error) is None:
        return None
    times = times_in_rounds(points, error)
    reference_times = times_in_rounds(reference, error)
    in_rounds = [time / other for time, other in zip(times, reference_times, strict=True)]
    of_least = time_for(points, error) / time_for(reference, error)
    return Ratio(of_least, min(in_rounds), max(in_rounds))
