"""A piece of a long study: what it measures, under a name by which a stored result is found again."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Task:
    """One measurement of seconds; a study that was interrupted goes on with the next one."""

    group: str
    """The part of the study that it belongs to."""
    name: str
    """Unique in its group, and shown while it runs."""
    measure: Callable[[], dict[str, Any]]
    """Takes it; what it returns can be kept as JSON."""
