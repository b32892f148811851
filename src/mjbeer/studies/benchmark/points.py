"""What a benchmark measured: points on curves, the study that has them all, and the front of those that none beats."""

import csv
import io
import math
import pathlib
import statistics
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

import mujoco
import numpy as np

from mjbeer.model.build import specify
from mjbeer.model.setting import Rolling, Setting
from mjbeer.studies.rows import Study
from mjbeer.theory.scene import Scene

COMMAND = "mjbeer benchmark"
SHIPPED = pathlib.Path(__file__).with_name("study.jsonl")
"""The benchmark that comes with mjbeer: errors to six digits, least run times."""
TIMESTEP, TOLERANCE = "timestep", "tolerance"
CHOSEN = "mjbeer"
"""The method of runs to a tolerance, which choose their integrator and its steps."""
LEVELS = tuple(10.0**-k for k in range(2, 13, 2))
"""The errors [rad] for which tables and plots have the fastest setting."""
USUAL: dict[str, Rolling] = {
    "equality, slide first": "equality",
    "equality, hinge first": "equality",
    "contact, defaults": "contact",
}
"""Models as people usually write them, by their way of rolling. The order of the two joints in an equality matters:
MuJoCo's default diagonal softens the two by different factors."""


def usual_model(name: str, scene: Scene) -> mujoco.MjModel:
    """Return a model as people usually write it, with MuJoCo's defaults wherever there are any."""
    spec, stock = specify(scene, USUAL[name], integrator="Euler", timestep=2e-3), mujoco.MjSpec().option
    spec.option.enableflags, spec.option.impratio, spec.option.cone = stock.enableflags, stock.impratio, stock.cone
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    for constraint in (*spec.equalities, *spec.pairs):
        constraint.solref, constraint.solimp = (0.02, 1), (0.9, 0.95, 0.001, 0.5, 2)
    if name == "equality, hinge first":
        for equality in spec.equalities:
            equality.name1, equality.name2, equality.data[1] = equality.name2, equality.name1, 1 / scene.can.radius
    return spec.compile()


@dataclass(frozen=True, order=True)
class Curve:
    """A way of rolling and a method, run at a ladder of timesteps or tolerances: one line of the diagram."""

    way: str
    """A way of rolling, the name of a setting as people usually write it (USUAL), or the name of another tool."""
    method: str
    """The integrator, or `CHOSEN`; empty for another tool, which has its own."""
    knob: str = TIMESTEP
    """What is varied along the curve: "timestep" [s] or "tolerance"."""

    @property
    def label(self) -> str:
        """The name of the curve, unlike that of any other."""
        method = f"{self.method} to a tolerance" if self.method and self.knob == TOLERANCE else self.method
        return ", ".join(part for part in (self.way, method) if part)

    def setting(self, value: float) -> Setting:
        """Return the setting of mjbeer for a `value` of the knob: a timestep [s] or a tolerance [rad]."""
        if self.knob == TOLERANCE:
            return replace(Setting(), rolling=self.way, tolerance=value)
        return replace(Setting(), rolling=self.way, integrator=self.method, timestep=value)


@dataclass
class Point:
    """A setting of a case with what was measured with it; errors are against exact theory."""

    case: str
    way: str
    method: str
    knob: str
    value: float
    """Timestep [s] or tolerance."""
    phi_max: float = math.inf
    phi_end: float = math.inf
    u_max: float = math.inf
    u_end: float = math.inf
    """Errors of phi and of u/a, with a the can's radius, at most over the run and at its end [rad]."""
    slip_max: float | None = None
    """Largest slip [radii]."""
    energy_drift: float | None = None
    """The largest change of energy over the largest kinetic energy of the swing."""
    share: float | None = None
    """Share of the force of a hard constraint that the solver applied."""
    setup: float | None = None
    """Time to build the model and for all else that is done once [s]."""
    failure: str | None = None
    """The message of the exception if the run failed."""
    times: list[float] = field(default_factory=list)
    """Run times in the rounds [s]."""

    @property
    def curve(self) -> Curve:
        """The curve that the point is on."""
        return Curve(self.way, self.method, self.knob)

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
        knob = f"{self.value:g}" if self.knob == TOLERANCE else milliseconds(self.value)
        return f"{self.method} {'to ' if self.knob == TOLERANCE else ''}{knob}".strip()

    def known(self) -> dict[str, Any]:
        """Return what was measured but for the run times, without what is unknown or infinite, which JSON lacks."""
        values = asdict(self)
        for name in ("case", "way", "method", "knob", "times"):
            del values[name]
        return {name: value for name, value in values.items() if value is not None and value != math.inf}


