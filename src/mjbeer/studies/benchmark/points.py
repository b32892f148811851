"""The points of a study of error against run time, and how it is kept on disk."""

import csv
import dataclasses
import io
import json
import math
import os
import pathlib
import statistics
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.output import files
from mjbeer.studies.benchmark.curves import Curve
from mjbeer.theory.trajectory import Trajectory


@dataclass
class Point:
    """A setting and what was measured with it. Errors are against exact theory."""

    case: str
    way: str
    method: str
    knob: str
    value: float
    """Timestep [s] or tolerance."""
    phi_max: float = math.nan
    """Largest error of phi over the run [rad]."""
    phi_end: float = math.nan
    """Error of phi at its end [rad]."""
    u_max: float = math.nan
    """Largest error of u/a over the run [rad]."""
    u_end: float = math.nan
    """Error of u/a at its end [rad]."""
    slip_max: float | None = None
    """Largest slip [radii]."""
    slip_integral: float | None = None
    """Integral of the slip's size over the run [radii s]."""
    energy_drift: float | None = None
    """The largest change of energy, with its sign, over the largest kinetic energy of the swing."""
    pressed: bool | None = None
    """Whether the motion needed N > 0 throughout."""
    model_error: float | None = None
    """Error of phi and u/a of the same model under DOP853 at a tolerance of 1e-13 [rad]."""
    integrator_error: float | None = None
    """Distance of the run from that [rad]."""
    timeconst: float | None = None
    """solref's time constant as asked for [s]."""
    effective_timeconst: float | None = None
    """The one that the solver got [s]."""
    impedance: float | None = None
    """Share of the force of a hard constraint, as asked for."""
    effective_impedance: float | None = None
    """The share that it had."""
    setup: float = math.nan
    """Time to build the model and whatever else is done once [s]."""
    failure: str | None = None
    """Why there is no error."""
    times: list[float] = field(default_factory=list)
    """Run times of the repeats [s]."""

    @property
    def curve(self) -> Curve:
        """The curve that it is on."""
        return Curve(self.way, self.method, self.knob)

    @property
    def error(self) -> float:
        """Largest error of phi and u/a over the run [rad]; infinite if it failed."""
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
        """Fill in the errors of phi [rad] and u [m] at the samples of the exact motion."""
        radius = truth.scene.can.radius
        phi_error, u_error = np.abs(phi - truth.phi), np.abs(u - truth.u) / radius
        self.phi_max, self.phi_end = float(phi_error.max()), float(phi_error[-1])
        self.u_max, self.u_end = float(u_error.max()), float(u_error[-1])

    def listen(self, run: Trajectory) -> None:
        """Fill in what a run of MuJoCo says about itself."""
        radius = run.scene.can.radius
        slip = np.abs(run.slip) / radius
        self.slip_max, self.slip_integral = float(slip.max()), float(np.trapezoid(slip, run.time))
        change = run.energy - run.energy[0]
        self.energy_drift = math.copysign(run.energy_drift, float(change[np.abs(change).argmax()]))
        self.pressed = math.isinf(run.rolls_until())


@dataclass
class Study:
    """Points of a work-precision study, in the order in which they were measured."""

    settings: dict[str, Any]
    """What was asked for."""
    machine: dict[str, Any]
    points: list[Point] = field(default_factory=list)
    ablation: list[dict[str, Any]] = field(default_factory=list)
    """What each stage of a step costs, as ratios."""

    def of(self, case: str) -> list[Point]:
        """The points of a case that have an error and a run time."""
        return [each for each in self.points if each.case == case and math.isfinite(each.error) and each.times]

    @property
    def cases(self) -> list[str]:
        """The cases that it has, in their order."""
        return list(dict.fromkeys(each.case for each in self.points))

    def save(self, path: pathlib.Path) -> None:
        """Write it as JSON, whole or not at all.

        Raises:
          OutputError: if it cannot be written.
        """
        lines = [json.dumps(_known(each), allow_nan=False) for each in self.points]
        head = json.dumps({"settings": self.settings, "machine": self.machine, "ablation": self.ablation}, indent=1)
        files.write(path, head[: head.rindex("}")] + ',\n "points": [\n' + ",\n".join(lines) + "\n]}\n")

    def csv(self) -> str:
        """One line a point: its setting, its errors and its least and median run time; empty where unknown."""
        names = [each.name for each in dataclasses.fields(Point) if each.name != "times"]
        text = io.StringIO()
        writer = csv.DictWriter(text, [*names, "error", "time_min", "time_median", "repeats"], lineterminator="\n")
        writer.writeheader()
        for point in self.points:
            known = {name: value for name, value in _known(point).items() if name != "times"}
            if point.failure is None:
                known |= {"error": point.error, "time_min": point.time, "time_median": point.median_time}
            writer.writerow(known | {"repeats": len(point.times)})
        return text.getvalue()


def load(path: str | os.PathLike[str]) -> Study:
    """Read a stored study.

    Raises:
      ParameterError: if the file is missing, or no study of this version.
    """
    try:
        document = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        points = [Point(**each) for each in document["points"]]
        return Study(document["settings"], document["machine"], points, document["ablation"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ParameterError(f"{path} is no study that `mjbeer benchmark` wrote: {error}") from error


def _known(point: Point) -> dict[str, Any]:
    """What is known of a point; JSON has no number for the rest. Times to a nanosecond."""
    values = {name: value for name, value in dataclasses.asdict(point).items() if value is not None}
    values["times"] = [round(each, 9) for each in point.times]
    return {name: value for name, value in values.items() if not isinstance(value, float) or math.isfinite(value)}


def same_conditions(one: Study, settings: dict[str, Any], where: dict[str, Any]) -> bool:
    """Whether what a study has may stand beside what is measured with these settings on this machine."""
    return one.settings == settings and one.machine == where


def missing(points: Iterable[Point], repeats: int) -> list[Point]:
    """The points that still lack run times."""
    return [each for each in points if each.failure is None and len(each.times) < repeats]
