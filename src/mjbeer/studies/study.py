"""What all studies share: a file that keeps what was measured, pieces of work, and the machine they ran on."""

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

_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka", "exudyn")


def machine() -> dict[str, Any]:
    """Return what measured numbers depend on: processor, system, versions."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        "versions": {name: number for name in _PACKAGES if (number := _version(name))},
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


@dataclass(frozen=True)
class Task:
    """A piece of a long study, of seconds; a study that was interrupted goes on with the next one."""

    group: str
    """The part of the study that it belongs to."""
    name: str
    """Unique in its group, and shown while it runs."""
    measure: Callable[[], dict[str, Any]]
    """Does it, and returns what can be kept as JSON."""


@dataclass
class Study:
    """What was measured, with what was asked for and where; a subclass adds what it measures as fields."""

    command: ClassVar[str]
    """The command that writes such a study."""
    settings: dict[str, Any]
    """What was asked for."""
    machine: dict[str, Any]

    @classmethod
    def begin(cls, path: pathlib.Path, settings: dict[str, Any], console: Console) -> Self:
        """Return the study in a file if it was made with these settings on this machine, or else an empty one.

        Raises:
          ParameterError: if the file is no such study.
        """
        empty = cls(settings, machine())
        if path.exists():
            kept = cls.load(path)
            if (kept.settings, kept.machine) == (empty.settings, empty.machine):
                console.print(f"going on from {path}", highlight=False, markup=False, soft_wrap=True)
                return kept
        return empty

    @classmethod
    def load(cls, path: pathlib.Path) -> Self:
        """Return the study in a file.

        Raises:
          ParameterError: if the file is missing, or no such study of this version.
        """
        try:
            return cls.read(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ParameterError(f"{path} was not written by `{cls.command}`: {error}") from error

    @classmethod
    def read(cls, document: dict[str, Any]) -> Self:
        """Return the study that a JSON document has."""
        return cls(**document)

    def save(self, path: pathlib.Path) -> None:
        """Write the study to a file, whole or not at all.

        Raises:
          OutputError: if it cannot be written.
        """
        files.write(path, self.json())

    def json(self) -> str:
        """Return the study as a JSON document."""
        return json.dumps(vars(self), indent=1, allow_nan=False) + "\n"
