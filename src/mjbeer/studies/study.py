"""What all studies share: pieces of work that are kept as they are done, and the machine they ran on."""

import os
import pathlib
import platform
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any

_PACKAGES = ("mjbeer", "mujoco", "numpy", "scipy", "numba", "heyoka", "exudyn")


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


@dataclass(frozen=True)
class Task:
    """One measurement of seconds; a study that was interrupted goes on with the next one."""

    group: str
    """The part of the study that it belongs to."""
    name: str
    """Unique in its group, and shown while it runs."""
    measure: Callable[[], dict[str, Any]]
    """Takes it; what it returns can be kept as JSON."""
