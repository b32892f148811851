"""Rows: what was measured, against what, with which bound, and why; kept on disk one by one, and shown in tables."""

import json
import math
import os
import pathlib
import platform
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from rich.console import Console

from mjbeer.exceptions import OutputError, ParameterError
from mjbeer.output import files
from mjbeer.output.processes import pool
from mjbeer.output.terminal import Table, progress_bar

PASSED = {True: "[green]pass[/]", False: "[bold red]FAIL[/]"}
"""The verdict on a row in a terminal."""
FAILED = " **FAIL**"
"""What marks a row that failed in a document."""
_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka")


@dataclass(frozen=True)
class Result:
    """What was measured, beside its bound."""

    group: str
    """The part of the study that it belongs to."""
    name: str
    """What was measured."""
    by: str = ""
    """The scene and the setting that it was measured with; no two rows of a group share name and setting."""
    bound: float = math.inf
    """Largest error that passes, in `unit`; infinite where nothing is judged."""
    unit: str = ""
    reason: str = ""
    """Which error dominates; the bound follows from it."""
    error: float | None = None
    """Size of the deviation from what is expected, in `unit`; None if there is none, or none that is finite."""
    values: dict[str, Any] = field(default_factory=dict)
    """What else was measured, as JSON has it."""

    @property
    def passed(self) -> bool:
        """Whether the error is within its bound; NaN never is."""
        return self.bound == math.inf or (self.error is not None and self.error <= self.bound)

    def line(self) -> str:
        """Return the result as a line of JSON, without what is empty, and with null for what is not finite."""
        fields = {name: value for name, value in asdict(self).items() if value not in ("", {}, math.inf)}
        if self.error is not None and not math.isfinite(self.error):
            fields["error"] = None
        return json.dumps(fields, allow_nan=False) + "\n"


@dataclass(frozen=True)
class Row:
    """A quantity to be measured; the fields are those of `Result`, but for the function that measures it."""

    group: str
    name: str
    measure: Callable[[], float | dict[str, Any]]
    """Returns the deviation with its sign, or values as JSON has them, among which may be the deviation as "error"."""
    by: str = ""
    bound: float = math.inf
    unit: str = ""
    reason: str = ""

    def result(self) -> Result:
        """Measure the quantity."""
        measured = self.measure()
        values = dict(measured) if isinstance(measured, dict) else {"error": measured}
        deviation = values.pop("error", None)
        error = None if deviation is None else abs(float(deviation))
        return Result(self.group, self.name, self.by, self.bound, self.unit, self.reason, error, values)


@dataclass
class Study:
    """Results with the settings and the machine that they belong to."""

    command: str
    """The command that makes such a study."""
    settings: dict[str, Any]
    machine: dict[str, Any]
    """What `machine()` returned when the study began."""
    results: list[Result] = field(default_factory=list)

    @classmethod
    def load(cls, path: pathlib.Path, command: str) -> "Study":
        """Return the study in a file that `run` wrote; a last line that was torn by an interruption is dropped.

        Raises:
          ParameterError: if the file is missing, or is no study of that command.
        """
        try:
            head, *lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
            study = cls(**json.loads(head))
            study.results = [Result(**json.loads(line)) for line in lines if line.endswith("\n")]
            if study.command != command:
                raise ValueError(f"it is of `{study.command}`")
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

    def lines(self) -> str:
        """Return the study as lines of JSON: what it is of, and a line each result."""
        about = {name: getattr(self, name) for name in ("command", "settings", "machine")}
        return json.dumps(about, allow_nan=False) + "\n" + "".join(result.line() for result in self.results)


def run(
    rows: Sequence[Row],
    console: Console | None,
    path: pathlib.Path | None = None,
    command: str = "",
    settings: dict[str, Any] | None = None,
    processes: int = 1,
) -> Study:
    """Measure rows in their order and return them as a study; `console` shows a progress bar.

    With a `path`, every result is appended to that file as soon as it is there, and a study of the same settings on the
    same machine that is in it is gone on with. With several `processes`, the functions of the rows must be ones that
    can be pickled; they are told nothing of each other, and their warnings are not shown.

    Raises:
      OSError: if the system ends one of the processes.
      OutputError: if the file cannot be written.
      ParameterError: if the file is there, but is no study of this command.
    """
    study = Study(command, settings or {}, machine())
    if path is not None:
        if path.exists():
            stored = Study.load(path, command)
            if (stored.settings, stored.machine) == (study.settings, study.machine):
                study = stored
                if console is not None:
                    console.print(f"going on from {path}", highlight=False, markup=False, soft_wrap=True)
        files.write(path, study.lines())
    done = {_key(result): result for result in study.results}
    missing = [row for row in rows if _key(row) not in done]
    with progress_bar(console, len(missing)) as begin, closing(_measured(missing, processes, begin)) as results:
        for result in results:
            done[_key(result)] = result
            if path is not None:
                _append(path, result.line())
    study.results = [done[_key(row)] for row in rows]
    return study


def table(title: str, results: Sequence[Result], document: bool = False) -> Table:
    """Return a table of results; the last column is the verdict or, for a `document`, what dominates the error."""
    rows = []
    for result in results:
        failed = FAILED if document and not result.passed else ""
        last = result.reason if document else PASSED[result.passed]
        bound = f"{result.bound:.1e} {result.unit}".strip()
        rows.append((result.name, result.by, _number(result.error) + failed, bound, last))
    last = "what dominates the error" if document else "verdict"
    return Table(title, ("check", "by", "error", "at most", last), rows, left=(0, 1, 4))


def told(result: Result) -> str:
    """Return a result in a line, such as one that failed."""
    by = f" ({result.by})" if result.by else ""
    return f"{result.name}{by}: error {_number(result.error)}, at most {result.bound:.1e} {result.unit}".strip()


def machine() -> dict[str, Any]:
    """Return what run times and rounding depend on: processor, system, and versions of packages."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": {name: number for name in _PACKAGES if (number := _version(name))},
    }


def _measured(rows: Sequence[Row], processes: int, begin: Callable[[str], None]) -> Generator[Result]:
    """Yield the results of rows as they are ready, measured here or, if there are several, in other processes."""
    if min(processes, len(rows)) <= 1:
        for row in rows:
            begin(f"{row.name} ({row.by})" if row.by else row.name)
            yield row.result()
        return
    with pool(min(processes, len(rows))) as executor:
        try:
            for done in as_completed([executor.submit(_in_silence, row) for row in rows]):
                result = done.result()
                begin(result.name)
                yield result
        except BrokenProcessPool:
            raise OSError("a process of the study was ended from outside: is memory short?") from None


def _in_silence(row: Row) -> Result:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return row.result()


def _key(row: Row | Result) -> tuple[str, str, str]:
    return row.group, row.name, row.by


def _append(path: pathlib.Path, line: str) -> None:
    try:
        with path.open("a", encoding="utf-8") as file:
            file.write(line)
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}") from error


def _number(error: float | None) -> str:
    return "-" if error is None else f"{error:.1e}"


def _processor() -> str:
    """Return the name of the processor, or at least its architecture."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.machine())


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
