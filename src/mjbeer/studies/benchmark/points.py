"""The results of a benchmark: a Point for each setting, and the Benchmark that has them all, as JSON and as CSV."""

import csv
import dataclasses
import io
import json
import math
import statistics
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from mjbeer.studies.benchmark.curves import Curve
from mjbeer.studies.study import Study
from mjbeer.theory.trajectory import Trajectory


@dataclass
class Point:
    """A setting with what was measured with it; errors are against exact theory.

    `case` is the name of the case; `way`, `method` and `knob` are those of the Curve.
    """

    case: str
    way: str
    method: str
    knob: str
    value: float
    """Timestep [s] or tolerance."""
    phi_max: float = math.nan
    """Largest error of phi over the run [rad]."""
    phi_end: float = math.nan
    """Error of phi at the end of the run [rad]."""
    u_max: float = math.nan
    """Largest error of u/a over the run, with a the can's radius [rad]."""
    u_end: float = math.nan
    """Error of u/a at the end of the run [rad]."""
    slip_max: float | None = None
    """Largest slip [radii]."""
    slip_integral: float | None = None
    """Integral of the absolute slip over time [radii s]."""
    energy_drift: float | None = None
    """The largest change of energy, with its sign, over the largest kinetic energy of the swing."""
    pressed: bool | None = None
    """Whether the normal force of the motion was positive throughout."""
    model_error: float | None = None
    """Largest error of phi and u/a of the same model, integrated with DOP853 to a local tolerance of 1e-13 [rad]."""
    integrator_error: float | None = None
    """Largest distance of the run from that more exact run [rad]."""
    timeconst: float | None = None
    """Time constant of the soft constraint as set in solref [s]."""
    effective_timeconst: float | None = None
    """Time constant that the solver used [s]."""
    impedance: float | None = None
    """Impedance as set in solimp: the share of the force of a hard constraint."""
    effective_impedance: float | None = None
    """Share of the force of a hard constraint that the solver applied."""
    setup: float = math.nan
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
        worst = max(self.phi_max, self.u_max)
        return worst if math.isfinite(worst) else math.inf

    @property
    def time(self) -> float:
        """Least run time [s]; NaN if it was not timed."""
        return min(self.times, default=math.nan)

    @property
    def median_time(self) -> float:
        """Median run time [s]; NaN if it was not timed."""
        return statistics.median(self.times) if self.times else math.nan

    def judge(self, phi: np.ndarray, u: np.ndarray, truth: Trajectory) -> None:
        """Store the errors of phi [rad] and u [m], given at the samples of the exact motion."""
        radius = truth.scene.can.radius
        phi_error, u_error = np.abs(phi - truth.phi), np.abs(u - truth.u) / radius
        self.phi_max, self.phi_end = float(phi_error.max()), float(phi_error[-1])
        self.u_max, self.u_end = float(u_error.max()), float(u_error[-1])

    def describe(self, run: Trajectory) -> None:
        """Store the slip, the energy drift, and whether the normal force was positive throughout."""
        radius = run.scene.can.radius
        slip = np.abs(run.slip) / radius
        self.slip_max, self.slip_integral = float(slip.max()), float(np.trapezoid(slip, run.time))
        change = run.energy - run.energy[0]
        self.energy_drift = math.copysign(run.energy_drift, float(change[np.abs(change).argmax()]))
        self.pressed = math.isinf(run.rolls_until())


@dataclass
class Benchmark(Study):
    """A study of error against run time; its points are in the order in which they were measured."""

    command = "mjbeer benchmark"
    points: list[Point] = field(default_factory=list)
    ablation: list[dict[str, Any]] = field(default_factory=list)
    """Rows of `ablation.ablate`: the cost of each stage of a step."""

    @classmethod
    def read(cls, document: dict[str, Any]) -> Self:
        """Return the study in a JSON document."""
        study = super().read(document)
        study.points = [Point(**point) for point in document["points"]]
        return study

    def json(self) -> str:
        """Return the study as a JSON document with one line for each point."""
        head = json.dumps({"settings": self.settings, "machine": self.machine, "ablation": self.ablation}, indent=1)
        lines = [json.dumps(_known(point), allow_nan=False) for point in self.points]
        return head[: head.rindex("}")] + ',\n "points": [\n' + ",\n".join(lines) + "\n]}\n"

    def of(self, case: str) -> list[Point]:
        """Return the points of a case that have an error and a run time."""
        return [point for point in self.points if point.case == case and math.isfinite(point.error) and point.times]

    @property
    def cases(self) -> list[str]:
        """The cases of the points, in their order."""
        return list(dict.fromkeys(point.case for point in self.points))

    def csv(self) -> str:
        """Return CSV with a line for each point: setting, errors, least and median run time; empty where unknown."""
        names = [column.name for column in dataclasses.fields(Point) if column.name != "times"]
        text = io.StringIO()
        writer = csv.DictWriter(text, [*names, "error", "time_min", "time_median", "repeats"], lineterminator="\n")
        writer.writeheader()
        for point in self.points:
            known = {name: value for name, value in _known(point).items() if name != "times"}
            if point.failure is None:
                known |= {"error": point.error, "time_min": point.time, "time_median": point.median_time}
            writer.writerow(known | {"repeats": len(point.times)})
        return text.getvalue()


def _known(point: Point) -> dict[str, Any]:
    """Return the fields of a point that are known and finite, with run times to a nanosecond; JSON lacks NaN."""
    values = {name: value for name, value in dataclasses.asdict(point).items() if value is not None}
    values["times"] = [round(time, 9) for time in point.times]
    return {name: value for name, value in values.items() if not isinstance(value, float) or math.isfinite(value)}
