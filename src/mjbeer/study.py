"""A stored study: its points, what they were measured with, and how it is kept on disk."""

import csv
import dataclasses
import io
import json
import math
import os
import pathlib
import platform
from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from mjbeer import output
from mjbeer.exceptions import ParameterError
from mjbeer.point import Point

_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka", "exudyn")


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
        output.write(path, head[: head.rindex("}")] + ',\n "points": [\n' + ",\n".join(lines) + "\n]}\n")

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


def machine() -> dict[str, Any]:
    """What the numbers depend on: processor, system, versions."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": {name: found for name in _PACKAGES if (found := _version(name))},
    }


def _processor() -> str:
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    named = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.machine()


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


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
