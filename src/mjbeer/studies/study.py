"""Study: results on disk, so that an interrupted study is continued. Task: a piece of it. machine(): where it ran."""

import json
import os
import pathlib
import platform
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any, ClassVar, Self

from rich.console import Console

from mjbeer.exceptions import ParameterError
from mjbeer.output import files

_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka")


def machine() -> dict[str, Any]:
    """Return what run times and rounding depend on: processor, system, and versions of packages."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": {name: number for name in _PACKAGES if (number := _version(name))},
    }


def _processor() -> str:
    """Return the name of the processor, or at least its architecture."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def _version(name: str) -> str | None:
    """Return the version of a package, or None if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return None


@dataclass(frozen=True)
class Task:
    """A piece of a long study that takes seconds; an interrupted study is continued with the first that is missing."""

    group: str
    """The part of the study that the task belongs to."""
    name: str
    """A name that is unique in the group; the progress bar shows it."""
    measure: Callable[[], dict[str, Any]]
    """Runs the task and returns its results, which must be representable in JSON."""


@dataclass
class Study:
    """Results with the settings and the machine that they belong to; subclasses add the results as fields."""

    command: ClassVar[str]
    """The command that writes such a study."""
    settings: dict[str, Any]
    """What was to be measured, such as the cases and whether the study is quick."""
    machine: dict[str, Any]
    """What `machine()` returned when the study began."""

    @classmethod
    def begin(cls, path: pathlib.Path, settings: dict[str, Any], console: Console) -> Self:
        """Return the study in a file if it has these settings and is of this machine, or else an empty one.

        Raises:
          ParameterError: if the file exists and is not such a study.
        """
        empty = cls(settings, machine())
        if path.exists():
            stored = cls.load(path)
            if (stored.settings, stored.machine) == (empty.settings, empty.machine):
                console.print(f"going on from {path}", highlight=False, markup=False, soft_wrap=True)
                return stored
        return empty

    @classmethod
    def load(cls, path: pathlib.Path) -> Self:
        """Return the study in a file.

        Raises:
          ParameterError: if the file is missing, or is not such a study of this version.
        """
        try:
            return cls.read(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ParameterError(f"{path} was not written by `{cls.command}`: {error}") from error

    @classmethod
    def read(cls, document: dict[str, Any]) -> Self:
        """Return the study in a JSON document."""
        return cls(**document)

    def save(self, path: pathlib.Path) -> None:
        """Write the study to a file, whole or not at all.

        Raises:
          OutputError: if the file cannot be written.
        """
        files.write(path, self.json())

    def json(self) -> str:
        """Return the study as a JSON document."""
        return json.dumps(vars(self), indent=1, allow_nan=False) + "\n"
