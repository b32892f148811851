"""A study: checks whose results are saved one by one, so that an interruption loses none."""

import json
import os
import pathlib
import platform
import re
from collections.abc import Generator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from rich.console import Console

from mjbeer.checks.as_json import to_json
from mjbeer.checks.check import Check, Result
from mjbeer.exceptions import ParameterError
from mjbeer.output import files
from mjbeer.output.jobs import Job, finished_jobs

FAILED = {True: "", False: " **FAIL**"}
"""The mark in a table behind what passed, and what did not."""
_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka")


@dataclass
class Study:
    """The results of checks, with the settings and the machine that they belong to."""

    command: str
    """The command that makes such a study."""
    settings: dict[str, Any]
    machine: dict[str, Any]
    """What `machine()` returned when the study began."""
    results: list[Result] = field(default_factory=list)

    @classmethod
    def load(cls, path: pathlib.Path, command: str) -> "Study":
        """Return the study in a file that `run` wrote.

        Raises:
          ParameterError: if the file is missing, or is no study of that command.
        """
        try:
            head, *lines = path.read_text(encoding="utf-8").splitlines()
            study = cls(**json.loads(head))
            study.results = [Result(**json.loads(line)) for line in lines]
            if study.command != command:
                raise ValueError(f"it belongs to `{study.command}`")
        except (OSError, ValueError, TypeError) as error:
            raise ParameterError(f"{path} was not written by `{command}`: {error}") from error
        return study

    def of(self, group: str) -> list[Result]:
        """Return the results of a group."""
        return [result for result in self.results if result.group == group]

    @property
    def failed(self) -> list[Result]:
        """The results that are not within their bounds."""
        return [result for result in self.results if not result.passed]

    @property
    def about(self) -> dict[str, Any]:
        """Command, settings and machine."""
        return {"command": self.command, "settings": self.settings, "machine": self.machine}

    def save(self, path: pathlib.Path) -> None:
        """Write the study as lines of JSON: what it is about, then a line for each result."""
        lines = [to_json(self.about)]
        for result in self.results:
            lines.append(to_json(result.as_json()))
        files.write(path, "".join(lines))


def run(
    checks: Sequence[Check],
    console: Console | None,
    path: pathlib.Path,
    command: str,
    settings: dict[str, Any],
    finished: pathlib.Path | None = None,
) -> Study:
    """Measure checks on all cores and return them as a study; `console` shows a progress bar.

    Every result is saved at `path` at once. If `path` already has a study, it is continued. If not,
    the study at `finished` is continued, provided that its settings and its machine are the same;
    its file stays as it is. The functions that measure must be ones that can be pickled.

    Raises:
      OSError: if the system ends one of the processes.
      OutputError: if the file cannot be written.
      ParameterError: if a file exists but has no study of this command, or the study at `path` has
        other settings or is of another machine.
    """
    study = Study(command, settings, machine())
    for source in (path, finished):
        if source is None or not source.exists():
            continue
        stored = Study.load(source, command)
        if stored.settings == study.settings and stored.machine == study.machine:
            study = stored
            if console is not None:
                message = f"going on from {source}"
                console.print(message, highlight=False, markup=False, soft_wrap=True)
            break
        if source == path:
            raise ParameterError(
                f"{path} has a study of other settings, or of another machine: "
                "remove it, or name another folder"
            )
    study.save(path)
    done = {(result.group, result.name): result for result in study.results}
    missing = [check for check in checks if (check.group, check.name) not in done]
    with closing(run_checks(missing, console)) as results:
        for result in results:
            done[result.group, result.name] = result
            study.results.append(result)
            study.save(path)
    study.results = [done[check.group, check.name] for check in checks]
    return study


def run_checks(checks: Sequence[Check], console: Console | None) -> Generator[Result]:
    """Measure checks in a process for each core, and yield their results as they are ready.

    Raises:
      OSError: if the system ends one of the processes.
    """
    jobs = [Job(check.name, check.result) for check in checks]
    with closing(finished_jobs(jobs, console)) as finished:
        for _, result in finished:
            yield result


def machine() -> dict[str, Any]:
    """Return what run times and rounding depend on: processor, system and versions of packages."""
    versions = {}
    for name in _PACKAGES:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": versions,
    }


def _processor() -> str:
    """Return the processor's name, as the system has it."""
    about = pathlib.Path("/proc/cpuinfo")
    if about.exists():
        named = re.search(r"model name\s*: (.*)", about.read_text(encoding="utf-8"))
        if named:
            return named[1]
    return platform.processor() or platform.machine()