def milliseconds(time: float) -> str:
    """Return a time [s] as text, in milliseconds; an infinite one is that of what no setting reached."""
    return f"{1e3 * time:.3g} ms" if math.isfinite(time) else "not reached"


@dataclass
class Benchmark:
    """A study of error against run time; its points are in the order in which they were measured."""

    ERRORS, TIMES, SWEEPS = "errors", "run times", "sweeps"
    """The groups of its rows: a ladder with its errors, a round of timing, and the times of many scenes."""

    settings: dict[str, Any]
    machine: dict[str, Any]
    points: list[Point]
    sweeps: list[dict[str, Any]]
    """What `sweeps.compare` found; empty if sweeps were not timed."""

    @classmethod
    def load(cls, path: pathlib.Path) -> "Benchmark":
        """Return the benchmark in a file.

        Raises:
          ParameterError: if the file is missing, or is no benchmark of this version.
        """
        return cls.of_study(Study.load(path, COMMAND))

    @classmethod
    def of_study(cls, study: Study) -> "Benchmark":
        """Return the benchmark whose rows are in a study."""
        points = []
        for ladder in study.of(cls.ERRORS):
            curve = {name: ladder.values[name] for name in ("way", "method", "knob")}
            rungs = [Point(ladder.by, **curve, **rung) for rung in ladder.values["points"]]
            ran = [point for point in rungs if point.failure is None]
            for timed in study.of(cls.TIMES):
                if timed.by == ladder.by:
                    for point, time in zip(ran, timed.values[ladder.name], strict=True):
                        point.times.append(time)
            points += rungs
        sweeps = [way for result in study.of(cls.SWEEPS) for way in result.values["ways"]]
        return cls(study.settings, study.machine, points, sweeps)

    def of(self, case: str) -> list[Point]:
        """Return the points of a case that have an error and a run time."""
        return [point for point in self.points if point.case == case and point.error < math.inf and point.times]

    @property
    def cases(self) -> list[str]:
        """The cases of the points, in their order."""
        return list(dict.fromkeys(point.case for point in self.points))

    def csv(self) -> str:
        """Return CSV with a line for each point: setting, errors, least and median run time; empty where unknown."""
        names = [column.name for column in fields(Point) if column.name != "times"]
        text = io.StringIO()
        writer = csv.DictWriter(text, [*names, "error", "time_min", "time_median", "repeats"], lineterminator="\n")
        writer.writeheader()
        for point in self.points:
            known = {"case": point.case, **asdict(point.curve), **point.known(), "repeats": len(point.times)}
            if point.times:
                known |= {"error": point.error, "time_min": point.time, "time_median": statistics.median(point.times)}
            writer.writerow(known)
        return text.getvalue()


def front(points: Iterable[Point]) -> list[Point]:
    """Return the points than which no other has both less error and less run time, fastest first."""
    best: list[Point] = []
    for point in sorted(points, key=lambda point: (point.time, point.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def cheapest(points: Iterable[Point], error: float) -> Point | None:
    """Return the fastest point whose error is at most `error` [rad]; None if there is none."""
    return min((point for point in points if point.error <= error), key=lambda point: point.time, default=None)


def time_for(points: Iterable[Point], error: float) -> float:
    """Return the run time [s] for an `error` [rad], interpolated on the front as a power law, or infinity."""
    best = front(points)
    if not best or best[-1].error > error:
        return math.inf
    errors, times = [-math.log(point.error) for point in best], [math.log(point.time) for point in best]
    return math.exp(np.interp(-math.log(error), errors, times))


def error_for(points: Iterable[Point], time: float) -> float:
    """Return the error [rad] for a run `time` [s], interpolated as in `time_for`; infinite if no point is that fast."""
    best = front(points)
    if not best or best[0].time > time:
        return math.inf
    errors, times = [math.log(point.error) for point in best], [math.log(point.time) for point in best]
    return math.exp(np.interp(math.log(time), times, errors))
