"""A study: checks that are measured on all cores, with the machine that measured them, and shown in tables."""

import json
import os
import pathlib
import platform
import warnings
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any

from rich.console import Console

from mjbeer.checks import Check, Result, json_values
from mjbeer.output.processes import pool
from mjbeer.output.terminal import Table, progress_bar

PASSED = {True: "[green]pass[/]", False: "[bold red]FAIL[/]"}
"""The verdict on a check in a terminal."""
FAILED = " **FAIL**"
"""Marks a check that failed in a document."""
_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka")


@dataclass(frozen=True)
class Study:
    """Results with the settings and the machine that they belong to."""

    command: str
    """The command that makes such a study."""
    settings: dict[str, Any]
    machine: dict[str, Any]
    results: list[Result]

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


def run(checks: Sequence[Check], console: Console | None, command: str, settings: dict[str, Any]) -> Study:
    """Measure checks on all cores and return them as a study; `console` shows a progress bar.

    Functions that measure must be ones that can be pickled.

    Raises:
      OSError: if the system ends one of the processes.
    """
    with progress_bar(console, len(checks)) as begin, closing(measured(checks, begin)) as results:
        found = {(result.group, result.name): result for result in results}
    return Study(command, settings, machine(), [found[check.group, check.name] for check in checks])


def measured(checks: Sequence[Check], begin: Callable[[str], None]) -> Generator[Result]:
    """Yield the results of checks as they are ready, from a process for each core.

    Raises:
      OSError: if the system ends one of the processes.
    """
    if (processes := min(os.cpu_count() or 1, len(checks))) <= 1:
        for check in checks:
            begin(check.name)
            yield check.result()
        return
    with pool(processes) as executor:
        try:
            for done in as_completed([executor.submit(_in_silence, check) for check in checks]):
                result = done.result()
                begin(result.name)
                yield result
        except BrokenProcessPool:
            raise OSError("a process of the study was ended from outside: is memory short?") from None


def _in_silence(check: Check) -> Result:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return check.result()


def machine() -> dict[str, Any]:
    """Return what run times and rounding depend on: processor, system, and versions of packages."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return {
        "processor": next(names, platform.processor() or platform.machine()),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": {name: version(name) for name in _PACKAGES if find_spec(name)},
    }


def document(about: dict[str, Any], name: str, rows: Iterable[dict[str, Any]]) -> str:
    """Return as JSON what a study is about, and its rows under a name, a line each, with numbers of six digits."""
    lines = (json.dumps(json_values(row), allow_nan=False) for row in rows)
    rounded = (json.loads(line, parse_float=lambda digits: float(f"{float(digits):.6g}")) for line in lines)
    return json.dumps(about)[:-1] + f', "{name}": [\n' + ",\n".join(map(json.dumps, rounded)) + "\n]}\n"


def table(title: str, results: Sequence[Result], document: bool = False) -> Table:
    """Return a table of results; the last column is the verdict or, for a `document`, what dominates the error."""
    rows = []
    for result in results:
        failed = FAILED if document and not result.passed else ""
        last = result.reason if document else PASSED[result.passed]
        error = "-" if result.error is None else f"{result.error:.1e}"
        rows.append((result.name, result.by, error + failed, f"{result.bound:.1e} {result.unit}".strip(), last))
    last = "what dominates the error" if document else "verdict"
    return Table(title, ("check", "by", "error", "at most", last), rows, left=(0, 1, 4))
